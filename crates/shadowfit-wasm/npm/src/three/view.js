// Fits of one sun for one camera.

import { WebGPUCoordinateSystem } from 'three';

import { isSame } from './bounds.js';

/**
 * @typedef {object} Fit Result of a fit.
 * @property {import('../fitter.d.ts').FittedMap[]} maps Maps in the order of the look-up, without empty windows. It is
 * empty if the frame has no shadows.
 * @property {number[]} bits Bit of each map in the masks.
 * @property {Uint8Array} casters Maps that each row must be drawn into now.
 * @property {Uint8Array} keptCasters Maps that each row casts a shadow into.
 * @property {number[]} origin Position of the eye.
 * @property {unknown} settings Key of the settings of the fit.
 * @property {Error | undefined} error Reason why there are no maps.
 */

const NO_MASKS = new Uint8Array(0);

/** Returns a fit without maps. @returns {Fit} */
const noMaps = (origin, settings) =>
  ({ maps: [], bits: [], casters: NO_MASKS, keptCasters: NO_MASKS, origin, settings, error: undefined });

const UNUSABLE_CAMERA = 'the matrix of the camera is not finite; check its position, its field of view and its far plane';

/** The fitter of one camera, and its latest fit. */
export class CameraFit {
  /** @param {{ windows: Function, cascades?: Function }} fitters Classes of fitters, by their kind of maps. */
  constructor(fitters) {
    this.fitters = fitters;
    this.fitter = undefined;
    this.settings = undefined;
    /** @type {unknown[] | undefined} Everything that the latest fit was computed from. */
    this.input = undefined;
    /** @type {Fit} */
    this.fit = undefined;
    /** Whether visible surfaces are known, and whether they were counted since the latest fit. */
    this.isCounted = false;
    this.isRecounted = false;
    /** Input of the fit whose visible surfaces were read last. */
    this.read = undefined;
  }

  /** Forgets the visible surfaces. The boxes place the maps from now on. */
  forgetDepths() {
    if (this.isCounted) {
      this.fitter?.forgetDepths();
      this.isCounted = false;
      this.isRecounted = true;
    }
  }

  /** Returns a receiver of the visible surfaces of the latest fit's frame, unless they were read before. */
  reading() {
    const { fitter, input, direction, fit } = this;
    if (fitter === undefined || this.read === input || fit.maps.length === 0) {
      return undefined;
    }
    const count = (depths, width, view) => {
      // The fitter may be another one now.
      if (this.fitter === fitter) {
        fitter.countDepths(depths, width, view, direction);
        this.isCounted = true;
        this.isRecounted = true;
      }
    };
    const begin = () => { this.read = input; };
    return { begin, count };
  }

  /**
   * Returns the maps for a frame. Equal frames get the same object.
   * @param {import('./scan.js').SceneScan} scan
   * @param {import('three').Camera} camera
   * @param {{ direction: number[], casting: import('three').Layers, settings: import('./settings.js').Settings }} sun
   * @returns {Fit}
   */
  update(scan, camera, { direction, casting, settings }) {
    const views = viewsOf(camera);
    if (views.some(({ worldFromClip }) => !worldFromClip.every(Number.isFinite))) {
      this.input = undefined;
      this.fit = { ...noMaps([0, 0, 0], settings.key), error: new Error(UNUSABLE_CAMERA) };
      return this.fit;
    }
    const input = [scan, scan.version, scan.rows.length, settings.key, camera.layers.mask, casting.mask, ...direction];
    for (const { depth, worldFromClip } of views) {
      input.push(depth, ...worldFromClip);
    }
    if (!this.isRecounted && this.input && isSame(this.input, input)) {
      return this.fit;
    }
    // A fit by new counts has the same visible surfaces.
    this.read = this.input && isSame(this.input, input) ? input : this.read;
    this.input = input;
    this.direction = direction;
    this.isRecounted = false;
    const origin = [...views[0].eye];
    this.fit = noMaps(origin, settings.key);
    if (scan.hasCasters && scan.hasReceivers) {
      try {
        this.run(scan, views, camera, { direction, casting, settings });
      } catch (error) {
        this.fit = { ...this.fit, maps: [], error };
        // A fitter may be unusable after an error of the module itself.
        this.fitter = error.code === undefined ? undefined : this.fitter;
      }
    }
    return this.fit;
  }

  run(scan, views, camera, { direction, casting, settings }) {
    const Fitter = settings.isByDepth ? this.fitters.cascades : this.fitters.windows;
    if (!(this.fitter instanceof Fitter)) {
      this.fitter = new Fitter(settings.fitter);
    } else if (this.settings !== settings.key) {
      this.fitter.configure(settings.fitter);
    }
    this.settings = settings.key;
    const { fitter, fit } = this;
    scan.write(fitter.boxes(scan.rows.length, fit.origin), fit.origin, camera.layers, casting);
    const maps = fitter.fit(views, direction);
    fit.casters = fitter.casters.slice();
    fit.keptCasters = fitter.keptCasters.slice();
    if (maps.every((map) => map.isEmpty)) {
      return;
    }
    // Stock suns have two cascades, also if one of them is empty.
    maps.forEach((map, index) => {
      if (!map.isEmpty || settings.isByDepth) {
        fit.maps.push(map);
        fit.bits.push(1 << index);
      }
    });
  }
}

/**
 * Returns the fitter's views of a camera: one, or one per camera of a headset.
 * @param {import('three').Camera} camera
 * @returns {import('../fitter.d.ts').FitterView[]}
 */
export function viewsOf(camera) {
  const cameras = camera.isArrayCamera && camera.cameras.length > 0 ? camera.cameras : [camera];
  return cameras.map(viewOf);
}

/** @returns {import('../fitter.d.ts').FitterView} */
export function viewOf({ matrixWorld, projectionMatrixInverse, reversedDepth, coordinateSystem }) {
  const m = matrixWorld.elements;
  const zeroToOne = coordinateSystem === WebGPUCoordinateSystem ? 'zero-to-one' : 'minus-one-to-one';
  return {
    eye: [m[12], m[13], m[14]],
    worldFromClip: multiply(m, projectionMatrixInverse.elements),
    depth: reversedDepth ? 'reversed' : zeroToOne,
  };
}

/** Returns the product of two column-major matrices. */
function multiply(a, b) {
  const product = new Float64Array(16);
  for (let column = 0; column < 4; column += 1) {
    for (let row = 0; row < 4; row += 1) {
      for (let k = 0; k < 4; k += 1) {
        product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
      }
    }
  }
  return product;
}
