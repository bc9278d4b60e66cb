// Tests the viewer's page in headless Chromium, on software WebGPU and on software WebGL2. Compares its pictures and
// figures with the native viewer's. Keys, pointers, links and files use the same code with both APIs, so one API is
// enough for their tests.
//
// `cargo xtask web --test` runs this file. Environment variables: PAGE is the address of the page, NATIVE the folder
// with the native viewer's files from `tour.txt`, BROWSER the browser, and ASSETS a folder of hostile files, which may
// be absent. LONG=1 extends the random actions to ten minutes with each API.

import assert from 'node:assert/strict';
import { readFileSync, readdirSync, existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { after, afterEach, before, describe, test } from 'node:test';
import { chromium } from 'playwright-core';

const { PAGE, NATIVE, BROWSER, ASSETS, LONG } = process.env;
const here = (name) => fileURLToPath(new URL(name, import.meta.url));

const FLAGS = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync',
  // WebGPU. If one of these flags is missing, frames run but the page stays white.
  '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader',
  // WebGL2. It also needs the first WebGPU flag.
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  // Without this flag, the browser disables both APIs for the page after two lost devices within two minutes.
  '--disable-domain-blocking-for-3d-apis',
];
/// API for tests that do not depend on the API.
const EITHER = 'webgl2';
/// Time limit for any single wait with a software GPU, in milliseconds.
const PATIENCE = 120_000;
/// Time between two checks of the page, in milliseconds.
const PERIOD = 50;
/// Longest task of the page that a user does not notice, in milliseconds.
const LONGEST_TASK = 50;
/// Position of the panel's button on a phone 390 points wide.
const DRAWER = [350, 22];
/// Position on the picture beside the open drawer of that phone.
const BESIDE = [10, 500];
/// Rectangle in the top bar that contains no text at any page size.
const BAR = [150, 4, 150, 3];
/// Console messages of the browser itself, which a page cannot prevent.
const OF_BROWSER = /software WebGL|GPU stall due to ReadPixels|Automatic fallback to software|powerPreference/;

