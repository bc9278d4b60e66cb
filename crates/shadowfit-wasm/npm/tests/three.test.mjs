// Tests of `shadowfit/three` in headless Chromium, on software WebGL2.
//
//     node --test tests/

import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';

import { ShaderChunk } from 'three';

import { installLookUp, withLookUp } from '../src/three/lookup.js';
import { open } from './browser.mjs';

let browser;
before(async () => {
  browser = await open();
});
after(async () => browser?.close());
beforeEach(async () => {
  await browser.page.evaluate(() => window.cleanUp());
  browser.said.length = 0;
});

/** Runs a function in the page. */
const run = (body, ...values) => browser.page.evaluate(body, ...values);
const isQuiet = () => assert.deepEqual(browser.said, [], 'the console is free of warnings');

test('shadows fall where rays say', async () => {
  const cases = {
    'by coverage': {},
    // Its bias covers the ground. Steeper surfaces may shadow themselves.
    'by the stock look-up': { shadow: { lookUp: 'stock' }, dark: 0.02 },
    'one map': { shadow: { maps: 1, mapSize: 1024 } },
    'two maps': { shadow: { maps: 2 } },
    'three maps': { shadow: { maps: 3 } },
    'nearest texels': { type: 'BasicShadowMap' },
    'a soft filter': { radius: 3, margin: 6 },
    'reversed depth': { renderer: { reversedDepthBuffer: true } },
    'reversed depth, stock': { renderer: { reversedDepthBuffer: true }, shadow: { lookUp: 'stock' }, dark: 0.02 },
    'reversed depth, nearest texels': { renderer: { reversedDepthBuffer: true }, type: 'BasicShadowMap' },
    'logarithmic depth': { renderer: { logarithmicDepthBuffer: true } },
    centimetres: { scale: 100 },
    kilometres: { scale: 0.001 },
    'far from the origin': { offset: 3000 },
    'an orthographic camera': { camera: 'orthographic' },
    'a nested scene': { isNested: true },
    VSM: { type: 'VSMShadowMap', warns: /VSMShadowMap/ },
  };
  for (const [name, options] of Object.entries(cases)) {
    browser.said.length = 0;
    const { count, shadowed, light, dark } = await run((o) => window.judgeTown(o), options);
    assert.ok(count > 500 && shadowed > 0.08, `${name}: ${count} pixels, ${shadowed} of them in shadow`);
    assert.ok(light < 0.005 && dark < (options.dark ?? 0.004), `${name}: ${light} falsely lit, ${dark} falsely dark`);
    assert.match(browser.said.join('\n'), options.warns ?? /^$/, name);
  }
});

test('boxes contain what is drawn, for every kind of object', async () => {
  for (const name of await run(() => Object.keys(window.CASTERS))) {
    const seen = await run((kind) => {
      const stage = new Stage();
      const { object, move } = window.CASTERS[kind]();
      object.castShadow = true;
      stage.scene.add(object);
      const out = {};
      move(8, -6);
      const first = stage.draw();
      // A cube at a height of 5 throws its shadow 5 toward -x.
      Object.assign(out, { passes: first.passes, error: first.error, shadow: stage.at(3, -6), lit: stage.at(-3, 9) });
      move(2, 9);
      stage.draw();
      Object.assign(out, { left: stage.at(3, -6), arrived: stage.at(-3, 9) });
      return Object.assign(out, { kept: stage.draw().isKept });
    }, name);
    assert.ok(seen.passes > 0, `${name}: no maps: ${seen.error}`);
    assert.ok(seen.shadow < 60 && seen.lit > 120, `${name}: no shadow in the first frame: ${JSON.stringify(seen)}`);
    assert.ok(seen.left > 120 && seen.arrived < 60, `${name}: the shadow did not move: ${JSON.stringify(seen)}`);
    assert.ok(seen.kept, `${name}: a still frame was drawn again`);
    await run(() => window.cleanUp());
  }
  isQuiet();
});

