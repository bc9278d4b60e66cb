/**
 * The fitter of one sun and one camera, around an instance of the WebAssembly module. Instances are small and share the
 * compiled code, and the garbage collector frees them, so there is nothing to dispose of.
 */

/** Numbers of the settings, in the module's order. */
const KINDS = { windows: 0, cascades: 1 };
const BIASES = { plane: 0, normal: 1, constant: 2 };
const FORMATS = { float32: 0, unorm24: 1, unorm16: 2 };
const DEPTH_RANGES = { 'zero-to-one': 0, 'minus-one-to-one': 1, reversed: 2 };
/** Layout of the module's memory, as in the crate's `input.rs` and `output.rs`. */
const SETTINGS = 15;
const MAX_VIEWS = 4;
const VIEW = 20;
const MAP = 22;
/** Sentences of the module's error numbers. `name` is the input, `a`, `b` and `c` are values. */
const SENTENCES = {
  1: ({ name, a }) => `${name} is ${a}; give a finite number`,
  2: ({ name, a, b, c }) => `${name} is ${a}; give a value from ${b} to ${c}`,
  3: ({ name, a }) => `${name} has length ${a}; give a vector of about unit length`,
  4: ({ a, b }) => `the camera's matrix has w = ${b} at corner ${a} of the view; check its near and far planes`,
  5: ({ name }) => `the camera's matrix has no usable ${name}`,
  6: () => 'the far plane is infinite, so shadows have no end; set a shadow distance',
  7: ({ a }) => `the camera's depth range differs from the stated one: its depth is ${a ? '' : 'not '}reversed`,
  8: ({ a, b, c }) => `the view is empty: its box is ${a} × ${b} × ${c}; check the field of view and the aspect ratio`,
  9: ({ a, b }) => `near ${a} is not below far ${b}; raise the far plane or the shadow distance`,
  10: () => 'there is no view to fit to; give at least one camera',
  11: () => 'the shadow map has no texels; give it a width and a height',
  12: ({ name }) => `this module has no ${name}; import the one that has them`,
  99: () => 'the settings do not work together',
};

/** Reason why a fit failed. */
export class FitError extends Error {
  /**
   * @param {number} code
   * @param {string} message
   */
  constructor(code, message) {
    super(message);
    this.name = 'FitError';
    this.code = code;
  }
}

/**
 * Creates the class of fitters for a module.
 * @param {Uint8Array<ArrayBuffer>} bytes The module.
 * @param {'windows' | 'cascades'} kind Its kind of maps.
 */
