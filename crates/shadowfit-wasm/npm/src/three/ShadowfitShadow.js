// The shadow of a `SunLight`, fitted by shadowfit.
//
// Steps of a frame, in the order of `WebGLRenderer.render`:
//
//   _begin, _prepare   the scene's hook: scan, fit, and decide whether the maps stay as they are
//   autoUpdate         WebGLShadowMap asks whether to draw
//   _beginPass         it sets `camera._reversedDepth`; from here on there are up to four viewports
//   updateMatrices     places the cameras and writes the uniforms
//   needsUpdate        it sets `needsUpdate = false` after the last viewport
//   getMatrix          WebGLLights takes two matrices and two vectors as uniforms
//   _end               the scene's hook

import {
  BasicShadowMap, LightShadow, Matrix4, OrthographicCamera, REVISION, RGFormat, VSMShadowMap, Vector2, Vector4,
} from 'three';

import { SunFitter as CascadesFitter } from '../cascades.js';
import { SunFitter as WindowsFitter } from '../windows.js';
import { Atlas } from './atlas.js';
import { AllFaces } from './faces.js';
import { SceneHook } from './hook.js';
import { KEEP, REDRAW, WIDEN, compare, drawnNow } from './kept.js';
import { installLookUp, packWindows } from './lookup.js';
import { reportOf } from './report.js';
import {
  BASIC, BLEND, CASCADES, FADE, NO_END, PCF, VSM, isSize, problemOf, settingsOf, withDefaults,
} from './settings.js';
import { stockBiases } from './stock.js';
import { CameraFit } from './view.js';
import { nameOf, warnOnce } from './warn.js';

const hasLookUp = installLookUp();

/** Whether three.js selects casters by the shadow camera's layers. */
const HAS_CASTER_LAYERS = Number.parseInt(REVISION, 10) >= 187;

/** Range of view depths that contains no point. */
const NOWHERE = [1, 0, 0, 0];

/**
 * The camera that WebGLShadowMap tells the depth convention to. It does so just before each pass, and at no other time.
 */
class PassCamera extends OrthographicCamera {
  get _reversedDepth() {
    return this.isReversed === true;
  }

  set _reversedDepth(isReversed) {
    this.isReversed = isReversed;
    this.onPass?.();
  }
}

/** See `src/three.d.ts` for the documentation of the public members. */
export class ShadowfitShadow extends LightShadow {
  constructor(options = {}) {
    super(new PassCamera());
    const { maps, mapSize, distance, lookUp, demand } = withDefaults(options);
    this.isShadowfitShadow = true;
    this.isSunLightShadow = true;
    this.maps = maps;
    this.lookUp = lookUp;
    this.demand = demand;
    this.distance = distance;
    this.mapSize.set(mapSize, mapSize);
    this.camera.onPass = () => this._beginPass();

    this._autoUpdate = true;
    this._needsUpdate = false;
    this._matrices = Array.from({ length: CASCADES }, () => new Matrix4());
    this._cascadeData = Array.from({ length: CASCADES }, () => new Vector4(...NOWHERE));

    /** @type {import('three').Light | undefined} */
    this._light = undefined;
    /** @type {SceneHook | undefined} */
    this._hook = undefined;
    /** @type {WeakMap<import('three').Camera, CameraFit>} */
    this._fits = new WeakMap();
    /** Type of the renderer's shadow maps: PCF, BASIC or VSM. */
    this._look = PCF;
    this._limit = Infinity;
    this._arrange();

    /** Fit of the present frame, and the camera and key that it was made for. */
    this._prepared = undefined;
    /** Whether WebGLShadowMap must not draw the maps in this frame. */
    this._isSkipped = false;
    this._isInPass = false;
    this._faces = new AllFaces();
    /** Whether the light is no sun. */
    this._isRefused = false;
    /** Result of the comparison with the drawn maps. */
    this._answer = undefined;
    /** @type {import('./kept.js').Drawn | undefined} */
    this._drawn = undefined;
    /** Figures of the latest frame. */
    this._frame = { passes: 0, isKept: false, error: undefined, camera: undefined, fit: undefined };
  }

  // State of three.js's own properties.

  get autoUpdate() {
    return this._isSkipped || this._isRefused ? false : this._autoUpdate;
  }

  set autoUpdate(value) {
    this._autoUpdate = value;
  }

  get needsUpdate() {
    return this._isSkipped ? false : this._needsUpdate;
  }

