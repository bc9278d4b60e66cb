// A program with the public names of `shadowfit/three`. The type check of the tests reads it.

import { PerspectiveCamera, Scene, Vector2, WebGLRenderer } from 'three';
import { SunLight } from 'three/addons/lights/SunLight.js';
import {
  ShadowfitHelper, ShadowfitShadow, type MapReport, type ShadowfitOptions, type ShadowfitReport,
} from '../src/three.js';

const options: ShadowfitOptions = { maps: 4, mapSize: 2048, distance: 200, lookUp: 'coverage', demand: 'auto' };
const sun = new SunLight(0xffffff, 3);
const shadow = new ShadowfitShadow(options);
sun.castShadow = true;
sun.shadow = shadow;
shadow.distance = Infinity;
shadow.mapSize.set(1024, 1024);
shadow.mapSize = new Vector2(512, 512);
shadow.radius = 2;
shadow.intensity = 0.5;
shadow.autoUpdate = false;
shadow.needsUpdate = true;

const scene = new Scene();
const helper: ShadowfitHelper = new ShadowfitHelper(sun);
scene.add(sun, helper);
new WebGLRenderer().render(scene, new PerspectiveCamera());

const report: ShadowfitReport = shadow.report();
const finest: MapReport | undefined = report.maps[0];
const pixels: number | undefined = finest?.pixelsPerTexel;
const error: string | undefined = report.error;
console.log(pixels, error, report.isKept, report.passes, finest?.texelSize[0], finest?.use, finest?.casters);

const copy: ShadowfitShadow = shadow.clone();
copy.dispose();
helper.dispose();
// @ts-expect-error The look-up has two values.
new ShadowfitShadow({ lookUp: 'magic' });