export function fitterClass(bytes, kind) {
  /** Compiled when the first fitter needs it. @type {WebAssembly.Module | undefined} */
  let module;
  return class SunFitter {
    /** @type {any} */ #wasm;
    #count = 0;
    #origin = [0, 0, 0];
    /** @type {import('./fitter.js').FittedMap[]} */
    maps = [];

    /** @param {import('./fitter.js').FitterSettings} [settings] */
    constructor(settings = {}) {
      module ??= new WebAssembly.Module(bytes);
      this.#wasm = new WebAssembly.Instance(module).exports;
      this.configure(settings);
    }

    /** @param {import('./fitter.js').FitterSettings} settings */
    configure({
      maps = 4,
      mapSize = 2048,
      distance = Infinity,
      up = [0, 1, 0],
      selection = 'coverage',
      blend = selection === 'coverage' ? 8 : 0.1,
      filter: { taps = 1, disc = 0 } = {},
      bias = 'plane',
      faces = 'all',
      depth = 'float32',
    } = {}) {
      const isByDepth = selection === 'view-depth' ? 1 : 0;
      const hasBackFaces = faces === 'back' ? 1 : 0;
      const numbers = [KINDS[kind], maps, mapSize, mapSize, Math.min(distance, Number.MAX_VALUE), up[0], up[1], up[2]];
      numbers.push(blend, isByDepth, taps, disc, BIASES[bias], hasBackFaces, FORMATS[depth]);
      this.#doubles(this.#wasm.settings(), SETTINGS).set(numbers);
      this.#wasm.configure();
    }

    /**
     * @param {number} count
     * @param {import('./fitter.js').Vec3} origin
     */
    boxes(count, origin) {
      this.#count = count;
      this.#origin = [origin[0], origin[1], origin[2]];
      const bounds = this.#wasm.boxes(count, ...this.#origin);
      const flags = this.#wasm.flags();
      const { buffer } = this.#wasm.memory;
      return { bounds: new Float32Array(buffer, bounds, count * 6), flags: new Uint8Array(buffer, flags, count) };
    }

    /**
     * @param {import('./fitter.js').FitterView[]} views
     * @param {import('./fitter.js').Vec3} direction
     */
    fit(views, direction) {
      this.#writeFrame(views, direction);
      const count = this.#wasm.fit();
      if (count < 0) {
        this.maps = [];
        throw this.#error();
      }
      const numbers = this.#doubles(this.#wasm.maps(), count * MAP).slice();
      this.maps = Array.from({ length: count }, (_, i) => fittedMap(numbers.subarray(i * MAP, (i + 1) * MAP)));
      return this.maps;
    }

    get casters() {
      return new Uint8Array(this.#wasm.memory.buffer, this.#wasm.casters(0), this.#count);
    }

    get keptCasters() {
      return new Uint8Array(this.#wasm.memory.buffer, this.#wasm.casters(1), this.#count);
    }

    /**
     * @param {Float32Array} depths
     * @param {number} width
     * @param {import('./fitter.js').FitterView} view
     * @param {import('./fitter.js').Vec3} direction
     */
    countDepths(depths, width, view, direction) {
      this.#writeFrame([view], direction);
      const address = this.#wasm.depths(depths.length);
      new Float32Array(this.#wasm.memory.buffer, address, depths.length).set(depths);
      if (this.#wasm.count_depths(width) !== 0) throw this.#error();
    }

    reset() {
      this.#wasm.reset();
    }

    forgetDepths() {
      this.#wasm.forget_depths();
    }

    #writeFrame(views, direction) {
      if (views.length > MAX_VIEWS) throw new FitError(2, `there are ${views.length} views; give at most ${MAX_VIEWS}`);
      const input = this.#doubles(this.#wasm.input(), 4 + MAX_VIEWS * VIEW);
      input.set([views.length, direction[0], direction[1], direction[2]]);
      views.forEach(({ eye, worldFromClip, depth }, i) => {
        input.set([eye[0], eye[1], eye[2], DEPTH_RANGES[depth]], 4 + i * VIEW);
        input.set(worldFromClip, 8 + i * VIEW);
      });
    }

    /** Returns numbers of the memory. They are valid until the next call, because memory may grow. */
    #doubles(address, count) {
      return new Float64Array(this.#wasm.memory.buffer, address, count);
    }

    #error() {
      const wasm = this.#wasm;
      const code = wasm.error();
      const length = wasm.error_input_length();
      const name = new TextDecoder().decode(new Uint8Array(wasm.memory.buffer, wasm.error_input(), length));
      const [a, b, c] = [0, 1, 2].map((i) => wasm.error_value(i));
      return new FitError(code, (SENTENCES[code] ?? SENTENCES[99])({ name, a, b, c }));
    }
  };
}

/**
 * Names the numbers of a map.
 * @param {Float64Array} numbers
 * @returns {import('./fitter.js').FittedMap}
 */
function fittedMap(numbers) {
  return {
    x: numbers.subarray(0, 3),
    y: numbers.subarray(3, 6),
    z: numbers.subarray(6, 9),
    position: numbers.subarray(9, 12),
    width: numbers[12],
    height: numbers[13],
    depthRange: numbers[14],
    constantDepth: numbers[15],
    receiverPlane: numbers[16],
    normalOffset: numbers[17],
    depths: numbers.subarray(18, 21),
    isEmpty: numbers[21] !== 0,
  };
}