test('frames keep the maps until something changes in them', async () => {
  // Each change is made on a still stage. It lists whether the next frame draws the maps.
  const changes = {
    nothing: false,
    'a caster moves': true,
    'a caster moves out of reach of the maps': false,
    'a receiver alone changes its colour': false,
    'a caster is added': true,
    'a caster is removed': true,
    'a caster is hidden': true,
    'a caster stops casting': true,
    'a material changes its side': true,
    'the texture of a cut-out moves': true,
    'a part changes its material': true,
    'an instance count changes': true,
    'the sun turns': true,
    'the map size changes': true,
    'the radius changes': true,
    'the user asks for an update': true,
    'the camera turns': true,
    'the renderer type changes': true,
    'the user turns updates off': false,
  };
  const seen = await run(() => {
    const stage = new Stage();
    const caster = addBox(stage.scene, [5, 4, 5], [2, 2, 2]);
    const other = addBox(stage.scene, [-5, 4, -5], [2, 2, 2]);
    const far = addBox(stage.scene, [0, -500, 0], [2, 2, 2]);
    far.receiveShadow = false;
    const copies = new THREE.InstancedMesh(new THREE.BoxGeometry(1, 1, 1), new THREE.MeshLambertMaterial(), 2);
    copies.setMatrixAt(0, new THREE.Matrix4().makeTranslation(9, 4, 9));
    copies.setMatrixAt(1, new THREE.Matrix4().makeTranslation(-9, 4, 9));
    copies.castShadow = true;
    stage.scene.add(copies);
    const map = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
    map.needsUpdate = true;
    const parts = addBox(stage.scene, [9, 4, -9], [1, 1, 1]);
    parts.material = [new THREE.MeshLambertMaterial({ map, alphaTest: 0.5 }), new THREE.MeshLambertMaterial()];
    const { shadow } = stage.sun;
    const changes = {
      nothing: () => {},
      'a caster moves': () => caster.position.setX(4),
      'a caster moves out of reach of the maps': () => far.position.setX(3),
      'a receiver alone changes its colour': () => stage.ground.material.color.set(0xffeeee),
      'a caster is added': () => addBox(stage.scene, [0, 4, 0], [1, 1, 1]),
      'a caster is removed': () => stage.scene.remove(other),
      'a caster is hidden': () => { caster.visible = false; },
      'a caster stops casting': () => { caster.visible = true; caster.castShadow = false; },
      'a material changes its side': () => { copies.material.side = THREE.DoubleSide; },
      'the texture of a cut-out moves': () => map.offset.setX(0.5),
      'a part changes its material': () => { parts.geometry.groups[0].materialIndex = 1; },
      'an instance count changes': () => { copies.count = 1; },
      'the sun turns': () => stage.sun.position.set(1, 2, 0),
      'the map size changes': () => shadow.mapSize.set(256, 256),
      'the radius changes': () => { shadow.radius = 2; },
      'the user asks for an update': () => { shadow.needsUpdate = true; },
      'the camera turns': () => stage.camera.position.setX(30),
      'the renderer type changes': () => { stage.renderer.shadowMap.type = THREE.BasicShadowMap; },
      'the user turns updates off': () => { shadow.autoUpdate = false; caster.castShadow = true; },
    };
    const out = {};
    for (const [name, change] of Object.entries(changes)) {
      const still = [stage.draw(3), stage.draw()];
      const { calls } = still[1];
      change();
      const next = stage.draw();
      out[name] = { isStill: still[1].isKept && still[1].passes === 0, draws: next.passes > 0, calls: [calls, next.calls] };
    }
    // The user draws the maps when they want to, and a shader may move a caster in any frame.
    shadow.needsUpdate = true;
    out.asked = [stage.draw().passes > 0, shadow.needsUpdate, stage.draw().passes > 0];
    shadow.autoUpdate = true;
    copies.onBeforeShadow = () => {};
    out.moving = [stage.draw(3).passes > 0, stage.draw().passes > 0];
    return out;
  });
  const { asked, moving } = seen;
  assert.deepEqual(asked, [true, false, false], 'needsUpdate draws once');
  assert.deepEqual(moving, [true, true], 'a caster with a handler of its own is drawn in each frame');
  for (const [name, draws] of Object.entries(changes)) {
    assert.ok(seen[name].isStill, `before "${name}": a still frame was drawn again`);
    assert.equal(seen[name].draws, draws, `${name}: ${JSON.stringify(seen[name])}`);
    assert.equal(seen[name].calls[1] > seen[name].calls[0], draws, `${name}: draw calls ${seen[name].calls}`);
  }
  isQuiet();
});

