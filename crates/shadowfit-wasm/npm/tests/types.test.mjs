// Type check of a program that uses every public name of `shadowfit/three`.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { test } from 'node:test';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

test('the declarations accept a strict program', () => {
  const flags = ['--noEmit', '--strict', '--target', 'es2022', '--module', 'esnext', '--moduleResolution', 'bundler'];
  const compiler = at('../node_modules/typescript/bin/tsc');
  try {
    execFileSync(process.execPath, [compiler, ...flags, at('sample.ts')], { encoding: 'utf8' });
  } catch (error) {
    assert.fail(error.stdout ?? error.message);
  }
});
