// Camera paths around a target, like a user who drags orbit controls.

import { MathUtils, PerspectiveCamera, Vector3 } from 'three';

/** Number of frames of a path. */
const FRAMES = 20;
/** Turn of the camera around its target, in degrees per frame: 72 degrees a second at 60 frames a second. */
const TURN = 1.2;
/** Greatest angle between the view and the target, in degrees. */
const SWING = 10;
/** Elevations of the two suns, in degrees. */
const ELEVATIONS = [20, 55];
/** Azimuth of the suns, in degrees. */
const AZIMUTH = 37;

/**
 * Returns the frames of a path under two suns. The camera orbits the target, while its view swings to both sides.
 *
 * @param {object} path
 * @param {string} path.name - Name of the scene.
 * @param {[number, number, number]} path.eye - Position of the camera in the middle of the path.
 * @param {[number, number, number]} path.target
 * @param {number} path.fov - Vertical field of view, in degrees.
 * @param {number} path.near
 * @param {number} path.far
 * @returns {import('../page/camera.js').Frame[]}
 */
export function orbit({ name, eye, target, fov, near, far }) {
  return ELEVATIONS.flatMap((elevation) => Array.from({ length: FRAMES }, (_, frame) => ({
    id: `${name}/${elevation}/${frame}`,
    elevation_deg: elevation,
    frame,
    view: view(new Vector3(...eye), new Vector3(...target), frame),
    fov_y_deg: fov,
    aspect: 16 / 9,
    near,
    far,
    light_dir: sunAt(elevation).negate().toArray(),
  })));
}

function view(eye, target, frame) {
  const up = new Vector3(0, 1, 0);
  const camera = new PerspectiveCamera();
  const turn = MathUtils.degToRad(TURN * (frame - (FRAMES - 1) / 2));
  camera.position.copy(eye).sub(target).applyAxisAngle(up, turn).add(target);
  camera.lookAt(target);
  camera.rotateOnWorldAxis(up, MathUtils.degToRad(SWING) * Math.sin(2 * Math.PI * frame / FRAMES));
  camera.updateMatrixWorld();
  return camera.matrixWorldInverse.toArray();
}

/** Returns the unit direction toward the sun. */
function sunAt(elevation) {
  const [height, side] = [MathUtils.degToRad(elevation), MathUtils.degToRad(AZIMUTH)];
  return new Vector3(Math.cos(height) * Math.cos(side), Math.sin(height), Math.cos(height) * Math.sin(side));
}
