// A contestant at work: its sun on one path, and its pictures.

import * as THREE from 'three';
import { cameraInViewSpaceOf, moveCamera } from './camera.js';
import { PassCounter } from './passes.js';

/** Time between frames at 60 frames per second, in milliseconds. */
const FRAME_TIME = 16;

/**
 * Biases of a contestant. Absent ones keep three.js's defaults.
 *
 * @typedef {object} Biases
 * @property {number} [bias] - Shadow bias, in units of the shadow camera's depth range.
 * @property {number} [normalBias] - Offset along the normal, in metres.
 * @property {'front' | 'back' | 'double'} [shadowSide] - Side of the materials that is drawn into shadow maps.
 */

/** A contestant that draws the frames of a scene. */
export class Entry {
  /**
   * Uses a stage until `dispose`.
   *
   * @param {object} contestant - See `contestants/index.js`.
   * @param {import('./stage.js').Stage} stage
   * @param {Biases} [biases]
   */
  constructor(contestant, stage, biases = {}) {
    this.contestant = contestant;
    this.biases = biases;
    // CSM replaces shader chunks for good, which would change the shaders of later contestants.
    this.chunks = { ...THREE.ShaderChunk };
    this.stage = stage;
    this.counter = new PassCounter(this.stage.renderer);
    this.camera = new THREE.PerspectiveCamera();
    this.megatexels = 0;
  }

  /**
   * Begins a path with a fresh sun.
   *
   * @param {import('./camera.js').Frame} frame - The first frame.
   */
  async beginPath(frame) {
    this.#endPath();
    const { scene, box } = this.stage.scene;
    const materials = this.stage.dress(this.biases.shadowSide);
    moveCamera(this.camera, frame);
    this.sun = await this.contestant.create({
      THREE,
      renderer: this.stage.renderer,
      scene,
      camera: this.camera,
      box,
      materials,
      towardLight: new THREE.Vector3().fromArray(frame.light_dir).negate(),
      distance: frame.far,
    });
    this.setBiases(this.biases);
    this.last = undefined;
  }

  /** Sets the biases that need no new materials. */
  setBiases({ bias, normalBias }) {
    for (const shadow of this.sun.shadows) {
      shadow.bias = bias ?? shadow.bias;
      shadow.normalBias = normalBias ?? shadow.normalBias;
    }
  }

  /**
   * Fits and draws the maps of a frame and its picture. Returns the time that both took on the CPU, in milliseconds.
   *
   * @param {import('./camera.js').Frame} frame
   */
  draw(frame) {
    this.counter.start();
    moveCamera(this.camera, frame);
    const start = performance.now();
    this.sun.update?.();
    const updated = performance.now();
    const drawing = this.stage.draw(this.camera, true);
    this.last = frame;
    return updated - start + drawing;
  }

  /**
   * Draws the picture of a frame with the maps of the last frame, as that frame selected them. Returns the time that the
   * calls took on the CPU, in milliseconds.
   *
   * @param {import('./camera.js').Frame} frame
   */
  drawWithLastMaps(frame) {
    return this.stage.draw(cameraInViewSpaceOf(frame, this.last), false);
  }

  /** Waits as long as an application between frames. Results that a fit reads from the GPU arrive in this time. */
  rest() {
    return new Promise((done) => { setTimeout(done, FRAME_TIME); });
  }

  /** Draws and returns the picture of the last frame without shadows, which must show the brightness of a plain sun. */
  drawUnshadowed() {
    const intensities = this.sun.shadows.map((shadow) => shadow.intensity);
    this.sun.shadows.forEach((shadow) => { shadow.intensity = 0; });
    this.stage.draw(this.camera, false);
    this.sun.shadows.forEach((shadow, index) => { shadow.intensity = intensities[index]; });
    return this.stage.read();
  }

  /** Removes the sun, and restores everything that the contestant changed. */
  dispose() {
    this.#endPath();
    this.counter.dispose();
    Object.assign(THREE.ShaderChunk, this.chunks);
  }

  #endPath() {
    this.sun?.dispose();
    this.sun = undefined;
    this.megatexels = Math.max(this.megatexels, this.counter.takeMegatexels());
  }
}
