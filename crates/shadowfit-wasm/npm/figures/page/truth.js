// The truth of a frame: one shadow ray for each pixel that faces the light.

import {
  BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, GLSL3, PerspectiveCamera, Ray, ShaderMaterial,
} from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { cameraInViewSpaceOf, inView, moveCamera } from './camera.js';
import { edgeZones } from './edges.js';
import { bySide, TRIANGLE } from './scene.js';
import { Stage } from './stage.js';
import { surfacePoints } from './surface.js';

/** Distance of a ray's start from the surface, along the geometric normal on the side of the eye, in metres. */
const RAY_OFFSET = 1e-3;
/** Brightness below which a pixel has no shadow factor, because a division would amplify rounding errors. */
const DARK = 1e-4;

/**
 * The judged pixels of a frame: they face the light, and lie between the near and the far plane. All lists have one
 * element per judged pixel.
 *
 * @typedef {object} Truth
 * @property {Uint32Array} pixels - Index in the picture, rows from the bottom.
 * @property {Float32Array} brightness - Brightness without shadows.
 * @property {Float32Array} facing - Cosine between the geometric normal and the direction toward the light.
 * @property {Uint8Array} isLit - Whether the ray reaches the light.
 * @property {Uint8Array} isInEdgeZone - Whether a true shadow edge lies within 4 pixels.
 * @property {Uint8Array} isNearEdge - Whether a true shadow edge lies within 16 pixels.
 * @property {Uint8Array} isCompared - Whether crawl can be counted: the view of the frame before holds the point.
 */

/** Traces the truth of a scene's frames. */
export class TruthTracer {
  /**
   * @param {import('./scene.js').MeasuredScene} scene
   * @param {[number, number]} size - Width and height of pictures, in pixels.
   */
  constructor(scene, size) {
    this.scene = scene;
    this.stage = new Stage(scene, size);
    this.stage.renderer.shadowMap.enabled = false;
    this.light = new DirectionalLight(0xffffff, Math.PI);
    this.numbers = bySide(numberMaterial);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(scene.castingCorners, 3));
    this.bvh = new MeshBVH(geometry);
  }

  /**
   * Traces the truth of a frame.
   *
   * @param {import('./camera.js').Frame} frame
   * @param {import('./camera.js').Frame} [before] - The frame before on the path.
   * @returns {Truth}
   */
  trace(frame, before) {
    const camera = new PerspectiveCamera();
    moveCamera(camera, frame);
    const brightness = this.#brightness(frame, camera);
    const triangles = this.#triangles(camera);
    const again = before && this.#triangles(cameraInViewSpaceOf(frame, before));
    const visible = triangles.map((triangle, pixel) => (brightness[pixel] < DARK ? -1 : triangle));
    const points = surfacePoints(frame, this.stage.size, this.scene.corners, visible);
    const isLit = this.#rays(frame, points);
    const isHeld = before ? inView(before) : () => false;
    const isCompared = (pixel, index) => again?.[pixel] === triangles[pixel] && isHeld(points.positions, 3 * index);
    return {
      pixels: points.pixels,
      brightness: Float32Array.from(points.pixels, (pixel) => brightness[pixel]),
      facing: points.facing,
      isLit,
      ...edgeZones(this.stage.size, points.pixels, isLit),
      isCompared: Uint8Array.from(points.pixels, isCompared),
    };
  }

  /** Frees the renderer. */
  dispose() {
    this.stage.dispose();
  }

  #brightness(frame, camera) {
    const { scene } = this.scene;
    this.stage.dress();
    this.light.position.fromArray(frame.light_dir).negate();
    scene.add(this.light);
    this.stage.draw(camera, false);
    scene.remove(this.light);
    return this.stage.read();
  }

  /** Returns the number of the visible triangle at each pixel, or -1. */
  #triangles(camera) {
    this.scene.dress(this.numbers);
    this.scene.withNumbers(() => this.stage.draw(camera, false));
    return this.stage.read().map((number) => number - 1);
  }

  #rays(frame, { pixels, positions, normals }) {
    const ray = new Ray();
    ray.direction.fromArray(frame.light_dir).negate();
    return Uint8Array.from(pixels, (_, index) => {
      ray.origin.fromArray(positions, 3 * index);
      ray.origin.x += RAY_OFFSET * normals[3 * index];
      ray.origin.y += RAY_OFFSET * normals[3 * index + 1];
      ray.origin.z += RAY_OFFSET * normals[3 * index + 2];
      return this.bvh.raycastFirst(ray, DoubleSide) === null;
    });
  }
}

/** Returns a material that draws the numbers of triangles plus one. Vertices transform exactly as in stock materials. */
function numberMaterial(side) {
  return new ShaderMaterial({
    side,
    glslVersion: GLSL3,
    vertexShader: `
      in float ${TRIANGLE};
      flat out float vNumber;
      void main() {
        vNumber = ${TRIANGLE} + 1.0;
        vec4 mvPosition = vec4(position, 1.0);
        mvPosition = modelViewMatrix * mvPosition;
        gl_Position = projectionMatrix * mvPosition;
      }`,
    fragmentShader: `
      flat in float vNumber;
      out vec4 number;
      void main() { number = vec4(vNumber); }`,
  });
}