test('a moving camera keeps maps that stay, and the pictures are those of new maps', async () => {
  const { kept, wrong, count } = await run(() => {
    const [width, height] = [200, 120];
    const scene = new THREE.Scene();
    addTown(scene);
    const sun = makeSun(30, 160, new ShadowfitShadow({ mapSize: 256 }));
    scene.add(sun);
    const renderer = makeRenderer(width, height);
    const camera = new THREE.PerspectiveCamera(60, width / height, 0.1, 200);
    let [kept, wrong, count] = [0, 0, 0];
    for (let frame = 0; frame < 12; frame += 1) {
      camera.position.set(10 + frame * 0.01, 7, 18);
      camera.lookAt(-3 + frame * 0.02, 0, 0);
      renderer.render(scene, camera);
      const { isKept } = sun.shadow.report();
      count += 1;
      if (isKept) {
        kept += 1;
        const { data } = pixelsOf(renderer);
        sun.shadow.needsUpdate = true;
        renderer.render(scene, camera);
        const fresh = pixelsOf(renderer).data;
        // The fits of two frames round differently.
        wrong += data.some((value, index) => Math.abs(value - fresh[index]) > 8) ? 1 : 0;
      }
    }
    return { kept, wrong, count };
  });
  assert.ok(kept >= count / 4, `${kept} of ${count} frames were kept`);
  assert.equal(wrong, 0);
  isQuiet();
});

test('other lights draw the same pixels with this module as without it', async () => {
  const picture = () => {
    const renderer = makeRenderer(160, 100);
    const scene = new THREE.Scene();
    addTown(scene);
    const camera = new THREE.PerspectiveCamera(60, 1.6, 0.1, 100);
    camera.position.set(10, 7, 18);
    camera.lookAt(-3, 0, 0);
    const lights = [makeSun(30, 160, undefined, 1), makeSun(50, 20, undefined, 0)];
    for (const Light of [THREE.DirectionalLight, THREE.SpotLight, THREE.PointLight]) {
      lights.push(new Light(0xffffff, Light === THREE.DirectionalLight ? 0.5 : 90));
      lights.at(-1).position.set(4, 8, 6);
      lights.at(-1).castShadow = true;
    }
    // The second sun is dark. With this module, it has our shadow.
    if (window.ShadowfitShadow) {
      lights[1].shadow = new ShadowfitShadow({ mapSize: 256 });
    }
    scene.add(...lights);
    renderer.render(scene, camera);
    renderer.render(scene, camera);
    return [...pixelsOf(renderer).data];
  };
  const ours = await run(picture);
  const plain = await open({ path: 'tests/page.html?plain' });
  try {
    const theirs = await plain.page.evaluate(picture);
    assert.ok(new Set(theirs).size > 30, 'the picture shows something');
    assert.deepEqual(ours, theirs);
  } finally {
    await plain.close();
  }
  isQuiet();
});

test('the light of two suns is the sum of the light of each', async () => {
  const worst = await run(() => {
    const renderer = makeRenderer(160, 100);
    renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    const scene = new THREE.Scene();
    addTown(scene);
    const camera = new THREE.PerspectiveCamera(60, 1.6, 0.1, 200);
    camera.position.set(10, 7, 18);
    camera.lookAt(-3, 0, 0);
    const places = [[20, 160, {}], [40, 60, { maps: 2 }], [55, 250, { lookUp: 'stock' }]];
    const suns = places.map(([elevation, azimuth, options]) =>
      makeSun(elevation, azimuth, new ShadowfitShadow({ mapSize: 512, ...options }), 0.9));
    scene.add(...suns);
    const draw = (...on) => {
      suns.forEach((sun) => { sun.visible = on.includes(sun); });
      renderer.render(scene, camera);
      renderer.render(scene, camera);
      return pixelsOf(renderer).data;
    };
    const alone = suns.map((sun) => draw(sun));
    const all = draw(...suns);
    let worst = 0;
    all.forEach((value, index) => {
      const sum = alone[0][index] + alone[1][index] + alone[2][index];
      worst = index % 4 < 3 ? Math.max(worst, Math.abs(value - Math.min(sum, 255))) : worst;
    });
    return worst;
  });
  assert.ok(worst <= 3, `a channel differs by ${worst}`);
  isQuiet();
});

