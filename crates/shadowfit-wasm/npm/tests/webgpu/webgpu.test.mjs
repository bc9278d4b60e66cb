// Tests the WebGPURenderer adapter in headless Chromium, on software WebGPU and on the renderer's WebGL2 backend.
//
// `node --test tests/webgpu` runs this file. Environment variables: BROWSER is the browser, and THREE the folder of another
// release of three.js.

import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { chromium } from 'playwright-core';

import { serve } from './server.mjs';

const { BROWSER = '/usr/bin/chromium', THREE } = process.env;

const FLAGS = [
  '--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run',
  // WebGPU. If one of these flags is missing, frames run but the page stays white.
  '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader',
  // WebGL2. It also needs the first WebGPU flag.
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-domain-blocking-for-3d-apis',
];
/// Messages of the browser itself.
const OF_BROWSER = /software WebGL|GPU stall due to ReadPixels|Automatic fallback to software|powerPreference/;
/// Largest difference of a shade that 8-bit colours cause.
const STEP = 0.02;

const isLit = (shade) => Math.abs(shade - 1) <= STEP;
const isDark = (shade) => shade <= STEP;

let browser;
let server;
let address;

before(async () => {
  ({ server, address } = await serve(THREE));
  browser = await chromium.launch({ executablePath: BROWSER, args: FLAGS });
});

after(async () => {
  await browser?.close();
  server?.close();
});

const BACKENDS = { WebGPU: {}, WebGL2: { forceWebGL: true } };

