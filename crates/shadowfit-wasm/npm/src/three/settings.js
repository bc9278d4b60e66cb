// A sun's settings, checked, and converted to a fitter's.

import { warnOnce } from './warn.js';

/** Greatest number of windows. The uniforms of a sun have no room for more. */
export const MAX_WINDOWS = 4;

/** Radius of the disc in texels, per unit of `radius`: that of three.js's own filter. The disc of a radius of 1 reaches as
 * far as the tent. */
export const DISC_PER_RADIUS = 1;

/** Width of the blend into the next window, in texels. */
export const BLEND = 8;

/** Share of a cascade's view depths that the next one also covers. Stock suns use the same share. */
const DEPTH_BLEND = 0.1;

/** Share of the shadow distance over which shadows fade out. Stock suns use the same share. */
export const FADE = 0.1;

/** View depth at which shadows end if they have no end. Shaders compute no number from infinity. */
export const NO_END = 1e30;

/** Number of cascades in three.js's shaders. */
export const CASCADES = 2;

/**
 * @typedef {object} Settings Settings of a frame.
 * @property {import('../fitter.d.ts').FitterSettings} fitter
 * @property {boolean} isByDepth Whether the stock shader selects cascades by view depth.
 * @property {number} end View depth at which shadows end.
 * @property {string} key Identity of these settings.
 */

/** Look-ups of three.js's shadow map types. */
export const PCF = 'pcf';
export const BASIC = 'basic';
export const VSM = 'vsm';

/** Values of the options that name a choice. */
const CHOICES = { lookUp: ['coverage', 'stock'], demand: ['auto', 'boxes'] };
/** Numbers of maps by coverage. */
const COUNTS = [1, 2, 3, 4];
const NAMES = ['maps', 'mapSize', 'distance', 'lookUp', 'demand'];

/**
 * Returns a constructor's options with defaults. `problemOf` reports wrong values when the sun is drawn, with its name.
 * @param {import('../three.d.ts').ShadowfitOptions} options
 */
export function withDefaults(options) {
  const unknown = Object.keys(options).filter((name) => !NAMES.includes(name));
  if (unknown.length > 0) {
    warnOnce(`option ${unknown}`, `ShadowfitShadow has no option "${unknown.join('", "')}". It has ${NAMES.join(', ')}.`);
  }
  const { maps = MAX_WINDOWS, lookUp = 'coverage', demand = 'auto', mapSize = 2048, distance = Infinity } = options;
  return { maps, lookUp, demand, mapSize, distance };
}

/**
 * Returns whether a texture can have a size.
 * @param {import('three').Vector2} size
 */
export function isSize({ x, y }) {
  return Number.isInteger(x) && Number.isInteger(y) && x > 0 && y > 0;
}

/**
 * Returns the reason why a sun's settings are unusable, or undefined.
 * @param {import('./ShadowfitShadow.js').ShadowfitShadow} shadow
 */
export function problemOf(shadow) {
  const { maps, mapSize, distance, radius, lookUp } = shadow;
  for (const [name, values] of Object.entries(CHOICES)) {
    if (!values.includes(shadow[name])) {
      return `its ${name} is "${shadow[name]}". Give "${values.join('" or "')}"`;
    }
  }
  if (lookUp === 'coverage' && !COUNTS.includes(maps)) {
    return `its number of maps is ${maps}. Give 1 to ${MAX_WINDOWS}`;
  }
  if (!isSize(mapSize)) {
    return `its mapSize is ${mapSize.x} × ${mapSize.y}. Give whole numbers above 0`;
  }
  if (!(distance > 0)) {
    return `its distance is ${distance}. Give a number above 0, or Infinity for the camera's far plane`;
  }
  if (!Number.isFinite(radius) || radius < 0) {
    return `its radius is ${radius}. Give a number from 0 up`;
  }
  return undefined;
}

/**
 * Returns a sun's settings for a frame.
 * @param {import('./ShadowfitShadow.js').ShadowfitShadow} shadow
 * @param {{ isByDepth: boolean, look: string, up: import('three').Vector3 }} frame `look` is three.js's shadow map type.
 * @returns {Settings}
 */
export function settingsOf({ maps, mapSize, distance, radius }, { isByDepth, look, up }) {
  // The fitter takes one size. Texels along the longer side are finer than it assumes.
  const size = Math.min(mapSize.x, mapSize.y);
  const common = { mapSize: size, distance, up: [up.x, up.y, up.z], depth: 'unorm24' };
  const comparison = { taps: look === BASIC ? 0.5 : 1, disc: 0 };
  // The stock look-up spreads five comparisons over a disc of `radius` texels of the atlas.
  const stock = { ...comparison, disc: look === BASIC ? 0 : radius };
  const covering = { ...comparison, disc: look === BASIC ? 0 : DISC_PER_RADIUS * Math.max(1, radius) };
  const fitter = isByDepth
    ? { ...common, maps: CASCADES, selection: 'view-depth', blend: DEPTH_BLEND, bias: 'constant', filter: stock }
    : { ...common, maps, selection: 'coverage', blend: BLEND, bias: 'plane', filter: covering };
  const key = [isByDepth, look, mapSize.x, mapSize.y, ...common.up, distance, radius, maps].join(' ');
  return { fitter, isByDepth, end: distance, key };
}
