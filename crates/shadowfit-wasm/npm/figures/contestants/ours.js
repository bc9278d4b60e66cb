// Maps that shadowfit places.

import { ShaderChunk } from 'three';
import { SunLight } from 'three/addons/lights/SunLight.js';

/** The package's class, and the shader chunks that it replaced when it was loaded. */
let loaded;

/** Returns the package's class, with its shader chunks in place. Other contestants run without them. */
async function load() {
  if (loaded === undefined) {
    const before = { ...ShaderChunk };
    const { ShadowfitShadow } = await import('../../src/three.js');
    const chunks = Object.fromEntries(Object.entries(ShaderChunk).filter(([name, text]) => text !== before[name]));
    loaded = { ShadowfitShadow, chunks };
  }
  Object.assign(ShaderChunk, loaded.chunks);
  return loaded.ShadowfitShadow;
}

/** Returns a contestant with the settings of a `ShadowfitShadow`. */
function ours(name, settings) {
  return {
    name,
    isTunable: false,
    hasMemory: true,
    async create({ scene, towardLight, distance }) {
      const ShadowfitShadow = await load();
      const sun = new SunLight(0xffffff, Math.PI);
      sun.position.copy(towardLight);
      sun.castShadow = true;
      sun.shadow = new ShadowfitShadow({ mapSize: 2048, distance, ...settings });
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

export const oursFour = ours('shadowfit-4', { maps: 4 });
/** Two maps that the stock shader reads. */
export const oursStock = ours('shadowfit-2-stock', { maps: 2, lookUp: 'stock' });
