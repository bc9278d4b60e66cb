// Counts shadow passes, drawn casters and map texels.

import { Object3D } from 'three';

/** Counters of a renderer's shadow passes. */
export class PassCounter {
  /** @param {import('three').WebGLRenderer} renderer */
  constructor(renderer) {
    this.targets = new Set();
    this.start();
    // The handlers of meshes stay as they are, because shadows of meshes with own handlers may not be kept for later frames.
    this.handler = Object3D.prototype.onBeforeShadow;
    Object3D.prototype.onBeforeShadow = (caller, _object, _camera, shadowCamera) => {
      if (caller === renderer) {
        this.casters += 1;
        this.cameras.add(shadowCamera);
        this.targets.add(renderer.getRenderTarget());
      }
    };
  }

  /** Begins a frame. */
  start() {
    this.casters = 0;
    this.cameras = new Set();
  }

  /** Returns the casters that were drawn since `start`, and the passes that drew any. */
  counts() {
    return { casters: this.casters, passes: this.cameras.size };
  }

  /** Returns the size of all maps that were drawn, in millions of texels, and forgets them. */
  takeMegatexels() {
    const texels = [...this.targets].reduce((sum, { width, height }) => sum + width * height, 0);
    this.targets.clear();
    return texels / 1e6;
  }

  /** Ends counting. */
  dispose() {
    Object3D.prototype.onBeforeShadow = this.handler;
  }
}
