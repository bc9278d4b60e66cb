// Finds the biases with the fewest wrong pixels.

import { Entry } from './entry.js';
import { Stage } from './stage.js';
import { judge, shadowFactors } from './tally.js';

/** Sides that are drawn into maps. Without one, three.js chooses it for each material. */
const SHADOW_SIDES = [undefined, 'front', 'back', 'double'];
/** Biases in units of the shadow camera's depth range. */
const BIAS = [0, -0.00003, -0.0001, -0.0003];
/** Normal biases, in metres. */
const NORMAL_BIAS = [0, 0.02];

/**
 * Tries the 32 variants of side, bias and normal bias on every second judged frame of a scene.
 *
 * @param {object} task - See `measure`.
 * @returns {Promise<{ biases: import('./entry.js').Biases, wrong: number }[]>} The variants and their share of wrong
 *   pixels, 0 to 1. The best variant is first.
 */
export async function tune({ scene, contestant, paths, truths, size }) {
  const stage = new Stage(scene, size);
  const variants = [];
  for (const shadowSide of SHADOW_SIDES) {
    const tried = BIAS.flatMap((bias) => NORMAL_BIAS.map((normalBias) => ({
      biases: { bias, normalBias, shadowSide }, wrong: 0, pixels: 0,
    })));
    const entry = new Entry(contestant, stage, { shadowSide });
    for (const path of paths) {
      await entry.beginPath(path[0]);
      const frames = path.filter((frame) => truths.has(frame.id)).filter((_, index) => index % 2 === 1);
      frames.forEach((frame) => tryAll(entry, frame, truths.get(frame.id), tried));
    }
    entry.dispose();
    variants.push(...tried);
  }
  stage.dispose();
  const shares = variants.map(({ biases, wrong, pixels }) => ({ biases, wrong: wrong / pixels }));
  return shares.sort((a, b) => a.wrong - b.wrong);
}

/** Draws the maps of a frame once, and its picture with each variant. Biases only change the look-up. */
function tryAll(entry, frame, truth, variants) {
  entry.draw(frame);
  for (const variant of variants) {
    entry.setBiases(variant.biases);
    entry.stage.draw(entry.camera, false);
    const { wrong, pixels } = judge(truth, shadowFactors(truth, entry.stage.read()));
    variant.wrong += wrong;
    variant.pixels += pixels;
  }
}
