// A depth texture with a layer per map.

import {
  Compatibility, DepthTexture, FloatType, GreaterEqualCompare, LessEqualCompare, LinearFilter, NearestFilter, REVISION,
  RedFormat, RenderTarget,
} from 'three/webgpu';

/** three.js renders to depth textures without a colour texture since this release. */
const DEPTH_ONLY = 187;

/** Layers that three.js needs to take a texture for an array. */
const LEAST_LAYERS = 2;

/** A depth texture that changes its size in place, so that no shader has to be built anew. */
export class Maps {
  /** @param {string} name */
  constructor(name) {
    this.name = name;
    /** @type {RenderTarget | undefined} */
    this.target = undefined;
    this.size = { width: 0, height: 0, layers: 0 };
    /** Called when the content is lost. */
    this.onDispose = undefined;
    /** Observers of the materials that read the texture. @type {Set<{ hasNode: boolean }>} */
    this.observers = new Set();
  }

  /**
   * Returns the texture for a material.
   * @param {import('three/webgpu').NodeBuilder} builder
   */
  textureFor(builder) {
    this.create(builder.renderer);
    this.observers.add(builder.observer);
    return this.target.depthTexture;
  }

  create(renderer) {
    if (this.target !== undefined) {
      return;
    }
    const texture = new DepthTexture(1, 1, FloatType);
    texture.image.depth = LEAST_LAYERS;
    texture.isArrayTexture = true;
    texture.name = this.name;
    texture.compareFunction = renderer.reversedDepthBuffer ? GreaterEqualCompare : LessEqualCompare;
    const hasComparison = renderer.hasCompatibility(Compatibility.TEXTURE_COMPARE);
    texture.minFilter = hasComparison ? LinearFilter : NearestFilter;
    texture.magFilter = texture.minFilter;
    const count = Number.parseInt(REVISION, 10) >= DEPTH_ONLY ? 0 : 1;
    this.target = new RenderTarget(1, 1, { count, format: RedFormat, depth: LEAST_LAYERS, useArrayDepthTexture: true });
    this.target.depthTexture = texture;
    this.target.addEventListener('dispose', () => this.onDispose?.());
  }

  /**
   * Changes the size. The content is lost unless the size stays.
   * @param {import('three/webgpu').Renderer} renderer
   * @param {{ width: number, height: number, layers: number }} size
   */
  resize(renderer, { width, height, layers }) {
    this.create(renderer);
    const { size } = this;
    if (size.width === width && size.height === height && size.layers === layers) {
      return;
    }
    this.size = { width, height, layers };
    const depth = Math.max(LEAST_LAYERS, layers);
    const { depthTexture } = this.target;
    Object.assign(depthTexture.image, { width, height, depth });
    depthTexture.needsUpdate = true;
    // The size of the texture may stay although its layers get other maps.
    this.target.dispose();
    this.target.setSize(width, height, depth);
  }

  /**
   * Makes all materials that read the texture bind it anew. three.js does not look for new textures of objects that stay as
   * they are, unless their material has nodes of its own. Render bundles must be recorded again.
   * @param {import('three').Object3D} [root] Object whose descendants may be bundles.
   */
  refresh(root) {
    for (const observer of this.observers) {
      observer.hasNode = true;
    }
    this.observers.clear();
    root?.traverse((object) => {
      if (object.isBundleGroup) {
        object.needsUpdate = true;
      }
    });
  }

  /** Frees the texture's memory. The texture can be used again. */
  dispose() {
    this.target?.dispose();
    this.refresh();
  }
}
