// Options of the program.

import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

export const FOLDER = fileURLToPath(new URL('..', import.meta.url));

export const USAGE = `Usage: node run.mjs [options]

  --scenes DIR       folder with scenarios.json and its GLB files; without it, only generated scenes are measured
  --out DIR          folder for figures.json, figures.md and pictures (default: out)
  --quick            judge two of every ten frames instead of two of every four, and draw no pictures
  --only A,B         only these scenes
  --contestant A,B   only these contestants
  --double-sided     make all materials double-sided, as many glTF files have them
  --tune             find the best biases again, and store them in tuned.json
  --pictures ID,...  frames to draw, such as town/40/10, or none (default: the middle of each scene's first path)
  --packages DIR     folder whose node_modules holds the packages (default: this folder; or PACKAGES)
  --browser FILE     Chromium (default: /usr/bin/chromium; or BROWSER)
`;

/** Reads the command line. */
export function readOptions() {
  const text = { type: 'string' };
  const flag = { type: 'boolean', default: false };
  const { values } = parseArgs({
    options: {
      scenes: text,
      out: { ...text, default: 'out' },
      quick: flag,
      only: text,
      contestant: text,
      'double-sided': flag,
      tune: flag,
      pictures: text,
      packages: { ...text, default: process.env.PACKAGES ?? FOLDER },
      browser: { ...text, default: process.env.BROWSER ?? '/usr/bin/chromium' },
      help: flag,
    },
  });
  const list = (names) => names?.split(',');
  return { ...values, only: list(values.only), contestant: list(values.contestant), pictures: list(values.pictures) };
}
