// A web server for the package's folder, and a headless Chromium with software WebGL2.

import { createReadStream, existsSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';

const ROOT = fileURLToPath(new URL('..', import.meta.url));
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json' };
const BROWSER = process.env.BROWSER ?? '/usr/bin/chromium';
const FLAGS = [
  '--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
  // Without this flag, the browser refuses WebGL to the page after lost contexts.
  '--disable-domain-blocking-for-3d-apis',
];
/** Console messages of the browser itself. */
const OF_BROWSER = /software WebGL|GPU stall due to ReadPixels|Automatic fallback to software/;

/** Serves a folder. Returns its address. */
export async function serve(root = ROOT) {
  const server = createServer((request, response) => {
    const path = join(root, normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname)));
    if (!path.startsWith(root) || !existsSync(path) || !statSync(path).isFile()) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { 'content-type': TYPES[extname(path)] ?? 'application/octet-stream' });
    createReadStream(path).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

/** Starts a browser. Each page that it opens collects the messages of its console in `said`. */
export async function launch() {
  const browser = await chromium.launch({ executablePath: BROWSER, args: FLAGS });
  const open = async (address, viewport = { width: 800, height: 600 }) => {
    const page = await browser.newPage({ viewport });
    const said = [];
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type()) && !OF_BROWSER.test(message.text())) {
        said.push(message.text());
      }
    });
    page.on('pageerror', (error) => said.push(error.message));
    await page.goto(address);
    return { page, said };
  };
  return { open, close: () => browser.close() };
}

/** Opens the page of the tests. */
export async function open() {
  const { address, close } = await serve();
  const browser = await launch();
  const { page, said } = await browser.open(`${address}/tests/page.html`);
  await page.waitForFunction(() => window.ready === true);
  return { page, said, close: async () => Promise.all([browser.close(), close()]) };
}
