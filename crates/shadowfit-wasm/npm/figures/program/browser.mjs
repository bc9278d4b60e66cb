// The headless browser with the page.

import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { FOLDER } from './options.mjs';
import { packageFolder, serve } from './server.mjs';

const FLAGS = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];

/**
 * Opens the page.
 *
 * @param {{ packages: string, browser: string, scenes?: string }} options
 * @returns {Promise<{
 *   call: (method: string, ...values: unknown[]) => Promise<any>, version: string, close: () => Promise<void>,
 * }>} `call` calls a method of the page.
 */
export async function openPage({ packages, browser: executablePath, scenes }) {
  const { chromium } = createRequire(join(resolve(packages), 'package.json'))('playwright-core');
  const server = await serve({
    '/package/': resolve(FOLDER, '..'),
    '/packages/three/': packageFolder('three', packages),
    '/packages/three-mesh-bvh/': packageFolder('three-mesh-bvh', packages),
    ...(scenes && { '/scenes/': resolve(scenes) }),
  });
  const browser = await chromium.launch({ executablePath, args: FLAGS });
  const page = await browser.newPage();
  page.on('pageerror', (error) => console.error(error.message));
  page.on('console', (message) => message.type() === 'error' && console.error(message.text()));
  await page.goto(`${server.address}/package/figures/page/index.html`);
  await page.waitForFunction(() => window.figures !== undefined);
  return {
    call: (method, ...values) => page.evaluate(([name, given]) => window.figures[name](...given), [method, values]),
    version: browser.version(),
    async close() {
      await browser.close();
      server.close();
    },
  };
}