test('bad input is drawn without shadows of the sun, with one warning that names the object', async () => {
  // The warning of each input, or undefined if a frame without shadows is right.
  const inputs = {
    'a sun at the origin': /SunLight "noon".*no direction/,
    'a sun that is not finite': /SunLight "noon".*no direction/,
    'no maps': /SunLight "noon".*number of maps is 0/,
    'five maps': /SunLight "noon".*number of maps is 5/,
    'a map size that is not a number': /SunLight "noon".*mapSize is NaN/,
    'a map size of 0': /SunLight "noon".*mapSize is 0/,
    'a negative distance': /SunLight "noon".*distance is -1/,
    'a radius that is not a number': /SunLight "noon".*radius is NaN/,
    'an unknown look-up': /SunLight "noon".*lookUp is "magic"/,
    'a camera that is not finite': /SunLight "noon".*the matrix of the camera is not finite/,
    'a far plane at infinity': /SunLight "noon".*far plane/,
    'an empty scene': undefined,
    'no receivers': undefined,
    'no casters': undefined,
    'a directional light': /DirectionalLight "noon".*only a SunLight/,
  };
  for (const [name, warning] of Object.entries(inputs)) {
    browser.said.length = 0;
    const seen = await run((kind) => {
      const options = {
        'no maps': { maps: 0 }, 'five maps': { maps: 5 }, 'a map size that is not a number': { mapSize: NaN },
        'a map size of 0': { mapSize: 0 }, 'a negative distance': { distance: -1 },
        'an unknown look-up': { lookUp: 'magic' },
      };
      const stage = new Stage({ shadow: options[kind] });
      const box = addBox(stage.scene, [5, 4, 5], [2, 2, 2]);
      const { sun, scene, camera, renderer } = stage;
      sun.name = 'noon';
      const changes = {
        'a sun at the origin': () => sun.position.set(0, 0, 0),
        'a sun that is not finite': () => sun.position.setX(NaN),
        'a radius that is not a number': () => { sun.shadow.radius = NaN; },
        'a camera that is not finite': () => camera.position.setX(NaN),
        'a far plane at infinity': () => { camera.far = Infinity; camera.updateProjectionMatrix(); },
        'an empty scene': () => scene.clear().add(sun),
        'no receivers': () => { stage.ground.receiveShadow = false; box.receiveShadow = false; },
        'no casters': () => { stage.ground.castShadow = false; box.castShadow = false; },
        'a directional light': () => {
          const light = new THREE.DirectionalLight(0xffffff, 3);
          Object.assign(light, { name: 'noon', castShadow: true, shadow: sun.shadow });
          light.position.copy(sun.position);
          scene.remove(sun);
          scene.add(light);
        },
      };
      changes[kind]?.();
      const { passes } = stage.draw(3);
      return { passes, ground: stage.at(1, 5), code: renderer.getContext().getError() };
    }, name);
    // three.js draws nothing without a finite projection.
    const isLit = !/^a sun|^a camera|^a far|empty/.test(name);
    assert.deepEqual([seen.passes, seen.code], [0, 0], `${name}: maps drawn, and error of WebGL`);
    assert.equal(seen.ground > 120, isLit, `${name}: the ground's brightness is ${seen.ground}`);
    assert.equal(browser.said.length, warning ? 1 : 0, `${name}: ${browser.said.join('; ')}`);
    assert.match(browser.said.join(), warning ?? /^$/, name);
    await run(() => window.cleanUp());
  }
});

