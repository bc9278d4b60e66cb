// The maps of a sun as tiles of one texture: cameras, viewports and frustums to draw them, and the matrices of the stock
// look-up.

import { Frustum, OrthographicCamera, Vector4 } from 'three';

import { depthBias } from './lookup.js';

/**
 * A map's frustum. It culls objects by the fitter's lists of casters instead of their spheres. three.js r186 and r187 both
 * ask it by `intersectsObject`.
 */
class CasterFrustum extends Frustum {
  constructor() {
    super();
    /** Bit of the map in the masks. */
    this.bit = 0;
    /** Objects that were drawn into the map. */
    this.drawn = 0;
    /** @type {import('./scan.js').SceneScan | undefined} */
    this.scan = undefined;
    /** @type {Uint8Array} */
    this.masks = new Uint8Array(0);
  }

  /** Sets the list of casters. Nothing is drawn without a scan. */
  use(scan, masks, bit) {
    this.scan = scan;
    this.masks = masks;
    this.bit = bit;
    this.drawn = 0;
  }

  intersectsObject(object) {
    const isDrawn = this.scan !== undefined && (this.scan.maskOf(object, this.masks) & this.bit) !== 0;
    this.drawn += isDrawn ? 1 : 0;
    return isDrawn;
  }
}

/** Tiles of the maps of one sun in its texture. */
export class Atlas {
  /** @param {number} tiles Number of tiles, 1 to 4. */
  constructor(tiles) {
    this.columns = tiles > 1 ? 2 : 1;
    this.rows = tiles > 2 ? 2 : 1;
    /** @type {import('../fitter.d.ts').FittedMap[]} */
    this.windows = [];
    /** Coordinate of the common near plane along the axis toward the light, and distance to the common far plane. */
    this.near = 0;
    this.range = 1;
    this.isReversed = false;
    this.viewports = Array.from({ length: tiles }, (_, tile) =>
      new Vector4(tile % this.columns, Math.floor(tile / this.columns), 1, 1));
    this.cameras = this.viewports.map(() => new OrthographicCamera());
    this.frustums = this.viewports.map(() => new CasterFrustum());
  }

  /**
   * Sets the maps. They share the near plane nearest to the light and the farthest far plane, so that one factor converts
   * positions to depths in all maps.
   * @param {import('../fitter.d.ts').FittedMap[]} windows
   */
  place(windows, isReversed) {
    this.windows = windows;
    this.isReversed = isReversed;
    const planes = windows.map(({ z, position, depthRange }) => {
      const near = z[0] * position[0] + z[1] * position[1] + z[2] * position[2];
      return { near, far: near - depthRange };
    });
    this.near = Math.max(...planes.map(({ near }) => near));
    this.range = this.near - Math.min(...planes.map(({ far }) => far));
    windows.forEach((window, tile) => aim(this.cameras[tile], window, this.near - planes[tile].near, this));
  }

  /**
   * Sets the casters to draw. Tiles without a map get none.
   * @param {Uint8Array} masks
   * @param {number[]} bits Bit of each map.
   */
  cull(scan, masks, bits) {
    this.frustums.forEach((frustum, tile) => frustum.use(tile < bits.length ? scan : undefined, masks, bits[tile]));
  }

  /**
   * Writes the matrix of the stock look-up for one map, from world space to the atlas, with the bias in its depth.
   * @param {import('three').Matrix4} matrix
   */
  writeMatrix(matrix, tile) {
    const camera = this.cameras[tile];
    const { columns, rows, isReversed } = this;
    const { x, y } = this.viewports[tile];
    const [u, v] = [1 / columns, 1 / rows];
    const bias = depthBias(this.windows[tile], this);
    matrix.set(
      0.5 * u, 0, 0, (0.5 + x) * u,
      0, 0.5 * v, 0, (0.5 + y) * v,
      0, 0, isReversed ? 1 : 0.5, isReversed ? bias : 0.5 - bias,
      0, 0, 0, 1,
    );
    matrix.multiply(camera.projectionMatrix).multiply(camera.matrixWorldInverse);
  }
}

/**
 * Places a camera over a map.
 * @param {import('three').OrthographicCamera} camera
 * @param {import('../fitter.d.ts').FittedMap} window
 * @param {number} rise Distance from the map's near plane to the common one.
 */
function aim(camera, { x, y, z, position: p, width, height }, rise, { range, isReversed }) {
  camera.matrix.set(
    x[0], y[0], z[0], p[0] + z[0] * rise,
    x[1], y[1], z[1], p[1] + z[1] * rise,
    x[2], y[2], z[2], p[2] + z[2] * rise,
    0, 0, 0, 1,
  );
  camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
  camera.matrixWorld.copy(camera.matrix);
  camera.matrixWorldInverse.copy(camera.matrixWorld).invert();
  [camera.left, camera.right, camera.bottom, camera.top] = [-width / 2, width / 2, -height / 2, height / 2];
  [camera.near, camera.far] = [0, range];
  camera._reversedDepth = isReversed;
  camera.updateProjectionMatrix();
}
