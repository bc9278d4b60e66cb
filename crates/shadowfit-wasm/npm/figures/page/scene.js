// A scene to measure: meshes for the renderer, and the same triangles in world space for rays.

import { Box3, BufferAttribute, DoubleSide, Scene, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

/** Attribute with the number of each triangle, equal at its three corners. */
export const TRIANGLE = 'triangle';

/** Meshes of a scene, and their triangles in world space. */
export class MeasuredScene {
  /**
   * Takes over the meshes below an object. All receive shadows.
   *
   * @param {string} name
   * @param {import('three').Object3D} root
   */
  constructor(name, root) {
    this.name = name;
    this.scene = new Scene();
    this.scene.add(root);
    this.scene.updateMatrixWorld(true);
    /** @type {import('three').Mesh[]} */
    this.meshes = [];
    root.traverse((object) => object.isMesh && this.meshes.push(object));
    for (const mesh of this.meshes) {
      mesh.receiveShadow = true;
      mesh.matrixAutoUpdate = false;
      if (!mesh.geometry.hasAttribute('normal')) {
        mesh.geometry.computeVertexNormals();
      }
    }
    /** Materials of the meshes as loaded. */
    this.materials = this.meshes.map((mesh) => mesh.material);
    /** Geometries of the meshes as loaded, and the same triangles with numbers. */
    this.geometries = this.meshes.map((mesh) => mesh.geometry);
    this.numbered = numberedGeometries(this.geometries);
    const lists = this.meshes.map((mesh, index) => worldCorners(mesh, this.numbered[index]));
    /** World-space corners, nine numbers per triangle. */
    this.corners = concatenate(lists);
    /** World-space corners of the triangles that cast shadows. */
    this.castingCorners = concatenate(lists.filter((_, index) => this.meshes[index].castShadow));
    this.box = new Box3().setFromArray(this.corners);
  }

  /**
   * Loads a GLB file. All its meshes cast shadows.
   *
   * @param {string} name
   * @param {string} address
   */
  static async load(name, address) {
    const { scene } = await new GLTFLoader().loadAsync(address);
    scene.traverse((object) => { object.castShadow = true; });
    return new MeasuredScene(name, scene);
  }

  /**
   * Gives every mesh a material.
   *
   * @param {(loaded: import('three').Material, index: number) => import('three').Material} materialOf - Receives the
   *   loaded material of a mesh, and the mesh's index.
   */
  dress(materialOf) {
    this.meshes.forEach((mesh, index) => {
      mesh.material = materialOf(this.materials[index], index);
    });
  }

  /**
   * Calls a function while the meshes have geometries with the attribute `TRIANGLE`.
   *
   * @param {() => void} draw
   */
  withNumbers(draw) {
    this.meshes.forEach((mesh, index) => { mesh.geometry = this.numbered[index]; });
    draw();
    this.meshes.forEach((mesh, index) => { mesh.geometry = this.geometries[index]; });
  }

  /** Number of triangles. */
  get triangles() {
    return this.corners.length / 9;
  }
}

/** Returns non-indexed copies of geometries, whose triangles are numbered one after another. */
function numberedGeometries(geometries) {
  let next = 0;
  return geometries.map((geometry) => {
    const copy = geometry.index ? geometry.toNonIndexed() : geometry.clone();
    const { count } = copy.attributes.position;
    const numbers = Float32Array.from({ length: count }, (_, corner) => next + Math.floor(corner / 3));
    next += count / 3;
    return copy.setAttribute(TRIANGLE, new BufferAttribute(numbers, 1));
  });
}

function worldCorners(mesh, { attributes: { position } }) {
  const corners = new Float32Array(position.count * 3);
  const corner = new Vector3();
  for (let index = 0; index < position.count; index += 1) {
    corner.fromBufferAttribute(position, index).applyMatrix4(mesh.matrixWorld).toArray(corners, 3 * index);
  }
  return corners;
}

function concatenate(lists) {
  const all = new Float32Array(lists.reduce((sum, list) => sum + list.length, 0));
  let offset = 0;
  for (const list of lists) {
    all.set(list, offset);
    offset += list.length;
  }
  return all;
}

/**
 * Returns a function for `dress` that gives all meshes of one side the same material. Its `made` holds the materials.
 *
 * @param {(side: import('three').Side) => import('three').Material} make
 */
export function bySide(make) {
  const made = new Map();
  return Object.assign((loaded) => {
    const side = loaded.side ?? DoubleSide;
    if (!made.has(side)) {
      made.set(side, make(side));
    }
    return made.get(side);
  }, { made });
}
