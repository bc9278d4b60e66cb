// The page's side of the program: holds one scene at a time, and does the work that the program asks for.

import { DoubleSide } from 'three';
import { CONTESTANTS } from '../contestants/index.js';
import { SCENES } from '../scenes/index.js';
import { gallery } from './gallery.js';
import { measure } from './measure.js';
import { MeasuredScene } from './scene.js';
import { TruthTracer } from './truth.js';
import { tune } from './tune.js';

/** Width and height of judged pictures, in pixels. */
const SIZE = [480, 270];

/** Number of frames of which the last two are judged. Crawl compares the second one with the first one. */
const [EVERY, EVERY_QUICK] = [4, 10];

/** The open scene, its paths and the truth of its judged frames. */
let open;

const contestantOf = (name) => CONTESTANTS.find((contestant) => contestant.name === name);

window.figures = {
  /** Returns the name of the device that draws. */
  device() {
    const gl = document.createElement('canvas').getContext('webgl2');
    return gl.getParameter(gl.getExtension('WEBGL_debug_renderer_info').UNMASKED_RENDERER_WEBGL);
  },

  /** Returns the contestants' names, and whether their biases are tuned. */
  contestants: () => CONTESTANTS.map(({ name, isTunable }) => ({ name, isTunable })),

  /** Returns the names of the scenes that this folder generates. */
  generated: () => SCENES.map(({ name }) => name),

  /**
   * Opens a scene and traces the truth of the judged frames.
   *
   * @param {object} task
   * @param {string} task.name
   * @param {string} [task.address] - Address of a GLB file. Without one, the scene is generated.
   * @param {import('./camera.js').Frame[]} [task.frames] - Frames, unless the scene is generated.
   * @param {boolean} task.isQuick - Whether fewer frames are judged.
   * @param {boolean} task.isDoubleSided - Whether all materials become double-sided.
   */
  async open({ name, address, frames, isQuick, isDoubleSided }) {
    open = undefined;
    const generated = SCENES.find((scene) => scene.name === name);
    const scene = address ? await MeasuredScene.load(name, address) : new MeasuredScene(name, generated.build());
    if (isDoubleSided) {
      scene.materials.forEach((material) => { material.side = DoubleSide; });
    }
    const paths = byElevation(frames ?? generated.frames());
    const tracer = new TruthTracer(scene, SIZE);
    const truths = new Map();
    for (const path of paths) {
      path.forEach((frame, index) => {
        if (isJudged(frame, isQuick)) {
          truths.set(frame.id, tracer.trace(frame, path[index - 1]));
        }
      });
    }
    tracer.dispose();
    open = { scene, paths, truths, isQuick, size: SIZE };
    return {
      triangles: scene.triangles,
      objects: scene.meshes.length,
      judged: truths.size,
      paths: paths.map((path) => path.map(({ id }) => id)),
    };
  },

  /** Measures variants of a contestant. See `measure`. */
  measure: (name, variants) => measure({ ...open, contestant: contestantOf(name), variants }),

  /** Tunes a contestant. See `tune`. */
  tune: (name) => tune({ ...open, contestant: contestantOf(name) }),

  /**
   * Draws pictures of a frame. See `gallery`.
   *
   * @param {string} id - The frame's.
   * @param {{ title: string, name: string, biases: object }[]} columns
   */
  pictures(id, columns) {
    const path = open.paths.find((frames) => frames.some((frame) => frame.id === id));
    const last = path.findIndex((frame) => frame.id === id);
    return gallery({
      scene: open.scene,
      path: path.slice(0, last + 1),
      columns: columns.map((column) => ({ ...column, contestant: contestantOf(column.name) })),
    });
  },
};

function isJudged({ frame }, isQuick) {
  const every = isQuick ? EVERY_QUICK : EVERY;
  return frame % every >= every - 2;
}

function byElevation(frames) {
  const paths = Map.groupBy(frames, (frame) => frame.elevation_deg);
  return [...paths.values()];
}
