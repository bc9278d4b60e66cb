// The look-up by coverage, in TSL, and the uniforms that it reads.
//
// The maps of a sun are layers of one depth texture and share the light's axes. A point reads the first map in the list, the
// finest, that contains the point and the filter's footprint. Near its border, the look-up blends it into the next map.
// Points outside all maps are lit. The rule and the formulas are the library's: see "Look up" in docs/INTEGRATION.md.

import { BasicShadowMap, Matrix3, Vector2, Vector3, Vector4 } from 'three/webgpu';
import {
  If, Loop, abs, clamp, cos, cross, dFdx, dFdy, dot, float, floor, int, interleavedGradientNoise, length, max, min, mix,
  positionView, renderGroup, screenCoordinate, select, shadowPositionWorld, sin, smoothstep, sqrt, texture, uniform,
  uniformArray, vec2,
} from 'three/tsl';

/** Greatest number of maps of a sun. The fitter fits up to eight. */
export const MAX_MAPS = 8;

/** Width of the blend into the next map, in texels. */
export const BLEND = 8;

/** Half width of the tent filter, in texels: look-ups one texel away, each with a bilinear comparison. */
export const TENT = 2;

/** Radius of the disc in texels, per unit of `shadow.radius`: that of three.js's own filter. The disc of a radius of 1
 * reaches as far as the tent. */
export const DISC_PER_RADIUS = 1;

/** Look-ups of the disc. Fewer show the noise of the rotation, more cost time. */
const DISC_LOOK_UPS = 16;

/** Angle between consecutive look-ups of the disc, in radians: the golden angle spreads any number of them evenly
 * (H. Vogel, "A better way to construct the sunflower head", 1979). */
const GOLDEN_ANGLE = Math.PI * (3 - Math.sqrt(5));

/** Below this cosine (89.7 degrees from the light), a surface's slope is clamped. Such surfaces receive almost no light. */
const MIN_COSINE = 0.005;

/** Share of the shadow distance over which shadows fade out. Stock suns use the same share. */
const FADE = 0.1;

/** Depth at which shadows end if they have no end. */
const NO_END = 1e30;

/** Rounding error of `1 - depth` in a 32-bit float. */
const REVERSAL_ERROR = 2 ** -24;

/** Uniforms of a sun. All of its materials share them, so no map that moves needs a new shader. */
export class LookUpUniforms {
  constructor() {
    /** Rows are the light's axes in the world. */
    this.axes = new Matrix3();
    /** World position near the eye. Light-space positions are relative to it. */
    this.origin = new Vector3();
    /** Scale and offset from light-space x, y to 0..1 in each map, v from the top. */
    this.places = list();
    /** Scale and offset from light-space z to depth in each map, receiver-plane bias in texels, layer. */
    this.depths = list();
    /** Size of a map in texels. */
    this.size = new Vector2(1, 1);
    const shared = (node) => node.setGroup(renderGroup);
    this.nodes = {
      axes: shared(uniform(this.axes)),
      origin: shared(uniform(this.origin)),
      places: shared(uniformArray(this.places, 'vec4')),
      depths: shared(uniformArray(this.depths, 'vec4')),
      size: shared(uniform(this.size)),
      count: shared(uniform(0, 'int')),
      end: shared(uniform(NO_END)),
      radius: shared(uniform(1)),
      intensity: shared(uniform(1)),
    };
  }

  /** Sets the softness and the darkness. */
  setStyle({ radius, intensity }) {
    this.nodes.radius.value = radius;
    this.nodes.intensity.value = intensity;
  }

  /** Leaves everything lit. */
  clear() {
    this.nodes.count.value = 0;
  }

