// Scenes and measurements of the browser's tests.

import * as THREE from 'three';
import { SunLight } from 'three/addons/lights/SunLight.js';

window.THREE = THREE;
window.SunLight = SunLight;
// `?plain` opens the page without this package.
if (location.search !== '?plain') {
  Object.assign(window, await import('shadowfit/three'));
}

const renderers = [];

/** Creates a renderer with a canvas of its own. */
window.makeRenderer = (width, height, options = {}) => {
  const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true, ...options });
  renderer.setSize(width, height);
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = options.type ?? THREE.PCFShadowMap;
  document.body.append(renderer.domElement);
  renderers.push(renderer);
  return renderer;
};

/** Adds a box. */
window.addBox = (scene, [x, y, z], [width, height, depth], colour = 0xffffff) => {
  const box = new THREE.Mesh(new THREE.BoxGeometry(width, height, depth), new THREE.MeshLambertMaterial({ color: colour }));
  box.position.set(x, y, z);
  box.castShadow = true;
  box.receiveShadow = true;
  scene.add(box);
  return box;
};

/** Creates a sun at an elevation and an azimuth, in degrees. */
window.makeSun = (elevation, azimuth, shadow, intensity = 3) => {
  const sun = new SunLight(0xffffff, intensity);
  const [e, a] = [elevation, azimuth].map(THREE.MathUtils.degToRad);
  sun.position.set(Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a));
  sun.castShadow = true;
  if (shadow) {
    sun.shadow = shadow;
  }
  return sun;
};

/** Reads the pixels of a canvas, rows from the top. */
window.pixelsOf = (renderer) => {
  const gl = renderer.getContext();
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const data = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
  return { data, width, height };
};

/** Returns the first distance at which a ray meets one of the boxes (meshes with a BoxGeometry), or infinity. */
const meets = (boxes, origin, direction, least) => {
  let nearest = Infinity;
  for (const { inverse, half } of boxes) {
    const [o, d] = [origin.clone().applyMatrix4(inverse), direction.clone().transformDirectionOf(inverse)];
    let [enter, leave] = [-Infinity, Infinity];
    for (const axis of ['x', 'y', 'z']) {
      const [a, b] = [(-half[axis] - o[axis]) / d[axis], (half[axis] - o[axis]) / d[axis]];
      enter = Math.max(enter, Math.min(a, b));
      leave = Math.min(leave, Math.max(a, b));
    }
    const at = enter > least ? enter : leave;
    if (enter <= leave && at > least && at < nearest) {
      nearest = at;
    }
  }
  return nearest;
};

THREE.Vector3.prototype.transformDirectionOf = function transformDirectionOf({ elements: m }) {
  const { x, y, z } = this;
  return this.set(m[0] * x + m[4] * y + m[8] * z, m[1] * x + m[5] * y + m[9] * z, m[2] * x + m[6] * y + m[10] * z);
};

/**
 * Compares a picture with rays. The scene's meshes must be boxes. Returns two shares of the
 * pixels that face the sun: `light` are lit although rays say shadow, and `dark` are dark although rays say light. A pixel
 * counts only if the four rays at the corners of its neighbourhood agree with its own.
 */