/// An open page and its console messages.
class Viewer {
  static async open(browser, { api, query = '', hash = '', width = 720, height = 300, scale = 1, isTouch = false, colours = 'light' }) {
    const context = await browser.newContext({
      viewport: { width, height }, deviceScaleFactor: scale, hasTouch: isTouch, colorScheme: colours,
      acceptDownloads: true,
      permissions: ['clipboard-read', 'clipboard-write'],
    });
    context.setDefaultTimeout(PATIENCE);
    const page = await context.newPage();
    const viewer = new Viewer();
    // A separate page compares pictures, because the comparison would be a long task in the viewer's page.
    const address = `${PAGE}?api=${api}${query}${hash}`;
    Object.assign(viewer, { context, page, address, desk: await context.newPage(), said: [], files: new Map(), tasks: [] });
    await page.bringToFront();
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type()) && !OF_BROWSER.test(message.text())) {
        viewer.said.push(message.text());
      }
    });
    page.on('pageerror', (error) => viewer.said.push(error.message));
    page.on('download', async (download) => {
      const stream = await download.createReadStream();
      const parts = [];
      for await (const part of stream) {
        parts.push(part);
      }
      viewer.files.set(download.suggestedFilename(), Buffer.concat(parts));
    });
    await page.addInitScript(() => {
      window.longTasks = [];
      new PerformanceObserver((list) => {
        window.longTasks.push(...list.getEntries().map(({ startTime, duration }) => ({ startTime, duration })));
      }).observe({ entryTypes: ['longtask'] });
    });
    await viewer.wake();
    return viewer;
  }

  /// Loads the page and waits for its first frame.
  async wake() {
    await this.page.goto(this.address);
    await this.untilReady();
  }

  async untilReady() {
    await this.until(() => this.page.evaluate(() => document.documentElement.dataset.ready), 'the first frame');
  }

  /// Leaves the page until `wake`, so that another page can use the software GPU alone.
  async rest() {
    await this.keepTasks();
    await this.page.goto('about:blank');
  }

  /// Records the long tasks of the page before it is left.
  async keepTasks() {
    this.tasks.push(...await this.page.evaluate(() => window.longTasks?.splice(0) ?? []));
  }

  async close() {
    await this.context.close();
  }

  async facts() {
    return this.page.evaluate(() => window.viewer.facts());
  }

  /// Waits until `what` returns a true value, and returns that value.
  async until(what, name, patience = PATIENCE) {
    const end = Date.now() + patience;
    for (;;) {
      const found = await what();
      if (found) {
        return found;
      }
      const state = await this.page.evaluate(() => document.querySelector('#cover.failed #state')?.textContent);
      assert.equal(state, undefined, `${name}: the viewer has ended`);
      if (Date.now() > end) {
        assert.fail(`${name} did not come: ${JSON.stringify(await this.facts()).slice(0, 400)}; ${this.said}`);
      }
      await new Promise((resolve) => setTimeout(resolve, PERIOD));
    }
  }

  async untilFacts(check, name, patience) {
    return this.until(async () => {
      const facts = await this.facts();
      return await check(facts) && facts;
    }, name, patience);
  }

  /// Opens files like the page's file button.
  async choose(...files) {
    await this.page.setInputFiles('#files', files);
  }

  /// Plays a script, waits for its end, and returns the facts at that time.
  async play(lines, patience = PATIENCE) {
    await this.choose({ name: 'script.txt', mimeType: 'text/plain', buffer: Buffer.from(lines.join('\n')) });
    await this.untilFacts(({ has_played: done }) => !done, 'the start of the script');
    const isOver = ({ has_played: done, is_waiting: busy }) => done && !busy;
    return this.untilFacts(isOver, 'the end of the script', patience);
  }

  /// Returns the number of colours in a picture, and its size.
  async colours(png) {
    return this.desk.evaluate(async (bytes) => {
      const picture = await createImageBitmap(await (await fetch(`data:image/png;base64,${bytes}`)).blob());
      const context = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
      context.drawImage(picture, 0, 0);
      const { data } = context.getImageData(0, 0, picture.width, picture.height);
      const colours = new Set(new Uint32Array(data.buffer));
      return { count: colours.size, size: [picture.width, picture.height] };
    }, png.toString('base64'));
  }

  /// Returns the share of pixels that differ by more than `least` in any channel, and the mean difference. Shrinks both
  /// pictures first, because this page has one sample per pixel, and headless pictures have four.
  async difference(one, other, least = 40) {
    return this.desk.evaluate(async ([one, other, least]) => {
      const pixels = async (bytes) => {
        const blob = await (await fetch(`data:image/png;base64,${bytes}`)).blob();
        const picture = await createImageBitmap(blob, { colorSpaceConversion: 'none' });
        const [width, height] = [picture.width, picture.height].map((side) => Math.round(side / 3));
        const context = new OffscreenCanvas(width, height).getContext('2d');
        context.imageSmoothingQuality = 'high';
        context.drawImage(picture, 0, 0, width, height);
        return context.getImageData(0, 0, width, height);
      };
      const [a, b] = [await pixels(one), await pixels(other)];
      if (a.width !== b.width || a.height !== b.height) {
        return { share: 1, mean: 255, sizes: [a.width, a.height, b.width, b.height] };
      }
      let [far, sum] = [0, 0];
      for (let at = 0; at < a.data.length; at += 4) {
        const channels = [0, 1, 2].map((channel) => Math.abs(a.data[at + channel] - b.data[at + channel]));
        far += Math.max(...channels) > least ? 1 : 0;
        sum += channels[0] + channels[1] + channels[2];
      }
      return { share: far / (a.data.length / 4), mean: sum / (a.data.length / 4 * 3) };
    }, [one.toString('base64'), other.toString('base64'), least]);
  }

  /// Returns the mean value of all colour channels in a rectangle of the page, 0..=255.
  async brightness([x, y, width, height]) {
    const png = await this.page.screenshot({ clip: { x, y, width, height } });
    return this.desk.evaluate(async (bytes) => {
      const picture = await createImageBitmap(await (await fetch(`data:image/png;base64,${bytes}`)).blob());
      const context = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
      context.drawImage(picture, 0, 0);
      const { data } = context.getImageData(0, 0, picture.width, picture.height);
      const channels = data.filter((_, index) => index % 4 !== 3);
      return channels.reduce((sum, value) => sum + value, 0) / channels.length;
    }, png.toString('base64'));
  }

  quiet() {
    assert.deepEqual(this.said, [], 'the console is free of errors and warnings');
  }
}

