// Sums over the judged pixels of a frame, by the definitions of docs/BENCHMARKS.md.

/** Relative difference of brightness that two shaders may have, because they round light directions. */
const BRIGHTNESS_TOLERANCE = 0.01;
/** Greatest share of pixels that may differ in brightness. Grazing light amplifies rounding errors. */
const MAX_DIFFERENT = 0.01;

/**
 * Returns the share of the sunlight that reaches each judged pixel, 0 to 1.
 *
 * @param {import('./truth.js').Truth} truth
 * @param {Float32Array} picture - Brightness with shadows, rows from the bottom.
 */
export function shadowFactors(truth, picture) {
  const factor = (pixel, index) => Math.min(Math.max(picture[pixel] / truth.brightness[index], 0), 1);
  return Float32Array.from(truth.pixels, factor);
}

/**
 * Fails unless a contestant's picture without shadows is as bright as the picture of a plain sun. Otherwise its sun has
 * another intensity or direction, and its shadow factors would be wrong.
 *
 * @param {import('./truth.js').Truth} truth
 * @param {Float32Array} picture - Brightness, rows from the bottom.
 */
export function checkBrightness(truth, picture) {
  const differs = (pixel, index) => Math.abs(picture[pixel] / truth.brightness[index] - 1) > BRIGHTNESS_TOLERANCE;
  const share = truth.pixels.filter(differs).length / truth.pixels.length;
  if (share > MAX_DIFFERENT) {
    throw new Error(`without shadows, ${(100 * share).toFixed(1)}% of the pixels differ from a sun of intensity π`);
  }
}

/** Returns whether a share of the light counts as lit. */
export const countsAsLit = (factor) => factor >= 0.5;

/**
 * Compares shadow factors with the truth.
 *
 * @param {import('./truth.js').Truth} truth
 * @param {Float32Array} factors
 */
export function judge(truth, factors) {
  const sums = { pixels: factors.length, wrong: 0, falseShadow: 0, falseLight: 0, light: 0, lightError: 0 };
  for (let index = 0; index < factors.length; index += 1) {
    const isLit = truth.isLit[index];
    const isWrong = Number(countsAsLit(factors[index])) !== isLit;
    const isFar = isWrong && !truth.isNearEdge[index];
    sums.wrong += isWrong;
    sums.falseShadow += isFar && isLit === 1;
    sums.falseLight += isFar && isLit === 0;
    sums.light += truth.facing[index];
    sums.lightError += Math.abs(factors[index] - isLit) * truth.facing[index];
  }
  return sums;
}

/**
 * Counts the pixels at shadow edges whose verdict changes only because the maps changed.
 *
 * @param {import('./truth.js').Truth} truth
 * @param {Float32Array} factors - Factors with the maps of this frame.
 * @param {Float32Array} before - Factors of the same pixels with the maps of the frame before.
 */
export function crawl(truth, factors, before) {
  const sums = { compared: 0, crawled: 0 };
  for (let index = 0; index < factors.length; index += 1) {
    if (truth.isInEdgeZone[index] && truth.isCompared[index]) {
      sums.compared += 1;
      sums.crawled += countsAsLit(factors[index]) !== countsAsLit(before[index]);
    }
  }
  return sums;
}