for (const [name, backend] of Object.entries(BACKENDS)) {
  describe(name, () => {
    let page;
    before(async () => {
      page = await browser.newPage();
      await page.goto(`${address}/tests/webgpu/index.html`);
      await page.waitForFunction(() => window.isReady);
    });
    const run = async (test, values = {}) => {
      const options = { ...backend, ...values.options };
      return page.evaluate(([test, values]) => window.run(test, values), [test, { ...values, options }]);
    };
    const isQuiet = ({ messages }) => {
      assert.deepEqual(messages.filter((message) => !OF_BROWSER.test(message)), []);
    };

    // First, because a renderer with reversed depth breaks the output of later renderers on the same page (three.js r187).
    test('other ways to render have the same shadows, and their depths are counted', async () => {
      for (const [way, result] of Object.entries(await run('ways'))) {
        const { shadow, lit, depths } = result;
        assert.ok(isDark(shadow) && isLit(lit), `${way}: ${JSON.stringify(result)}`);
        // The floor has the depth (3 - 0.1) / (20 - 0.1).
        const floor = 2.9 / 19.9;
        const isCounted = depths?.every((depth) => Math.abs(depth - floor) < 1e-3);
        assert.ok(way.startsWith('two views') || isCounted, `${way}: depths ${depths}`);
        isQuiet(result);
      }
    });

    const PICTURES = {
      'a SunLight': {},
      'a DirectionalLight': { sun: { isDirectional: true } },
      'reversed depth': { options: { reversedDepthBuffer: true } },
      'logarithmic depth': { options: { logarithmicDepthBuffer: true } },
      'hard shadows': { type: 'BasicShadowMap' },
      'variance shadow maps': { type: 'VSMShadowMap' },
      'a disc': { radius: 2 },
      'one map': { sun: { maps: 1 } },
      'eight maps': { sun: { maps: 8 } },
      centimetres: { scale: 100 },
    };
    for (const [title, values] of Object.entries(PICTURES)) {
      test(`the shadow lies where the sun's direction says, with ${title}`, async () => {
        const result = await run('picture', values);
        const [shadow, under, beside] = result.shades;
        assert.ok(isDark(shadow) && isLit(under) && isLit(beside), `shades ${result.shades}`);
        assert.ok(result.half > 0.3 && result.half < 0.85, `half intensity gives ${result.half}`);
        assert.ok(isLit(result.none), 'receiveShadow is ignored');
        isQuiet(result);
      });
    }

    test('casters of all kinds cast shadows', async () => {
      const { results, messages } = await run('casters');
      for (const [kind, result] of Object.entries(results)) {
        const { shadow, beside, lit, none } = result;
        assert.ok(isDark(shadow) && isLit(beside) && isLit(lit) && isLit(none), `${kind}: ${JSON.stringify(result)}`);
      }
      isQuiet({ messages });
    });

    test('an edge lights up in four steps, with the weights of the tent filter', async () => {
      const { profile, hasStayed } = await run('edge');
      assert.ok(hasStayed && isDark(profile[0]) && isLit(profile.at(-1)), `${profile}`);
      const rises = profile.slice(1).map((shade, index) => shade - profile[index]).filter((rise) => rise > STEP / 8);
      // 3 × 3 bilinear comparisons weight four texels so, for a point that lies t texels from a texel's centre.
      const weights = (t) => [1 - t, 2 - t, 1 + t, t].map((weight) => weight / 4);
      const errors = Array.from({ length: 101 }, (_, index) => {
        const expected = weights(index / 100).filter((weight) => weight > STEP / 8);
        return expected.length === rises.length
          ? Math.max(...expected.map((weight, step) => Math.abs(weight - rises[step]))) : Infinity;
      });
      assert.ok(Math.min(...errors) < STEP / 2, `rises of ${rises.map((rise) => rise.toFixed(3))}`);
    });

    test('no lit surface has acne, from sunrise to noon', async () => {
      const result = await run('acne');
      for (const [elevation, least] of Object.entries(result.least)) {
        assert.ok(least >= -1, `at ${elevation} degrees, a pixel is darker by ${-least}`);
      }
      isQuiet(result);
    });

    test('only maps whose content changes are drawn, and the picture is the same', async () => {
      const { passes, worst, ...result } = await run('cache');
      assert.equal(passes.first[0], 3);
      assert.ok(passes.still.every((count) => count === 0), `still: ${passes.still}`);
      assert.ok(passes['slow camera'].filter((count) => count === 0).length >= 5, `slow camera: ${passes['slow camera']}`);
      assert.ok(passes['moving box'].every((count) => count > 0), `moving box: ${passes['moving box']}`);
      assert.equal(passes['box rests'][0], 0);
      assert.ok(passes.removed[0] > 0, `removed: ${passes.removed}`);
      assert.ok(worst.most <= 2, `${worst.count} pixels differ by up to ${worst.most}`);
      isQuiet(result);
    });

    test('broken input draws no shadows and warns once', async () => {
      const results = await run('broken');
      const unlit = new Set(['no direction', 'NaN sun', 'infinite camera', 'empty']);
      const quiet = new Set(['empty', 'no casters']);
      for (const [name, { messages, thrown, shadow }] of Object.entries(results)) {
        assert.equal(thrown, undefined, name);
        if (name === 'recovered') {
          assert.ok(isDark(shadow), 'shadows do not come back');
          continue;
        }
        assert.ok(unlit.has(name) || isLit(shadow), `${name}: ${shadow}`);
        const warnings = messages.filter((message) => message.startsWith('shadowfit:'));
        assert.equal(warnings.length, quiet.has(name) ? 0 : 1, `${name}: ${messages.join('\n')}`);
        assert.ok(quiet.has(name) || /the (sun|box)/.test(warnings[0]), warnings[0]);
      }
    });

    test('each camera has its own maps, and settings may change', async () => {
      const result = await run('cameras');
      assert.ok(result.shadows.every(isDark), `shadows ${result.shadows}`);
      assert.deepEqual(result.passes.slice(-4), [0, 0, 0, 0], `passes ${result.passes}`);
      assert.ok(Object.values(result.changed).every(isDark), JSON.stringify(result.changed));
      assert.equal(result.maps, 4);
      isQuiet(result);
    });

    test('suns are independent, and can be cloned, replaced and disposed of', async () => {
      const result = await run('suns');
      const [first, second, lit] = result.both;
      assert.ok(first > 0.2 && first < 0.8 && second > 0.2 && second < 0.8 && isLit(lit), `both: ${result.both}`);
      for (const [shadow, other] of [result.one, result.replaced]) {
        assert.ok(isDark(shadow) && isLit(other), JSON.stringify(result));
      }
      assert.equal(result.leaked, 0, 'textures leak');
      assert.ok(result.isCopy && result.json);
      assert.ok(isLit(result.off) && isDark(result.on), 'castShadow is ignored');
      isQuiet(result);
    });

    test('maps show the layers of the camera, or their own', async () => {
      const { unseen, seen } = await run('layers');
      assert.ok(isLit(unseen) && isDark(seen), `${unseen} ${seen}`);
    });
  });
}
