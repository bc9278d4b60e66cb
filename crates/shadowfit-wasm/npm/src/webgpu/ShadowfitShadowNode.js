// The shadow of one light, as a node of its materials: draws the maps before a frame reads them, and looks them up.

import { BasicShadowMap, REVISION, ShadowBaseNode, Vector2 } from 'three/webgpu';
import { Fn, float } from 'three/tsl';

import { isSame } from '../three/bounds.js';
import { SceneScan } from '../three/scan.js';
import { CameraFit, viewsOf } from '../three/view.js';
import { SunFitter } from '../windows.js';
import { DepthReader, WIDTH } from './demand.js';
import { KEEP, Layer, OVERLAY, SPLIT } from './layers.js';
import { LookUpUniforms, lookUp } from './lookup.js';
import { Maps } from './maps.js';
import { Movement } from './movement.js';
import { Passes } from './passes.js';
import { directionOf, problemOf, settingsOf, warnWithout } from './settings.js';

/** Greatest number of cameras whose maps are kept. More cameras take turns, and their maps are drawn anew. */
const MAX_SLOTS = 4;

/** A camera whose maps were lost gets room for its own if it returns within this number of render calls. */
const TURNS = 8;

/** Greatest age of counted surfaces, in render calls, while the camera moves. Usually they are counted every few frames. */
const MAX_AGE = 60;

/** Cosine of the greatest turn of a camera from the counted surfaces: 20 degrees. */
const MAX_TURN = Math.cos(Math.PI / 9);

/** Fitters of cameras. There are no cascades here. */
const FITTERS = { windows: SunFitter };

/** The WebGL2 backend copies layers of depth textures since this release. */
const COPIES_DEPTH = 187;

const drawingSize = new Vector2();

/**
 * @typedef {object} Slot Layers of one camera.
 * @property {import('three').Camera | undefined} camera
 * @property {CameraFit} fit
 * @property {{ key: unknown[], at: number, matrix: import('three').Matrix4 } | undefined} counted Frame whose visible
 * surfaces were counted last.
 * @property {Layer[]} layers
 * @property {number} used Number of the render call that used it last.
 */

/**
 * @typedef {object} Room Maps per camera, number of cameras, and size of a map.
 * @property {number} maps
 * @property {number} slots
 * @property {number} width
 * @property {number} height
 */

/**
 * @typedef {object} Call A render call.
 * @property {import('three/webgpu').Renderer} renderer
 * @property {import('three').Scene} scene
 * @property {import('three').Camera} camera
 * @property {number} renderId
 */

/** Scans by scene, and the render call that they belong to. @type {WeakMap<object, { scan: SceneScan, call: unknown[] }>} */
const scans = new WeakMap();

/** Returns the scan of a scene. All suns of a render call share it. */
function scanned(root, { renderer, renderId, camera }) {
  let known = scans.get(root);
  if (known === undefined) {
    known = { scan: new SceneScan(root), call: [] };
    scans.set(root, known);
  }
  const call = [renderer, renderId, camera];
  if (call.some((value, index) => value !== known.call[index])) {
    known.call = call;
    known.scan.update(camera, false);
  }
  return known.scan;
}

/** The shadow node of a light. three.js creates one per light that has a `ShadowfitShadow`. */
export class ShadowfitShadowNode extends ShadowBaseNode {
  static get type() {
    return 'ShadowfitShadowNode';
  }

