import {
  type BufferGeometry, type Camera, type Light, LightShadow, type LineBasicMaterial, LineSegments, type OrthographicCamera,
  type Vector2,
} from 'three';
import { type Node } from 'three/webgpu';

import { type MapReport } from './three.js';

export { type MapReport };

/** Options of a shadow. Lengths are in world units. */
export interface ShadowfitOptions {
  /** Number of maps, 1 to 8. More maps draw finer shadows and need more memory. Default: 4. */
  maps?: number;
  /** Width and height of a map, in texels. Default: 2048. */
  mapSize?: number;
  /** View depth at which shadows end. Shadows fade out over its last tenth. Default: `Infinity`, the camera's far plane. */
  distance?: number;
  /** Source of the surfaces that the maps are placed by.
   * - `auto`: the depth buffer of recent frames, where it can be read without waiting, otherwise the boxes.
   * - `boxes`: the boxes of the receivers alone.
   * Default: `auto`. */
  demand?: 'auto' | 'boxes';
}

/** Figures of the latest frame. */
export interface ShadowfitReport {
  /** Whether the frame kept all maps of an earlier one. */
  isKept: boolean;
  /** Shadow passes of the frame. */
  passes: number;
  /** The maps, from fine to coarse. It is empty if the frame has no shadows of this sun. */
  maps: MapReport[];
  /** Reason why the frame has no shadows of this sun, or `undefined`. */
  error: string | undefined;
}

/**
 * Shadow of a `SunLight` or a `DirectionalLight` of three.js, for `WebGPURenderer` and its WebGL2 backend. The maps are placed
 * where they improve the most visible pixels, and the bias is computed, so there is nothing to tune. A map whose content stays
 * the same is not drawn again, so a still scene has no shadow passes.
 *
 * Materials draw all of their faces into the maps, unless their `shadowSide` states other ones.
 *
 * Up to four cameras have maps of their own, in one texture: `maps` × `mapSize`² × 4 bytes per camera. Moving casters double
 * it. `shadowMap.type` of the renderer may be `PCFShadowMap` or `BasicShadowMap`. Other types draw like `PCFShadowMap`.
 * `shadowMap.transmitted` has no effect.
 *
 * `toJSON` returns nothing, because three.js's `ObjectLoader` knows no `SunLight`. Create the sun again after loading.
 *
 * ```js
 * SunLight.registerNode(SunLightNode); // r187; in r186: renderer.library.addLight(SunLightNode, SunLight)
 * const sun = new SunLight(0xffffff, 3);
 * sun.castShadow = true;
 * sun.shadow = new ShadowfitShadow({ distance: 200 });
 * scene.add(sun);
 * ```
 */
export class ShadowfitShadow extends LightShadow<OrthographicCamera> {
  readonly isShadowfitShadow: true;
  constructor(options?: ShadowfitOptions);
  /** Number of maps, 1 to 8. */
  maps: number;
  /** Source of the surfaces that the maps are placed by. */
  demand: 'auto' | 'boxes';
  /** View depth at which shadows end, in world units. */
  distance: number;
  /** Width and height of a map, in texels. */
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
  /** A new node for a light of three.js. */
  readonly shadowNode: Node;
  updateMatrices(light: Light, viewCamera?: Camera): void;
}

/** Lines around the four finest maps of a sun, coloured by map from fine to coarse: red, yellow, green, blue. They follow the
 * maps with a delay of one frame. Add it to the scene itself. */
export class ShadowfitHelper extends LineSegments<BufferGeometry, LineBasicMaterial> {
  constructor(light: Light & { shadow?: LightShadow });
  readonly light: Light;
  /** Moves the lines to the present maps. Each frame calls it. */
  update(): void;
  dispose(): void;
}
