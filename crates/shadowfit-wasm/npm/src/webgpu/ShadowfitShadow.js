// The shadow of a sun for WebGPURenderer, fitted by shadowfit.

import { LightShadow, OrthographicCamera } from 'three/webgpu';

import { reportOf } from '../three/report.js';
import { BASIC, PCF } from '../three/settings.js';
import { ShadowfitShadowNode } from './ShadowfitShadowNode.js';
import { withDefaults } from './settings.js';

/** See `src/three-webgpu.d.ts` for the documentation of the public members. */
export class ShadowfitShadow extends LightShadow {
  constructor(options = {}) {
    super(new OrthographicCamera());
    const { maps, mapSize, distance, demand } = withDefaults(options);
    this.isShadowfitShadow = true;
    this.maps = maps;
    this.distance = distance;
    this.demand = demand;
    this.mapSize.set(mapSize, mapSize);
    /** Figures of the latest frame. */
    this._frame = { camera: undefined, passes: 0, isKept: false, error: undefined, casters: [], isBasic: false, rows: 0 };
    /** Maps of the latest frame, and the scan that they were fitted to. The helper draws them. */
    this._drawn = undefined;
  }

  /** A new node, for three.js's node of the light. Each light node asks once, and again after it was disposed of. */
  get shadowNode() {
    return new ShadowfitShadowNode(this);
  }

  /** Does nothing: the node fits the maps. */
  updateMatrices() {}

  report() {
    const { _frame: frame, _drawn, mapSize, distance, radius } = this;
    const { lookUp: _, ...report } = reportOf({
      _frame: { ...frame, rows: frame.rows || undefined },
      _drawn,
      _isCovering: true,
      _look: frame.isBasic ? BASIC : PCF,
      _atlas: { frustums: frame.casters.map((drawn) => ({ drawn })) },
      mapSize,
      distance,
      radius,
    });
    return report;
  }

  copy(source) {
    for (const name of ['intensity', 'bias', 'normalBias', 'radius', 'blurSamples', 'mapType', 'biasNode', 'autoUpdate',
      'needsUpdate']) {
      this[name] = source[name];
    }
    for (const name of ['maps', 'distance', 'demand']) {
      this[name] = source[name] ?? this[name];
    }
    this.camera.layers.mask = source.camera.layers.mask;
    this.mapSize.copy(source.mapSize);
    return this;
  }

  /** Returns nothing: three.js's ObjectLoader knows no SunLight, and fails at an object with the data of a shadow. */
  toJSON() {
    return undefined;
  }

  dispose() {
    super.dispose();
    this.map = null;
    this._drawn = undefined;
  }
}
