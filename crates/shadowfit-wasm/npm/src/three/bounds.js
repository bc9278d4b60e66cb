// Boxes around what objects draw, in their own space or in the world: plain, morphed, instanced, batched and skinned
// meshes, lines and points.
//
// A box that is too small cuts a shadow, so each bound here holds for every pose. A mesh's box contains all vertices with
// their morph targets. A skinned vertex is a weighted mean of its positions under its bones, so the boxes of the vertices
// of each bone, moved by that bone, contain it.

import { Box3, Matrix4, Vector3 } from 'three';

/** Relative difference above which a geometry's bounding sphere was not computed from its vertices. */
const ENLARGED = 1e-3;

/** Greatest difference of a vertex's sum of weights from 1. Others are not means of positions. */
const WEIGHT_ERROR = 0.01;

const matrix = new Matrix4();
const point = new Vector3();

/**
 * @typedef {object} GeometryBounds Bounds of a geometry's vertices.
 * @property {Box3} box Box of the base positions. It is empty without vertices.
 * @property {Box3[]} morphs Boxes of the morph targets' positions.
 * @property {unknown[]} stamp State that they were computed from.
 */

/** @type {WeakMap<import('three').BufferGeometry, GeometryBounds>} */
const geometries = new WeakMap();

/** Returns the version of an attribute's data. */
export function versionOf(attribute) {
  return attribute ? attribute.version ?? attribute.data?.version : undefined;
}

/** Returns whether both lists have the same elements. It is called for every object in every frame. */
export function isSame(one, other) {
  if (one === undefined || one.length !== other.length) {
    return false;
  }
  for (let index = 0; index < one.length; index += 1) {
    if (one[index] !== other[index] && !Object.is(one[index], other[index])) {
      return false;
    }
  }
  return true;
}

/** Appends the values of a geometry's bounding box and sphere to a list. */
export function stampBounds(stamp, { boundingBox: box, boundingSphere: sphere }) {
  if (box) {
    stamp.push(box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z);
  }
  if (sphere) {
    stamp.push(sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius);
  }
}

/** Adds the positions of an attribute to a box. */
function addPositions(box, attribute) {
  if (!attribute || attribute.isGLBufferAttribute) {
    return box;
  }
  for (let index = 0; index < attribute.count; index += 1) {
    const [x, y, z] = [attribute.getX(index), attribute.getY(index), attribute.getZ(index)];
    // Comparisons with NaN are false, so broken vertices do not count.
    box.min.set(x < box.min.x ? x : box.min.x, y < box.min.y ? y : box.min.y, z < box.min.z ? z : box.min.z);
    box.max.set(x > box.max.x ? x : box.max.x, y > box.max.y ? y : box.max.y, z > box.max.z ? z : box.max.z);
  }
  return box;
}

function isFinite3({ x, y, z }) {
  return Number.isFinite(x) && Number.isFinite(y) && Number.isFinite(z);
}

/** Returns whether a box has finite corners, and is not empty. */
export function isBounded(box) {
  return !box.isEmpty() && isFinite3(box.min) && isFinite3(box.max);
}

/**
 * Returns the bounds of a geometry. They contain its vertices, its bounding box, and its bounding sphere if that is larger
 * than the vertices need: shaders may move vertices within them.
 * @param {import('three').BufferGeometry} geometry
 */
export function boundsOf(geometry) {
  const { position } = geometry.attributes;
  const { boundingBox, boundingSphere } = geometry;
  const targets = geometry.morphAttributes.position ?? [];
  const stamp = [
    position, versionOf(position), position?.count, ...targets, ...targets.map(versionOf),
  ];
  stampBounds(stamp, geometry);
  const known = geometries.get(geometry);
  if (known && isSame(known.stamp, stamp)) {
    return known;
  }
  const box = addPositions(new Box3(), position);
  if (!position || position.isGLBufferAttribute || geometry.attributes.instanceStart) {
    // Such geometries know their bounds, or nothing does.
    if (!boundingBox && geometry.attributes.instanceStart) {
      geometry.computeBoundingBox();
      return boundsOf(geometry);
    }
  }
  if (boundingBox && isBounded(boundingBox)) {
    box.union(boundingBox);
  }
  if (boundingSphere && boundingSphere.radius > 0) {
    const half = box.isEmpty() ? 0 : 0.5 * box.min.distanceTo(box.max);
    if (boundingSphere.radius > half * (1 + ENLARGED)) {
      box.union(boundingSphere.getBoundingBox(new Box3()));
    }
  }
  const bounds = { box, morphs: targets.map((target) => addPositions(new Box3(), target)), stamp };
  geometries.set(geometry, bounds);
  return bounds;
}