  set needsUpdate(value) {
    this._needsUpdate = value;
    this._isInPass &&= value;
    if (!value) {
      this._faces?.end();
    }
  }

  /** Size of a map, in texels. A size that no texture can have is 1, until the sun is known and a warning can name it. */
  get mapSize() {
    return this._light === undefined && !isSize(this._mapSize) ? new Vector2(1, 1) : this._mapSize;
  }

  set mapSize(value) {
    this._mapSize = value;
  }

  getFrameExtents() {
    return this._frameExtents;
  }

  getViewportCount() {
    if (this._isInPass) {
      return this._atlas.viewports.length;
    }
    // WebGLLights asks after the shadow pass. From here on, nothing is skipped, so that a lost hook is replaced.
    this._isSkipped = false;
    return CASCADES;
  }

  getViewport(index) {
    return this._atlas.viewports[index];
  }

  // Point lights have six faces, so their indices may have no map.

  getCamera(index = 0) {
    return this._atlas.cameras[index] ?? this._atlas.cameras[0];
  }

  getFrustum(index = 0) {
    return this._atlas.frustums[index] ?? this._atlas.frustums[0];
  }

  getMatrix(index = 0) {
    return this._matrices[index];
  }

  // Steps of a frame.

  /** Begins a frame. */
  _begin() {
    this._faces.end();
    this._isSkipped = false;
    this._isInPass = false;
    this._prepared = undefined;
    this._answer = undefined;
    this._frame = { ...this._frame, passes: 0, isKept: false };
  }

  /** Fits the maps, and decides whether they must be drawn. */
  _prepare(renderer, camera) {
    if (!this._isVisibleTo(camera) || (!this._autoUpdate && !this._needsUpdate)) {
      return;
    }
    const { type } = renderer.shadowMap;
    this._limit = renderer.capabilities.maxTextureSize;
    this._arrange(type === VSMShadowMap ? VSM : type === BasicShadowMap ? BASIC : PCF);
    const fit = this._fit(camera);
    if (fit.maps.length === 0) {
      this._isSkipped = true;
      this._setLit();
      return;
    }
    const answer = this._compare(renderer, fit);
    if (answer === KEEP) {
      this._isSkipped = true;
      this._frame.isKept = true;
    }
  }

  /** Begins a shadow pass. */
  _beginPass() {
    this._isInPass = true;
  }

  updateMatrices(light, camera) {
    if (camera === undefined) {
      return;
    }
    this._attach(light);
    if (!light.isSunLight) {
      this._refuse(light);
      return;
    }
    if (this._prepared?.camera !== camera || this._prepared.key !== this._settings().key) {
      this._arrangeFromMap();
      this._fit(camera);
    }
    const { fit, scan } = this._prepared;
    this._commit(fit, scan);
    if (this._look !== VSM) {
      this._faces.begin(scan);
    }
    this._prepared = undefined;
    this._answer = undefined;
  }

  /** Ends a frame. */
  _end(renderer, camera) {
    this._faces.end();
    this._isSkipped = false;
    this._isInPass = false;
    // A kept frame does not use its fit. Another frame needs another one.
    this._prepared = undefined;
    this._answer = undefined;
    if (this._frame.camera === camera) {
      this._frame.rows = renderer.getRenderTarget()?.height ?? renderer.getContext().drawingBufferHeight;
    }
    if (this._drawn && this._drawn.texture === undefined) {
      this._drawn.renderer = renderer;
      this._drawn.texture = textureOf(renderer, this.map);
    }
  }

  /** Returns a receiver of the visible surfaces of the frame, if the sun can use them. */
  _readingFor(camera) {
    const isUsed = this.demand === 'auto' && this._isCovering && this._frame.camera === camera;
    return isUsed ? this._fits.get(camera)?.reading() : undefined;
  }

  // Parts of these steps.

  /** Connects the sun with its scene. */
  _attach(light) {
    const hook = SceneHook.of(light);
    if (this._hook !== hook) {
      this._hook?.remove(this);
      this._drawn = undefined;
    }
    this._light = light;
    this._hook = hook;
    hook.add(this);
  }

  /** Returns whether the renderer draws this sun for a camera. */
  _isVisibleTo(camera) {
    for (let object = this._light; object !== null; object = object.parent) {
      if (!object.visible) {
        return false;
      }
    }
    return this._light.castShadow && this._light.layers.test(camera.layers);
  }

