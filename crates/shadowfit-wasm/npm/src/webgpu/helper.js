// Lines around the maps of a sun, coloured by map.

import { ShadowfitHelper as Lines } from '../three/helper.js';

/** See `src/three-webgpu.d.ts`. */
export class ShadowfitHelper extends Lines {
  /** Moves the lines to the present maps. The geometry has room for the finest four. */
  update() {
    super.update();
    const { drawRange, attributes: { position } } = this.geometry;
    this.geometry.setDrawRange(0, Math.min(drawRange.count, position.count));
  }
}
