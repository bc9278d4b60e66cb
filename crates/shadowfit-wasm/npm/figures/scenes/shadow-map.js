// The knot between four pillars on a wide floor of three.js's example webgpu_shadowmap.

import { CylinderGeometry, FrontSide, Group, Mesh, MeshLambertMaterial, PlaneGeometry, TorusKnotGeometry } from 'three';
import { orbit } from './orbit.js';

const NAME = 'shadow-map';
const PILLARS = [[8, 8], [8, -8], [-8, 8], [-8, -8]];

export const shadowMap = {
  name: NAME,
  build() {
    const material = new MeshLambertMaterial({ color: 0x999999, side: FrontSide });
    const knot = new Mesh(new TorusKnotGeometry(25, 8, 75, 20), material);
    knot.scale.setScalar(1 / 18);
    knot.position.y = 3;
    knot.rotation.set(0.3, 0.6, 1.2);
    const pillar = new CylinderGeometry(0.75, 0.75, 7, 32);
    const pillars = PILLARS.map(([x, z]) => {
      const mesh = new Mesh(pillar.clone(), material);
      mesh.position.set(x, 3.5, z);
      return mesh;
    });
    const floor = new Mesh(new PlaneGeometry(600, 600), material);
    floor.rotation.x = -Math.PI / 2;
    const objects = [knot, ...pillars, floor];
    objects.forEach((object) => { object.castShadow = true; });
    return new Group().add(...objects);
  },
  frames: () => orbit({ name: NAME, eye: [0, 10, 20], target: [0, 2, 0], fov: 45, near: 1, far: 1000 }),
};