test('an object that is not finite is left out, and others keep their shadows', async () => {
  const seen = await run(() => {
    const stage = new Stage();
    addBox(stage.scene, [5, 4, 5], [2, 2, 2]);
    const broken = addBox(stage.scene, [-5, 4, -5], [2, 2, 2]);
    broken.name = 'wreck';
    broken.position.setX(NaN);
    stage.draw(3);
    return { shadow: stage.at(1, 5), ...stage.draw() };
  });
  assert.ok(seen.shadow < 60 && seen.isKept, JSON.stringify(seen));
  assert.deepEqual(browser.said.map((text) => /Mesh "wreck".*not finite/.test(text)), [true], browser.said.join('; '));
});

test('the scene keeps its own handlers, and dispose removes ours', async () => {
  const seen = await run(() => {
    const calls = [];
    const early = () => calls.push('early');
    const stage = new Stage();
    const { scene, sun } = stage;
    scene.onBeforeRender = early;
    addBox(scene, [5, 4, 5], [2, 2, 2]);
    stage.draw(2);
    // A later handler replaces ours, and the one after it calls the replaced one.
    scene.onBeforeRender = () => calls.push('late');
    const lost = [stage.draw().isKept, stage.draw().isKept];
    const inner = scene.onBeforeRender;
    scene.onBeforeRender = (...values) => { inner.apply(scene, values); calls.push('outer'); };
    const wrapped = [stage.draw().isKept, stage.draw().isKept];
    scene.onBeforeRender = inner;
    scene.onAfterRender = () => calls.push('after');
    stage.draw(2);
    const after = stage.draw().isKept;
    const { map } = sun.shadow;
    let freed = 0;
    map.addEventListener('dispose', () => { freed += 1; });
    sun.dispose();
    const handlers = [scene.onBeforeRender, scene.onAfterRender].map((handler) => handler.toString());
    calls.push('end');
    // It works again if it is drawn after all.
    const again = [stage.draw(3).isKept, stage.at(1, 5) < 60];
    scene.remove(sun);
    stage.draw(2);
    const removed = [scene.onBeforeRender, scene.onAfterRender].map((handler) => handler.toString());
    // Another sun takes over.
    stage.sun = makeSun(45, 90, new ShadowfitShadow({ mapSize: 256 }));
    scene.add(stage.sun);
    stage.draw(2);
    const next = [stage.draw().isKept, stage.at(1, 5) < 60];
    return { calls: calls.slice(0, calls.indexOf('end')), lost, wrapped, after, handlers, freed, again, removed, next };
  });
  const last = ['late', 'after'];
  const calls = ['early', 'early', 'late', 'late', 'late', 'outer', 'late', 'outer', ...last, ...last, ...last];
  assert.deepEqual(seen.calls, calls);
  // A frame without the hook draws the maps.
  assert.deepEqual(seen.lost, [false, true], 'a replaced hook returns');
  assert.deepEqual(seen.wrapped, [true, true], 'a wrapped hook runs');
  assert.equal(seen.after, true, 'a hook after the frame returns');
  for (const handlers of [seen.handlers, seen.removed]) {
    assert.ok(/push\('late'\)/.test(handlers[0]) && /push\('after'\)/.test(handlers[1]), `left handlers: ${handlers}`);
  }
  assert.deepEqual([seen.freed, ...seen.again], [1, true, true]);
  assert.deepEqual(seen.next, [true, true], 'the next sun works');
  isQuiet();
});