/** Adds `share` times a box to a box, each corner by interval arithmetic. */
function addShare(box, { min, max }, share) {
  const [low, high] = share < 0 ? [max, min] : [min, max];
  box.min.addScaledVector(low, share);
  box.max.addScaledVector(high, share);
}

/**
 * Returns the range of an object's morph influences: the least and the greatest of each target.
 * @returns {[number, number][]}
 */
function influencesOf(object) {
  const { morphTexture, morphTargetInfluences } = object;
  if (!morphTexture) {
    return (morphTargetInfluences ?? []).map((influence) => [influence, influence]);
  }
  // Each row of the texture is an instance: the share of the base, then the influences.
  const { data, width } = morphTexture.source.data;
  const ranges = Array.from({ length: width - 1 }, () => [0, 0]);
  for (let row = 0; row < object.count; row += 1) {
    ranges.forEach((range, target) => {
      const influence = data[row * width + 1 + target];
      range[0] = Math.min(range[0], influence);
      range[1] = Math.max(range[1], influence);
    });
  }
  return ranges;
}

/** Returns a box of base positions, moved by an object's morph targets. */
function morphed(box, object, { morphs }) {
  if (morphs.length === 0 || box.isEmpty()) {
    return box;
  }
  const influences = influencesOf(object);
  const isRelative = object.geometry.morphTargetsRelative;
  const result = box.clone();
  if (!isRelative) {
    // position = base · (1 - sum) + sum of target · influence
    const sums = influences.reduce(([low, high], range) => [low + range[0], high + range[1]], [0, 0]);
    result.min.set(0, 0, 0);
    result.max.set(0, 0, 0);
    const part = new Box3(new Vector3(), new Vector3());
    addShare(part, box, 1 - sums[1]);
    const other = new Box3(new Vector3(), new Vector3());
    addShare(other, box, 1 - sums[0]);
    result.copy(part.union(other));
  }
  morphs.forEach((target, index) => {
    const [low, high] = influences[index] ?? [0, 0];
    if (target.isEmpty() || (low === 0 && high === 0)) {
      return;
    }
    const part = new Box3(new Vector3(), new Vector3());
    addShare(part, target, low);
    const other = new Box3(new Vector3(), new Vector3());
    addShare(other, target, high);
    part.union(other);
    addShare(result, part, 1);
  });
  return result;
}

/** Returns the greatest distance that displacement maps move an object's vertices. */
function displacementOf(object) {
  let most = 0;
  for (const material of [object.material].flat()) {
    if (material?.displacementMap) {
      const { displacementScale: scale, displacementBias: bias } = material;
      most = Math.max(most, Math.abs(bias), Math.abs(bias + scale));
    }
  }
  return most;
}

/**
 * Adds the box of a moved box to a target: its middle moves, and its half size grows by the matrix's absolute values.
 * Returns whether the result is finite.
 * @param {number[] | Float32Array | Float64Array} m Column-major matrix.
 * @param {number} at Index of its first element.
 */
