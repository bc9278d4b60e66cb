// Type checks of programs that use every public name of the package.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { test } from 'node:test';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

test('the declarations accept strict programs', () => {
  const flags = ['--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext', '--moduleResolution', 'bundler'];
  const compiler = at('../node_modules/typescript/bin/tsc');
  try {
    execFileSync(process.execPath, [compiler, ...flags, at('sample.ts'), at('sample-webgpu.ts')], { encoding: 'utf8' });
  } catch (error) {
    assert.fail(error.stdout ?? error.message);
  }
});
