import {
  type BufferGeometry, type Camera, type Frustum, type Light, LightShadow, type LineBasicMaterial, LineSegments,
  type Matrix4, type OrthographicCamera, type Vector2,
} from 'three';

/** Options of a shadow. Lengths are in world units. */
export interface ShadowfitOptions {
  /** Number of maps. More maps draw finer shadows and need more memory. The stock look-up always has 2. Default: 4. */
  maps?: 1 | 2 | 3 | 4;
  /** Width and height of a map, in texels. All maps share one texture of up to 2 × 2 maps. Default: 2048. */
  mapSize?: number;
  /** View depth at which shadows end. Shadows fade out over its last tenth. Default: `Infinity`, the camera's far plane. */
  distance?: number;
  /** Look-up of the maps in the shaders.
   * - `coverage`: each point reads the finest map that covers it, with a filter of 3 × 3 comparisons and a bias from the
   *   receiver's plane. It changes the text of one shader chunk of three.js.
   * - `stock`: two cascades by view depth, read by three.js's own shader.
   * Default: `coverage`. */
  lookUp?: 'coverage' | 'stock';
  /** Source of the surfaces that the maps are placed by.
   * - `auto`: the depth buffer of recent frames, where it can be read without waiting, otherwise the boxes.
   * - `boxes`: the boxes of the receivers alone.
   * Default: `auto`. */
  demand?: 'auto' | 'boxes';
}

/** Figures of a map. */
export interface MapReport {
  /** Width and height of a texel, in world units. */
  texelSize: [number, number];
  /** Pixels per texel at the median of the pixels that read the map: below 1, texels are finer than pixels. `undefined` if
   * no pixel reads it. It is an estimate from the receivers' boxes. */
  pixelsPerTexel: number | undefined;
  /** Share of the visible receivers that read the map, 0 to 1. It is an estimate from the receivers' boxes. */
  use: number;
  /** Objects that this frame drew into the map. */
  casters: number;
}

/** Figures of the latest frame. */
export interface ShadowfitReport {
  /** Look-up that the frame used. */
  lookUp: 'coverage' | 'stock';
  /** Whether the frame kept the maps of an earlier one. */
  isKept: boolean;
  /** Maps that the frame drew. */
  passes: number;
  /** The maps, from fine to coarse. It is empty if the frame has no shadows of this sun. */
  maps: MapReport[];
  /** Reason why the frame has no shadows of this sun, or `undefined`. */
  error: string | undefined;
}

/**
 * Shadow of a `SunLight` of three.js, for `WebGLRenderer`. The maps are placed where they improve the most visible pixels.
 * The bias is computed, so `bias` and `normalBias` have no effect by coverage. The light's `up` is the world's up direction.
 *
 * Import this module before the first frame: three.js keeps shaders that it compiled earlier, and these draw no shadows of
 * this sun.
 *
 * `toJSON` returns nothing, because three.js's `ObjectLoader` knows no `SunLight`. Create the sun again after loading.
 *
 * ```js
 * const sun = new SunLight(0xffffff, 3);
 * sun.castShadow = true;
 * sun.shadow = new ShadowfitShadow({ distance: 200 });
 * scene.add(sun);
 * ```
 */
export class ShadowfitShadow extends LightShadow<OrthographicCamera> {
  readonly isShadowfitShadow: true;
  constructor(options?: ShadowfitOptions);
  /** Number of maps. */
  maps: number;
  /** Look-up of the maps in the shaders. */
  lookUp: 'coverage' | 'stock';
  /** Source of the surfaces that the maps are placed by. */
  demand: 'auto' | 'boxes';
  /** View depth at which shadows end, in world units. */
  distance: number;
  /** Width and height of a map, in texels. Sizes that the device cannot hold are reduced. */
  mapSize: Vector2;
  /** Softness of the edges. Up to 1, a tent of 3 × 3 comparisons; above, a disc of this radius, in texels. Default: 1. */
  radius: number;
  /** Darkness of the shadows, 0 to 1. Default: 1. */
  intensity: number;
  /** Whether the maps follow the scene. If `false`, they stay until `needsUpdate` is set. Default: `true`. */
  autoUpdate: boolean;
  /** Set it to `true` to draw the maps in the next frame, for example after a change that three.js cannot know. */
  needsUpdate: boolean;
  /** Returns figures of the latest frame. */
  report(): ShadowfitReport;
  // Members that three.js calls.
  readonly isSunLightShadow: true;
  getCamera(index?: number): OrthographicCamera;
  getMatrix(index?: number): Matrix4;
  getFrustum(index?: number): Frustum;
  updateMatrices(light: Light, viewCamera?: Camera): void;
}

/** Lines around the maps of a sun, coloured by map from fine to coarse: red, yellow, green, blue. They follow the maps with
 * a delay of one frame. Add it to the scene itself. */
export class ShadowfitHelper extends LineSegments<BufferGeometry, LineBasicMaterial> {
  constructor(light: Light & { shadow?: LightShadow });
  readonly light: Light;
  /** Moves the lines to the present maps. Each frame calls it. */
  update(): void;
  dispose(): void;
}
