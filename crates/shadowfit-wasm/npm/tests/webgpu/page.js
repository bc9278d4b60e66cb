// The page of the tests: builds small scenes, renders them into a target, and returns numbers.
//
// Most scenes are a white floor that is seen from above, a caster over it, and a sun. `shades` are the floor's
// brightnesses at points, relative to a point far from the caster: 1 is lit, 0 is shadowed.

import * as THREE from 'three/webgpu';
import { pass, positionLocal, uniform } from 'three/tsl';
import { SunLight } from 'three/addons/lights/SunLight.js';
import { SunLightNode } from 'three/addons/lights/SunLightNode.js';
import { ShadowfitHelper, ShadowfitShadow } from 'shadowfit/three/webgpu';
import { DepthReader } from '../../src/webgpu/demand.js';

const said = [];
for (const level of ['warn', 'error']) {
  const write = console[level];
  console[level] = (...values) => {
    said.push(values.join(' '));
    write.apply(console, values);
  };
}
window.addEventListener('error', ({ message }) => said.push(message));
window.addEventListener('unhandledrejection', ({ reason }) => said.push(String(reason)));

/** Console messages since the last call. */
const messages = () => said.splice(0);

// Rows of 512 bytes, since r186 returns them padded to multiples of 256.
const SIZE = 128;
const VIEW = 12;
/** Direction to the sun, such that a caster at height h shades the point 0.5 h to the right of it. */
const TO_SUN = [-0.5, 1, 0];

/** Creates a renderer with shadows. */
async function createRenderer({ forceWebGL, ...options }) {
  const renderer = new THREE.WebGPURenderer({ forceWebGL, antialias: false, ...options });
  renderer.shadowMap.enabled = true;
  renderer.setSize(SIZE, SIZE, false);
  await renderer.init();
  if (!SunLight.registerNode) {
    renderer.library.addLight(SunLightNode, SunLight);
  }
  return renderer;
}
SunLight.registerNode?.(SunLightNode);

function createSun({ isDirectional = false, ...options } = {}) {
  const sun = isDirectional ? new THREE.DirectionalLight(0xffffff, 1) : new SunLight(0xffffff, 1);
  sun.name = 'the sun';
  sun.position.set(...TO_SUN);
  sun.castShadow = true;
  sun.shadow = new ShadowfitShadow({ maps: 3, mapSize: 512, ...options });
  return sun;
}

const white = () => new THREE.MeshLambertMaterial({ color: 0xffffff });

function createFloor(size = 40) {
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(size, size).rotateX(-Math.PI / 2), white());
  floor.name = 'the floor';
  floor.receiveShadow = true;
  floor.castShadow = true;
  return floor;
}

function createBox() {
  const box = new THREE.Mesh(new THREE.BoxGeometry(2, 0.2, 2), white());
  box.name = 'the box';
  box.position.set(0, 4, 0);
  box.castShadow = true;
  box.receiveShadow = true;
  return box;
}

/** Camera that sees VIEW × VIEW metres of the floor from above, from below the casters. */
function createCamera() {
  const camera = new THREE.OrthographicCamera(-VIEW / 2, VIEW / 2, VIEW / 2, -VIEW / 2, 0.1, 20);
  camera.position.set(0, 3, 0);
  camera.lookAt(0, 0, 0);
  return camera;
}

/** A renderer, a scene and its parts. */
class Stage {
  static async create(options = {}, sunOptions = {}) {
    const stage = new Stage();
    stage.renderer = await createRenderer(options);
    stage.target = new THREE.RenderTarget(SIZE, SIZE);
    stage.scene = new THREE.Scene();
    stage.camera = createCamera();
    stage.floor = createFloor();
    stage.box = createBox();
    stage.sun = createSun(sunOptions);
    stage.scene.add(stage.floor, stage.box, stage.sun);
    messages();
    return stage;
  }

