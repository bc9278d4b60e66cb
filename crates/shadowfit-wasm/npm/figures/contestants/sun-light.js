// Two cascades of the addon SunLight, with its usual maps and with the texels of four maps of 2048 × 2048.

import { SunLight } from 'three/addons/lights/SunLight.js';

/** Returns a contestant with two square maps. */
function sunLight(name, mapSize) {
  return {
    name,
    isTunable: true,
    create({ scene, towardLight, distance }) {
      const sun = new SunLight(0xffffff, Math.PI);
      sun.position.copy(towardLight);
      sun.castShadow = true;
      sun.shadow.mapSize.set(mapSize, mapSize);
      sun.shadow.camera.far = distance;
      scene.add(sun);
      return {
        shadows: [sun.shadow],
        dispose() {
          scene.remove(sun);
          sun.dispose();
        },
      };
    },
  };
}

export const sunLight2048 = sunLight('sun-light', 2048);
/** The largest even size of two maps within the texels of four maps of 2048 × 2048. */
export const sunLight2896 = sunLight('sun-light-2896', 2896);
