// The packed package in a fresh project: bundled by Vite with React Three Fiber, and in a page without a bundler. The
// variable PACKAGE names the file that `npm pack` wrote.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { launch, serve } from '../browser.mjs';

const PACKAGE = process.env.PACKAGE;
const at = (path) => fileURLToPath(new URL(path, import.meta.url));
/** Packages of the fresh project, at the versions of our own manifest. */
const NEEDED = ['three', 'vite', '@vitejs/plugin-react', 'react', 'react-dom', '@react-three/fiber'];
/** Seconds that a page may take to show its first frame with shadows on a software driver. */
const PATIENCE = 60_000;

let folder;
let browser;
before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'shadowfit-package-'));
  const { devDependencies } = JSON.parse(readFileSync(at('../../package.json'), 'utf8'));
  const dependencies = Object.fromEntries(NEEDED.map((name) => [name, devDependencies[name]]));
  writeFileSync(join(folder, 'package.json'), JSON.stringify({ type: 'module', private: true, dependencies }));
  execFileSync('npm', ['install', '--no-audit', '--no-fund', '--silent', PACKAGE], { cwd: folder });
  cpSync(at('../../examples'), folder, { recursive: true });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Console messages of React Three Fiber, which still uses names that three.js has deprecated. */
const OF_FIBER = /THREE\.Clock|PCFSoftShadowMap/;

/** Opens a page, waits until a predicate holds in it, and calls a function with it. The console must stay silent. */
async function visit(root, predicate, check = () => {}) {
  const { address, close } = await serve(root);
  const { page, said } = await browser.open(`${address}/index.html`, { width: 240, height: 160 });
  try {
    await page.waitForFunction(predicate, undefined, { timeout: PATIENCE });
    await check(page);
    assert.deepEqual(said.filter((message) => !OF_FIBER.test(message)), []);
  } finally {
    await page.close();
    close();
  }
}

test('the example page needs no bundler', async () => {
  await visit(folder, () => document.forms[0].figures.value.includes('4 windows'));
});

test('Vite bundles the package with React Three Fiber', async () => {
  const project = join(folder, 'react');
  cpSync(at('project'), project, { recursive: true });
  execFileSync('npx', ['vite', 'build', '--logLevel', 'error'], { cwd: project });
  await visit(join(project, 'dist'), () => window.shadowsOf?.().maps.length === 4, async (page) => {
    assert.equal(await page.evaluate(() => window.shadowsOf().error), undefined);
  });
});
