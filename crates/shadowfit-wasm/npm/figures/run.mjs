// Measures the shadows of three.js's suns and of shadowfit, and draws pictures of them. See README.md.

import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { cpus } from 'node:os';
import { join } from 'node:path';
import { openPage } from './program/browser.mjs';
import { FOLDER, readOptions, USAGE } from './program/options.mjs';
import { row, table } from './program/rows.mjs';

const TUNED = join(FOLDER, 'tuned.json');
/** Columns of pictures: contestant, and whether its biases are tuned. */
const PICTURED = [['sun-light', false], ['sun-light', true], ['csm', true], ['shadowfit-4', false]];

const options = readOptions();
if (options.help) {
  console.log(USAGE);
  process.exit();
}
const start = Date.now();
const page = await openPage(options);
const device = await page.call('device');
const tuned = JSON.parse(readFileSync(TUNED, 'utf8'));
const results = [];
for (const scene of await scenes()) {
  await measureScene(scene);
}
await page.close();
write();

/** Lists the scenes of the folder and the generated ones. */
async function scenes() {
  const listed = options.scenes ? JSON.parse(readFileSync(join(options.scenes, 'scenarios.json'), 'utf8')) : { scenes: [] };
  const files = listed.scenes.map(({ name }, index) => ({
    name, address: `/scenes/${name}.glb`, frames: listed.frames.filter((frame) => frame.scene === index),
  }));
  const generated = (await page.call('generated')).map((name) => ({ name }));
  const isDoubleSided = options['double-sided'];
  return [...files, ...generated].filter(({ name }) => options.only?.includes(name) ?? true).map((scene) => ({
    ...scene, isDoubleSided, title: isDoubleSided ? `${scene.name}, double-sided` : scene.name,
  }));
}

async function measureScene(scene) {
  const { triangles, objects, judged, paths } = await page.call('open', { ...scene, isQuick: options.quick });
  log(`${scene.title}: ${objects} objects, ${triangles} triangles, ${judged} judged frames`);
  const contestants = (await page.call('contestants')).filter(({ name }) => options.contestant?.includes(name) ?? true);
  for (const { name, isTunable } of contestants) {
    if (options.tune && isTunable) {
      await tune(scene.title, name);
    }
    await measure(scene.title, name, isTunable);
  }
  await draw(scene.title, contestants, paths);
}

async function tune(scene, name) {
  const [best] = await page.call('tune', name);
  (tuned[scene] ??= {})[name] = best.biases;
  writeFileSync(TUNED, `${JSON.stringify(tuned, undefined, 2)}\n`);
  log(`  ${name}: best biases ${JSON.stringify(best.biases)}, ${(100 * best.wrong).toFixed(3)}% wrong`);
}

async function measure(scene, name, isTunable) {
  const best = tuned[scene]?.[name];
  const variants = [{ title: isTunable ? `${name}, default` : name, biases: {} }];
  if (isTunable && best) {
    variants.push({ title: `${name}, tuned`, biases: best });
  }
  const measured = await page.call('measure', name, variants.map(({ biases }) => biases));
  variants.forEach(({ title, biases }, index) => {
    results.push({ scene, contestant: title, biases, ...measured[index] });
    const { wrong, crawl } = row(title, [measured[index]]);
    log(`  ${title}: ${wrong.toFixed(3)}% wrong, ${crawl?.toFixed(4)}% crawl`);
  });
}

/** Draws the pictures of a scene's frames. */
async function draw(scene, contestants, paths) {
  const middle = paths[0][Math.floor(paths[0].length / 2)];
  const usual = options.quick ? [] : [middle];
  const ids = options.pictures?.filter((id) => paths.flat().includes(id)) ?? usual;
  const columns = PICTURED.map(([name, isTuned]) => ({
    name, title: isTuned ? `${name}, tuned` : name, biases: isTuned ? tuned[scene]?.[name] : {},
  })).filter(({ name, biases }) => biases && contestants.some((contestant) => contestant.name === name));
  for (const id of columns.length > 0 ? ids : []) {
    const folder = join(options.out, 'pictures', id.replaceAll('/', '-'));
    mkdirSync(folder, { recursive: true });
    const pictures = await page.call('pictures', id, columns);
    for (const [name, picture] of Object.entries(pictures)) {
      writeFileSync(join(folder, `${name}.png`), Buffer.from(picture.split(',')[1], 'base64'));
    }
    log(`  pictures of ${id}`);
  }
}

/** Writes the tables of all scenes and of each scene. */
function write() {
  const names = [...new Set(results.map(({ contestant }) => contestant))];
  const rowsOf = (chosen) => names
    .map((name) => [name, chosen.filter(({ contestant }) => contestant === name)])
    .filter(([, found]) => found.length > 0)
    .map(([name, found]) => row(name, found));
  const frames = options.quick ? 'Two of every ten frames' : 'Two of every four frames';
  const note = `${frames}, 480 × 270 pixels, Chromium ${page.version}, ${device}, ${cpus().length} × ${cpus()[0].model}.`;
  const parts = [`# Figures\n\n${note}\n\n## All scenes\n\n${table(rowsOf(results))}`];
  for (const scene of new Set(results.map((result) => result.scene))) {
    parts.push(`## ${scene}\n\n${table(rowsOf(results.filter((result) => result.scene === scene)))}`);
  }
  mkdirSync(options.out, { recursive: true });
  writeFileSync(join(options.out, 'figures.md'), parts.join('\n'));
  const figures = { note, all: rowsOf(results), results };
  writeFileSync(join(options.out, 'figures.json'), `${JSON.stringify(figures, undefined, 1)}\n`);
  log(`wrote ${join(options.out, 'figures.md')}`);
}

function log(text) {
  console.log(`${((Date.now() - start) / 1000).toFixed(0).padStart(4)} s  ${text}`);
}