/// Returns the last row of a table of figures, by column name.
function figures(csv) {
  const lines = csv.toString().trim().split('\n');
  const [names, values] = [lines[0], lines.at(-1)].map((line) => line.split(','));
  return Object.fromEntries(names.map((name, index) => [name, Number(values[index])]));
}

/// The browser of all tests, and the open page of a group of tests.
let browser;
let viewer;

// Playwright kills the browser when this program exits.
for (const [signal, code] of [['SIGHUP', 129], ['SIGINT', 130], ['SIGTERM', 143]]) {
  process.once(signal, () => process.exit(code));
}
before(async () => {
  const signals = { handleSIGHUP: false, handleSIGINT: false, handleSIGTERM: false };
  browser = await chromium.launch({ executablePath: BROWSER, args: FLAGS, ...signals });
});
after(async () => browser?.close());

/// Opens a page for a group of tests. Closes pages that a test has left open, so that the next test can use the
/// software GPU alone.
function withViewer(api) {
  before(async () => {
    viewer = await Viewer.open(browser, { api });
  });
  afterEach(async () => {
    const others = browser.contexts().filter((context) => context !== viewer.context);
    await Promise.all(others.map((context) => context.close()));
  });
  after(async () => viewer?.close());
}

function testTasks() {
  test('no task of the page is long enough to notice', async (context) => {
    await viewer.keepTasks();
    const long = viewer.tasks.filter(({ duration }) => duration > LONGEST_TASK);
    context.diagnostic(`tasks of more than ${LONGEST_TASK} ms: ${JSON.stringify(long)}`);
    // A busy machine interrupts the page up to four times a minute. A viewer that blocks the page would block it in
    // each frame, hundreds of times.
    assert.ok(long.length <= 6, JSON.stringify(long));
  });
}

