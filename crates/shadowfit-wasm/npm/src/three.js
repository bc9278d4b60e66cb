/** Shadows of suns for three.js's WebGLRenderer. */

export { ShadowfitHelper } from './three/helper.js';
export { ShadowfitShadow } from './three/ShadowfitShadow.js';