  /** @param {import('./ShadowfitShadow.js').ShadowfitShadow} shadow */
  constructor(shadow) {
    super(undefined);
    this.shadow = shadow;
    /** The light's own node, once a material asked for this one. */
    this.lightNode = undefined;
    this.uniforms = new LookUpUniforms();
    this.passes = new Passes();
    this.reader = new DepthReader();
    this.maps = new Maps('shadowfit maps');
    /** Still casters of maps that others move in. It has a texture once a caster moves. */
    this.stillMaps = new Maps('shadowfit still casters');
    /** Number of cameras to make room for. It grows as cameras appear. */
    this.slotCount = 1;
    /** Maps that the texture has room for, after the first frame with usable settings. @type {Room | undefined} */
    this.room = undefined;
    /** Whether materials may have bound the texture. */
    this.isBound = false;
    this.isResizing = false;
    /** @type {WeakMap<object, Slot[]>} Slots by renderer. */
    this.slots = new WeakMap();
    /** @type {WeakMap<import('three').Camera, number>} Cameras that lost their slots, and the render call of the loss. */
    this.evicted = new WeakMap();
    this.calls = 0;
    // The texture is disposed of when it changes its size, or with the light.
    this.maps.onDispose = () => {
      this.slots = new WeakMap();
      this.maps.refresh();
    };
  }

  /** Builds the look-up of a material. */
  setup(builder) {
    if (builder.renderer.shadowMap.enabled === false) {
      return undefined;
    }
    this.lightNode = builder.lightsNode.getLightNodes(builder).find(({ light }) => light?.shadow === this.shadow)
      ?? this.lightNode;
    this.light = this.lightNode?.light;
    if (this.light === undefined) {
      return float(1);
    }
    const texture = this.maps.textureFor(builder);
    return Fn(() => {
      this.setupShadowPosition(builder);
      const lit = lookUp(builder, this.uniforms, texture).toVar();
      return builder.material.receivedShadowNode ? builder.material.receivedShadowNode(lit) : lit;
    })();
  }

  /** Draws the maps that a render call needs. */
  updateBefore(frame) {
    const { renderer, camera } = frame;
    const isPrecompiling = renderer._isPreCompiling === true || (renderer._precompilationState ?? null) !== null;
    if (isPrecompiling || this.light === undefined || !this.follow()) {
      return;
    }
    this.calls += 1;
    this.passes.count = 0;
    const { shadow, light } = this;
    this.uniforms.setStyle(shadow);
    if (!shadow.autoUpdate && !shadow.needsUpdate && shadow._drawn !== undefined) {
      shadow._frame = { ...shadow._frame, camera, passes: 0, isKept: true, casters: [] };
      return;
    }
    // Shadow passes overwrite the renderer's only frame.
    const problem = this.update({ renderer, camera, scene: frame.scene, renderId: frame.renderId });
    this.isBound = true;
    if (problem !== undefined) {
      warnWithout(light, problem);
      this.uniforms.clear();
      shadow._frame = { camera, passes: 0, isKept: false, error: new Error(problem), casters: [], isBasic: false, rows: 0 };
      shadow._drawn = undefined;
    }
    shadow.needsUpdate = false;
  }

  /** Follows the light to another shadow. Returns whether this node still draws it. */
  follow() {
    const { shadow } = this.light;
    if (shadow === this.shadow) {
      return true;
    }
    this.shadow.map = null;
    if (shadow?.isShadowfitShadow) {
      this.shadow = shadow;
      return true;
    }
    // The next frame asks for the node of the other shadow.
    this.uniforms.clear();
    queueMicrotask(() => this.lightNode.disposeShadow());
    return false;
  }

