// Reads the depths of the visible surfaces, at a low resolution and without waiting.
//
// The end of a render call copies its depth buffer into a small texture of floats. The numbers arrive some frames later,
// with the view that they were drawn with.

import {
  FloatType, NearestFilter, NoBlending, NodeMaterial, QuadMesh, RGBAFormat, RenderTarget, RendererUtils,
  Vector2,
} from 'three/webgpu';
import { ivec2, screenCoordinate, texture, uniform, vec4 } from 'three/tsl';

/** Size of the copy. Rows of 128 texels need no padding in any release of three.js. */
export const WIDTH = 128;
export const HEIGHT = 72;

/** Copies depth buffers of one renderer. */
export class DepthReader {
  constructor() {
    this.isBusy = false;
    this.state = {};
    this.step = uniform(new Vector2(1, 1));
    /** @type {RenderTarget | undefined} */
    this.target = undefined;
    /** @type {WeakMap<import('three').Texture, QuadMesh>} */
    this.quads = new WeakMap();
  }

  /**
   * Copies the depths of the present render call when it ends, unless an earlier copy is on its way or the call has no depth
   * texture.
   * @param {import('./ShadowfitShadowNode.js').Call} call
   * @param {(depths: Float32Array) => void} take Gets the depths, rows from the top.
   */
  watch({ renderer, scene, camera }, take) {
    if (this.isBusy || renderer.logarithmicDepthBuffer || !scene.isScene) {
      return;
    }
    this.isBusy = true;
    const { onAfterRender } = scene;
    const isOwn = Object.hasOwn(scene, 'onAfterRender');
    const handler = (...values) => {
      const [by, , with_, target] = values;
      onAfterRender.apply(scene, values);
      // Renders that are nested in this one end earlier.
      if (by !== renderer || with_ !== camera) {
        return;
      }
      if (scene.onAfterRender === handler) {
        if (isOwn) {
          scene.onAfterRender = onAfterRender;
        } else {
          delete scene.onAfterRender;
        }
      }
      this.copy(renderer, target, take);
    };
    scene.onAfterRender = handler;
  }

  /** Copies a target's depths, and reads them. */
  copy(renderer, from, take) {
    const depths = depthsOf(renderer, from);
    if (depths === undefined) {
      this.isBusy = false;
      return;
    }
    this.target ??= new RenderTarget(WIDTH, HEIGHT, {
      type: FloatType, format: RGBAFormat, minFilter: NearestFilter, magFilter: NearestFilter, depthBuffer: false,
    });
    this.step.value.set(from.width / WIDTH, from.height / HEIGHT);
    let quad = this.quads.get(depths);
    if (quad === undefined) {
      quad = new QuadMesh(this.material(depths));
      this.quads.set(depths, quad);
    }
    this.state = RendererUtils.resetRendererState(renderer, this.state);
    renderer.setRenderTarget(this.target);
    quad.render(renderer);
    RendererUtils.restoreRendererState(renderer, this.state);
    renderer.readRenderTargetPixelsAsync(this.target, 0, 0, WIDTH, HEIGHT).then((texels) => {
      take(rowsFromTop(texels, renderer.backend.isWebGLBackend === true));
    }).catch(() => {
      // A lost device. Boxes place the maps.
    }).finally(() => {
      this.isBusy = false;
    });
  }

  material(depths) {
    const material = new NodeMaterial();
    material.name = 'shadowfit depths';
    material.blending = NoBlending;
    material.fragmentNode = vec4(texture(depths).load(ivec2(screenCoordinate.mul(this.step))).r, 0, 0, 1);
    return material;
  }

  dispose() {
    this.target?.dispose();
    this.target = undefined;
  }
}

/** Returns the depth texture of a whole target, or undefined. */
function depthsOf(renderer, target) {
  if (!target?.depthBuffer || target.scissorTest) {
    return undefined;
  }
  const { x, y, z, w } = target.viewport;
  const depths = target.depthTexture ?? renderer._textures?.get(target).depthTexture;
  const isWhole = x === 0 && y === 0 && z === target.width && w === target.height;
  return isWhole && depths?.isDepthTexture && !depths.isArrayTexture && !depths.isCubeTexture ? depths : undefined;
}

/** Returns the first component of each texel, rows from the top. */
function rowsFromTop(texels, isBottomUp) {
  return Float32Array.from({ length: WIDTH * HEIGHT }, (_, index) => {
    const row = Math.floor(index / WIDTH);
    return texels[4 * ((isBottomUp ? HEIGHT - 1 - row : row) * WIDTH + (index % WIDTH))];
  });
}
