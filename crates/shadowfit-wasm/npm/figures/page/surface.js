// Surface points that pixels show: intersections of their rays with the planes of the visible triangles.

import { pixelRays } from './camera.js';

/**
 * Computes the points of the pixels that face the light, up to the far plane, in world space and double precision.
 *
 * @param {import('./camera.js').Frame} frame
 * @param {[number, number]} size - Width and height of the picture, in pixels.
 * @param {Float32Array} corners - World-space corners, nine numbers per triangle.
 * @param {Float32Array} triangles - Number of the visible triangle at each pixel, or -1.
 */
export function surfacePoints(frame, size, corners, triangles) {
  const rays = pixelRays(frame, size);
  const [pixels, facing, positions, normals] = [[], [], [], []];
  const ray = [0, 0, 0];
  for (let pixel = 0; pixel < triangles.length; pixel += 1) {
    if (triangles[pixel] < 0) {
      continue;
    }
    rays.direction(pixel % size[0], Math.floor(pixel / size[0]), ray);
    const { normal, depth } = surface(corners.subarray(9 * triangles[pixel], 9 * triangles[pixel] + 9), rays, ray);
    const cosine = -dot(normal, frame.light_dir);
    if (cosine > 0 && depth <= frame.far) {
      pixels.push(pixel);
      facing.push(cosine);
      normals.push(normal[0], normal[1], normal[2]);
      positions.push(rays.eye[0] + depth * ray[0], rays.eye[1] + depth * ray[1], rays.eye[2] + depth * ray[2]);
    }
  }
  return {
    pixels: Uint32Array.from(pixels),
    facing: Float32Array.from(facing),
    positions: Float64Array.from(positions),
    normals: Float64Array.from(normals),
  };
}

/**
 * Returns the unit normal of a triangle on the side of the eye, and the view depth at which a ray meets its plane. The
 * depth is clamped to the range of the corners, because a ray can meet the plane of an edge-on sliver anywhere.
 */
function surface(corners, { eye, forward }, ray) {
  const a = [corners[0] - eye[0], corners[1] - eye[1], corners[2] - eye[2]];
  const b = [corners[3] - eye[0], corners[4] - eye[1], corners[5] - eye[2]];
  const c = [corners[6] - eye[0], corners[7] - eye[1], corners[8] - eye[2]];
  const [ux, uy, uz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const [vx, vy, vz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
  const cross = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const slope = dot(cross, ray);
  const scale = (slope > 0 ? -1 : 1) / Math.hypot(cross[0], cross[1], cross[2]);
  const depths = [dot(a, forward), dot(b, forward), dot(c, forward)];
  const met = slope === 0 ? depths[0] : dot(cross, a) / slope;
  return {
    normal: [cross[0] * scale, cross[1] * scale, cross[2] * scale],
    depth: Math.min(Math.max(met, Math.min(...depths)), Math.max(...depths)),
  };
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