window.compareWithRays = (scene, camera, sun, { data, width, height }, lit, margin = 2) => {
  scene.updateMatrixWorld();
  const boxes = [];
  scene.traverse((object) => {
    if (object.geometry?.type === 'BoxGeometry') {
      const { width: x, height: y, depth: z } = object.geometry.parameters;
      const half = new THREE.Vector3(x / 2, y / 2, z / 2);
      boxes.push({ inverse: object.matrixWorld.clone().invert(), half });
    }
  });
  const toSun = new THREE.Vector3().setFromMatrixPosition(sun.matrixWorld).normalize();
  /** 1 lit, 0 in shadow, undefined for no surface or one that faces away. */
  const factorAt = (x, y) => {
    const from = new THREE.Vector3(2 * x / width - 1, 1 - 2 * y / height, camera.reversedDepth ? 1 : -1).unproject(camera);
    const to = new THREE.Vector3(2 * x / width - 1, 1 - 2 * y / height, 0.5).unproject(camera);
    const ray = to.sub(from).normalize();
    const at = meets(boxes, from, ray, 0);
    if (at === Infinity) {
      return undefined;
    }
    const point = from.addScaledVector(ray, at);
    return meets(boxes, point.addScaledVector(toSun, at * 1e-6), toSun, 0) === Infinity ? 1 : 0;
  };
  const corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]];
  let [count, light, dark, shadowed] = [0, 0, 0, 0];
  for (let y = 4; y < height - 4; y += 3) {
    for (let x = 4; x < width - 4; x += 3) {
      const truth = factorAt(x + 0.5, y + 0.5);
      const agrees = ([dx, dy]) => factorAt(x + 0.5 + dx * margin, y + 0.5 + dy * margin) === truth;
      if (truth === undefined || !corners.every(agrees)) {
        continue;
      }
      const index = 4 * ((height - 1 - y) * width + x);
      const full = lit.data[index];
      // The unshadowed picture tells which surfaces the sun reaches.
      if (full < 12) {
        continue;
      }
      count += 1;
      shadowed += truth === 0 ? 1 : 0;
      const factor = data[index] / full;
      light += truth === 0 && factor > 0.3 ? 1 : 0;
      dark += truth === 1 && factor < 0.9 ? 1 : 0;
    }
  }
  return { count, shadowed: shadowed / count, light: light / count, dark: dark / count };
};

/** Draws a scene with and without shadows of its sun, and compares it with rays. */
window.judge = (renderer, scene, camera, sun, frames = 2, margin = 2) => {
  sun.castShadow = false;
  renderer.render(scene, camera);
  const lit = window.pixelsOf(renderer);
  sun.castShadow = true;
  for (let frame = 0; frame < frames; frame += 1) {
    renderer.render(scene, camera);
  }
  return window.compareWithRays(scene, camera, sun, window.pixelsOf(renderer), lit, margin);
};

/** Adds a ground with boxes of several sizes, most of them rotated. */
window.addTown = (scene, scale = 1) => {
  const add = (place, size) => window.addBox(scene, place.map((v) => v * scale), size.map((v) => v * scale));
  add([0, -0.5, 0], [120, 1, 120]);
  for (let index = 0; index < 24; index += 1) {
    const height = 2 + (index * 7) % 6;
    const box = add([(index * 37) % 48 - 24, height / 2, -((index * 53) % 60) + 8], [1 + index % 3, height, 1 + index % 2]);
    box.rotation.y = index;
  }
  add([-2, 3, 2], [3, 0.2, 3]);
  // By default, three.js draws only back faces into maps, which hides a wrong bias.
  scene.traverse(({ material }) => {
    if (material) {
      material.shadowSide = THREE.DoubleSide;
    }
  });
};

/** Draws the town with options, and compares it with rays. */
window.judgeTown = ({ type = 'PCFShadowMap', renderer: options, shadow = {}, scale = 1, offset = 0, ...rest }) => {
  const [width, height] = [240, 150];
  const renderer = window.makeRenderer(width, height, { type: THREE[type], ...options });
  const scene = new THREE.Scene();
  const town = new THREE.Group();
  scene.add(town);
  window.addTown(town, scale);
  town.position.set(offset, 0, offset);
  const camera = rest.camera === 'orthographic'
    ? new THREE.OrthographicCamera(-16, 16, 10, -10, 0.1, 200)
    : new THREE.PerspectiveCamera(60, width / height, 0.1 * scale, 400 * scale);
  camera.position.set(10, 7, 18).multiplyScalar(scale).add(town.position);
  camera.lookAt(-3 * scale + offset, 0, offset);
  const sun = window.makeSun(14, 160, new ShadowfitShadow({ mapSize: 1024, ...shadow }));
  sun.shadow.radius = rest.radius ?? 1;
  if (rest.isNested) {
    const parent = new THREE.Group();
    parent.add(sun, camera);
    scene.add(parent);
  } else {
    scene.add(sun);
  }
  return window.judge(renderer, scene, camera, sun, 2, rest.margin);
};

