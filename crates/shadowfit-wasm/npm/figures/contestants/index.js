// All contestants, in the order of the tables.
//
// A contestant is `{ name, isTunable, hasMemory?, create }`. Its biases are tuned if `isTunable` is set. All frames of a
// path are drawn if `hasMemory` is set, because then the fit of a frame depends on earlier frames.
//
// `create` adds a sun of intensity π to `scene`. It returns `{ shadows, update?, dispose }`: the sun's `LightShadow`s, a
// function that is called before each frame, and a function that removes everything again. It receives
//
// - `THREE`, `renderer`, `scene` and `camera`,
// - `box`: the scene's bounding box,
// - `materials`: the materials of all meshes,
// - `towardLight`: unit direction toward the sun,
// - `distance`: greatest view depth with shadows, in metres.

import { csm } from './csm.js';
import { oneMap } from './one-map.js';
import { oursFour, oursStock } from './ours.js';
import { sunLight2048, sunLight2896 } from './sun-light.js';

export const CONTESTANTS = [oneMap, csm, sunLight2048, sunLight2896, oursStock, oursFour];
