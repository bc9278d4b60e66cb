/** Three numbers: x, y, z. */
export type Vec3 = readonly [number, number, number] | ArrayLike<number>;

/** Depth range of a camera's clip space. `reversed` has 1 at the near plane and 0 at the far plane. */
export type DepthRange = 'zero-to-one' | 'minus-one-to-one' | 'reversed';

/** Settings of a fitter. Lengths are in world units. */
export interface FitterSettings {
  /** Number of maps: 1 to 8 windows, or 1 to 8 cascades. Default: 4. */
  maps?: number;
  /** Width and height of a map, in texels. Default: 2048. */
  mapSize?: number;
  /** View depth at which shadows end. `Infinity` means the camera's far plane. Default: `Infinity`. */
  distance?: number;
  /** Up direction of the world. Default: `[0, 1, 0]`. */
  up?: Vec3;
  /** Width of the blend into the next coarser map, in texels, 0 to 64. Default: 8. Cascades read by view depth take it as
   * the share of a cascade's view depths that the next one also covers, 0 to 1. */
  blend?: number;
  /** Rule by which a point selects its map. Windows are always read by coverage. Default: `coverage`. */
  selection?: 'coverage' | 'view-depth';
  /** Footprint of the shader's filter. */
  filter?: {
    /** Greatest distance along one axis from a look-up to a texel that it reads, in texels: 0.5 for one nearest texel, 1 for
     * a bilinear comparison. Default: 1. */
    taps?: number;
    /** Radius of the disc that the look-ups are spread over, in texels. Default: 0. */
    disc?: number;
  };
  /** Form of the bias that the shader can apply.
   * - `plane`: each comparison uses the depth of the receiver's plane at that comparison's place, moved by
   *   `receiverPlane` texels of the plane's gradient, plus `constantDepth`.
   * - `normal`: an offset of the looked-up point along the normal times the sine of the angle to the light.
   * - `constant`: a constant depth alone. It covers the ground (the plane across `up`) and everything that faces the light
   *   at least as well.
   * Default: `plane`. */
  bias?: 'plane' | 'normal' | 'constant';
  /** Faces that are drawn into the maps. Default: `all`. */
  faces?: 'all' | 'back';
  /** Format of the maps. Default: `float32`. */
  depth?: 'float32' | 'unorm24' | 'unorm16';
}

/** A view to fit the maps to. */
export interface FitterView {
  /** Position of the eye. */
  eye: Vec3;
  /** Matrix from clip space to world space, column-major: `camera.matrixWorld * camera.projectionMatrixInverse`. */
  worldFromClip: ArrayLike<number>;
  /** Depth range of the clip space. */
  depth: DepthRange;
}

/** A fitted map. Light space has its axes along `x`, `y` and `z`; `z` points toward the light. A world point p has the
 * light-space position (x · (p - position), y · (p - position), z · (p - position)). The map covers -width/2 to width/2 and
 * -height/2 to height/2, and depths from 0 (near plane) to `depthRange` along -z. */
export interface FittedMap {
  /** Unit axes of the map in the world: u, against v, and toward the light. */
  readonly x: Float64Array;
  readonly y: Float64Array;
  readonly z: Float64Array;
  /** World position of the middle of the near plane. */
  readonly position: Float64Array;
  /** Size of the map across the light, in world units. */
  readonly width: number;
  readonly height: number;
  /** Distance between the near and the far plane. */
  readonly depthRange: number;
  /** Bias that moves a looked-up depth toward the light, in units of 0..1 over `depthRange`. */
  readonly constantDepth: number;
  /** Factor of the receiver plane's change of depth over one texel along u plus along v, in texels. */
  readonly receiverPlane: number;
  /** Offset along the geometric normal, times the sine of the angle to the light, in world units. */
  readonly normalOffset: number;
  /** View depths for which points read the map, if selected by view depth: begin, end, and begin of the next map's blend. */
  readonly depths: Float64Array;
  /** Whether nothing visible reads the map. */
  readonly isEmpty: boolean;
}

/** Why a fit failed. */
export class FitError extends Error {
  /** Number of the error, constant between versions. */
  readonly code: number;
}

/** Fits the maps of one sun for one camera, frame by frame. It remembers earlier frames. */
export class SunFitter {
  constructor(settings?: FitterSettings);
  /** Changes the settings. The next fit keeps no map of the old ones. */
  configure(settings: FitterSettings): void;
  /** Makes room for boxes, and returns the arrays to write them into: `bounds` has min x, y, z, max x, y, z of each box
   * **relative to `origin`**; `flags` has bit 0 for casters and bit 1 for receivers. The arrays are valid until the next
   * call of any method. Boxes keep their values between frames while their number stays the same. */
  boxes(count: number, origin: Vec3): { bounds: Float32Array; flags: Uint8Array };
  /** Fits the maps. `direction` is the light's direction of travel, of any length. Throws a `FitError` and leaves no maps if
   * an input is unusable. */
  fit(views: FitterView[], direction: Vec3): FittedMap[];
  /** The maps of the last fit; none after an error, or if nothing in view has shadows. */
  readonly maps: FittedMap[];
  /** One byte per box: bit i is set if the box must be drawn into map i to have all visible shadows. Valid until the next
   * call of any method. */
  readonly casters: Uint8Array;
  /** Like `casters`, but for maps that are kept over several frames: everything that casts a shadow into the map. */
  readonly keptCasters: Uint8Array;
  /** Counts the surfaces that a depth buffer shows. Later fits place the maps by them, until they are counted anew.
   * `depths` are rows from the **top**, as stored (0..1). `view` is the view that they were drawn with. */
  countDepths(depths: Float32Array, width: number, view: FitterView, direction: Vec3): void;
  /** Forgets the counted surfaces. Later fits estimate the visible surfaces from the boxes. */
  forgetDepths(): void;
  /** Forgets all earlier frames, after a camera cut. */
  reset(): void;
}