/** Position of the stage's camera above the ground, and half of the ground that it shows. */
const [ABOVE, HALF] = [60, 20];

/** A ground seen from above, in a sun at 45 degrees in the direction of +x. */
class Stage {
  constructor({ renderer, type, shadow = {}, sun = {} } = {}) {
    this.renderer = window.makeRenderer(200, 200, { type: THREE[type ?? 'PCFShadowMap'], ...renderer });
    this.scene = new THREE.Scene();
    this.ground = window.addBox(this.scene, [0, -0.5, 0], [100, 1, 100]);
    this.camera = new THREE.OrthographicCamera(-HALF, HALF, HALF, -HALF, 1, 200);
    this.camera.position.set(0, ABOVE, 0);
    this.camera.up.set(0, 0, -1);
    this.camera.lookAt(0, 0, 0);
    this.sun = window.makeSun(45, 90, shadow && new ShadowfitShadow({ mapSize: 512, ...shadow }));
    Object.assign(this.sun, sun);
    this.scene.add(this.sun);
  }

  /** Draws frames. Returns the report of the last one, with the number of objects drawn into maps. */
  draw(frames = 1) {
    let casters = 0;
    for (let frame = 0; frame < frames; frame += 1) {
      this.renderer.render(this.scene, this.camera);
    }
    const report = this.sun.shadow.report?.() ?? {};
    for (const map of report.maps ?? []) {
      casters += map.casters;
    }
    return { ...report, drawn: casters, calls: this.renderer.info.render.calls };
  }

  /** Returns the brightness of the ground at a place, 0 to 255. */
  at(x, z) {
    const { data, width, height } = window.pixelsOf(this.renderer);
    const column = Math.floor((x / HALF + 1) / 2 * width);
    const row = Math.floor((1 - z / HALF) / 2 * height);
    return data[4 * (row * width + column)];
  }

  /** Returns the number of pixels that differ from other pixels by more than a tolerance. */
  differs(other, tolerance = 0) {
    const { data } = window.pixelsOf(this.renderer);
    return data.reduce((sum, value, index) => sum + (Math.abs(value - other.data[index]) > tolerance ? 1 : 0), 0);
  }
}
window.Stage = Stage;

const lambert = () => new THREE.MeshLambertMaterial();

/** Distance of the rest pose from the stage. Bounds of the rest pose lie in no map. */
const REST = 500;

/** A cube in the rest pose. */
const cube = () => new THREE.BoxGeometry(2, 2, 2).translate(REST, 0, 0);

/**
 * Kinds of casters. Each entry returns the object and a function that moves its cube, of size 2, from the rest pose to a
 * height of 5 above a place.
 */
