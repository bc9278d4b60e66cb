// Figures of a sun's latest frame. They are computed when they are asked for.
//
// The map use and the pixels per texel are estimates: a grid of rays from the camera finds the nearest boxes of receivers,
// and each hit reads a map by the rule of the shader.

import { BASIC, BLEND, DISC_PER_RADIUS } from './settings.js';
import { viewsOf } from './view.js';

/** Rays per row and per column of the picture. */
const [ACROSS, DOWN] = [32, 18];

/** Rows of pixels in a picture, if its size is not known. */
const ROWS = 1080;

/** @param {import('./ShadowfitShadow.js').ShadowfitShadow} shadow */
export function reportOf(shadow) {
  const { passes, isKept, error, camera, rows = ROWS } = shadow._frame;
  const { fit } = shadow._drawn ?? {};
  const reads = fit && camera ? readsOf(shadow, fit, viewsOf(camera), rows) : { maps: [], hits: 0 };
  const maps = (fit?.maps ?? []).map((map, index) => {
    const sizes = reads.maps[index];
    const texel = [map.width / shadow.mapSize.x, map.height / shadow.mapSize.y];
    return {
      texelSize: texel,
      pixelsPerTexel: sizes.length > 0 ? Math.max(...texel) / median(sizes) : undefined,
      use: sizes.length / Math.max(reads.hits, 1),
      casters: passes > 0 ? shadow._atlas.frustums[index].drawn : 0,
    };
  });
  return { lookUp: shadow._isCovering ? 'coverage' : 'stock', isKept, passes, maps, error: error?.message };
}

/** Returns the sizes of the pixels that read each map, and the number of pixels that show a receiver. */
function readsOf(shadow, fit, views, rows) {
  const boxes = receiverBoxes(shadow);
  const maps = fit.maps.map(() => []);
  let hits = 0;
  for (const view of views) {
    for (let row = 0; row < DOWN; row += 1) {
      for (let column = 0; column < ACROSS; column += 1) {
        const at = [2 * (column + 0.5) / ACROSS - 1, 2 * (row + 0.5) / DOWN - 1];
        const hit = hitOf(rayOf(view, at, 2 / rows), boxes, shadow.distance);
        if (hit) {
          hits += 1;
          maps[readBy(shadow, fit, hit)]?.push(hit.pixel);
        }
      }
    }
  }
  return { maps, hits };
}

function receiverBoxes({ _drawn: { scan } }) {
  return scan.rows.filter((entry) => entry?.object.receiveShadow && !entry.box.isEmpty()).map(({ box: { min, max } }) =>
    [[min.x, min.y, min.z], [max.x, max.y, max.z]]);
}

/** Returns the ray through a point of the picture, from the near to the far plane, and its neighbour one pixel above. */
function rayOf({ worldFromClip: m, depth, eye }, [x, y], pixel) {
  const [near, far] = { reversed: [1, 0], 'zero-to-one': [0, 1], 'minus-one-to-one': [-1, 1] }[depth];
  const world = (at, z) => {
    const h = [0, 1, 2, 3].map((i) => m[i] * x + m[4 + i] * at + m[8 + i] * z + m[12 + i]);
    return [h[0] / h[3], h[1] / h[3], h[2] / h[3]];
  };
  const [from, to] = [world(y, near), world(y, far)];
  const forward = subtract(middle(m, far), middle(m, near));
  return { from, to, above: [world(y + pixel, near), world(y + pixel, far)], eye, forward };
}

function middle(m, z) {
  const h = [0, 1, 2, 3].map((i) => m[8 + i] * z + m[12 + i]);
  return [h[0] / h[3], h[1] / h[3], h[2] / h[3]];
}

/** Returns the nearest surface of a box on a ray, its view depth, and the size of a pixel there. */
function hitOf({ from, to, above, eye, forward }, boxes, distance) {
  const way = subtract(to, from);
  let nearest = 1;
  for (const [min, max] of boxes) {
    let [enter, leave] = [0, nearest];
    for (let axis = 0; axis < 3; axis += 1) {
      const [a, b] = [min, max].map((side) => (side[axis] - from[axis]) / way[axis]);
      // 0 / 0 says nothing about this axis.
      enter = Math.max(enter, Math.min(a, b) || 0);
      leave = Math.min(leave, Number.isNaN(a + b) ? leave : Math.max(a, b));
    }
    if (enter <= leave) {
      // From inside a box, its back is visible.
      nearest = Math.min(nearest, enter > 0 ? enter : leave);
    }
  }
  if (nearest >= 1) {
    return undefined;
  }
  const point = from.map((side, axis) => side + way[axis] * nearest);
  const other = above[0].map((side, axis) => side + (above[1][axis] - side) * nearest);
  const depth = dot(subtract(point, eye), forward) / Math.hypot(...forward);
  return depth > distance ? undefined : { point, depth, pixel: Math.hypot(...subtract(other, point)) };
}

/** Returns the index of the map that a point reads, or undefined. */
function readBy(shadow, { maps }, { point, depth }) {
  if (!shadow._isCovering) {
    const index = maps.findIndex(({ isEmpty, depths: [begin, end] }) => !isEmpty && depth >= begin && depth < end);
    return index < 0 ? undefined : index;
  }
  const reach = shadow._look === BASIC ? 0.5 : 1 + DISC_PER_RADIUS * Math.max(1, shadow.radius);
  const free = maps.map(({ x, y, position, width, height }) => {
    const p = subtract(point, position);
    const [u, v] = [0.5 - Math.abs(dot(x, p)) / width, 0.5 - Math.abs(dot(y, p)) / height];
    return Math.min(u * shadow.mapSize.x, v * shadow.mapSize.y);
  });
  const first = free.findIndex((texels) => texels >= reach);
  const second = free.findIndex((texels, index) => index > first && texels >= reach);
  const isBlended = first >= 0 && second >= 0 && free[first] - reach < BLEND / 2;
  const index = isBlended ? second : first >= 0 ? first : free.findIndex((texels) => texels >= 0);
  return index < 0 ? undefined : index;
}

function median(numbers) {
  return [...numbers].sort((a, b) => a - b)[numbers.length >> 1];
}

function subtract(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
