// Lines around the windows of a sun, coloured by map.

import { BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments, Matrix4, Vector3 } from 'three';

/** Colours of the maps, from the finest to the coarsest. They differ for colour-blind people too (P. Tol, "Colour
 * schemes", 2021: bright). */
const COLOURS = [[0.93, 0.4, 0.47], [0.8, 0.73, 0.27], [0.13, 0.53, 0.2], [0.27, 0.47, 0.67]];

/** Corners of the edges of a box, as bits of x, y and z. */
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7];

const matrix = new Matrix4();
const corner = new Vector3();

/** See `src/three.d.ts`. */
export class ShadowfitHelper extends LineSegments {
  /** @param {import('three').Light & { shadow: import('./ShadowfitShadow.js').ShadowfitShadow }} light */
  constructor(light) {
    const geometry = new BufferGeometry();
    const count = COLOURS.length * EDGES.length;
    geometry.setAttribute('position', new Float32BufferAttribute(3 * count, 3));
    geometry.setAttribute('color', new Float32BufferAttribute(COLOURS.flatMap((c) => EDGES.flatMap(() => c)), 3));
    super(geometry, new LineBasicMaterial({ vertexColors: true, toneMapped: false }));
    this.type = 'ShadowfitHelper';
    this.light = light;
    this.frustumCulled = false;
    this.castShadow = false;
    this.update();
  }

  /** Moves the lines to the present windows. three.js calls it in each frame. */
  update() {
    const windows = this.light.shadow?._drawn?.fit.maps ?? [];
    const { position } = this.geometry.attributes;
    let at = 0;
    windows.forEach(({ x, y, z, position: p, width, height, depthRange }) => {
      matrix.set(
        x[0] * width, y[0] * height, -z[0] * depthRange, p[0],
        x[1] * width, y[1] * height, -z[1] * depthRange, p[1],
        x[2] * width, y[2] * height, -z[2] * depthRange, p[2],
        0, 0, 0, 1,
      );
      for (const bits of EDGES) {
        corner.set((bits & 1) - 0.5, ((bits >> 1) & 1) - 0.5, bits >> 2).applyMatrix4(matrix);
        position.setXYZ(at, corner.x, corner.y, corner.z);
        at += 1;
      }
    });
    position.needsUpdate = true;
    this.geometry.setDrawRange(0, at);
  }

  updateMatrixWorld(force) {
    this.update();
    super.updateMatrixWorld(force);
  }

  dispose() {
    this.geometry.dispose();
    this.material.dispose();
  }
}