for (const api of ['webgpu', 'webgl2']) {
  const judges = api === 'webgpu';
  // These tests take minutes on software WebGPU, and most of their work is the same with both APIs.
  const byNight = !LONG && api !== EITHER && 'cargo xtask web --test --long';

  describe(api, { concurrency: 1, timeout: 30 * 60_000 }, () => {
    withViewer(api);

    test('the page loads with its API and shows a picture', async () => {
      assert.equal(await viewer.page.evaluate(() => document.documentElement.dataset.api), api);
      const { count, size } = await viewer.colours(await viewer.page.screenshot());
      assert.deepEqual(size, [720, 300]);
      assert.ok(count > 1000, `${count} colours`);
      viewer.quiet();
    });

    test('pictures and figures match the native viewer for each artefact', async () => {
      const lines = readFileSync(here('tour.txt'), 'utf8').split('\n');
      // Figures exist only with the API that judges pictures.
      const played = judges ? lines : lines.filter((line) => !/^(await judged|wait|figures)/.test(line));
      await viewer.play(played, 8 * 60_000);
      await viewer.until(() => viewer.files.has('hole.png'), 'the last picture');
      for (const name of ['first', 'acne', 'aliasing', 'hole']) {
        const native = readFileSync(`${NATIVE}/${name}.png`);
        const { share, mean } = await viewer.difference(viewer.files.get(`${name}.png`), native);
        assert.ok(share < 0.02 && mean < 6, `${name}: ${share * 100}% of the pixels differ, mean difference ${mean}`);
      }
      if (judges) {
        for (const name of readdirSync(NATIVE).filter((file) => file.endsWith('.csv'))) {
          const [here, there] = [viewer.files.get(name), readFileSync(`${NATIVE}/${name}`)].map(figures);
          for (const column of ['wrong (%)', 'false shadow (%)', 'false light (%)', 'hole (%)', 'light error (%)']) {
            const off = Math.abs(here[column] - there[column]);
            assert.ok(off <= 0.3 + 0.03 * there[column], `${name}, ${column}: ${here[column]}, not ${there[column]}`);
          }
        }
      }
      viewer.quiet();
    });

    test('views that need compute shaders are drawn, or refused with the reason', async () => {
      await viewer.page.keyboard.press('3');
      if (judges) {
        await viewer.untilFacts(({ view }) => view === 'Error', 'the view of errors');
      } else {
        const { view } = await viewer.untilFacts(({ message }) => /compute shaders/.test(message), 'the reason');
        assert.equal(view, 'Final');
      }
      await viewer.page.keyboard.press('1');
      viewer.quiet();
    });

    test('every view, sample and kind of edge is drawn', async () => {
      const views = ['truth', 'error', 'pixels_per_texel', 'maps', 'texel_grid', 'demand', 'updates', 'outside'];
      const samples = ['xna-shadow-mapping', 'headlight-real-shadow', 'terrain-vehicles', 'parallel-split'];
      // A smaller picture and smaller maps save time and need the same pipelines.
      await viewer.page.setViewportSize({ width: 320, height: 180 });
      const lines = ['await loaded', 'play', 'set map.resolution 512', ...views.flatMap((view) => [`view ${view}`, 'frames 1']),
        'view final', 'marks', 'frames 1', 'marks', 'marks', 'set map.edges traced', 'view traced', 'frames 1', 'view final', 'frames 1',
        'set map.edges filtered', 'set map.filter pcss', 'frames 1',
        ...samples.flatMap((sample) => [`open ${sample}`, 'await loaded', 'frames 1']), 'open courtyard', 'await loaded'];
      await viewer.play(lines, 4 * PATIENCE);
      viewer.quiet();
    });

    test('auto-tune runs while frames are drawn, and can be cancelled', { skip: byNight }, async () => {
      await viewer.page.keyboard.press('t');
      await viewer.untilFacts(({ is_waiting: busy }) => busy, 'the start of the search');
      await viewer.untilFacts(({ tried }) => tried > 0, 'the first figures of the search');
      const cancel = { name: 'cancel.txt', mimeType: 'text/plain', buffer: Buffer.from('cancel') };
      await viewer.choose(cancel);
      await viewer.untilFacts(({ is_waiting: busy }) => !busy, 'the end of the search');
      viewer.quiet();
    });

    test('random actions neither end the page nor grow its memory', { skip: byNight }, async () => {
      await viewer.page.setViewportSize({ width: 320, height: 180 });
      const seconds = LONG ? 360 : 10;
      const patience = (seconds + 300) * 1000;
      // Auto-tune needs more memory than any other action, and a WebAssembly module never releases memory. After some
      // random actions, all kinds of scenes, pictures and maps exist.
      const first = ['tune', 'wait 4', 'open courtyard', 'await loaded', `monkey ${LONG ? 240 : 5} 7`];
      const { memory } = await viewer.play(first, patience);
      const end = await viewer.play([`monkey ${seconds} 8`], patience);
      assert.ok(end.memory <= memory * (LONG ? 1.25 : 1.6), `memory grew from ${memory} to ${end.memory} bytes`);
      viewer.quiet();
    });

    testTasks();

    test('a lost device is reported, and the page can reload', async () => {
      const { page } = viewer;
      const { processInfo: processes } = await (await browser.newBrowserCDPSession()).send('SystemInfo.getProcessInfo');
      process.kill(processes.find(({ type }) => type === 'GPU').id, 'SIGKILL');
      await page.waitForSelector('#cover.failed');
      assert.match(await page.textContent('#state'), /graphics device was lost/);
      assert.match(await page.textContent('#advice'), /settings are saved/);
      await page.click('#again');
      await page.waitForSelector('#cover.failed', { state: 'detached' });
      await viewer.untilReady();
      // The threshold is low, because the random actions may have left any view.
      const { count } = await viewer.colours(await page.screenshot());
      assert.ok(count > 100, `${count} colours`);
    });
  });
}