  /**
   * Sets the maps.
   * @param {{ map: import('../fitter.d.ts').FittedMap, layer: import('./layers.js').Layer }[]} layers Maps in the order of
   * the look-up.
   * @param {{ origin: ArrayLike<number>, size: { width: number, height: number }, end: number, isReversed: boolean }} frame
   * `end` is the view depth at which shadows end.
   */
  set(layers, { origin, size, end, isReversed }) {
    const { nodes } = this;
    nodes.count.value = layers.length;
    nodes.end.value = Math.min(end, NO_END);
    this.size.set(size.width, size.height);
    if (layers.length === 0) {
      return;
    }
    // The shader subtracts this rounded origin.
    const [ox, oy, oz] = [0, 1, 2].map((axis) => Math.fround(origin[axis]));
    this.origin.set(ox, oy, oz);
    const [{ map: { x, y, z } }] = layers;
    this.axes.set(...x, ...y, ...z);
    layers.forEach(({ map, layer }, index) => {
      const { position: [px, py, pz], width, height, depthRange, constantDepth, receiverPlane } = map;
      const along = (axis) => axis[0] * (px - ox) + axis[1] * (py - oy) + axis[2] * (pz - oz);
      this.places[index].set(1 / width, -1 / height, 0.5 - along(x) / width, 0.5 + along(y) / height);
      const bias = constantDepth + (isReversed ? REVERSAL_ERROR : 0);
      this.depths[index].set(-1 / depthRange, along(z) / depthRange - bias, receiverPlane, layer.index);
    });
  }
}

function list() {
  return Array.from({ length: MAX_MAPS }, () => new Vector4());
}

/**
 * Builds the look-up at the point in `shadowPositionWorld`, inside a TSL function. Returns the share of light that reaches
 * it, from 0 to 1, with the sun's shadow intensity.
 * @param {import('three/webgpu').NodeBuilder} builder
 * @param {LookUpUniforms} uniforms
 * @param {import('three').DepthTexture} maps
 */
export function lookUp(builder, { nodes }, maps) {
  const { renderer } = builder;
  const isBasic = renderer.shadowMap.type === BasicShadowMap;
  const { light, slope } = surface(nodes);
  const reach = isBasic ? float(0.5) : max(float(TENT), nodes.radius.mul(DISC_PER_RADIUS).add(1));
  const chosen = choose(nodes, light, reach.toVar());

  const lit = float(0).toVar();
  Loop({ start: 0, end: 2, type: 'int', condition: '<', name: 'turn' }, ({ turn }) => {
    const isFirst = turn.equal(0);
    const share = select(isFirst, chosen.share, chosen.otherShare).toVar();
    If(share.greaterThan(0), () => {
      const index = select(isFirst, chosen.first, chosen.second).toVar();
      const place = nodes.places.element(index).toVar();
      const depth = nodes.depths.element(index).toVar();
      const gradient = slope.mul(depth.x).div(place.xy.mul(nodes.size)).toVar();
      const rise = depth.z.mul(abs(gradient.x).add(abs(gradient.y)));
      const point = {
        maps,
        layer: int(depth.w),
        size: nodes.size,
        texel: light.xy.mul(place.xy).add(place.zw).mul(nodes.size).toVar(),
        gradient,
        depth: light.z.mul(depth.x).add(depth.y).sub(rise).toVar(),
        isReversed: renderer.reversedDepthBuffer === true,
      };
      lit.addAssign(share.mul(isBasic ? nearest(point) : filter(point, nodes.radius)));
    });
  });
  const outside = select(chosen.first.lessThan(0), float(1), lit);
  const faded = mix(outside, 1, smoothstep(nodes.end.mul(1 - FADE), nodes.end, positionView.z.negate()));
  return mix(1, faded, nodes.intensity);
}

/**
 * Returns the point's light-space position, and the change of the surface's z along x and y. Only the differences to the
 * neighbouring pixels give the surface that is drawn: interpolated normals tilt away from it.
 */
function surface(nodes) {
  const light = nodes.axes.mul(shadowPositionWorld.sub(nodes.origin)).toVar();
  const normal = cross(dFdx(light), dFdy(light)).toVar();
  const away = max(abs(normal.z), length(normal).mul(MIN_COSINE)).max(1e-36);
  const side = select(normal.z.lessThan(0), float(-1), float(1));
  return { light, slope: normal.xy.mul(side).negate().div(away).toVar() };
}

/**
 * Returns the finest map that contains the filter's footprint, the next one that does, and their shares. If no map contains
 * the footprint, the first is the finest that contains the point alone. Outside all maps, both shares are 0.
 */
