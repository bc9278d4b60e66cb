// A program with the public names of `shadowfit/three/webgpu` and of the fitter. The type check of the tests reads it.

import { DirectionalLight, Scene } from 'three/webgpu';
import { ShadowfitHelper, ShadowfitShadow } from '../src/three-webgpu.js';
import { FitError, SunFitter, type FittedMap, type FitterView } from '../src/windows.js';

const sun = new DirectionalLight(0xffffff, 3);
const shadow = new ShadowfitShadow({ maps: 8, mapSize: 1024, distance: 200, demand: 'boxes' });
shadow.distance = 100;
shadow.radius = 2;
const scene = new Scene();
scene.add(sun, new ShadowfitHelper(sun));
console.log(shadow.report().maps.length, shadow.report().passes);
shadow.dispose();

const fitter = new SunFitter({ maps: 4, filter: { taps: 2 }, bias: 'plane', depth: 'unorm24' });
const { bounds, flags } = fitter.boxes(1, [0, 0, 0]);
bounds.set([-1, -1, -1, 1, 1, 1]);
flags[0] = 3;
const view: FitterView = { eye: [0, 0, 5], worldFromClip: new Float64Array(16), depth: 'zero-to-one' };
try {
  const [finest]: FittedMap[] = fitter.fit([view], [0, -1, 0]);
  console.log(finest?.width, fitter.casters[0], fitter.keptCasters[0]);
} catch (error) {
  if (error instanceof FitError) {
    console.log(error.code);
  }
}
fitter.countDepths(new Float32Array(9), 3, view, [0, -1, 0]);
fitter.forgetDepths();
fitter.reset();
// @ts-expect-error The form of a bias has three values.
fitter.configure({ bias: 'magic' });