  /** Arranges the tiles for a type of maps. */
  _arrange(look = this._look) {
    this._look = look;
    const isCovering = this.lookUp === 'coverage' && hasLookUp && look !== VSM;
    const tiles = isCovering ? Math.min(Math.max(Math.floor(this.maps) || 1, 1), 4) : CASCADES;
    if (this._isCovering === isCovering && this._atlas.viewports.length === tiles) {
      return;
    }
    if (look === VSM && this.lookUp === 'coverage') {
      warnOnce(`vsm ${this._light?.id}`, `${nameOf(this._light)} uses the stock look-up with two maps, because the `
        + 'renderer\'s shadow maps have the type VSMShadowMap. Use PCFShadowMap for the look-up by coverage.');
    }
    this._isCovering = isCovering;
    this._atlas = new Atlas(tiles);
    this._frameExtents.set(this._atlas.columns, this._atlas.rows);
    this._drawn = undefined;
  }

  /**
   * Finds the type of the maps without a renderer, in the first frame of a sun. The tiles stay as they are, because
   * WebGLShadowMap has already asked for their number.
   */
  _arrangeFromMap() {
    const { map } = this;
    if (map?.texture.format === RGFormat) {
      this._look = VSM;
      this._isCovering = false;
    } else {
      this._look = map?.depthTexture?.compareFunction === null ? BASIC : PCF;
    }
  }

  _settings() {
    const up = this._light.up;
    return settingsOf(this, { isByDepth: !this._isCovering, look: this._look, up });
  }

  /** Fits the maps to a camera. Fits without maps have an error, or the frame has no shadows. */
  _fit(camera) {
    const settings = this._clampedSettings();
    const { scan } = this._hook;
    let fit = { maps: [], bits: [], origin: [0, 0, 0], settings: settings.key, error: undefined };
    // Objects of other libraries may throw at any of their bounds, and no frame may end by that.
    try {
      this._hook.scanned(camera, this._look === VSM);
      fit = this._fitWith(settings, scan, camera);
    } catch (error) {
      fit.error = error;
    }
    this._prepared = { camera, key: settings.key, fit, scan };
    this._frame = { ...this._frame, error: fit.error, camera, fit };
    if (fit.error) {
      // Each reason has one warning, also if its numbers change from frame to frame.
      const key = fit.error.message.replace(/[-+]?[\d.]+(e[-+]?\d+)?/g, '#');
      warnOnce(`fit ${this._light.id} ${key}`, `${nameOf(this._light)} is drawn without shadows: ${fit.error.message}.`);
    }
    return fit;
  }

  /** Returns the settings for maps that the device can hold. WebGLShadowMap shrinks larger ones in the same way. */
  _clampedSettings() {
    const { x, y } = this._frameExtents;
    const { mapSize } = this;
    if (mapSize.x * x > this._limit) {
      mapSize.x = Math.floor(this._limit / x);
    }
    if (mapSize.y * y > this._limit) {
      mapSize.y = Math.floor(this._limit / y);
    }
    return this._settings();
  }

  _fitWith(settings, scan, camera) {
    const problem = problemOf(this);
    const direction = directionOf(this._light);
    if (problem !== undefined) {
      throw new Error(problem);
    }
    if (direction === undefined) {
      throw new Error('its position is the origin or not finite, so it has no direction');
    }
    let cameraFit = this._fits.get(camera);
    if (cameraFit === undefined) {
      cameraFit = new CameraFit({ windows: WindowsFitter, cascades: CascadesFitter });
      this._fits.set(camera, cameraFit);
    }
    if (this.demand !== 'auto') {
      cameraFit.forgetDepths();
    }
    const { layers } = this.camera;
    // From r187 on, three.js draws the casters of the shadow camera's layers, if it has more than layer 0.
    const hasLayers = HAS_CASTER_LAYERS && (layers.mask & 0xfffffffe) !== 0;
    const casting = hasLayers ? layers : camera.layers;
    return cameraFit.update(scan, camera, { direction, casting, settings });
  }

  /** Compares the maps' content with the need of a frame. */
  _compare(renderer, fit) {
    const drawn = this._drawn;
    const isOther = drawn && (drawn.renderer !== renderer || drawn.texture !== textureOf(renderer, this.map));
    this._answer = isOther || this._needsUpdate ? REDRAW : compare(drawn, this._prepared.scan, fit);
    return this._answer;
  }

  /** Writes uniforms that leave everything lit. */
  _setLit() {
    this._drawn = undefined;
    this._cascadeData.forEach((vector) => vector.set(...NOWHERE));
  }