function choose(nodes, light, reach) {
  const first = int(-1).toVar();
  const second = int(-1).toVar();
  const narrow = int(-1).toVar();
  const inner = float(1).toVar();
  Loop({ start: 0, end: nodes.count, type: 'int', condition: '<', name: 'level' }, ({ level }) => {
    const place = nodes.places.element(level).toVar();
    const uv = light.xy.mul(place.xy).add(place.zw).toVar();
    const sides = min(uv, uv.oneMinus()).mul(nodes.size).toVar();
    const free = min(sides.x, sides.y).toVar();
    If(free.greaterThanEqual(reach), () => {
      If(first.lessThan(0), () => {
        first.assign(level);
        inner.assign(clamp(free.sub(reach).div(BLEND), 0, 1));
      }).ElseIf(second.lessThan(0), () => {
        second.assign(level);
      });
    }).ElseIf(free.greaterThanEqual(0).and(narrow.lessThan(0)), () => {
      narrow.assign(level);
    });
  });
  If(first.lessThan(0), () => {
    first.assign(narrow);
  });
  const otherShare = select(second.lessThan(0), float(0), inner.oneMinus()).toVar();
  const share = select(first.lessThan(0), float(0), otherShare.oneMinus()).toVar();
  return { first, second, share, otherShare };
}

/** Compares the surface with the map at a position in texels. */
function compare({ maps, layer, size, texel, gradient, depth, isReversed }, at) {
  const inside = clamp(at, vec2(0.5), size.sub(0.5)).toVar();
  const moved = clamp(depth.add(dot(gradient, inside.sub(texel))), 0, 1);
  return texture(maps, inside.div(size)).depth(layer).compare(isReversed ? moved.oneMinus() : moved);
}

/** Compares with one texel. */
function nearest(point) {
  return compare(point, floor(point.texel).add(0.5));
}

function filter(point, radius) {
  const lit = float(0).toVar();
  If(radius.greaterThan(1), () => {
    lit.assign(disc(point, radius));
  }).Else(() => {
    lit.assign(tent(point));
  });
  return lit;
}

/**
 * Averages 3 × 3 bilinear comparisons, one texel apart, with the weights 1 2 1 along each axis. Bilinear comparisons weight
 * two texels by 1-t and t. So together, along an axis, four texels have the weights 1-t, 2-t, 1+t and t, over 4. Two
 * comparisons between the pairs of these texels give the same sum.
 */
function tent(point) {
  const { texel } = point;
  const centre = floor(texel.sub(0.5)).add(0.5).toVar();
  const t = texel.sub(centre).toVar();
  const before = t.mul(-2).add(3).toVar();
  const after = t.mul(2).add(1).toVar();
  const offsets = [t.oneMinus().add(1).div(before).sub(1), t.div(after).add(1)];
  const weights = [before, after];
  const columns = offsets.map((offset) => centre.x.add(offset.x).toVar());
  const rows = offsets.map((offset) => centre.y.add(offset.y).toVar());
  const lines = rows.map((row, j) => {
    const [a, b] = columns.map((column, i) => compare(point, vec2(column, row)).mul(weights[i].x));
    return a.add(b).mul(weights[j].y);
  });
  return lines[0].add(lines[1]).div(16);
}

/** Averages comparisons over a disc that is rotated per pixel. */
function disc(point, radius) {
  const turn = interleavedGradientNoise(screenCoordinate.xy).mul(2 * Math.PI).toVar();
  const lit = float(0).toVar();
  Loop({ start: 0, end: DISC_LOOK_UPS, type: 'int', condition: '<', name: 'tap' }, ({ tap }) => {
    const angle = float(tap).mul(GOLDEN_ANGLE).add(turn).toVar();
    const distance = sqrt(float(tap).add(0.5).div(DISC_LOOK_UPS)).mul(radius).mul(DISC_PER_RADIUS);
    const at = point.texel.add(vec2(cos(angle), sin(angle)).mul(distance));
    lit.addAssign(compare(point, at));
  });
  return lit.div(DISC_LOOK_UPS);
}