window.CASTERS = {
  mesh() {
    const object = new THREE.Mesh(cube(), lambert());
    return { object, move: (x, z) => object.position.set(x - REST, 5, z) };
  },
  'child of a scaled group': () => {
    const object = new THREE.Group();
    const mesh = new THREE.Mesh(cube(), lambert());
    mesh.castShadow = true;
    object.add(mesh);
    object.scale.setScalar(0.5);
    mesh.scale.setScalar(2);
    return { object, move: (x, z) => mesh.position.set(2 * (x - REST), 10, 2 * z) };
  },
  'changed vertices': () => {
    const object = new THREE.Mesh(cube(), lambert());
    const rest = cube().attributes.position;
    const move = (x, z) => {
      const { position } = object.geometry.attributes;
      for (let index = 0; index < position.count; index += 1) {
        position.setXYZ(index, rest.getX(index) - REST + x, rest.getY(index) + 5, rest.getZ(index) + z);
      }
      position.needsUpdate = true;
      object.geometry.computeBoundingSphere();
    };
    return { object, move };
  },
  'instanced mesh': () => {
    const object = new THREE.InstancedMesh(cube(), lambert(), 3);
    const matrix = new THREE.Matrix4();
    const move = (x, z) => {
      for (let index = 0; index < 3; index += 1) {
        object.setMatrixAt(index, matrix.makeTranslation((index === 1 ? x : 200) - REST, 5, z));
      }
      object.instanceMatrix.needsUpdate = true;
      object.computeBoundingSphere();
    };
    return { object, move };
  },
  'batched mesh': () => {
    const object = new THREE.BatchedMesh(4, 200, 200, lambert());
    const id = object.addInstance(object.addGeometry(cube()));
    object.addInstance(0);
    const matrix = new THREE.Matrix4();
    const move = (x, z) => {
      object.setMatrixAt(id, matrix.makeTranslation(x - REST, 5, z));
      object.computeBoundingSphere();
    };
    return { object, move };
  },
  'skinned mesh': () => {
    const geometry = cube();
    const { count } = geometry.attributes.position;
    geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(new Array(4 * count).fill(0), 4));
    geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(new Array(count).fill([1, 0, 0, 0]).flat(), 4));
    const object = new THREE.SkinnedMesh(geometry, lambert());
    const bone = new THREE.Bone();
    object.add(bone);
    object.bind(new THREE.Skeleton([bone]));
    const move = (x, z) => {
      bone.position.set(x - REST, 5, z);
      object.updateMatrixWorld();
      object.computeBoundingSphere();
    };
    return { object, move };
  },
  'relative morph target': () => morph(true),
  'absolute morph target': () => morph(false),
  points() {
    const places = [];
    for (let x = -1; x <= 1; x += 0.02) {
      for (let z = -1; z <= 1; z += 0.02) {
        places.push(x + REST, 0, z);
      }
    }
    const geometry = new THREE.BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
    const object = new THREE.Points(geometry, new THREE.PointsMaterial());
    return { object, move: (x, z) => object.position.set(x - REST, 5, z) };
  },
  'displaced plane': () => {
    const geometry = new THREE.PlaneGeometry(2, 2, 8, 8).rotateX(-Math.PI / 2);
    const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
    white.needsUpdate = true;
    const rise = { displacementMap: white, displacementScale: REST + 9, displacementBias: -4 };
    const object = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({ ...rise, side: THREE.DoubleSide }));
    // three.js does not cull by displaced bounds.
    object.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(0, REST, 0), 10);
    return { object, move: (x, z) => object.position.set(x, -REST, z) };
  },
  'level of detail': () => {
    const object = new THREE.LOD();
    for (const distance of [0, 30]) {
      const mesh = new THREE.Mesh(distance > 0 ? cube() : new THREE.SphereGeometry(0.01), lambert());
      mesh.castShadow = true;
      mesh.position.setX(-REST);
      object.addLevel(mesh, distance);
    }
    return { object, move: (x, z) => object.position.set(x, 5, z) };
  },
};

/** A cube that two morph targets move, and a third one lifts out of the rest pose. */
function morph(isRelative) {
  const geometry = cube();
  const { position } = geometry.attributes;
  const target = (x, y, z) => {
    const values = Array.from({ length: position.count }, (_, index) => {
      const base = isRelative ? [0, 0, 0] : [position.getX(index), position.getY(index), position.getZ(index)];
      return [base[0] + x, base[1] + y, base[2] + z];
    });
    return new THREE.Float32BufferAttribute(values.flat(), 3);
  };
  geometry.morphAttributes.position = [target(20, 0, 0), target(0, 0, 20), target(-2 * REST, 10, 0)];
  geometry.morphTargetsRelative = isRelative;
  const object = new THREE.Mesh(geometry, lambert());
  const move = (x, z) => [x / 20, z / 20, 0.5].forEach((value, index) => { object.morphTargetInfluences[index] = value; });
  // three.js's bounds of a geometry hold a single target at a time.
  object.frustumCulled = false;
  return { object, move };
}

/** Frees the renderers of a test. */
window.cleanUp = () => {
  for (const renderer of renderers.splice(0)) {
    renderer.dispose();
    renderer.forceContextLoss();
    renderer.domElement.remove();
  }
};

window.ready = true;
