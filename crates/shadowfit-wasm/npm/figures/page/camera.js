// Cameras of frames.

import { Matrix4, PerspectiveCamera } from 'three';

/**
 * A view of a scene under one sun. World space is right-handed with y up, in metres.
 *
 * @typedef {object} Frame
 * @property {string} id - Scene, elevation and number, such as `town/45/7`.
 * @property {number} elevation_deg - Elevation of the sun, in degrees.
 * @property {number} frame - Number along the path. Frames of one elevation are consecutive.
 * @property {number[]} view - View-from-world matrix, column-major. The camera looks along -z.
 * @property {number} fov_y_deg - Vertical field of view, in degrees.
 * @property {number} aspect - Width divided by height.
 * @property {number} near - View depth of the near plane, in metres.
 * @property {number} far - View depth of the far plane, in metres. It is also the shadow distance.
 * @property {number[]} light_dir - Unit direction in which the light travels.
 */

/**
 * Moves a camera to a frame.
 *
 * @param {PerspectiveCamera} camera
 * @param {Frame} frame
 */
export function moveCamera(camera, frame) {
  camera.fov = frame.fov_y_deg;
  camera.aspect = frame.aspect;
  camera.near = frame.near;
  camera.far = frame.far;
  camera.updateProjectionMatrix();
  new Matrix4().fromArray(frame.view).invert().decompose(camera.position, camera.quaternion, camera.scale);
  camera.updateMatrixWorld(true);
}

/**
 * Returns a camera that shows the picture of a frame, but uses the view space of the frame before. A renderer that
 * selects shadow maps by view depth then makes the selection of the frame before.
 *
 * @param {Frame} frame
 * @param {Frame} before
 * @returns {PerspectiveCamera}
 */
export function cameraInViewSpaceOf(frame, before) {
  const [now, then, shown] = [new PerspectiveCamera(), new PerspectiveCamera(), new PerspectiveCamera()];
  moveCamera(now, frame);
  moveCamera(then, before);
  shown.copy(then);
  shown.matrixAutoUpdate = shown.matrixWorldAutoUpdate = false;
  shown.matrixWorld.copy(then.matrixWorld);
  shown.matrixWorldInverse.copy(then.matrixWorldInverse);
  shown.projectionMatrix.multiplyMatrices(now.projectionMatrix, now.matrixWorldInverse).multiply(then.matrixWorld);
  shown.projectionMatrixInverse.copy(shown.projectionMatrix).invert();
  return shown;
}

/**
 * Returns the rays of a frame's pixels. `direction` has the view depth 1, so that a ray parameter is a view depth.
 *
 * @param {Frame} frame
 * @param {[number, number]} size - Width and height of the picture, in pixels.
 */
export function pixelRays(frame, [width, height]) {
  const { elements: world } = new Matrix4().fromArray(frame.view).invert();
  const tangent = Math.tan(frame.fov_y_deg * Math.PI / 360);
  return {
    eye: [world[12], world[13], world[14]],
    forward: [-world[8], -world[9], -world[10]],
    /** Writes the direction of the pixel in a column and a row, counted from the bottom, into `out`. */
    direction(column, row, out) {
      const x = (2 * (column + 0.5) / width - 1) * tangent * frame.aspect;
      const y = (2 * (row + 0.5) / height - 1) * tangent;
      for (let axis = 0; axis < 3; axis += 1) {
        out[axis] = world[axis] * x + world[4 + axis] * y - world[8 + axis];
      }
    },
  };
}

/**
 * Returns a function that tells whether a view holds a point, given by a list of coordinates and an offset into it.
 *
 * @param {Frame} frame
 * @returns {(positions: ArrayLike<number>, offset: number) => boolean}
 */
export function inView(frame) {
  const { view } = frame;
  const top = Math.tan(frame.fov_y_deg * Math.PI / 360);
  const along = (axis, positions, offset) => view[axis] * positions[offset] + view[4 + axis] * positions[offset + 1]
    + view[8 + axis] * positions[offset + 2] + view[12 + axis];
  return (positions, offset) => {
    const depth = -along(2, positions, offset);
    return depth >= frame.near && depth <= frame.far
      && Math.abs(along(0, positions, offset)) <= depth * top * frame.aspect
      && Math.abs(along(1, positions, offset)) <= depth * top;
  };
}
