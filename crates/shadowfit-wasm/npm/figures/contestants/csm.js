// Four cascades of the addon CSM.

import { CSM } from 'three/addons/csm/CSM.js';

export const csm = {
  name: 'csm',
  isTunable: true,
  create({ scene, camera, materials, towardLight, distance }) {
    const cascades = new CSM({
      camera,
      parent: scene,
      cascades: 4,
      shadowMapSize: 2048,
      maxFar: distance,
      // The defaults of 200 m and 2000 m would lose casters of large scenes under a low sun.
      lightMargin: Math.max(200, distance / 2),
      lightFar: Math.max(2000, 4 * distance),
      lightDirection: towardLight.clone().negate(),
      lightIntensity: Math.PI,
    });
    materials.forEach((material) => cascades.setupMaterial(material));
    return {
      shadows: cascades.lights.map((light) => light.shadow),
      update: () => cascades.update(),
      dispose() {
        cascades.remove();
        cascades.dispose();
        cascades.lights.forEach((light) => light.dispose());
      },
    };
  },
};
