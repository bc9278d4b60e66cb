// The content of a camera's maps: what to draw so that each map shows its casters.
//
// A map keeps its content while it stays in place and its casters stay as they are. A map whose only changes are moving
// casters gets a second layer, which keeps the other casters. Each frame copies that layer and draws the moving casters over
// it.

/** Kinds of work. */
export const KEEP = 'keep';
/** Clear, and draw all casters. */
export const DRAW = 'draw';
/** Copy the layer of still casters, and draw the moving ones over it. */
export const OVERLAY = 'overlay';
/** Like `OVERLAY`, after drawing the layer of still casters anew. */
export const SPLIT = 'split';

/** Greatest shift of a kept map, in texels. The fitter places maps relative to the eye in 32-bit floats, so maps that stay
 * differ by rounding. Kept maps keep their old place in the look-up too. */
const SAME_PLACE = 0.01;

/**
 * @typedef {object} Content What a layer shows.
 * @property {import('../fitter.d.ts').FittedMap} place
 * @property {import('../three/scan.js').SceneScan} scan
 * @property {number} drawnAt Number of the scan that it was drawn after.
 * @property {Uint8Array} rows 1 for each row that was drawn.
 */

/** A map's layer. */
export class Layer {
  /** @param {number} index Index of the layer in the texture. */
  constructor(index) {
    this.index = index;
    /** @type {Content | undefined} */
    this.content = undefined;
    /** Still casters alone, in the second texture. @type {Content | undefined} */
    this.still = undefined;
    /** Map whose place the layer has. @type {import('../fitter.d.ts').FittedMap | undefined} */
    this.place = undefined;
  }

  /** Forgets the content, after the texture lost it. */
  forget() {
    this.content = undefined;
    this.still = undefined;
  }

  /**
   * Returns the work that a frame needs, with the rows to draw, and the map as it is in the layer afterwards.
   * @param {import('../fitter.d.ts').FittedMap} map
   * @param {{ scan: import('../three/scan.js').SceneScan, movement: import('./movement.js').Movement, size: number,
   * needed: Uint8Array, isForced: boolean, canSplit: boolean }} frame `needed` has 1 for each row that casts a shadow into
   * the map.
   */
  plan(map, { scan, movement, size, needed, isForced, canSplit }) {
    const hasStayed = this.place !== undefined && isSamePlace(this.place, map, size);
    this.place = hasStayed ? this.place : map;
    const { place } = this;
    // Biases follow the settings, which may change while the map stays.
    const placed = { ...map, position: place.position };
    if (!isForced && isCurrent(this.content, place, movement, needed)) {
      return { kind: KEEP, map: placed };
    }
    const { still, moving, movers, others } = divide(needed, movement);
    this.content = { place, scan, drawnAt: movement.now, rows: needed };
    if (canSplit && !isForced && isCurrent(this.still, place, movement, still)) {
      return { kind: OVERLAY, map: placed, rows: moving };
    }
    // A map that moves is drawn whole, because its layer of still casters would last for this frame only.
    if (!canSplit || !hasStayed || movers === 0 || others === 0) {
      return { kind: DRAW, map: placed, rows: needed };
    }
    this.still = { place, scan, drawnAt: movement.now, rows: still };
    return { kind: SPLIT, map: placed, still, rows: moving };
  }
}

/** Returns whether a layer's content is as the frame needs it. */
function isCurrent(content, place, { scan, changedAt }, needed) {
  if (content === undefined || content.place !== place || content.scan !== scan) {
    return false;
  }
  const { rows, drawnAt } = content;
  const count = Math.max(rows.length, needed.length);
  for (let row = 0; row < count; row += 1) {
    const isNeeded = needed[row] === 1;
    const isDrawn = rows[row] === 1;
    if ((isNeeded && !isDrawn) || ((isNeeded || isDrawn) && changedAt[row] > drawnAt)) {
      return false;
    }
  }
  return true;
}

/** Divides rows into still and moving ones, with the number of each. */
function divide(needed, movement) {
  const still = new Uint8Array(needed.length);
  const moving = new Uint8Array(needed.length);
  let movers = 0;
  let others = 0;
  needed.forEach((isNeeded, row) => {
    if (isNeeded !== 1) {
      return;
    }
    if (movement.moves(row)) {
      moving[row] = 1;
      movers += 1;
    } else {
      still[row] = 1;
      others += 1;
    }
  });
  return { still, moving, movers, others };
}

/** Returns whether two maps cover the same volume, but for rounding. */
function isSamePlace(one, other, size) {
  if (one === other) {
    return true;
  }
  if (one.width !== other.width || one.height !== other.height || one.depthRange !== other.depthRange) {
    return false;
  }
  const isSameAxis = (axis) => [0, 1, 2].every((i) => one[axis][i] === other[axis][i]);
  if (!isSameAxis('x') || !isSameAxis('y') || !isSameAxis('z')) {
    return false;
  }
  const shift = [0, 1, 2].map((i) => other.position[i] - one.position[i]);
  const along = (axis) => Math.abs(axis[0] * shift[0] + axis[1] * shift[1] + axis[2] * shift[2]);
  const texel = one.width / size;
  return along(one.x) < SAME_PLACE * texel && along(one.y) < SAME_PLACE * texel && along(one.z) < SAME_PLACE * texel;
}
