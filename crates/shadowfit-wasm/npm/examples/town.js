/** A small generated town: houses along streets, with roofs, chimneys, fences and trees. */

import * as THREE from 'three';

/** Distance between streets, and number of blocks each way, in metres. */
const BLOCK = 26;
const BLOCKS = 9;

/** Returns a scene with the town. */
export function town() {
  const scene = new THREE.Scene();
  const random = generator(7);
  const pick = (list) => list[Math.floor(random() * list.length)];
  const material = (color, options) => new THREE.MeshStandardMaterial({ color, roughness: 0.9, ...options });
  const walls = [0xe8d9c3, 0xd9b99b, 0xc9cfd6, 0xe6e1d5, 0xb7a08a].map((color) => material(color));
  const roofs = [0x8a3b2c, 0x6e3a33, 0x4c4f57, 0x9c5a3c].map((color) => material(color, { side: THREE.DoubleSide }));
  const wood = material(0x6b4a2f);
  const leaves = [0x4c7a3a, 0x5f8c3f, 0x3f6b3d].map((color) => material(color));
  const add = (geometry, surface, x, y, z, turn = 0) => {
    const mesh = new THREE.Mesh(geometry, surface);
    mesh.position.set(x, y, z);
    mesh.rotation.y = turn;
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    scene.add(mesh);
    return mesh;
  };

  const size = BLOCK * (BLOCKS + 2);
  add(new THREE.PlaneGeometry(size, size).rotateX(-Math.PI / 2), material(0x7f9166), 0, 0, 0);
  for (let i = 0; i <= BLOCKS; i += 1) {
    const at = (i - BLOCKS / 2) * BLOCK;
    for (const [width, depth, x, z] of [[5, size, at, 0], [size, 5, 0, at]]) {
      const street = add(new THREE.BoxGeometry(width, 0.06, depth), material(0x5c5f63), x, 0.03, z);
      street.castShadow = false;
    }
  }

  const posts = [];
  for (let i = 0; i < BLOCKS; i += 1) {
    for (let j = 0; j < BLOCKS; j += 1) {
      const [x, z] = [(i + 0.5 - BLOCKS / 2) * BLOCK, (j + 0.5 - BLOCKS / 2) * BLOCK];
      const [width, depth] = [8 + random() * 5, 7 + random() * 4];
      const height = pick([4, 5, 6.5, 6.5, 9, 13]);
      add(new THREE.BoxGeometry(width, height, depth), pick(walls), x, height / 2, z);
      add(roof(width + 1, depth + 1, 2 + random() * 2), pick(roofs), x, height, z);
      add(new THREE.BoxGeometry(0.8, 2.4, 0.8), wood, x + width / 4, height + 1.9, z + depth / 5);
      for (let k = 0; k < 4; k += 1) tree(x + (random() - 0.5) * 19, z + (k % 2 ? 8.6 : -8.6), 0.7 + random());
      for (let k = 0; k < 14; k += 1) posts.push([x - 9.1 + k * 1.4, z + 10], [x - 9.1 + k * 1.4, z - 10]);
    }
  }
  fence(posts);
  return scene;

  function tree(x, z, scale) {
    add(new THREE.CylinderGeometry(0.18 * scale, 0.25 * scale, 2 * scale, 7), wood, x, scale, z);
    const crown = new THREE.IcosahedronGeometry(1.5 * scale, 1);
    add(crown, pick(leaves), x, 3 * scale, z, random() * 3);
  }

  function fence(places) {
    const mesh = new THREE.InstancedMesh(new THREE.BoxGeometry(0.12, 1.1, 0.12), wood, places.length);
    const matrix = new THREE.Matrix4();
    places.forEach(([x, z], i) => mesh.setMatrixAt(i, matrix.makeTranslation(x, 0.55, z)));
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    scene.add(mesh);
  }
}

/** Returns a gable roof, open below. */
function roof(width, depth, height) {
  const [x, z] = [width / 2, depth / 2];
  const corners = [[-x, 0, z], [x, 0, z], [x, height, 0], [-x, height, 0], [-x, 0, -z], [x, 0, -z]];
  const faces = [[0, 1, 2], [0, 2, 3], [5, 4, 3], [5, 3, 2], [4, 0, 3], [1, 5, 2]];
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(faces.flat().flatMap((i) => corners[i]), 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** Returns a function for random numbers of 0 to 1 (mulberry32). */
function generator(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}