test('copies, loading and suns that move between scenes work', async () => {
  const seen = await run(() => {
    const stage = new Stage({ shadow: { maps: 3, distance: 77 } });
    addBox(stage.scene, [5, 4, 5], [2, 2, 2]);
    Object.assign(stage.sun.shadow, { radius: 2, intensity: 0.5 });
    stage.draw(2);
    const copy = stage.sun.clone();
    const { maps, distance, radius, intensity, mapSize, lookUp } = copy.shadow;
    const settings = { maps, distance, radius, intensity, mapSize: mapSize.toArray(), lookUp };
    stage.scene.remove(stage.sun);
    const other = new THREE.Scene();
    other.add(stage.ground, copy);
    addBox(other, [-5, 4, 5], [2, 2, 2]);
    stage.scene = other;
    stage.draw(2);
    const pixels = [stage.at(1, 5), stage.at(-9, 5)];
    const loaded = new THREE.ObjectLoader().parse(JSON.parse(JSON.stringify(other.toJSON())));
    stage.scene = loaded;
    stage.draw();
    return { settings, pixels, isSame: copy.shadow === stage.sun.shadow, children: loaded.children.length };
  });
  const settings = { maps: 3, distance: 77, radius: 2, intensity: 0.5, mapSize: [512, 512], lookUp: 'coverage' };
  assert.deepEqual(seen.settings, settings);
  assert.ok(seen.pixels[0] > 200 && seen.pixels[1] < 200 && seen.pixels[1] > 60, JSON.stringify(seen.pixels));
  assert.deepEqual([seen.isSame, seen.children], [false, 3]);
  isQuiet();
});

test('a lost context draws the maps again', async () => {
  const seen = await run(async () => {
    const stage = new Stage();
    addBox(stage.scene, [5, 4, 5], [2, 2, 2]);
    stage.draw(2);
    const before = stage.at(1, 5);
    const { domElement } = stage.renderer;
    const extension = stage.renderer.getContext().getExtension('WEBGL_lose_context');
    const event = (name) => new Promise((resolve) => { domElement.addEventListener(name, resolve, { once: true }); });
    const lost = event('webglcontextlost');
    extension.loseContext();
    await lost;
    stage.draw();
    const restored = event('webglcontextrestored');
    setTimeout(() => extension.restoreContext(), 0);
    await restored;
    const { passes } = stage.draw();
    return { before, passes, after: stage.at(1, 5), isKept: stage.draw(2).isKept };
  });
  assert.ok(seen.before < 60 && seen.after < 60 && seen.passes > 0 && seen.isKept, JSON.stringify(seen));
});

test('several views of a frame get their own maps', async () => {
  const seen = await run(() => {
    const stage = new Stage();
    const { renderer, scene, sun, camera } = stage;
    addBox(scene, [5, 4, 5], [2, 2, 2]);
    addBox(scene, [5, 4, -5], [2, 2, 2]);
    // A camera for each half of the picture.
    const halves = [-5, 5].map((z) => {
      const half = new THREE.OrthographicCamera(-10, 10, 5, -5, 1, 200);
      half.position.set(0, 60, z);
      half.up.set(0, 0, -1);
      half.lookAt(0, 0, z);
      return half;
    });
    const split = () => {
      renderer.autoClear = false;
      renderer.clear();
      halves.forEach((half, index) => {
        renderer.setViewport(0, index === 0 ? 100 : 0, 200, 100);
        renderer.setScissor(0, index === 0 ? 100 : 0, 200, 100);
        renderer.setScissorTest(true);
        renderer.render(scene, half);
      });
      renderer.setScissorTest(false);
      renderer.setViewport(0, 0, 200, 200);
      return pixelsOf(renderer);
    };
    split();
    const { data } = split();
    const pixel = (x, row) => data[4 * (row * 200 + Math.floor((x / 10 + 1) * 100))];
    const splits = [pixel(1, 150), pixel(1, 50), pixel(-7, 150)];
    // One camera with two views, as a headset has.
    renderer.autoClear = true;
    const array = new THREE.ArrayCamera(halves);
    array.copy(camera);
    array.cameras = halves;
    halves.forEach((half, index) => {
      half.viewport = new THREE.Vector4(0, index === 0 ? 100 : 0, 200, 100);
      half.updateMatrixWorld();
    });
    renderer.render(scene, array);
    renderer.render(scene, array);
    const both = pixelsOf(renderer).data;
    const other = (x, row) => both[4 * (row * 200 + Math.floor((x / 10 + 1) * 100))];
    return { splits, array: [other(1, 150), other(1, 50), other(-7, 150)], isKept: sun.shadow.report().isKept };
  });
  for (const pixels of [seen.splits, seen.array]) {
    assert.ok(pixels[0] < 60 && pixels[1] < 60 && pixels[2] > 120, JSON.stringify(seen));
  }
  assert.ok(seen.isKept, 'still views of one camera keep their maps');
  isQuiet();
});

