/** Shadows of suns for three.js's WebGPURenderer. */

export { ShadowfitHelper } from './webgpu/helper.js';
export { ShadowfitShadow } from './webgpu/ShadowfitShadow.js';