export function addMoved(target, { min, max }, m, at = 0) {
  const [x, y, z] = [(min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2];
  const [a, b, c] = [(max.x - min.x) / 2, (max.y - min.y) / 2, (max.z - min.z) / 2];
  const px = m[at] * x + m[at + 4] * y + m[at + 8] * z + m[at + 12];
  const py = m[at + 1] * x + m[at + 5] * y + m[at + 9] * z + m[at + 13];
  const pz = m[at + 2] * x + m[at + 6] * y + m[at + 10] * z + m[at + 14];
  const sx = Math.abs(m[at]) * a + Math.abs(m[at + 4]) * b + Math.abs(m[at + 8]) * c;
  const sy = Math.abs(m[at + 1]) * a + Math.abs(m[at + 5]) * b + Math.abs(m[at + 9]) * c;
  const sz = Math.abs(m[at + 2]) * a + Math.abs(m[at + 6]) * b + Math.abs(m[at + 10]) * c;
  if (!Number.isFinite(px + py + pz + sx + sy + sz)) {
    return false;
  }
  target.min.set(Math.min(target.min.x, px - sx), Math.min(target.min.y, py - sy), Math.min(target.min.z, pz - sz));
  target.max.set(Math.max(target.max.x, px + sx), Math.max(target.max.y, py + sy), Math.max(target.max.z, pz + sz));
  return true;
}

/** Returns the box of all instances of a box. Instances that are not finite are not drawn, so they do not count. */
function instanced(box, { count, instanceMatrix }) {
  const all = new Box3();
  for (let index = 0; index < count && !box.isEmpty(); index += 1) {
    addMoved(all, box, instanceMatrix.array, 16 * index);
  }
  return all;
}

/**
 * Returns the box of an object in its own space. It is empty for objects without vertices. Skinned meshes have no such box
 * (see `skinnedBox`).
 */
export function localBox(object) {
  if (object.isBatchedMesh) {
    object.computeBoundingBox();
    return object.boundingBox;
  }
  const bounds = boundsOf(object.geometry);
  let box = morphed(bounds.box, object, bounds);
  const displacement = displacementOf(object);
  if (displacement > 0 && !box.isEmpty()) {
    box = box.clone().expandByScalar(displacement);
  }
  if (object.isInstancedMesh) {
    box = instanced(box, object);
  }
  if (object.boundingSphere && box.isEmpty()) {
    box = object.boundingSphere.getBoundingBox(new Box3());
  }
  return box;
}

/**
 * @typedef {object} Skin Boxes of the vertices of each bone, in the mesh's space.
 * @property {Box3[]} boxes
 * @property {boolean} isMean Whether the weights of each vertex sum to 1.
 * @property {unknown[]} stamp
 */

/** @type {WeakMap<import('three').BufferGeometry, Skin>} */
const skins = new WeakMap();

/** Returns the boxes of the vertices of each bone of a geometry. */
function skinOf({ geometry, skeleton }) {
  const { position, skinIndex, skinWeight } = geometry.attributes;
  const stamp = [position, versionOf(position), skinIndex, versionOf(skinIndex), skinWeight, versionOf(skinWeight)];
  const known = skins.get(geometry);
  if (known && isSame(known.stamp, stamp)) {
    return known;
  }
  const boxes = Array.from({ length: skeleton.bones.length }, () => new Box3());
  let isMean = true;
  for (let index = 0; index < position.count; index += 1) {
    point.fromBufferAttribute(position, index);
    let sum = 0;
    for (let slot = 0; slot < 4; slot += 1) {
      const weight = skinWeight.getComponent(index, slot);
      sum += weight;
      if (weight !== 0) {
        boxes[skinIndex.getComponent(index, slot)]?.expandByPoint(point);
      }
    }
    isMean &&= Math.abs(sum - 1) <= WEIGHT_ERROR;
  }
  const skin = { boxes, isMean, stamp };
  skins.set(geometry, skin);
  return skin;
}

/**
 * Computes the box of a skinned mesh in the world, for the present pose of its bones. Returns whether it is finite.
 * @param {import('three').SkinnedMesh} mesh
 * @param {Box3} target
 */
export function skinnedBox(mesh, target) {
  const { skeleton, bindMatrix, bindMatrixInverse, matrixWorld } = mesh;
  const skin = skinOf(mesh);
  target.makeEmpty();
  if (!skin.isMean) {
    mesh.computeBoundingBox();
    return addMoved(target, mesh.boundingBox, matrixWorld.elements);
  }
  let isFinite = true;
  const bounds = boundsOf(mesh.geometry);
  const displacement = displacementOf(mesh);
  const part = new Box3();
  skin.boxes.forEach((box, index) => {
    const bone = skeleton.bones[index];
    if (box.isEmpty() || !bone) {
      return;
    }
    matrix.copy(matrixWorld).multiply(bindMatrixInverse).multiply(bone.matrixWorld)
      .multiply(skeleton.boneInverses[index]).multiply(bindMatrix);
    part.copy(morphed(box, mesh, bounds)).expandByScalar(displacement);
    isFinite &&= addMoved(target, part, matrix.elements);
  });
  // Weights are stored with few digits.
  target.expandByScalar(WEIGHT_ERROR * target.min.distanceTo(target.max));
  return isFinite;
}
