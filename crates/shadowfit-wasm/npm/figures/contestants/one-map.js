// One map around the whole scene: a DirectionalLight, fitted as tightly as a careful user would.

import { Matrix4, Vector3 } from 'three';

export const oneMap = {
  name: 'one-map',
  isTunable: true,
  create({ THREE, scene, box, towardLight }) {
    const light = new THREE.DirectionalLight(0xffffff, Math.PI);
    light.castShadow = true;
    light.shadow.mapSize.set(4096, 4096);
    const centre = box.getCenter(new Vector3());
    light.target.position.copy(centre);
    light.position.copy(centre).addScaledVector(towardLight, box.getSize(new Vector3()).length());
    scene.add(light, light.target);
    fit(light.shadow.camera, box, light);
    return {
      shadows: [light.shadow],
      dispose() {
        scene.remove(light, light.target);
        light.dispose();
      },
    };
  },
};

/** Fits a shadow camera to a box, seen along the light. */
function fit(camera, box, light) {
  const turn = new Matrix4().lookAt(light.position, light.target.position, camera.up).setPosition(light.position).invert();
  const seen = box.clone().applyMatrix4(turn);
  Object.assign(camera, {
    left: seen.min.x, right: seen.max.x, bottom: seen.min.y, top: seen.max.y, near: -seen.max.z, far: -seen.min.z,
  });
  camera.updateProjectionMatrix();
}
