/** The fitter of windows: maps that are placed where they improve the most visible pixels, and that are read by coverage. */

import { fitterClass } from './fitter.js';
import { bytes } from './wasm/windows.js';

export { FitError } from './fitter.js';
export const SunFitter = fitterClass(bytes, 'windows');
