// The hills of three.js's example webgpu_tsl_procedural_terrain, with its size, view and amplitudes. The noise differs, and
// the grid is coarser, so that rays and software renderers can handle it.

import { FrontSide, Mesh, MeshLambertMaterial, PlaneGeometry } from 'three';
import { ImprovedNoise } from 'three/addons/math/ImprovedNoise.js';
import { orbit } from './orbit.js';

const NAME = 'procedural-terrain';
/** Side of the terrain, in metres. */
const SIZE = 10;
/** Cells of the grid per side. The example has 500. */
const CELLS = 160;
/** Waves per metre of the widest hills. */
const FREQUENCY = 0.175;
const OCTAVES = 3;
/** Height of the hills, in metres, before the noise is squared. */
const STRENGTH = 10;

export const proceduralTerrain = {
  name: NAME,
  build() {
    const geometry = new PlaneGeometry(SIZE, SIZE, CELLS, CELLS).rotateX(-Math.PI / 2);
    const { position } = geometry.attributes;
    const noise = new ImprovedNoise();
    for (let index = 0; index < position.count; index += 1) {
      position.setY(index, height(noise, position.getX(index), position.getZ(index)));
    }
    geometry.computeVertexNormals();
    const terrain = new Mesh(geometry, new MeshLambertMaterial({ color: 0x85d534, side: FrontSide }));
    terrain.castShadow = true;
    return terrain;
  },
  frames: () => orbit({ name: NAME, eye: [-10, 8, -2.2], target: [0, -0.5, 0], fov: 35, near: 0.1, far: 100 }),
};

/** Returns the height of the terrain: octaves of noise over warped coordinates, squared so that valleys become flat. */
function height(noise, x, z) {
  const warp = noise.noise(6 * FREQUENCY * x, 6 * FREQUENCY * z, 0);
  let sum = 0;
  for (let octave = 1; octave <= OCTAVES; octave += 1) {
    const scale = 2 * octave * FREQUENCY;
    sum += noise.noise(scale * (x + warp), scale * (z + warp), 9.87 * octave) / (2 * (octave + 1));
  }
  return Math.sign(sum) * sum * sum * STRENGTH;
}
