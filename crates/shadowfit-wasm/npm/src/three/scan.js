// The boxes of a scene's casters and receivers, and which of them changed since earlier frames.
//
// Each object has a row, and keeps it until it leaves the scene. Fitters get the rows as boxes, and return a mask of
// maps for each row.

import { BatchedMesh, Box3, Material, MeshDepthMaterial, Object3D } from 'three';

import { addMoved, isSame, localBox, skinnedBox, stampBounds, versionOf } from './bounds.js';
import { nameOf, warnOnce } from './warn.js';

/** Bits of all maps in a caster's mask. */
export const ALL_MAPS = 0xff;

/** Flags of a box for the fitter. */
const CASTER = 1;
const RECEIVER = 2;

/** Greatest coordinate of a box. The fitter's squares of lengths must stay finite. */
const LARGEST = 1e15;

/** Relative rounding error of 32-bit floats. Boxes grow by it, so that they still contain their objects. */
const ROUNDING = 2 ** -23;

/** State of an object's box. */
const BOUNDED = 0;
/** Nothing knows the object's bounds, or it has no vertices. It is drawn into all maps, and none is placed by it. */
const UNKNOWN = 1;
/** The transform or the vertices are not finite. The object is not drawn. */
const BROKEN = 2;

/**
 * @typedef {object} Entry An object with a row.
 * @property {Object3D} object
 * @property {number} row
 * @property {number} seen Number of the scan that found it last.
 * @property {number} state
 * @property {Box3} local Box in the object's space.
 * @property {Box3} box Box in the world.
 * @property {Float64Array} matrix Matrix that the box was computed with.
 * @property {Float64Array | undefined} bones Matrices of the bones that the box was computed with.
 * @property {unknown[]} stamp Everything else that the box and the object's picture depend on.
 * @property {boolean} casts
 */

/** Objects of one scene that cast or receive shadows. */
export class SceneScan {
  /** @param {Object3D} root */
  constructor(root) {
    this.root = root;
    /** @type {Map<Object3D, Entry>} */
    this.entries = new Map();
    /** @type {(Entry | undefined)[]} */
    this.rows = [];
    this.freeRows = [];
    /** Number of the latest change of any row. */
    this.version = 0;
    /** Number of the latest change of each row's caster. */
    this.casterChanges = [];
    this.scans = 0;
    this.hasReceivers = false;
    this.hasCasters = false;
  }

  /**
   * Finds the objects and their changes.
   * @param {import('three').Camera} camera Camera that selects levels of detail.
   * @param {boolean} drawsReceivers Whether the renderer also draws receivers into maps.
   */
  update(camera, drawsReceivers) {
    this.scans += 1;
    this.camera = camera;
    this.drawsReceivers = drawsReceivers;
    this.next = this.version + 1;
    this.hasReceivers = false;
    this.hasCasters = false;
    this.visit(this.root);
    for (const entry of this.entries.values()) {
      if (entry.seen !== this.scans) {
        this.remove(entry);
      }
    }
  }

  visit(object) {
    if (object.visible === false) {
      return;
    }
    // three.js selects the level later in the frame, and the same level is then drawn into the maps.
    if (object.isLOD && object.autoUpdate && object.layers.test(this.camera.layers)) {
      object.update(this.camera);
    }
    if ((object.castShadow || object.receiveShadow) && (object.isMesh || object.isLine || object.isPoints)) {
      this.find(object);
    }
    for (const child of object.children) {
      this.visit(child);
    }
  }

  /** Finds the changes of an object, and adds it if it is new. */
  find(object) {
    const casts = object.castShadow || (this.drawsReceivers && object.receiveShadow);
    let entry = this.entries.get(object);
    if (entry === undefined) {
      entry = this.add(object);
    }
    entry.seen = this.scans;
    const isStamped = isSame(entry.stamp, stampOf(object, casts));
    if (!isStamped) {
      entry.stamp = scratch.slice();
    }
    const hasMoved = copyChanged(entry.matrix, object.matrixWorld.elements, 0) || hasNewPose(entry);
    if (!isStamped || hasMoved) {
      this.measure(entry, isStamped);
    }
    if (!isStamped || hasMoved || (casts && isVolatile(object))) {
      this.version = this.next;
      if (casts || entry.casts) {
        this.casterChanges[entry.row] = this.next;
      }
    }
    entry.casts = casts;
    this.hasCasters ||= casts && entry.state === BOUNDED;
    this.hasReceivers ||= object.receiveShadow && entry.state === BOUNDED;
  }