  render(camera = this.camera) {
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.scene, camera);
    this.renderer.setRenderTarget(null);
    return this.sun.shadow.report();
  }

  /** Renders, and returns the picture's red values. */
  async pixels(camera = this.camera) {
    this.render(camera);
    const data = await this.renderer.readRenderTargetPixelsAsync(this.target, 0, 0, SIZE, SIZE);
    return Uint8Array.from({ length: SIZE * SIZE }, (_, index) => data[4 * index]);
  }

  /** Renders, and returns the shades at points of the floor. */
  async shades(points, camera = this.camera) {
    const pixels = await this.pixels(camera);
    const at = ([x, z]) => {
      const column = Math.round((x / VIEW + 0.5) * SIZE - 0.5);
      const row = Math.round((z / VIEW + 0.5) * SIZE - 0.5);
      return pixels[row * SIZE + column];
    };
    const lit = at([-5, 5]);
    return points.map((point) => at(point) / lit);
  }

  dispose() {
    this.renderer.dispose();
    this.target.dispose();
  }
}

/** Runs a function with a stage, and adds the console's messages to its result. */
async function on(options, sunOptions, run) {
  const stage = await Stage.create(options, sunOptions);
  const result = await run(stage);
  // Rejected promises and errors of the device arrive later.
  await new Promise((resolve) => {
    setTimeout(resolve, 20);
  });
  stage.dispose();
  return { ...result, messages: messages() };
}

/** Centre of the box's shadow, and a lit point under the box. */
const SHADOW = [2, 0];
const UNDER = [-1.5, 0];

/** Largest difference between two pictures, and the number of differing pixels. */
function difference(one, other) {
  const steps = one.map((value, index) => Math.abs(value - other[index]));
  return { most: Math.max(...steps), count: steps.filter((step) => step > 2).length };
}

/** Casters of all kinds. Each shades SHADOW as the box does. */
const CASTERS = {
  mesh: () => createBox(),
  group: () => {
    const group = new THREE.Group().add(createBox());
    group.scale.setScalar(0.5);
    group.position.set(0, 2, 0);
    group.children[0].scale.setScalar(2);
    return group;
  },
  nested: () => {
    const box = createBox();
    const inner = createBox();
    box.geometry = new THREE.BoxGeometry(0.01, 0.01, 0.01);
    inner.position.set(0, 0, 0);
    return box.add(inner);
  },
  instanced: () => {
    const { geometry, material } = createBox();
    const mesh = new THREE.InstancedMesh(geometry, material, 2);
    mesh.setMatrixAt(0, new THREE.Matrix4().makeTranslation(0, 4, 0));
    mesh.setMatrixAt(1, new THREE.Matrix4().makeTranslation(100, 4, 0));
    mesh.castShadow = true;
    return mesh;
  },
  batched: () => {
    const { geometry, material } = createBox();
    const mesh = new THREE.BatchedMesh(2, 100, 200, material);
    const id = mesh.addGeometry(geometry);
    mesh.setMatrixAt(mesh.addInstance(id), new THREE.Matrix4().makeTranslation(0, 4, 0));
    mesh.setMatrixAt(mesh.addInstance(id), new THREE.Matrix4().makeTranslation(100, 4, 0));
    mesh.castShadow = true;
    return mesh;
  },
  skinned: () => {
    const geometry = new THREE.BoxGeometry(2, 0.2, 2);
    const count = geometry.attributes.position.count;
    geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(new Uint16Array(4 * count), 4));
    const weights = Float32Array.from({ length: 4 * count }, (_, index) => (index % 4 === 0 ? 1 : 0));
    geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(weights, 4));
    const mesh = new THREE.SkinnedMesh(geometry, white());
    const bone = new THREE.Bone();
    mesh.add(bone);
    mesh.bind(new THREE.Skeleton([bone]));
    bone.position.set(0, 4, 0);
    mesh.castShadow = true;
    return mesh;
  },
  morphed: () => {
    const box = createBox();
    const { position } = box.geometry.attributes;
    const moved = position.clone();
    for (let index = 0; index < moved.count; index += 1) {
      moved.setY(index, moved.getY(index) + 4);
    }
    box.geometry.morphAttributes.position = [moved];
    box.updateMorphTargets();
    box.position.set(0, 0, 0);
    box.morphTargetInfluences[0] = 1;
    return box;
  },
  levels: () => {
    const lod = new THREE.LOD();
    const far = createBox();
    far.position.set(0, 0, 0);
    lod.addLevel(new THREE.Object3D(), 0);
    lod.addLevel(far, 0.5);
    lod.position.set(0, 4, 0);
    return lod;
  },
  bundle: () => new THREE.BundleGroup().add(createBox()),
  oneSided: () => {
    const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2, 2).rotateX(-Math.PI / 2), white());
    mesh.position.set(0, 4, 0);
    mesh.castShadow = true;
    return mesh;
  },
  alphaTested: () => {
    const box = createBox();
    const texture = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255, 255, 255, 255, 0]), 2, 1);
    texture.needsUpdate = true;
    const holed = new THREE.MeshLambertMaterial({ map: texture, alphaTest: 0.5 });
    box.geometry = new THREE.PlaneGeometry(6, 2).rotateX(-Math.PI / 2);
    box.material = holed;
    box.position.set(1.5, 4, 0);
    return box;
  },
};