test('distance, intensity, layers and visibility act as in three.js', async () => {
  const seen = await run(() => {
    const look = (change, shadow = {}) => {
      const stage = new Stage({ shadow });
      const box = addBox(stage.scene, [5, 4, 5], [2, 2, 2]);
      change(stage, box);
      stage.draw(2);
      const brightness = stage.at(1, 5);
      cleanUp();
      return brightness;
    };
    return {
      plain: look(() => {}),
      // The ground is 60 below the camera.
      near: look(({ sun }) => { sun.shadow.distance = 55; }),
      far: look(({ sun }) => { sun.shadow.distance = 70; }),
      nearStock: look(({ sun }) => { sun.shadow.distance = 55; }, { lookUp: 'stock' }),
      farStock: look(({ sun }) => { sun.shadow.distance = 70; }, { lookUp: 'stock' }),
      endless: look(() => {}, { lookUp: 'stock' }),
      half: look(({ sun }) => { sun.shadow.intensity = 0.5; }),
      hidden: look((_, box) => { box.visible = false; }),
      otherLayer: look((_, box) => { box.layers.set(1); }),
      // Before r187, three.js draws no such caster.
      castLayer: Number(THREE.REVISION) < 187 ? 0 : look(({ sun }, box) => {
        box.layers.set(1);
        sun.shadow.camera.layers.enable(1);
      }),
      parent: look(({ scene }, box) => {
        const group = new THREE.Group();
        group.visible = false;
        scene.add(group.add(box));
      }),
      wall: look(({ ground }) => { ground.receiveShadow = false; }),
    };
  });
  const lit = Object.entries(seen).filter(([, brightness]) => brightness > 200).map(([name]) => name);
  assert.deepEqual(lit, ['near', 'nearStock', 'hidden', 'otherLayer', 'parent', 'wall'], JSON.stringify(seen));
  const dark = [seen.plain, seen.far, seen.farStock, seen.endless, seen.castLayer];
  assert.ok(seen.half > 100 && seen.half < 200 && Math.max(...dark) < 60, JSON.stringify(seen));
  isQuiet();
});

test('the report and the helper describe the maps', async () => {
  const { report, lines, corners } = await run(() => {
    const renderer = makeRenderer(160, 100);
    const scene = new THREE.Scene();
    addTown(scene);
    const camera = new THREE.PerspectiveCamera(60, 1.6, 0.1, 200);
    camera.position.set(10, 7, 18);
    camera.lookAt(-3, 0, 0);
    const sun = makeSun(30, 160, new ShadowfitShadow({ mapSize: 512 }));
    const helper = new ShadowfitHelper(sun);
    scene.add(sun, helper);
    renderer.render(scene, camera);
    const report = sun.shadow.report();
    renderer.render(scene, camera);
    helper.geometry.computeBoundingBox();
    const { position } = helper.geometry.attributes;
    const corners = Array.from({ length: 3 }, (_, index) => position.array[index]);
    return { report, lines: helper.geometry.drawRange.count / 2, corners };
  });
  assert.deepEqual([report.lookUp, report.isKept, report.passes, report.error], ['coverage', false, 4, undefined]);
  assert.equal(lines, 12 * report.maps.length);
  assert.ok(corners.every(Number.isFinite) && corners.some((corner) => corner !== 0));
  const texels = report.maps.map(({ texelSize }) => Math.max(...texelSize));
  assert.deepEqual(texels, [...texels].sort((a, b) => a - b), 'from fine to coarse');
  const use = report.maps.reduce((sum, map) => sum + map.use, 0);
  assert.ok(use > 0.95 && use <= 1.0001, `the maps cover ${use} of the view`);
  for (const { pixelsPerTexel, casters, use: share } of report.maps) {
    assert.ok(share === 0 || (pixelsPerTexel > 0.02 && pixelsPerTexel < 4), `${pixelsPerTexel} pixels per texel`);
    assert.ok(casters > 0);
  }
  isQuiet();
});

