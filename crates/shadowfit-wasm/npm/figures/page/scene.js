// A scene to measure: meshes for the renderer, and the same triangles in world space for rays.

import { Box3, BufferAttribute, DoubleSide, Scene, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

/** Attribute with the number of each triangle, equal at its three corners. */
export const TRIANGLE = 'triangle';

/** Meshes of a scene, and their triangles in world space. */
export class MeasuredScene {
  /**
   * Takes over the meshes below an object. All receive shadows. Geometries become non-indexed, so that each triangle has
   * a number.
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
    /** Materials of the meshes as loaded. */
    this.materials = this.meshes.map((mesh) => mesh.material);
    const lists = this.meshes.map(numberTriangles());
    /** World-space corners, nine numbers per triangle. */
    this.corners = concatenate(lists);
    /** World-space corners of the triangles that cast shadows. */
    this.castingCorners = concatenate(lists.filter((_, index) => this.meshes[index].castShadow));
    this.box = new Box3().setFromArray(this.corners);
    for (const mesh of this.meshes) {
      mesh.receiveShadow = true;
      mesh.matrixAutoUpdate = false;
    }
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

  /** Number of triangles. */
  get triangles() {
    return this.corners.length / 9;
  }
}

/** Returns a function that numbers the triangles of meshes one after another, and returns their world-space corners. */
function numberTriangles() {
  let next = 0;
  return (mesh) => {
    mesh.geometry = mesh.geometry.index ? mesh.geometry.toNonIndexed() : mesh.geometry.clone();
    if (!mesh.geometry.hasAttribute('normal')) {
      mesh.geometry.computeVertexNormals();
    }
    const { position } = mesh.geometry.attributes;
    const corners = new Float32Array(position.count * 3);
    const numbers = new Float32Array(position.count);
    const corner = new Vector3();
    for (let index = 0; index < position.count; index += 1) {
      corner.fromBufferAttribute(position, index).applyMatrix4(mesh.matrixWorld).toArray(corners, 3 * index);
      numbers[index] = next + Math.floor(index / 3);
    }
    next += position.count / 3;
    mesh.geometry.setAttribute(TRIANGLE, new BufferAttribute(numbers, 1));
    return corners;
  };
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