/** Records the depths that a sun counts: the least and the greatest. */
function countsOf(sun) {
  const counts = [];
  const { prototype } = DepthReader;
  const watch = prototype.watch;
  prototype.watch = function spy(call, take) {
    watch.call(this, call, (depths) => {
      if (sun.shadow) {
        counts.push([Math.min(...depths), Math.max(...depths)]);
      }
      take(depths);
    });
  };
  return counts;
}

const TESTS = {
  /** Shades of the box's shadow, of a lit point, and with half the intensity. */
  async picture({ options, sun, type, radius, scale = 1 }) {
    return on(options, sun, async (stage) => {
      if (type !== undefined) {
        stage.renderer.shadowMap.type = THREE[type];
      }
      stage.sun.shadow.radius = radius ?? 1;
      if (scale !== 1) {
        stage.scene.scale.setScalar(scale);
        const { camera } = stage;
        [camera.left, camera.right, camera.top, camera.bottom] = [-6, 6, 6, -6].map((edge) => edge * scale);
        camera.position.multiplyScalar(scale);
        camera.near *= scale;
        camera.far *= scale;
        camera.updateProjectionMatrix();
      }
      const shades = await stage.shades([SHADOW, UNDER, [2, 3]]);
      stage.sun.shadow.intensity = 0.5;
      const [half] = await stage.shades([SHADOW]);
      stage.floor.receiveShadow = false;
      stage.floor.material.needsUpdate = true;
      const [none] = await stage.shades([SHADOW]);
      return { shades, half, none };
    });
  },

  async casters({ options }) {
    return on(options, {}, async (stage) => {
      const results = {};
      stage.scene.remove(stage.box);
      for (const [name, create] of Object.entries(CASTERS)) {
        const caster = create();
        stage.scene.add(caster);
        const [shadow, beside, lit] = await stage.shades([SHADOW, [4.5, 0], UNDER]);
        caster.traverse((object) => {
          object.castShadow = false;
        });
        const [none] = await stage.shades([SHADOW]);
        stage.scene.remove(caster);
        results[name] = { shadow, beside, lit, none };
      }
      return { results };
    });
  },

  /** Shades of a point, while the edge of a box along the map's axis v crosses it in steps of a quarter of a texel. */
  async edge({ options }) {
    return on(options, { maps: 1, mapSize: 256 }, async (stage) => {
      const { box, sun } = stage;
      // More steps of an 8-bit colour.
      sun.intensity = 3;
      stage.render();
      const [{ x, y, z, width }] = sun.shadow._drawn.fit.maps;
      const axes = [x, y, z].map((axis) => new THREE.Vector3(...axis));
      box.geometry = new THREE.BoxGeometry(2, 2, 0.2);
      box.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(...axes));
      const [column, row] = [0.7 * SIZE, 0.5 * SIZE].map((pixel) => ((Math.floor(pixel) + 0.5) / SIZE - 0.5) * VIEW);
      const point = new THREE.Vector3(column, 0, row);
      const profile = [];
      for (let step = -5; step <= 5; step += 0.25) {
        box.position.copy(point).addScaledVector(axes[2], 4).addScaledVector(axes[0], 1 + step * (width / 256));
        profile.push((await stage.shades([[column, row]]))[0]);
      }
      const [after] = sun.shadow._drawn.fit.maps;
      return { profile, hasStayed: after.width === width && after.position.every((value, i) => value === after.position[i]) };
    });
  },

  /** Least shade of a floor with a bump at each elevation of the sun. */
  async acne({ options }) {
    return on(options, { maps: 4, mapSize: 512 }, async (stage) => {
      const least = {};
      stage.scene.remove(stage.box);
      const slope = createFloor(6);
      slope.rotation.set(0.2, 0, 0.3);
      slope.position.set(0, 0.1, 0);
      stage.scene.add(slope);
      stage.scene.remove(stage.floor);
      const camera = new THREE.PerspectiveCamera(50, 1, 0.1, 100);
      camera.position.set(0, 4, 0.5);
      camera.lookAt(0, 0, 0);
      for (const elevation of [10, 15, 20, 30, 45, 60, 80]) {
        const angle = (elevation * Math.PI) / 180;
        stage.sun.position.set(-Math.cos(angle), Math.sin(angle), 0.1);
        slope.rotation.z = elevation < 20 ? 0.1 : 0.3;
        const shadowed = await stage.pixels(camera);
        stage.sun.shadow.intensity = 0;
        const lit = await stage.pixels(camera);
        stage.sun.shadow.intensity = 1;
        least[elevation] = Math.min(...shadowed.map((value, index) => value - lit[index] + 128)) - 128;
      }
      return { least };
    });
  },

  /** Passes of frames, while objects and the camera move. */
  async cache({ options }) {
    return on(options, { maps: 3, mapSize: 512 }, async (stage) => {
      const other = createBox();
      other.position.set(-3, 4, 3);
      stage.scene.add(other);
      const camera = new THREE.PerspectiveCamera(60, 1, 0.1, 100);
      camera.position.set(0, 3, 6);
      camera.lookAt(0, 0, 0);
      const passes = {};
      const worst = { most: 0, count: 0 };
      const frame = async (name) => {
        const picture = await stage.pixels(camera);
        const report = stage.sun.shadow.report();
        (passes[name] ??= []).push(report.passes);
        stage.sun.shadow.needsUpdate = true;
        const { most, count } = difference(picture, await stage.pixels(camera));
        worst.most = Math.max(worst.most, most);
        worst.count = Math.max(worst.count, count);
      };
      await frame('first');
      for (let i = 0; i < 3; i += 1) {
        await frame('still');
      }
      for (let i = 0; i < 8; i += 1) {
        camera.position.x += 0.01;
        await frame('slow camera');
      }
      for (let i = 0; i < 8; i += 1) {
        stage.box.position.x += 0.1;
        await frame('moving box');
      }
      await frame('box rests');
      stage.scene.remove(other);
      await frame('removed');
      stage.box.visible = false;
      await frame('hidden');
      return { passes, worst };
    });
  },

  /** Pictures without shadows, and one warning, for each broken input. */
  async broken({ options }) {
    const results = {};
    const breaks = {
      'no maps': ({ sun }) => { sun.shadow.maps = 0; },
      'too many maps': ({ sun }) => { sun.shadow.maps = 9; },
      'huge maps': ({ sun }) => { sun.shadow.mapSize.set(1e6, 1e6); },
      'no size': ({ sun }) => { sun.shadow.mapSize.set(0, 0); },
      'no distance': ({ sun }) => { sun.shadow.distance = NaN; },
      'bad radius': ({ sun }) => { sun.shadow.radius = NaN; },
      'no direction': ({ sun }) => { sun.position.set(0, 0, 0); },
      'NaN sun': ({ sun }) => { sun.position.set(NaN, 1, 0); },
      'NaN box': ({ box }) => { box.position.set(NaN, 1, 0); },
      'infinite camera': ({ camera }) => { camera.position.set(0, Infinity, 0); },
      empty: ({ scene, box, floor }) => { scene.remove(box, floor); },
      'no casters': ({ box, floor }) => { box.castShadow = false; floor.castShadow = false; },
    };
    for (const [name, damage] of Object.entries(breaks)) {
      results[name] = await on(options, {}, async (stage) => {
        damage(stage);
        let thrown;
        let shadow;
        try {
          stage.render();
          stage.render();
          [shadow] = await stage.shades([SHADOW]);
        } catch (error) {
          thrown = error.stack;
        }
        return { shadow, thrown };
      });
    }
    results.recovered = await on(options, {}, async (stage) => {
      stage.sun.shadow.maps = 0;
      const [without] = await stage.shades([SHADOW]);
      stage.sun.shadow.maps = 2;
      stage.render();
      await null;
      const [shadow] = await stage.shades([SHADOW]);
      return { without, shadow };
    });
    return results;
  },

  /** Two cameras in turn, and changed settings. */
  async cameras({ options }) {
    return on(options, {}, async (stage) => {
      const second = createCamera();
      second.position.x = 1;
      second.updateMatrixWorld();
      const moved = [SHADOW[0] - 1, 0];
      const shadows = [];
      const passes = [];
      for (let i = 0; i < 8; i += 1) {
        shadows.push((await stage.shades([SHADOW]))[0]);
        passes.push(stage.sun.shadow.report().passes);
        shadows.push((await stage.shades([moved], second))[0]);
        passes.push(stage.sun.shadow.report().passes);
      }
      const changed = {};
      for (const [name, change] of Object.entries({
        'one map': (shadow) => { shadow.maps = 1; },
        'two maps': (shadow) => { shadow.maps = 2; },
        maps: (shadow) => { shadow.maps = 4; },
        mapSize: (shadow) => { shadow.mapSize.set(128, 256); },
        radius: (shadow) => { shadow.radius = 3; },
      })) {
        change(stage.sun.shadow);
        stage.render();
        await null;
        stage.render();
        [changed[name]] = await stage.shades([SHADOW]);
      }
      return { shadows, passes, changed, maps: stage.sun.shadow.report().maps.length };
    });
  },

  /** Two suns, one of them replaced, cloned and disposed of. */
  async suns({ options }) {
    return on(options, {}, async (stage) => {
      const { scene, sun, renderer } = stage;
      stage.render();
      const before = renderer.info.memory.textures;
      const moon = sun.clone();
      moon.position.set(0.5, 1, 0);
      scene.add(moon);
      const both = await stage.shades([SHADOW, [-2, 0], [0, 3]]);
      const isCopy = moon.shadow !== sun.shadow && moon.shadow.maps === sun.shadow.maps;
      const helper = new ShadowfitHelper(sun);
      scene.add(helper);
      stage.render();
      scene.remove(helper);
      helper.dispose();
      moon.removeFromParent();
      moon.dispose();
      const one = await stage.shades([SHADOW, [-2, 0]]);
      const after = renderer.info.memory.textures;
      sun.shadow = new ShadowfitShadow({ maps: 2, mapSize: 256 });
      stage.render();
      await null;
      stage.render();
      const replaced = await stage.shades([SHADOW, [-2, 0]]);
      const json = JSON.stringify(scene.toJSON()).includes('"the sun"');
      sun.castShadow = false;
      const [off] = await stage.shades([SHADOW]);
      sun.castShadow = true;
      const [on] = await stage.shades([SHADOW]);
      return { both, one, replaced, leaked: after - before, isCopy, json, off, on };
    });
  },

  /** Other ways to render. Each returns the shades of the shadow and of a lit point, and the surfaces that were counted. */
  async ways({ options }) {
    const results = {};
    const ways = {
      'a pass with tone mapping': async (stage, pixels) => {
        const { renderer, scene, camera } = stage;
        renderer.toneMapping = THREE.ACESFilmicToneMapping;
        const pipeline = new THREE.RenderPipeline(renderer, pass(scene, camera));
        return pixels(() => pipeline.render());
      },
      'multisampling on the canvas': async (stage, pixels) => pixels(() => stage.renderer.render(stage.scene, stage.camera)),
      'two views of one camera': async (stage, pixels) => {
        const views = [0, 1].map((index) => {
          const view = createCamera();
          view.viewport = new THREE.Vector4(index * SIZE / 2, 0, SIZE / 2, SIZE);
          view.updateMatrixWorld();
          return view;
        });
        const camera = new THREE.ArrayCamera(views);
        camera.layers.enableAll();
        return pixels(() => stage.renderer.render(stage.scene, camera));
      },
      'compiled shaders': async (stage, pixels) => {
        await stage.renderer.compileAsync(stage.scene, stage.camera);
        return pixels(() => stage.renderer.render(stage.scene, stage.camera));
      },
      'a bundle, after a change of size': async (stage, pixels) => {
        const bundle = new THREE.BundleGroup();
        bundle.add(stage.floor);
        stage.scene.add(bundle);
        stage.render();
        stage.sun.shadow.mapSize.set(256, 256);
        stage.render();
        await null;
        return pixels(() => stage.renderer.render(stage.scene, stage.camera));
      },
      'a node that moves vertices': async (stage, pixels) => {
        const shift = uniform(new THREE.Vector3(0, 0, 3));
        stage.box.material = new THREE.MeshLambertNodeMaterial();
        stage.box.material.positionNode = positionLocal.add(shift);
        stage.box.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 5);
        stage.render();
        shift.value.z = 0;
        return pixels(() => stage.renderer.render(stage.scene, stage.camera));
      },
    };
    for (const [name, way] of Object.entries(ways)) {
      results[name] = await on({ ...options, antialias: true }, {}, async (stage) => {
        const { renderer } = stage;
        const canvas = document.createElement('canvas');
        [canvas.width, canvas.height] = [SIZE, SIZE];
        const context = canvas.getContext('2d', { willReadFrequently: true });
        const counts = countsOf(stage.sun);
        const isCounting = name !== 'two views of one camera';
        const pixels = async (render) => {
          render();
          for (let wait = 0; wait < 50 && counts.length === 0 && isCounting; wait += 1) {
            await new Promise((resolve) => {
              setTimeout(resolve, 20);
            });
          }
          render();
          context.drawImage(renderer.domElement, 0, 0, SIZE, SIZE);
          const { data } = context.getImageData(0, 0, SIZE, SIZE);
          return ([x, z]) => {
            const [column, row] = [x, z].map((at) => Math.round((at / VIEW + 0.5) * SIZE - 0.5));
            return data[4 * (row * SIZE + column)];
          };
        };
        const at = await way(stage, pixels);
        return {
          shadow: at(isCounting ? SHADOW : [SHADOW[0] / 2 + 3, 0]) / at([-5, 5]),
          lit: at([-5, -5]) / at([-5, 5]),
          depths: counts.at(-1),
        };
      });
    }
    return results;
  },

  /** Layers of the camera and of the maps. */
  async layers({ options }) {
    return on(options, {}, async (stage) => {
      stage.box.layers.set(1);
      const [unseen] = await stage.shades([SHADOW]);
      stage.sun.shadow.camera.layers.enable(1);
      const [seen] = await stage.shades([SHADOW]);
      return { unseen, seen };
    });
  },
};

/** Runs a test. */
window.run = async (name, values) => {
  messages();
  return TESTS[name](values);
};
window.isReady = true;