test('the depth buffer of earlier frames makes texels finer, and leaves the renderer as it was', async () => {
  const cases = {
    'a canvas': {},
    'a canvas with four samples': { renderer: { antialias: true } },
    'reversed depth': { renderer: { reversedDepthBuffer: true } },
    'a render target': { target: { samples: 0 } },
    'a render target with four samples': { target: { samples: 4 } },
  };
  for (const [name, options] of Object.entries(cases)) {
    const seen = await run(async ({ renderer: parameters, target: samples }) => {
      const [width, height] = [160, 100];
      const renderer = makeRenderer(width, height, parameters);
      const target = samples ? new THREE.WebGLRenderTarget(width, height, samples) : null;
      if (target) {
        target.depthTexture = new THREE.DepthTexture(width, height);
      }
      renderer.setRenderTarget(target);
      const scene = new THREE.Scene();
      addTown(scene);
      // A wall hides the town from the camera.
      addBox(scene, [10, 5, 12], [40, 20, 0.5]);
      const camera = new THREE.PerspectiveCamera(60, 1.6, 0.1, 200);
      camera.position.set(10, 2, 18);
      camera.lookAt(10, 1, 12);
      const pixels = {};
      let settled;
      for (const demand of ['boxes', 'auto']) {
        const sun = makeSun(40, 30, new ShadowfitShadow({ mapSize: 128, demand }));
        scene.add(sun);
        // The depths arrive some frames later, and the maps are then drawn again.
        for (let frame = 0; frame < 300; frame += 1) {
          renderer.render(scene, camera);
          if (frame > 2 && (demand === 'boxes' || !sun.shadow.report().isKept)) {
            break;
          }
          await new Promise((resolve) => { setTimeout(resolve, 4); });
        }
        renderer.render(scene, camera);
        const { maps, isKept } = sun.shadow.report();
        pixels[demand] = maps.reduce((sum, { use, pixelsPerTexel }) => sum + use * (pixelsPerTexel ?? 0), 0);
        settled = isKept;
        scene.remove(sun);
      }
      const calls = renderer.info.render.calls;
      const isSame = renderer.getRenderTarget() === target;
      return { pixels, settled, calls, isSame, code: renderer.getContext().getError() };
    }, options);
    assert.ok(seen.pixels.auto < 0.95 * seen.pixels.boxes, `${name}: pixels per texel ${JSON.stringify(seen.pixels)}`);
    assert.deepEqual([seen.settled, seen.isSame, seen.code], [true, true, 0], name);
    assert.ok(seen.calls <= 27, `${name}: ${seen.calls} draw calls in a still frame`);
    await run(() => window.cleanUp());
  }
  isQuiet();
});

test('the look-up is added once, and only to the expected chunk', () => {
  const chunk = ShaderChunk.shadowmap_pars_fragment;
  const changed = withLookUp(chunk);
  assert.ok(changed.length > chunk.length);
  // White space does not matter, and neither do other lights.
  assert.ok(withLookUp(chunk.replaceAll('\t', '  ').replace('shadow *= 0.2;', 'shadow *= 0.3;')));
  const others = {
    'three cascades': (text) => text.replace('SUN_LIGHT_CASCADES 2', 'SUN_LIGHT_CASCADES 3'),
    'another function': (text) => text.replace('getSunShadow(', 'getSunlight('),
    'a second function': (text) => text + text,
    'another position': (text) => text.replaceAll('vSunShadowWorldPosition', 'vPosition'),
    nothing: () => '',
  };
  for (const [name, change] of Object.entries(others)) {
    assert.equal(withLookUp(change(chunk)), undefined, name);
  }
  assert.deepEqual([installLookUp(), installLookUp()], [true, true]);
  assert.equal(ShaderChunk.shadowmap_pars_fragment, changed);
});
