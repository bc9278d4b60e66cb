// The thick knot over a floor of three.js's example webgpu_clipping_stencil, without clipping planes.

import { FrontSide, DoubleSide, Group, Mesh, MeshLambertMaterial, PlaneGeometry, TorusKnotGeometry } from 'three';
import { orbit } from './orbit.js';

const NAME = 'clipping-stencil';

export const clippingStencil = {
  name: NAME,
  build() {
    const knot = new Mesh(
      new TorusKnotGeometry(0.4, 0.15, 220, 60),
      new MeshLambertMaterial({ color: 0xffc107, side: FrontSide }),
    );
    knot.castShadow = true;
    const floor = new Mesh(new PlaneGeometry(9, 9), new MeshLambertMaterial({ color: 0x8a97a0, side: DoubleSide }));
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -1;
    return new Group().add(knot, floor);
  },
  frames: () => orbit({ name: NAME, eye: [2, 2, 2], target: [0, 0, 0], fov: 36, near: 1, far: 100 }),
};
