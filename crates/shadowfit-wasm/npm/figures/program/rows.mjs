// Rows of the tables: sums over frames, and figures from these sums.

/**
 * The figures of a contestant on some frames. Percentages are of the facing pixels, unless stated otherwise.
 *
 * @typedef {object} Row
 * @property {string} contestant - Name and variant.
 * @property {number} wrong - Pixels whose verdict differs from the truth.
 * @property {number} lightError - Error of the sunlight, in per cent of the light without shadows.
 * @property {number} falseShadow - Wrongly shadowed pixels far from true shadow edges.
 * @property {number} falseLight - Wrongly lit pixels far from true shadow edges.
 * @property {number | null} crawl - Pixels near true shadow edges whose verdict changes with the maps, in per cent of them.
 * @property {number} casters - Casters that a frame draws into maps.
 * @property {number} passes - Maps that a frame draws.
 * @property {number | null} milliseconds - Median CPU time of fits and shadow passes.
 * @property {number} megatexels - Size of all maps.
 */

/**
 * Computes the figures of frames.
 *
 * @param {string} contestant
 * @param {{ megatexels: number, frames: object[] }[]} results - From scenes.
 * @returns {Row}
 */
export function row(contestant, results) {
  const frames = results.flatMap((result) => result.frames);
  const sum = (name) => frames.reduce((total, frame) => total + (frame[name] ?? 0), 0);
  const percent = (part, whole) => (sum(whole) > 0 ? 100 * sum(part) / sum(whole) : null);
  return {
    contestant,
    wrong: percent('wrong', 'pixels'),
    lightError: percent('lightError', 'light'),
    falseShadow: percent('falseShadow', 'pixels'),
    falseLight: percent('falseLight', 'pixels'),
    crawl: percent('crawled', 'compared'),
    casters: sum('casters') / frames.length,
    passes: sum('passes') / frames.length,
    milliseconds: median(frames.map((frame) => frame.milliseconds).filter((time) => time !== null)),
    megatexels: Math.max(...results.map((result) => result.megatexels)),
  };
}

function median(values) {
  return values.length > 0 ? values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)] : null;
}

const COLUMNS = [
  ['wrong %', 'wrong'], ['light error %', 'lightError'], ['false shadow %', 'falseShadow'], ['false light %', 'falseLight'],
  ['crawl %', 'crawl'], ['casters', 'casters'], ['passes', 'passes'], ['CPU ms', 'milliseconds'], ['Mtexel', 'megatexels'],
];

/**
 * Returns a Markdown table.
 *
 * @param {Row[]} rows
 */
export function table(rows) {
  const lines = [['contestant', ...COLUMNS.map(([title]) => title)], ['---', ...COLUMNS.map(() => '---:')]];
  const cells = (found) => COLUMNS.map(([, name]) => number(found[name]));
  return [...lines, ...rows.map((found) => [found.contestant, ...cells(found)])]
    .map((line) => `| ${line.join(' | ')} |\n`).join('');
}

/** Returns a number with three significant digits. */
function number(value) {
  return value === null ? '' : String(value >= 100 ? Math.round(value) : Number(value.toPrecision(3)));
}
