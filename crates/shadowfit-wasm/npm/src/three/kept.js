// Whether a sun's maps can stay as an earlier frame drew them.
//
// Maps stay if they are where they were, if every caster that the frame needs was drawn, and if no caster that was drawn,
// or that casts a shadow into them, has changed.

import { ALL_MAPS } from './scan.js';

/**
 * @typedef {object} Drawn Content of a sun's maps.
 * @property {import('three').WebGLRenderer | undefined} renderer Renderer that drew them, once it is known.
 * @property {unknown} texture Its texture, once it is known. After a lost context, another one has other content.
 * @property {import('./scan.js').SceneScan} scan
 * @property {number} version Version of the scan.
 * @property {import('./view.js').Fit} fit
 * @property {Uint8Array} masks Maps that each row was drawn into.
 */

/**
 * Records the content of maps that are drawn now.
 * @param {import('./scan.js').SceneScan} scan
 * @param {import('./view.js').Fit} fit
 * @param {Uint8Array} masks Maps that each row is drawn into.
 * @returns {Drawn}
 */
export function drawnNow(scan, fit, masks) {
  const drawn = masks.slice();
  drawn.forEach((_, row) => {
    if (scan.isAlwaysDrawn(row)) {
      drawn[row] = ALL_MAPS;
    }
  });
  return { renderer: undefined, texture: undefined, scan, version: scan.version, fit, masks: drawn };
}

/** Answers of `compare`. */
export const KEEP = 'keep';
/** Other maps, or a caster has changed. */
export const REDRAW = 'redraw';
/** Nothing but casters that come into reach of the view. */
export const WIDEN = 'widen';

/**
 * Compares the content of maps with the need of a frame.
 * @param {Drawn | undefined} drawn
 * @param {import('./scan.js').SceneScan} scan
 * @param {import('./view.js').Fit} fit
 */
export function compare(drawn, scan, fit) {
  if (drawn === undefined || drawn.scan !== scan || !isSameFit(drawn.fit, fit)) {
    return REDRAW;
  }
  if (drawn.fit === fit && drawn.version === scan.version) {
    return KEEP;
  }
  const used = fit.bits.reduce((all, bit) => all | bit, 0);
  let answer = KEEP;
  for (let row = 0; row < scan.rows.length; row += 1) {
    const old = drawn.masks[row] ?? 0;
    if (scan.casterChanges[row] > drawn.version) {
      const always = scan.isAlwaysDrawn(row) ? ALL_MAPS : 0;
      if (((old | fit.keptCasters[row] | always) & used) !== 0) {
        return REDRAW;
      }
    }
    if ((fit.casters[row] & ~old & used) !== 0) {
      answer = WIDEN;
    }
  }
  return answer;
}

/** Returns whether two fits have the same maps. */
function isSameFit(one, other) {
  return one === other || (one.settings === other.settings && one.maps.length === other.maps.length
    && one.maps.every((map, index) => one.bits[index] === other.bits[index] && isSameMap(map, other.maps[index])));
}

/** Greatest difference of the positions of equal maps, as a share of their width. It is 1/32 of a texel of 2048. Fits
 * compute relative to the eye, so that their rounding differs from eye to eye. */
const SHIFT = 2 ** -16;

/** Greatest relative difference of the sizes and axes of equal maps. */
const STRETCH = 1e-6;

/** Share by which a later fit's bias may exceed the one that is used. Only its part for rounding changes with the eye. */
const MORE_BIAS = 0.125;

function isSameMap(one, other) {
  const near = (a, b, limit) => a === b || Math.abs(a - b) <= limit;
  const size = Math.min(one.width, one.height);
  return one.isEmpty === other.isEmpty
    && ['width', 'height', 'depthRange'].every((name) => near(one[name], other[name], STRETCH * one[name]))
    && ['x', 'y', 'z'].every((name) => one[name].every((value, axis) => near(value, other[name][axis], STRETCH)))
    && one.position.every((value, axis) => near(value, other.position[axis], SHIFT * size))
    && one.depths.every((value, index) => near(value, other.depths[index], STRETCH * value))
    && other.constantDepth <= one.constantDepth * (1 + MORE_BIAS)
    && other.receiverPlane <= one.receiverPlane * (1 + MORE_BIAS);
}