  add(object) {
    const row = this.freeRows.pop() ?? this.rows.length;
    const entry = {
      object, row, seen: 0, state: UNKNOWN, local: new Box3(), box: new Box3(), matrix: new Float64Array(16).fill(NaN),
      bones: undefined, stamp: undefined, casts: false,
    };
    this.rows[row] = entry;
    this.casterChanges[row] ??= 0;
    this.entries.set(object, entry);
    return entry;
  }

  remove({ object, row, casts }) {
    this.entries.delete(object);
    this.rows[row] = undefined;
    this.freeRows.push(row);
    this.version = this.next;
    if (casts) {
      this.casterChanges[row] = this.next;
    }
  }

  /** Computes an object's box. */
  measure(entry, isMovement) {
    const { object, box } = entry;
    let isFinite;
    box.makeEmpty();
    if (object.isSkinnedMesh && object.skeleton && object.geometry.attributes.skinIndex) {
      isFinite = skinnedBox(object, box);
    } else {
      if (!isMovement) {
        entry.local.copy(localBox(object));
      }
      isFinite = entry.local.isEmpty() || addMoved(box, entry.local, object.matrixWorld.elements);
    }
    const { min, max } = box;
    const most = Math.max(-min.x, -min.y, -min.z, max.x, max.y, max.z, min.x, min.y, min.z, -max.x, -max.y, -max.z);
    if (!isFinite || (!box.isEmpty() && !(most <= LARGEST))) {
      entry.state = BROKEN;
      warnOnce(`broken ${object.id}`, `${nameOf(object)} has a transform or vertices that are not finite numbers. `
        + 'It casts and receives no shadows.');
    } else {
      entry.state = box.isEmpty() ? UNKNOWN : BOUNDED;
    }
  }

  /**
   * Writes the rows for a fitter.
   * @param {{ bounds: Float32Array, flags: Uint8Array }} boxes
   * @param {number[]} origin
   * @param {import('three').Layers} receiving Layers whose receivers are visible.
   * @param {import('three').Layers} casting Layers whose casters are drawn.
   */
  write({ bounds, flags }, [x, y, z], receiving, casting) {
    this.rows.forEach((entry, row) => {
      if (entry === undefined || entry.state !== BOUNDED) {
        bounds.fill(0, 6 * row, 6 * row + 6);
        flags[row] = 0;
        return;
      }
      const { object, casts, box: { min, max } } = entry;
      flags[row] = (casts && object.layers.test(casting) ? CASTER : 0)
        | (object.receiveShadow && object.layers.test(receiving) ? RECEIVER : 0);
      writeRange(bounds, 6 * row, min.x - x, max.x - x);
      writeRange(bounds, 6 * row + 1, min.y - y, max.y - y);
      writeRange(bounds, 6 * row + 2, min.z - z, max.z - z);
    });
  }

  /**
   * Returns the maps that an object is drawn into.
   * @param {Object3D} object
   * @param {Uint8Array} masks Masks by row.
   */
  maskOf(object, masks) {
    const entry = this.entries.get(object);
    if (entry === undefined || entry.state === UNKNOWN) {
      return ALL_MAPS;
    }
    return entry.state === BROKEN ? 0 : masks[entry.row] ?? ALL_MAPS;
  }

  /** Returns whether three.js draws a row into all maps without asking for its mask. */
  isAlwaysDrawn(row) {
    const entry = this.rows[row];
    return entry !== undefined && entry.casts && (!entry.object.frustumCulled || entry.state === UNKNOWN);
  }
}

function writeRange(bounds, at, low, high) {
  bounds[at] = low - Math.abs(low) * ROUNDING;
  bounds[at + 3] = high + Math.abs(high) * ROUNDING;
}

/** Copies 16 numbers, and returns whether any was different. */
function copyChanged(target, source, at) {
  let isChanged = false;
  for (let index = 0; index < 16; index += 1) {
    if (target[at + index] !== source[index]) {
      // NaN differs from itself without any movement.
      isChanged ||= !(Number.isNaN(target[at + index]) && Number.isNaN(source[index]));
      target[at + index] = source[index];
    }
  }
  return isChanged;
}

/** Returns whether the bones of a skinned mesh have moved, and keeps their matrices. */
function hasNewPose(entry) {
  const { object } = entry;
  const bones = object.isSkinnedMesh ? object.skeleton?.bones : undefined;
  if (!bones) {
    return false;
  }
  if (entry.bones?.length !== 16 * bones.length) {
    entry.bones = new Float64Array(16 * bones.length).fill(NaN);
  }
  let isChanged = false;
  bones.forEach((bone, index) => {
    // All matrices are copied, so no short circuit.
    isChanged = (bone ? copyChanged(entry.bones, bone.matrixWorld.elements, 16 * index) : false) || isChanged;
  });
  return isChanged;
}

