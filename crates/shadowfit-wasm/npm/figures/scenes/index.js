// All generated scenes, after examples of three.js whose sun casts shadows. A scene is `{ name, build, frames }`: `build`
// returns an `Object3D` whose casters have `castShadow` set, and `frames` returns the frames of its paths.

import { clipping } from './clipping.js';
import { clippingStencil } from './clipping-stencil.js';
import { proceduralTerrain } from './procedural-terrain.js';
import { shadowMap } from './shadow-map.js';

export const SCENES = [clipping, clippingStencil, shadowMap, proceduralTerrain];