  /** Writes the cameras and the uniforms of the maps that are drawn now. */
  _commit(fit, scan) {
    const atlas = this._atlas;
    if (fit.maps.length === 0) {
      atlas.cull(undefined, undefined, []);
      this._setLit();
      return;
    }
    const reach = this._look === BASIC ? 0.5 : 1 + this.radius;
    const size = Math.min(this.mapSize.x, this.mapSize.y);
    const biases = this._isCovering ? { normalBias: 0, maps: fit.maps } : stockBiases(fit.maps, size, reach);
    this.normalBias = biases.normalBias;
    atlas.place(biases.maps, this.camera._reversedDepth);
    // Maps that will stay for several frames hold all casters.
    const isLasting = this._answer === WIDEN || !this._autoUpdate;
    const masks = isLasting ? fit.keptCasters : fit.casters;
    atlas.cull(scan, masks, fit.bits);
    if (this._isCovering) {
      // At the camera's far plane, there is nothing to fade into.
      const end = this.distance < (this._frame.camera?.far ?? Infinity) ? this.distance : Infinity;
      packWindows({ matrices: this._matrices, vectors: this._cascadeData }, atlas,
        { origin: fit.origin, blend: BLEND, end });
    } else {
      this._writeCascades(fit.maps);
    }
    this._drawn = drawnNow(scan, fit, masks);
    this._frame = { ...this._frame, passes: fit.maps.length, isKept: false };
  }

  /** Writes the uniforms of the stock look-up. Each cascade fades into the next one, and the last one into light. */
  _writeCascades(maps) {
    this._cascadeData.forEach((vector) => vector.set(...NOWHERE));
    const last = maps.findLastIndex((map) => !map.isEmpty);
    maps.forEach((map, index) => {
      const [begin, , blendStart] = map.depths;
      const end = Math.min(map.depths[1], this.distance, NO_END);
      const fadeStart = index === last ? end * (1 - FADE) : Math.min(blendStart, end);
      this._atlas.writeMatrix(this._matrices[index], index);
      if (!map.isEmpty) {
        this._cascadeData[index].set(index === 0 ? -NO_END : begin, end, fadeStart, 0);
      }
    });
  }

  /** Leaves a light lit that is no sun. */
  _refuse(light) {
    warnOnce(`carrier ${light.id}`, `${nameOf(light)} has a ShadowfitShadow, but only a SunLight of `
      + '"three/addons/lights/SunLight.js" can have one. It is drawn without shadows.');
    this._isRefused = true;
    this._atlas.cull(undefined, undefined, []);
    this._setLit();
    // Everything lies beside the map of such a light.
    this.matrix.set(0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1);
  }

  // Public methods.

  report() {
    return reportOf(this);
  }

  copy(source) {
    const { camera, _autoUpdate: autoUpdate, _needsUpdate: needsUpdate } = source;
    this.camera.layers.mask = camera.layers.mask;
    for (const name of ['intensity', 'bias', 'normalBias', 'radius', 'blurSamples', 'mapType', 'biasNode']) {
      this[name] = source[name];
    }
    for (const name of ['maps', 'lookUp', 'demand', 'distance']) {
      this[name] = source[name] ?? this[name];
    }
    this.mapSize.copy(source.mapSize);
    this.autoUpdate = autoUpdate ?? source.autoUpdate;
    this.needsUpdate = needsUpdate ?? source.needsUpdate;
    this._arrange();
    return this;
  }

  /** Returns nothing: three.js's ObjectLoader knows no SunLight, and fails at an object with the data of a shadow. */
  toJSON() {
    return undefined;
  }

  dispose() {
    super.dispose();
    this._hook?.remove(this);
    this._hook = undefined;
    this.map = null;
    this.mapPass = null;
    this._fits = new WeakMap();
    this._prepared = undefined;
    this._setLit();
  }
}

/**
 * Returns a sun's direction of travel, or undefined. A sun shines from its position to the origin.
 * @param {import('three').Light} light
 */
function directionOf({ matrixWorld: { elements: m } }) {
  const length = Math.hypot(m[12], m[13], m[14]);
  return length > 0 && Number.isFinite(length) ? [-m[12] / length, -m[13] / length, -m[14] / length] : undefined;
}

/** Returns WebGL's texture of a map, or undefined if the renderer has none. */
function textureOf(renderer, map) {
  const texture = map?.depthTexture;
  return texture ? renderer.properties.get(texture).__webglTexture : undefined;
}
