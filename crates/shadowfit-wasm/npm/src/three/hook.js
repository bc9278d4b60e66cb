// The hooks into a scene's frame, so that a sun needs no call per frame.
//
// `WebGLRenderer.render` calls `scene.onBeforeRender` after it has updated the world matrices and before it draws shadow
// maps. There all suns of a scene share one scan. Handlers of the user keep working: ours calls theirs first. A handler
// that is assigned later replaces ours, and the next shadow pass puts ours around it.

import { Object3D } from 'three';

import { Demand } from './demand.js';
import { SceneScan } from './scan.js';

/** @type {WeakMap<Object3D, SceneHook>} */
const hooks = new WeakMap();

/** Events of a scene's frame that are hooked. */
const EVENTS = ['onBeforeRender', 'onAfterRender'];

/** The suns of one scene, and the scene's scan. */
export class SceneHook {
  /**
   * Returns the hook of the scene that contains an object.
   * @param {Object3D} object
   */
  static of(object) {
    let root = object;
    while (root.parent !== null) {
      root = root.parent;
    }
    const known = hooks.get(root);
    if (known) {
      return known;
    }
    const hook = new SceneHook(root);
    hooks.set(root, hook);
    return hook;
  }

  /** @param {Object3D} root */
  constructor(root) {
    this.root = root;
    this.scan = new SceneScan(root);
    this.demand = new Demand();
    /** @type {Set<import('./ShadowfitShadow.js').ShadowfitShadow>} */
    this.suns = new Set();
    /** Our handlers, by event. */
    this.handlers = {};
    /** Camera of the render call whose `onBeforeRender` ran last. */
    this.camera = undefined;
    /** Whether that call has scanned the scene. */
    this.isScanned = false;
  }

  /** Adds a sun. */
  add(shadow) {
    this.suns.add(shadow);
    // Handlers that ran in this frame are in place, perhaps inside handlers of the user.
    if (this.camera === undefined) {
      EVENTS.forEach((event) => this.chain(event));
    }
  }

  /** Removes a sun, and our handlers with the last one. */
  remove(shadow) {
    this.suns.delete(shadow);
    if (this.suns.size > 0) {
      return;
    }
    for (const event of EVENTS) {
      const handler = this.handlers[event];
      if (handler && this.root[event] === handler) {
        if (handler.isOwn) {
          this.root[event] = handler.previous;
        } else {
          delete this.root[event];
        }
      }
      // A handler of the user may still call ours.
      delete this.handlers[event];
    }
    this.camera = undefined;
  }

  /** Puts our handler of an event around the scene's, unless it is there. */
  chain(event) {
    const hook = this;
    const previous = this.root[event];
    if (!this.root.isScene || previous === this.handlers[event]) {
      return;
    }
    const handler = function handle(...values) {
      previous.apply(this, values);
      // A handler that was replaced may still be called by its successor.
      if (hook.handlers[event] === handler) {
        hook[event](...values);
      }
    };
    handler.previous = previous;
    handler.isOwn = Object.hasOwn(this.root, event);
    this.handlers[event] = handler;
    this.root[event] = handler;
  }

  /** Prepares the suns for a frame. */
  onBeforeRender(renderer, scene, camera) {
    // The latest frame did not end for us: it contains this one, or our handler was replaced.
    if (this.camera !== undefined) {
      this.chain('onAfterRender');
    }
    this.camera = camera;
    this.isScanned = false;
    // Mirrors draw the scene once more with the maps of the frame.
    const { enabled, autoUpdate, needsUpdate } = renderer.shadowMap;
    if (!enabled || (!autoUpdate && !needsUpdate)) {
      return;
    }
    for (const shadow of this.suns) {
      const { _hook: hook, _light: light } = shadow;
      if (hook !== this || light.shadow !== shadow || SceneHook.of(light) !== this) {
        this.remove(shadow);
      } else {
        shadow._begin();
        shadow._prepare(renderer, camera);
      }
    }
  }

  onAfterRender(renderer, scene, camera) {
    this.camera = undefined;
    this.isScanned = false;
    for (const shadow of this.suns) {
      shadow._end(renderer, camera);
    }
    this.demand.gather(renderer, camera, this.suns);
  }

  /**
   * Returns the scan of the present state. Suns of one render call share it.
   * @param {import('three').Camera} camera
   * @param {boolean} drawsReceivers
   */
  scanned(camera, drawsReceivers) {
    if (!this.isScanned) {
      this.scan.update(camera, drawsReceivers);
      this.isScanned = this.camera === camera;
    }
    return this.scan;
  }
}
