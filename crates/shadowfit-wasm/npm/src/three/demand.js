// The surfaces that are visible in recent frames, from their depth buffers. Fits place the maps by them, which makes texels
// finer than boxes alone do.
//
// A few texels of the depth buffer are copied, and arrive some frames later, so no frame waits for the GPU. If the depth
// buffer cannot be read, the boxes of the receivers place the maps.

import {
  BufferGeometry, DepthStencilFormat, DepthTexture, Float32BufferAttribute, Mesh, NearestFilter, NoBlending,
  OrthographicCamera, RedFormat, Scene, ShaderMaterial, UnsignedInt248Type, Vector4, WebGLRenderTarget,
} from 'three';

import { viewOf } from './view.js';
import { warnOnce } from './warn.js';

/** Copied texels per row and per column. The fitter needs a few hundred surfaces. */
const [WIDTH, HEIGHT] = [96, 54];

/** Least number of frames between two copies. */
const PERIOD = 8;

/** Share of the texels that must show a surface. Below it, the depth buffer is another one than the scene's. */
const LEAST_SURFACES = 1 / 64;

const VERTEX = 'void main() { gl_Position = vec4( position.xy, 0.0, 1.0 ); }';

/** Copies the bits of depths, rows from the top. */
const FRAGMENT = /* glsl */`
uniform highp sampler2D depths;
uniform vec4 view;

void main() {

	vec2 share = vec2( gl_FragCoord.x, ${HEIGHT}.0 - gl_FragCoord.y ) / vec2( ${WIDTH}.0, ${HEIGHT}.0 );
	uint bits = floatBitsToUint( texelFetch( depths, ivec2( view.xy + share * view.zw ), 0 ).r );
	gl_FragColor = vec4( uvec4( bits, bits >> 8u, bits >> 16u, bits >> 24u ) & 255u ) / 255.0;

}
`;

/** @type {WeakMap<import('three').WebGLRenderer, DepthReader>} */
const readers = new WeakMap();

/** Reads depth buffers of one renderer. */
class DepthReader {
  /** @param {import('three').WebGLRenderer} renderer */
  static of(renderer) {
    const reader = readers.get(renderer) ?? new DepthReader(renderer);
    readers.set(renderer, reader);
    return reader;
  }

