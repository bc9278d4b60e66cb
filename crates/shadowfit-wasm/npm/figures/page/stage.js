// A renderer that draws a scene into a float picture, as stock three.js shows it: no tone mapping, no ambient light.

import {
  BackSide, DepthTexture, DoubleSide, FloatType, FrontSide, MeshLambertMaterial, NearestFilter, NoToneMapping, PCFShadowMap,
  RedFormat, WebGLRenderer, WebGLRenderTarget,
} from 'three';
import { bySide } from './scene.js';

/** Names of the sides that a material can draw into shadow maps. */
export const SHADOW_SIDES = { front: FrontSide, back: BackSide, double: DoubleSide };

/** A renderer with a float picture, and counters of its shadow passes. */
export class Stage {
  /**
   * @param {import('./scene.js').MeasuredScene} scene
   * @param {[number, number]} size - Width and height of pictures, in pixels.
   */
  constructor(scene, [width, height]) {
    this.scene = scene;
    this.size = [width, height];
    this.renderer = new WebGLRenderer();
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    const filter = { minFilter: NearestFilter, magFilter: NearestFilter };
    // The depth texture makes the picture's depths readable, like the depths of a canvas.
    const depthTexture = new DepthTexture(width, height);
    this.target = new WebGLRenderTarget(width, height, { type: FloatType, format: RedFormat, depthTexture, ...filter });
    /** Materials that meshes were given. They are kept to the end, so that later ones find their compiled shaders. */
    this.materials = [];
  }

  /**
   * Gives every mesh a stock white Lambert material.
   *
   * @param {string} [shadowSide] - Side that is drawn into shadow maps, if it is not three.js's choice.
   * @returns {import('three').Material[]} The materials, one per side.
   */
  dress(shadowSide) {
    const material = (side) => new MeshLambertMaterial({
      side, shadowSide: shadowSide === undefined ? null : SHADOW_SIDES[shadowSide],
    });
    const white = bySide(material);
    this.scene.dress(white);
    this.materials.push(...white.made.values());
    return [...white.made.values()];
  }

  /**
   * Draws the scene. Returns the time that the calls took on the CPU, in milliseconds.
   *
   * @param {import('three').Camera} camera
   * @param {boolean} drawsMaps - Whether shadow maps are fitted and drawn. If not, the maps of the last frame are used.
   */
  draw(camera, drawsMaps) {
    this.renderer.shadowMap.autoUpdate = drawsMaps;
    this.renderer.setRenderTarget(this.target);
    const start = performance.now();
    this.renderer.render(this.scene.scene, camera);
    return performance.now() - start;
  }

  /** Returns the brightness of the picture's pixels, rows from the bottom. Also waits for the GPU. */
  read() {
    const [width, height] = this.size;
    const pixels = new Float32Array(width * height);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, width, height, pixels);
    return pixels;
  }

  /** Frees the renderer and its context. */
  dispose() {
    this.materials.forEach((material) => material.dispose());
    this.target.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