describe('the page', { concurrency: 1, timeout: 30 * 60_000 }, () => {
  withViewer(EITHER);

  test('W moves the camera, and a drag and a locked mouse turn it', async () => {
    const start = await viewer.facts();
    await viewer.page.keyboard.down('w');
    const moved = await viewer.untilFacts(({ position }) => `${position}` !== `${start.position}`, 'a movement');
    await viewer.page.keyboard.up('w');
    assert.ok(moved.position[2] < start.position[2], `forward: ${start.position} to ${moved.position}`);
    await viewer.page.mouse.move(200, 200);
    await viewer.page.mouse.down();
    let x = 200;
    const drags = async () => viewer.page.mouse.move(x += 5, 210);
    await viewer.untilFacts(async ({ angles }) => `${angles}` !== `${start.angles}` || void await drags(), 'a turn');
    await viewer.page.mouse.up();
    await viewer.page.keyboard.press('v');
    const lock = () => viewer.page.evaluate(() => document.pointerLockElement?.id);
    await viewer.until(async () => await lock() === 'canvas', 'a locked mouse');
    const { angles: before } = await viewer.facts();
    await viewer.page.mouse.move(300, 220, { steps: 4 });
    await viewer.untilFacts(({ angles }) => `${angles}` !== `${before}`, 'a turn by the locked mouse');
    await viewer.page.evaluate(() => document.exitPointerLock());
    await viewer.until(async () => !await lock(), 'a free mouse');
    viewer.quiet();
  });

  test('settings are kept from one visit to the next', async () => {
    // The mouse of the previous test may still move the camera in the next frame.
    await viewer.play(['frames 3']);
    await viewer.page.evaluate(() => window.viewer.tell('save'));
    // The viewer answers messages in order. After this answer the page has stored the settings.
    const start = await viewer.facts();
    assert.ok(await viewer.page.evaluate(() => localStorage.getItem('shadowfit viewer')));
    await viewer.keepTasks();
    await viewer.page.reload();
    const again = await viewer.untilFacts(({ is_ready: ready }) => ready, 'the first frame');
    // The tolerance is necessary because the file stores angles in degrees.
    const near = (one, other) => one.every((value, index) => Math.abs(value - other[index]) < 1e-5);
    assert.ok(near(again.position, start.position) && near(again.angles, start.angles),
      `${start.position}, ${start.angles} became ${again.position}, ${again.angles}`);
    assert.equal(again.view, start.view);
    viewer.quiet();
  });

  test('hostile files show an error, and the page keeps running', async () => {
    const hostile = [
      { name: 'short.glb', buffer: Buffer.from('glTF\x02\0\0\0\xff\xff\xff\x7f', 'latin1') },
      { name: 'empty.glb', buffer: Buffer.alloc(0) },
      { name: 'noise.png', buffer: Buffer.from('not a picture') },
      { name: 'deep.gltf', buffer: Buffer.from(`{"asset":${'['.repeat(5000)}`) },
    ];
    const folder = `${ASSETS}/hostile_shared`;
    if (existsSync(folder)) {
      const files = readdirSync(folder, { recursive: true }).filter((file) => /\.(glb|gltf)$/.test(file));
      for (const file of files.filter((_, index) => index % Math.ceil(files.length / 12) === 0)) {
        hostile.push({ name: file.split('/').at(-1), buffer: readFileSync(`${folder}/${file}`) });
      }
    }
    for (const file of hostile) {
      await viewer.choose({ mimeType: 'application/octet-stream', ...file });
      // A few of the shared files are valid, so they open.
      await viewer.untilFacts(({ message, title, is_waiting: busy }) =>
        !busy && (message?.includes(file.name) || title.includes(file.name)), `an answer to ${file.name}`);
    }
    const before = await viewer.facts();
    await viewer.page.keyboard.down('s');
    await viewer.untilFacts(({ position }) => `${position}` !== `${before.position}`, 'a movement after all files');
    await viewer.page.keyboard.up('s');
    viewer.quiet();
  });

  test('the page follows its size', async () => {
    await viewer.page.setViewportSize({ width: 800, height: 500 });
    await viewer.untilFacts(({ size }) => `${size}` === '800,500', 'the new size');
    viewer.quiet();
  });

  test('a link restores the complete state', async () => {
    // The clipboard may contain another link from random actions.
    await viewer.page.evaluate(() => navigator.clipboard.writeText(''));
    const there = await viewer.play(['open plain', 'await loaded', 'play', 'technique stable-4', 'set bias.constant 2.5', 'set map.resolution 1024',
      'set light.azimuth 200', 'look 3 4 12 TO 0 1 0', 'view maps', 'compare on', 'frames 2', 'copy-link']);
    const link = await viewer.until(async () => {
      const text = await viewer.page.evaluate(() => navigator.clipboard.readText().catch(() => ''));
      return text.startsWith(PAGE) && text;
    }, 'the link');
    await viewer.rest();
    const other = await Viewer.open(browser, { api: EITHER, hash: new URL(link).hash, query: '&afresh' });
    const here = await other.untilFacts(({ title, is_waiting: busy }) => title === there.title && !busy, 'the same scene');
    for (const fact of ['settings', 'position', 'angles', 'view', 'artefact']) {
      assert.deepEqual(here[fact], there[fact], fact);
    }
    other.quiet();
  });

  test('the page fits high-resolution screens, and follows a dark theme', async () => {
    const options = { api: EITHER, query: '&afresh', width: 400, height: 240, scale: 2, colours: 'dark' };
    const fine = await Viewer.open(browser, options);
    await fine.untilFacts(({ size }) => `${size}` === '800,480', 'two pixels per point');
    assert.ok(await fine.brightness(BAR) < 80, 'a dark page');
    fine.quiet();
  });

  test('on a phone fingers open and close the drawer, turn the camera and fly forward', async () => {
    const phone = await Viewer.open(browser, { api: EITHER, query: '&afresh', width: 390, height: 844, scale: 0.5, isTouch: true });
    const shut = await phone.page.screenshot();
    await phone.page.touchscreen.tap(...DRAWER);
    await phone.untilFacts(({ drawer }) => drawer, 'the drawer');
    const { share } = await phone.difference(shut, await phone.page.screenshot());
    assert.ok(share > 0.3, `the drawer covers ${share} of the picture`);
    assert.ok(await phone.brightness(BAR) > 160, 'a light page with a light theme');
    await phone.page.touchscreen.tap(...BESIDE);
    await phone.untilFacts(({ drawer }) => !drawer, 'the picture');
    // A smaller picture saves time.
    await phone.page.setViewportSize({ width: 400, height: 300 });
    await phone.untilFacts(({ size }) => `${size}` === '200,150', 'the new size');
    const screen = await phone.context.newCDPSession(phone.page);
    const touch = (type, points) =>
      screen.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    /// Puts fingers down, moves them at once, and lifts them after the viewer has reacted. Resting fingers would open a
    /// menu.
    const gesture = async (fingers, fact, before) => {
      // A busy browser may treat the first touches as resting fingers and report no movement, so the gesture is
      // repeated.
      for (let tries = 5; ; tries -= 1) {
        let by = 0;
        const move = () => touch('touchMove', fingers(by += 8));
        await touch('touchStart', fingers(by));
        for (let step = 0; step < 4; step += 1) {
          await move();
        }
        const isSeen = async (now) => `${now[fact]}` !== `${before[fact]}` || void await move();
        const seen = phone.untilFacts(isSeen, fact, tries > 1 ? 10_000 : PATIENCE);
        const facts = await (tries > 1 ? seen.catch(() => undefined) : seen);
        await touch('touchEnd', []);
        if (facts) {
          return facts;
        }
      }
    };
    const turned = await gesture((by) => [[150 + by, 150]], 'angles', await phone.facts());
    const there = await gesture((by) => [[190 - by, 150], [210 + by, 150]], 'position', turned);
    const way = there.position.map((side, axis) => side - turned.position[axis]);
    const [yaw, pitch] = there.angles;
    const forward = [-Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), -Math.cos(yaw) * Math.cos(pitch)];
    const along = way.reduce((sum, side, axis) => sum + side * forward[axis], 0) / Math.hypot(...way);
    assert.ok(along > 0.9, `forward: moved by ${way}, not along ${forward}`);
    phone.quiet();
  });

  testTasks();

  test('a page without memory reports it', async () => {
    const { page } = await Viewer.open(browser, { api: EITHER, query: '&afresh' });
    // Larger than the memory of a 32-bit module.
    await page.evaluate(() => window.viewer.tell('file', 'huge.glb', { length: 4e9 }));
    await page.waitForSelector('#cover.failed');
    assert.match(await page.textContent('#state'), /No memory is left/);
    assert.match(await page.textContent('#advice'), /smaller scene/);
  });

  test('a page without any API says what to do', async () => {
    const page = await browser.newPage();
    await page.goto(`${PAGE}?api=none`);
    await page.waitForSelector('#cover.failed');
    assert.match(await page.textContent('#advice'), /hardware acceleration/);
  });
});