  constructor(renderer) {
    this.renderer = renderer;
    this.texels = new WebGLRenderTarget(WIDTH, HEIGHT, { depthBuffer: false });
    this.material = new ShaderMaterial({
      uniforms: { depths: { value: null }, view: { value: new Vector4() } },
      vertexShader: VERTEX, fragmentShader: FRAGMENT, blending: NoBlending, depthTest: false, depthWrite: false,
    });
    const triangle = new BufferGeometry()
      .setAttribute('position', new Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
    const mesh = new Mesh(triangle, this.material);
    mesh.frustumCulled = false;
    this.scene = new Scene().add(mesh);
    this.camera = new OrthographicCamera();
    /** Copy of the canvas's depth buffer. */
    this.copy = undefined;
    /** Whether the canvas's depth buffer can be copied, once it is known. */
    this.canCopy = undefined;
    this.isBusy = false;
  }

  /**
   * Starts to read the depth buffer of the frame that was just drawn. Returns a promise of its depths, or undefined if they
   * cannot be read.
   */
  read() {
    const { renderer } = this;
    const { xr, capabilities } = renderer;
    if (this.isBusy || xr.isPresenting || capabilities.logarithmicDepthBuffer) {
      return undefined;
    }
    const target = renderer.getRenderTarget();
    const [face, level] = [renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()];
    const { info } = renderer;
    const figures = { ...info.render };
    const { autoReset } = info;
    info.autoReset = false;
    const view = renderer.getCurrentViewport(this.material.uniforms.view.value);
    try {
      const depths = target ? this.ofTarget(target) : this.ofCanvas(view);
      return depths && this.start(depths);
    } finally {
      renderer.setRenderTarget(target, face, level);
      Object.assign(info.render, figures);
      info.autoReset = autoReset;
    }
  }

  /** Returns the depth texture of a render target, if it has one that can be read. */
  ofTarget(target) {
    const isPlain = !target.isWebGLCubeRenderTarget && !target.isWebGL3DRenderTarget && !target.isWebGLArrayRenderTarget;
    const isResolved = target.samples === 0 || target.resolveDepthBuffer;
    const { depthTexture } = target;
    return isPlain && isResolved && depthTexture && depthTexture.compareFunction === null ? depthTexture : undefined;
  }

  /**
   * Copies the canvas's depth buffer, and returns the copy. A canvas with several samples per pixel allows only copies of
   * the same size.
   */
  ofCanvas(view) {
    const { renderer } = this;
    const gl = renderer.getContext();
    if (this.canCopy === false || !gl.getContextAttributes()?.depth) {
      return undefined;
    }
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const { antialias } = gl.getContextAttributes();
    const size = antialias ? [width, height] : [WIDTH, HEIGHT];
    if (this.copy === undefined) {
      // Browsers create canvases with this format, also without a stencil buffer.
      const depthTexture = new DepthTexture(...size, UnsignedInt248Type);
      depthTexture.format = DepthStencilFormat;
      depthTexture.magFilter = NearestFilter;
      depthTexture.minFilter = NearestFilter;
      this.copy = new WebGLRenderTarget(...size, { depthTexture, stencilBuffer: true, format: RedFormat });
    }
    this.copy.setSize(...size);
    renderer.setRenderTarget(this.copy);
    const isKnown = this.canCopy !== undefined;
    if (!isKnown) {
      clearErrors(gl);
    }
    const { x, y, z, w } = view;
    const from = antialias ? [0, 0, width, height] : [x, y, x + z, y + w];
    // three.js does not keep track of this binding, which each of its framebuffers replaces.
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    gl.blitFramebuffer(...from, 0, 0, ...size, gl.DEPTH_BUFFER_BIT, gl.NEAREST);
    if (!isKnown) {
      this.canCopy = gl.getError() === gl.NO_ERROR;
    }
    if (!antialias) {
      view.set(0, 0, ...size);
    }
    return this.canCopy ? this.copy.depthTexture : undefined;
  }

  /** Draws the texels, and starts to read them. */
  start(depths) {
    const { renderer, texels, material } = this;
    material.uniforms.depths.value = depths;
    renderer.setRenderTarget(texels);
    renderer.render(this.scene, this.camera);
    const bytes = new Uint8Array(4 * WIDTH * HEIGHT);
    this.isBusy = true;
    const done = () => {
      this.isBusy = false;
      material.uniforms.depths.value = null;
    };
    return renderer.readRenderTargetPixelsAsync(texels, 0, 0, WIDTH, HEIGHT, bytes)
      .then(() => new Float32Array(bytes.buffer))
      .finally(done);
  }
}

function clearErrors(gl) {
  for (let index = 0; index < 8 && gl.getError() !== gl.NO_ERROR; index += 1);
}

/** Visible surfaces of one scene's frames. */
export class Demand {
  constructor() {
    this.frames = 0;
    this.isOff = false;
  }

  /**
   * Reads the depth buffer of a frame for the suns that it was fitted for, now and then.
   * @param {import('three').WebGLRenderer} renderer
   * @param {import('three').Camera} camera
   * @param {Set<import('./ShadowfitShadow.js').ShadowfitShadow>} suns
   */
  gather(renderer, camera, suns) {
    this.frames += 1;
    if (this.isOff || this.frames < PERIOD || camera.isArrayCamera) {
      return;
    }
    const readings = [...suns].map((shadow) => shadow._readingFor(camera)).filter(Boolean);
    if (readings.length === 0) {
      return;
    }
    const view = viewOf(camera);
    let promise;
    try {
      promise = DepthReader.of(renderer).read();
    } catch (error) {
      // Better maps are not worth a broken frame.
      warnOnce('demand', `the depth buffer cannot be read, so boxes place the maps: ${error.message}`);
      this.isOff = true;
    }
    if (promise === undefined) {
      return;
    }
    this.frames = 0;
    readings.forEach((reading) => reading.begin());
    const far = view.depth === 'reversed' ? 0 : 1;
    promise.then((depths) => {
      const surfaces = depths.reduce((sum, depth) => sum + (depth === far ? 0 : 1), 0);
      if (surfaces >= LEAST_SURFACES * depths.length) {
        readings.forEach((reading) => reading.count(depths, WIDTH, view));
      }
    // A lost context has no depths.
    }).catch(() => {});
  }
}