  /**
   * Fits and draws the maps. Returns the reason if it cannot.
   * @param {Call} frame
   */
  update(frame) {
    const { renderer, camera } = frame;
    const { shadow, light } = this;
    const problem = problemOf(shadow, renderer);
    if (problem !== undefined) {
      return problem;
    }
    const direction = directionOf(light);
    if (direction === undefined) {
      return 'its position is not finite, or where it shines to, so it has no direction';
    }
    this.makeRoom(renderer);
    if (this.room === undefined) {
      this.uniforms.clear();
      return undefined;
    }
    const slot = this.slotOf(renderer, camera);
    shadow.map = this.maps.target;
    const scan = scanned(rootOf(frame, light), { renderer, renderId: frame.renderId, camera });
    const movement = Movement.of(scan);
    movement.update();
    const settings = settingsOf(shadow, this.room, { up: light.up, type: renderer.shadowMap.type });
    const { layers } = shadow.camera;
    // three.js draws the casters of the shadow camera's layers, if it has more than layer 0.
    const casting = (layers.mask & 0xfffffffe) !== 0 ? layers : camera.layers;
    const fit = this.fitOf(slot, camera).update(scan, camera, { direction, casting, settings });
    if (fit.error) {
      return fit.error.message;
    }
    const plan = { scan, movement, size: this.room.width, isForced: shadow.needsUpdate, canSplit: canCopyDepth(renderer) };
    const works = fit.maps.map((map, index) => {
      const layer = slot.layers[Math.log2(fit.bits[index])];
      return { layer, ...layer.plan(map, { ...plan, needed: neededRows(scan, fit, index) }) };
    });
    this.draw(works, { renderer, scan, camera, casting });
    this.count(frame, slot, { scan, direction });
    this.uniforms.set(works, {
      origin: fit.origin,
      size: this.room,
      end: settings.end,
      isReversed: renderer.reversedDepthBuffer === true,
    });
    shadow._drawn = { fit: { ...fit, maps: works.map(({ map }) => map) }, scan };
    shadow._frame = {
      camera,
      passes: this.passes.count,
      isKept: works.every(({ kind }) => kind === KEEP),
      error: undefined,
      casters: works.map(({ rows }) => rows?.reduce((sum, isDrawn) => sum + isDrawn, 0) ?? 0),
      isBasic: renderer.shadowMap.type === BasicShadowMap,
      rows: renderer.getRenderTarget()?.height ?? renderer.getDrawingBufferSize(drawingSize).y,
    };
    return undefined;
  }

  /** Counts the visible surfaces of this frame, unless they were counted in an equal one. */
  count(call, slot, { scan, direction }) {
    const { fit } = slot;
    const views = viewsOf(call.camera);
    if (this.shadow.demand !== 'auto' || views.length > 1 || fit.fitter === undefined) {
      return;
    }
    const [view] = views;
    const key = [fit.settings, scan.version, ...direction, view.depth, ...view.worldFromClip];
    if (isSame(slot.counted?.key, key)) {
      return;
    }
    const { fitter } = fit;
    const counted = { key, at: this.calls, matrix: call.camera.matrixWorld.clone() };
    this.reader.watch(call, (depths) => {
      if (slot.fit === fit && fit.fitter === fitter) {
        fitter.countDepths(depths, WIDTH, view, direction);
        fit.isRecounted = true;
        slot.counted = counted;
      }
    });
  }

  /** Returns the fit of a slot. It starts anew, from boxes, if the surfaces that it counted are no longer those in view. */
  fitOf(slot, camera) {
    const { counted } = slot;
    if (counted !== undefined) {
      const isOld = this.calls - counted.at > MAX_AGE && !counted.matrix.equals(camera.matrixWorld);
      const reach = 0.5 * (this.shadow._drawn?.fit.maps[0]?.width ?? Infinity);
      if (isOld || this.shadow.demand !== 'auto' || isCut(counted.matrix, camera.matrixWorld, reach)) {
        slot.fit = new CameraFit(FITTERS);
        slot.counted = undefined;
      }
    }
    return slot.fit;
  }

  /** Draws the maps that have to change. */
  draw(works, { renderer, scan, camera, casting }) {
    if (works.every(({ kind }) => kind === KEEP)) {
      return;
    }
    const { maps, stillMaps, passes } = this;
    const common = { scan, view: camera, casting };
    passes.within(renderer, this.getShadowMaterial(), () => {
      works.forEach(({ kind, map, rows, still, layer: { index: layer } }) => {
        const isOver = kind === SPLIT || kind === OVERLAY;
        if (kind === SPLIT) {
          stillMaps.resize(renderer, maps.size);
          passes.draw(renderer, stillMaps.target, layer, map, { ...common, rows: still, isOver: false });
        }
        if (isOver) {
          passes.copy(renderer, stillMaps.target.depthTexture, maps.target.depthTexture, layer);
        }
        if (kind !== KEEP && (!isOver || rows.includes(1))) {
          passes.draw(renderer, maps.target, layer, map, { ...common, rows, isOver });
        }
      });
    });
  }

