// Serves the page, the packages and the scenes on a local port.

import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { existsSync } from 'node:fs';
import { dirname, extname, join, normalize, resolve } from 'node:path';

const TYPES = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json',
  '.wasm': 'application/wasm', '.glb': 'model/gltf-binary',
};

/**
 * Returns the folder of an installed package: the first `node_modules` that holds it, upwards from a folder.
 *
 * @param {string} name
 * @param {string} from
 */
export function packageFolder(name, from) {
  for (let folder = resolve(from); ; folder = dirname(folder)) {
    const found = join(folder, 'node_modules', name);
    if (existsSync(found)) {
      return found;
    }
    if (folder === dirname(folder)) {
      throw new Error(`${name} is not installed for ${from}: run npm install there, or pass --packages`);
    }
  }
}

/**
 * Serves folders by the first part of the path.
 *
 * @param {Record<string, string>} folders - Folder by prefix, such as `{ '/scenes/': '/home/me/scenes' }`.
 * @returns {Promise<{ address: string, close: () => void }>}
 */
export async function serve(folders) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const prefix = Object.keys(folders).find((start) => path.startsWith(start));
    const body = prefix && await readFile(join(folders[prefix], path.slice(prefix.length))).catch(() => undefined);
    response.writeHead(body ? 200 : 404, {
      'content-type': TYPES[extname(path)] ?? 'application/octet-stream',
      // Isolated pages have a clock with a resolution of 5 µs.
      'cross-origin-opener-policy': 'same-origin',
      'cross-origin-embedder-policy': 'require-corp',
    });
    response.end(body);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
