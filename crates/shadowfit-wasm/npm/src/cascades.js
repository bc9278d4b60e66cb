/** The fitter of cascades: maps for ranges of view depths, for shaders that select a map by view depth. */

import { fitterClass } from './fitter.js';
import { bytes } from './wasm/cascades.js';

export { FitError } from './fitter.js';
export const SunFitter = fitterClass(bytes, 'cascades');
