export { FitError, SunFitter } from './fitter.js';
export type * from './fitter.js';
