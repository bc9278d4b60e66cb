// The knot over a floor of three.js's example webgpu_clipping, without clipping planes.

import { DoubleSide, FrontSide, Group, Mesh, MeshLambertMaterial, PlaneGeometry, TorusKnotGeometry } from 'three';
import { orbit } from './orbit.js';

const NAME = 'clipping';

export const clipping = {
  name: NAME,
  build() {
    const knot = new Mesh(
      new TorusKnotGeometry(0.4, 0.08, 95, 20),
      new MeshLambertMaterial({ color: 0x80ee10, side: DoubleSide }),
    );
    knot.position.y = 0.8;
    knot.rotation.set(0.9, 0.4, 0);
    knot.castShadow = true;
    const floor = new Mesh(new PlaneGeometry(9, 9), new MeshLambertMaterial({ color: 0xa0adaf, side: FrontSide }));
    floor.rotation.x = -Math.PI / 2;
    return new Group().add(knot, floor);
  },
  frames: () => orbit({ name: NAME, eye: [0, 1.3, 3], target: [0, 0.7, 0], fov: 36, near: 0.25, far: 16 }),
};