/** List that `stampOf` fills. It is reused, so that still objects cost no memory. */
const scratch = [];

/**
 * Returns everything but transforms that an object's box and its picture in a map depend on. The list is valid until the
 * next call.
 */
function stampOf(object, casts) {
  const { geometry } = object;
  const { position } = geometry.attributes;
  scratch.length = 0;
  // three.js computes this sphere when it culls the object, and the sphere is part of the list.
  if (geometry.boundingSphere === null && object.boundingSphere === undefined && object.frustumCulled && position) {
    geometry.computeBoundingSphere();
  }
  scratch.push(
    casts, object.receiveShadow, object.layers.mask, object.frustumCulled, geometry, position, versionOf(position),
    position?.count, geometry.index, versionOf(geometry.index), geometry.drawRange.start, geometry.drawRange.count,
  );
  stampBounds(scratch, geometry);
  if (object.morphTargetInfluences && geometry.morphAttributes.position) {
    scratch.push(...object.morphTargetInfluences);
  }
  if (object.isInstancedMesh) {
    const { instanceMatrix, count, morphTexture } = object;
    scratch.push(instanceMatrix, instanceMatrix.version, count, morphTexture?.version);
  }
  if (object.isBatchedMesh) {
    stampBatch(object);
  }
  if (casts) {
    if (Array.isArray(object.material)) {
      object.material.forEach(stampMaterial);
      for (const { start, count, materialIndex } of geometry.groups) {
        scratch.push(start, count, materialIndex);
      }
    } else {
      stampMaterial(object.material);
    }
    stampMaterial(object.customDepthMaterial);
  }
  return scratch;
}

/** Appends the state of a batch. It has no version for its instances' visibility, so their states are hashed. */
function stampBatch({ _matricesTexture: matrices, _instanceInfo: instances }) {
  let hash = 0;
  for (const { active, visible, geometryIndex } of instances ?? []) {
    hash = (Math.imul(hash, 31) + 4 * geometryIndex + (active ? 2 : 0) + (visible ? 1 : 0)) | 0;
  }
  scratch.push(matrices?.version, instances?.length, hash);
}

function stampMaterial(material) {
  if (!material) {
    return;
  }
  const { map, alphaMap, displacementMap } = material;
  scratch.push(
    material, material.version, material.visible, material.side, material.shadowSide, material.alphaTest,
    material.alphaToCoverage, material.wireframe, map, map?.version, alphaMap, alphaMap?.version, displacementMap,
    displacementMap?.version, material.displacementScale, material.displacementBias,
    material.clipShadows ? material.clippingPlanes?.length : 0,
  );
  if (material.alphaTest > 0) {
    stampTransform(map);
    stampTransform(alphaMap);
  }
}

/** Appends the place of a texture whose alpha shapes a shadow. */
function stampTransform(texture) {
  if (texture) {
    const { offset, repeat, rotation, center, matrix, matrixAutoUpdate } = texture;
    scratch.push(offset.x, offset.y, repeat.x, repeat.y, rotation, center.x, center.y);
    if (!matrixAutoUpdate) {
      scratch.push(...matrix.elements);
    }
  }
}

/** Returns whether an object's picture in a map may change without any change that a scan finds. */
function isVolatile(object) {
  const { onBeforeShadow, customDepthMaterial, material } = object;
  if (onBeforeShadow !== Object3D.prototype.onBeforeShadow && onBeforeShadow !== BatchedMesh.prototype.onBeforeShadow) {
    return true;
  }
  if (customDepthMaterial) {
    return !(customDepthMaterial instanceof MeshDepthMaterial)
      || customDepthMaterial.onBeforeCompile !== Material.prototype.onBeforeCompile;
  }
  return Array.isArray(material) ? material.some(isAnimated) : isAnimated(material);
}

/** Returns whether a material's shape moves: by clipping planes, or by the alpha of a video or a rendered texture. */
function isAnimated(material) {
  if (!material) {
    return false;
  }
  const isMoving = (texture) => Boolean(texture?.isVideoTexture || texture?.isRenderTargetTexture);
  return (material.clipShadows && material.clippingPlanes?.length > 0)
    || (material.alphaTest > 0 && (isMoving(material.map) || isMoving(material.alphaMap)));
}
