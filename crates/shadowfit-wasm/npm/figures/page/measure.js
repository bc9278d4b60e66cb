// Figures of a contestant on the frames of a scene.

import { Entry } from './entry.js';
import { Stage } from './stage.js';
import { checkBrightness, crawl, judge, shadowFactors } from './tally.js';

/**
 * Draws the frames of a scene with each variant of a contestant. Returns the sums of each judged frame, by variant.
 *
 * @param {object} task
 * @param {import('./scene.js').MeasuredScene} task.scene
 * @param {object} task.contestant - See `contestants/index.js`.
 * @param {import('./entry.js').Biases[]} task.variants
 * @param {import('./camera.js').Frame[][]} task.paths - Frames by elevation.
 * @param {Map<string, import('./truth.js').Truth>} task.truths - Truth of each judged frame, by its id.
 * @param {boolean} task.isQuick - Whether frames are skipped that are not judged, even if the contestant has a memory.
 * @param {[number, number]} task.size - Width and height of pictures, in pixels.
 */
export async function measure({ scene, contestant, variants, paths, truths, isQuick, size }) {
  const stage = new Stage(scene, size);
  const drawsAll = contestant.hasMemory && !isQuick;
  const results = [];
  for (const biases of variants) {
    const entry = new Entry(contestant, stage, biases);
    const frames = [];
    for (const path of paths) {
      frames.push(...await measurePath(entry, path, truths, drawsAll));
    }
    entry.dispose();
    results.push({ megatexels: entry.megatexels, frames });
  }
  stage.dispose();
  return results;
}

async function measurePath(entry, path, truths, drawsAll) {
  await entry.beginPath(path[0]);
  const sums = [];
  for (const frame of path) {
    const truth = truths.get(frame.id);
    if (truth) {
      sums.push({ id: frame.id, elevation: frame.elevation_deg, ...measureFrame(entry, frame, truth) });
    } else if (drawsAll) {
      entry.draw(frame);
      entry.stage.read();
    }
    await entry.rest();
  }
  const last = path.findLast((frame) => truths.has(frame.id));
  if (last) {
    if (entry.last !== last) {
      entry.draw(last);
    }
    checkBrightness(truths.get(last.id), entry.drawUnshadowed());
  }
  return sums;
}

function measureFrame(entry, frame, truth) {
  let [before, baseline] = [];
  if (entry.last?.frame === frame.frame - 1) {
    baseline = entry.drawWithLastMaps(frame);
    before = shadowFactors(truth, entry.stage.read());
  }
  const time = entry.draw(frame);
  const counts = entry.counter.counts();
  const factors = shadowFactors(truth, entry.stage.read());
  return {
    ...judge(truth, factors),
    ...(before && crawl(truth, factors, before)),
    ...counts,
    milliseconds: baseline === undefined ? null : time - baseline,
  };
}