  /**
   * Changes the texture's size if the settings or the cameras need another one. Materials that have bound the texture bind
   * the new one in the next frame only, so it changes after this frame.
   */
  makeRoom(renderer) {
    const { maps, mapSize: { x: width, y: height } } = this.shadow;
    const room = { maps, slots: this.slotCount, width, height };
    if (this.room !== undefined && Object.entries(room).every(([name, value]) => this.room[name] === value)) {
      return;
    }
    const resize = () => {
      this.room = room;
      this.maps.resize(renderer, { width, height, layers: maps * room.slots });
    };
    if (!this.isBound) {
      resize();
    } else if (!this.isResizing) {
      this.isResizing = true;
      queueMicrotask(() => {
        this.isResizing = false;
        resize();
        this.maps.refresh(highest(this.light));
      });
    }
  }

  /** Returns the layers of a camera. */
  slotOf(renderer, camera) {
    const { room } = this;
    let slots = this.slots.get(renderer);
    if (slots === undefined) {
      slots = Array.from({ length: room.slots }, (_, index) => createSlot(index * room.maps, room.maps));
      this.slots.set(renderer, slots);
    }
    let slot = slots.find((one) => one.camera === camera);
    if (slot === undefined) {
      slot = slots.reduce((oldest, one) => (one.used < oldest.used ? one : oldest));
      if (slot.camera !== undefined) {
        const hasReturned = this.calls - (this.evicted.get(camera) ?? -Infinity) <= TURNS;
        this.slotCount = hasReturned ? Math.min(room.slots + 1, MAX_SLOTS) : this.slotCount;
        this.evicted.set(slot.camera, this.calls);
      }
      slot.camera = camera;
      slot.fit = new CameraFit(FITTERS);
      slot.counted = undefined;
      slot.layers.forEach((layer) => layer.forget());
    }
    slot.used = this.calls;
    return slot;
  }

  dispose() {
    this.disposeShadowMaterial();
    this.maps.dispose();
    this.stillMaps.dispose();
    this.reader.dispose();
    super.dispose();
  }
}

/** @returns {Slot} */
function createSlot(first, count) {
  const layers = Array.from({ length: count }, (_, map) => new Layer(first + map));
  return { camera: undefined, fit: new CameraFit(FITTERS), counted: undefined, layers, used: 0 };
}

/** Returns whether a camera turned far, or moved farther than a distance. */
function isCut({ elements: from }, { elements: to }, distance) {
  const turn = from[8] * to[8] + from[9] * to[9] + from[10] * to[10];
  const lengths = Math.hypot(from[8], from[9], from[10]) * Math.hypot(to[8], to[9], to[10]);
  return turn < MAX_TURN * lengths || Math.hypot(to[12] - from[12], to[13] - from[13], to[14] - from[14]) > distance;
}

function canCopyDepth({ backend }) {
  return backend.isWebGPUBackend === true || Number.parseInt(REVISION, 10) >= COPIES_DEPTH;
}

/** Returns the object whose descendants are drawn. */
function rootOf({ scene }, light) {
  // Without a scene, three.js renders an object in an empty one.
  return scene.children.length > 0 ? scene : highest(light);
}

function highest(object) {
  return object.parent === null ? object : highest(object.parent);
}

/** Returns the rows whose casters cast a shadow into a map. */
function neededRows(scan, { keptCasters, bits }, index) {
  const rows = new Uint8Array(scan.rows.length);
  for (let row = 0; row < rows.length; row += 1) {
    rows[row] = (keptCasters[row] & bits[index]) !== 0 || scan.isAlwaysDrawn(row) ? 1 : 0;
  }
  return rows;
}
