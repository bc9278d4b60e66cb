// A sun's settings, checked, and converted to a fitter's.

import { BasicShadowMap } from 'three/webgpu';

import { nameOf, warnOnce } from '../three/warn.js';
import { BLEND, DISC_PER_RADIUS, MAX_MAPS } from './lookup.js';

/** Options of the constructor, with their default values. */
const DEFAULTS = { maps: 4, mapSize: 2048, distance: Infinity, demand: 'auto' };

/** Returns a constructor's options with defaults. `problemOf` reports wrong values when the sun is drawn, with its name. */
export function withDefaults(options) {
  const unknown = Object.keys(options).filter((name) => !Object.hasOwn(DEFAULTS, name));
  if (unknown.length > 0) {
    warnOnce(`option ${unknown}`, `ShadowfitShadow has no option "${unknown.join('", "')}". It has `
      + `${Object.keys(DEFAULTS).join(', ')}.`);
  }
  const given = Object.fromEntries(Object.entries(options).filter(([, value]) => value !== undefined));
  return { ...DEFAULTS, ...given };
}

/**
 * Returns the greatest width of a texture.
 * @param {import('three/webgpu').Renderer} renderer
 */
function sizeLimit({ backend }) {
  const { device, gl } = backend;
  return device?.limits?.maxTextureDimension2D ?? gl?.getParameter(gl.MAX_TEXTURE_SIZE) ?? Infinity;
}

/**
 * Returns the reason why a sun's settings are unusable, or undefined.
 * @param {import('./ShadowfitShadow.js').ShadowfitShadow} shadow
 * @param {import('three/webgpu').Renderer} renderer
 */
export function problemOf({ maps, mapSize, distance, radius, intensity, demand }, renderer) {
  if (!Number.isInteger(maps) || maps < 1 || maps > MAX_MAPS) {
    return `its number of maps is ${maps}. Give a whole number from 1 to ${MAX_MAPS}`;
  }
  const limit = sizeLimit(renderer);
  const isSize = (size) => Number.isInteger(size) && size > 0 && size <= limit;
  if (!isSize(mapSize.x) || !isSize(mapSize.y)) {
    return `its mapSize is ${mapSize.x} × ${mapSize.y}. Give whole numbers from 1 to ${limit}`;
  }
  if (!(distance > 0)) {
    return `its distance is ${distance}. Give a number above 0, or Infinity for the camera's far plane`;
  }
  if (!Number.isFinite(radius) || radius < 0) {
    return `its radius is ${radius}. Give a number from 0 up`;
  }
  if (!Number.isFinite(intensity)) {
    return `its intensity is ${intensity}. Give a number from 0 to 1`;
  }
  if (demand !== 'auto' && demand !== 'boxes') {
    return `its demand is "${demand}". Give "auto" or "boxes"`;
  }
  return undefined;
}

/**
 * Returns the settings of a fit.
 * @param {import('./ShadowfitShadow.js').ShadowfitShadow} shadow
 * @param {import('./ShadowfitShadowNode.js').Room} room
 * @param {{ up: import('three').Vector3, type: number }} frame Up direction, and the renderer's type of shadow maps.
 * @returns {import('../three/settings.js').Settings}
 */
export function settingsOf({ distance, radius }, { maps, width, height }, { up, type }) {
  const isBasic = type === BasicShadowMap;
  const filter = isBasic ? { taps: 0.5, disc: 0 } : { taps: 1, disc: DISC_PER_RADIUS * Math.max(1, radius) };
  const direction = [up.x, up.y, up.z];
  // The fitter takes one size. Texels along the longer side are finer than it assumes.
  const mapSize = Math.min(width, height);
  const fitter = { maps, mapSize, distance, up: direction, blend: BLEND, filter, bias: 'plane', depth: 'float32' };
  const key = [maps, width, height, ...direction, distance, isBasic, radius].join(' ');
  return { fitter, isByDepth: false, end: distance, key };
}

/**
 * Returns a light's direction of travel, or undefined. Lights with a target shine toward it, and suns toward the origin.
 * @param {import('three').Light} light
 */
export function directionOf({ matrixWorld: { elements: from }, target }) {
  const to = target?.matrixWorld.elements ?? [];
  const direction = [12, 13, 14].map((index) => (to[index] ?? 0) - from[index]);
  const length = Math.hypot(...direction);
  return length > 0 && Number.isFinite(length) ? direction.map((value) => value / length) : undefined;
}

/** Warns that a light has no shadows. */
export function warnWithout(light, reason) {
  warnOnce(`without ${light.id} ${reason}`, `${nameOf(light)} has no shadows in this frame: ${reason}.`);
}
