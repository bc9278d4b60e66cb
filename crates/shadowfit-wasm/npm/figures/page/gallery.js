// Pictures of a frame for people: contestants side by side, in the scene's own colours and with their wrong pixels.

import { ACESFilmicToneMapping, Color, HemisphereLight, WebGLRenderer } from 'three';
import { Entry } from './entry.js';
import { SHADOW_SIDES, Stage } from './stage.js';
import { countsAsLit, judge, shadowFactors } from './tally.js';
import { TruthTracer } from './truth.js';

/** Width and height of pictures, in pixels. */
const SIZE = [960, 540];
/** Frames of the path that are drawn before the picture, so that fits with a memory have one. */
const LEAD = 8;
const SKY = 0xa9c6e8;
const GROUND = 0x8a8273;
/** Intensity of the sky. The sun has π. */
const SKY_INTENSITY = 1.2;
const EXPOSURE = 0.8;
/** Colours of pixels that are shadowed, and lit, although the truth is the opposite. */
const FALSE_SHADOW = [255, 40, 40];
const FALSE_LIGHT = [40, 110, 255];
/** Brightness of the other pixels where pixels are marked, so that the marks are the most vivid colours. */
const DIMMED = 0.6;
/** Grey of everything that is not judged: the sky, and surfaces that face away from the sun. */
const NOT_JUDGED = [214, 220, 228];
/** Height of a caption, in pixels. */
const CAPTION = 44;

/** A renderer that draws a scene into a canvas as an application would. */
class ShownStage {
  constructor(scene, [width, height]) {
    this.scene = scene;
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setSize(width, height, false);
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.toneMappingExposure = EXPOSURE;
    this.renderer.shadowMap.enabled = true;
    this.sky = new HemisphereLight(SKY, GROUND, SKY_INTENSITY);
    scene.scene.add(this.sky);
    scene.scene.background = new Color(SKY);
  }

  /** Gives every mesh a copy of its loaded material. Returns the copies. */
  dress(shadowSide) {
    const copies = new Map();
    this.scene.dress((loaded) => {
      if (!copies.has(loaded)) {
        copies.set(loaded, loaded.clone());
        copies.get(loaded).shadowSide = SHADOW_SIDES[shadowSide] ?? null;
      }
      return copies.get(loaded);
    });
    this.materials = [...copies.values()];
    return this.materials;
  }

  draw(camera) {
    this.renderer.render(this.scene.scene, camera);
    return 0;
  }

  dispose() {
    this.scene.scene.remove(this.sky);
    this.scene.scene.background = null;
    this.materials.forEach((material) => material.dispose());
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}

/**
 * Draws one frame with several contestants. Returns PNGs as data URLs, by the names of files.
 *
 * @param {object} task
 * @param {import('./scene.js').MeasuredScene} task.scene
 * @param {import('./camera.js').Frame[]} task.path - The frames of the path up to the one that is shown.
 * @param {{ title: string, contestant: object, biases: import('./entry.js').Biases }[]} task.columns
 * @returns {Promise<Record<string, string>>}
 */
export async function gallery({ scene, path, columns }) {
  const frames = path.slice(-1 - LEAD);
  const tracer = new TruthTracer(scene, SIZE);
  const truth = tracer.trace(frames.at(-1));
  tracer.dispose();
  const files = {};
  const sheet = newCanvas([columns.length * SIZE[0], 2 * (SIZE[1] + CAPTION)]);
  for (const [index, { title, contestant, biases }] of columns.entries()) {
    const { picture, marked, wrong } = await bothPictures({ scene, frames, contestant, biases, truth });
    const name = title.replaceAll(/\W+/g, '-');
    files[name] = picture.toDataURL('image/png');
    files[`${name}-wrong`] = marked.toDataURL('image/png');
    place(sheet, picture, [index, 0], title);
    place(sheet, marked, [index, 1], `${(100 * wrong).toFixed(2)}% of the pixels wrong`);
  }
  return { ...files, 'side-by-side': sheet.toDataURL('image/png') };
}

async function bothPictures({ scene, frames, contestant, biases, truth }) {
  const shown = new ShownStage(scene, SIZE);
  const picture = newCanvas(SIZE);
  await drawAll(new Entry(contestant, shown, biases), frames, () => {
    picture.getContext('2d').drawImage(shown.renderer.domElement, 0, 0);
  });
  const stage = new Stage(scene, SIZE);
  let factors;
  await drawAll(new Entry(contestant, stage, biases), frames, () => {
    factors = shadowFactors(truth, stage.read());
  });
  const { wrong, pixels } = judge(truth, factors);
  return { picture, marked: markedPicture(truth, factors), wrong: wrong / pixels };
}

async function drawAll(entry, frames, then) {
  await entry.beginPath(frames[0]);
  for (const frame of frames) {
    await entry.rest();
    entry.draw(frame);
  }
  then();
  entry.dispose();
  entry.stage.dispose();
}

/** Returns the lit surfaces in grey, with the wrong pixels marked. */
function markedPicture(truth, factors) {
  const canvas = newCanvas(SIZE);
  const context = canvas.getContext('2d');
  const image = context.createImageData(...SIZE);
  for (let offset = 0; offset < image.data.length; offset += 4) {
    image.data.set([...NOT_JUDGED, 255], offset);
  }
  truth.pixels.forEach((pixel, index) => {
    const [column, row] = [pixel % SIZE[0], SIZE[1] - 1 - Math.floor(pixel / SIZE[0])];
    const isLit = countsAsLit(factors[index]);
    const grey = 255 * DIMMED * Math.sqrt(0.05 + truth.brightness[index] * factors[index]);
    const mark = isLit ? FALSE_LIGHT : FALSE_SHADOW;
    const colour = Number(isLit) === truth.isLit[index] ? [grey, grey, grey] : mark;
    image.data.set(colour, 4 * (row * SIZE[0] + column));
  });
  context.putImageData(image, 0, 0);
  return canvas;
}

function newCanvas([width, height]) {
  return Object.assign(document.createElement('canvas'), { width, height });
}

/** Places a picture with a caption on a sheet. */
function place(sheet, picture, [column, row], caption) {
  const context = sheet.getContext('2d');
  const [x, y] = [column * SIZE[0], row * (SIZE[1] + CAPTION)];
  context.fillStyle = '#fff';
  context.fillRect(x, y, SIZE[0], SIZE[1] + CAPTION);
  context.drawImage(picture, x, y + CAPTION);
  context.fillStyle = '#222';
  context.font = '26px sans-serif';
  context.fillText(caption, x + 12, y + CAPTION - 13);
}
