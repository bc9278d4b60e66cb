// Runs the shadow fits of three.js and Babylon.js, as their packages have them, on the frames of a scenarios file, and
// writes a fit file for each.
//
//     node fit.mjs scenarios.json FOLDER [RESOLUTION]
import fs from 'node:fs';
import * as THREE from 'three';
import { CSM } from 'three/examples/jsm/csm/CSM.js';
import { SunLight } from 'three/examples/jsm/lights/SunLight.js';
import * as BABYLON from '@babylonjs/core/index.js';

const [scenariosFile, folder, resolutionText] = process.argv.slice(2);
const scenarios = JSON.parse(fs.readFileSync(scenariosFile, 'utf8'));
const resolution = Number(resolutionText ?? 2048);
const NO_END = 1e9; // the last map of a fit has no end
const babylonVersion = BABYLON.Engine.Version;

// Depth 0..1 from -1..1.
const halfDepth = new THREE.Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 1);

// The maps of matrices with the view depths where they end.
function maps(matrices, ends, texels) {
    return matrices.map((matrix, index) => ({
        view_proj: Array.from(matrix),
        resolution: texels,
        split_near: index === 0 ? 0 : ends[index - 1],
        split_far: index === matrices.length - 1 ? NO_END : ends[index],
    }));
}

function threeCamera(frame) {
    const camera = new THREE.PerspectiveCamera(frame.fov_y_deg, frame.aspect, frame.near, frame.far);
    const world = new THREE.Matrix4().fromArray(frame.view).invert();
    world.decompose(camera.position, camera.quaternion, camera.scale);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld(true);
    return camera;
}

function clipFromWorld(camera) {
    camera.updateMatrixWorld(true);
    camera.updateProjectionMatrix();
    const view = camera.matrixWorld.clone().invert();
    return halfDepth.clone().multiply(camera.projectionMatrix).multiply(view).elements;
}

function threeCsm(frame) {
    const camera = threeCamera(frame);
    const direction = new THREE.Vector3().fromArray(frame.light_dir);
    const parent = new THREE.Scene();
    const settings = { camera, parent, cascades: 4, maxFar: frame.far, mode: 'practical', shadowMapSize: resolution };
    const csm = new CSM({ ...settings, lightDirection: direction });
    csm.update();
    parent.updateMatrixWorld(true);
    const matrices = csm.lights.map((light) => {
        light.shadow.updateMatrices(light);
        return clipFromWorld(light.shadow.camera);
    });
    return maps(matrices, csm.breaks.map((part) => part * (frame.far - frame.near)), resolution);
}

function threeSunLight(frame) {
    const camera = threeCamera(frame);
    const sun = new SunLight();
    sun.position.fromArray(frame.light_dir).negate();
    sun.updateMatrixWorld(true);
    sun.shadow.mapSize.set(resolution, resolution);
    sun.shadow.updateMatrices(sun, camera);
    const cascades = sun.shadow._cascadeData;
    const texels = Math.round(resolution * sun.shadow._viewports[0].z);
    const matrices = cascades.map((_, index) => clipFromWorld(sun.shadow.getCamera(index)));
    return maps(matrices, cascades.map((data) => data.y), texels);
}

// A Babylon.js scene with one box per object, without a screen.
function babylonFit(isStable) {
    const engine = new BABYLON.NullEngine();
    // Fits need no textures, which this engine does not have.
    engine._features.supportCSM = true;
    engine._createDepthStencilTexture = () => new BABYLON.InternalTexture(engine, BABYLON.InternalTextureSource.DepthStencil);
    const scene = new BABYLON.Scene(engine);
    scene.useRightHandedSystem = true;
    const light = new BABYLON.DirectionalLight('sun', new BABYLON.Vector3(0, -1, 0), scene);
    const camera = new BABYLON.FreeCamera('camera', BABYLON.Vector3.Zero(), scene);
    const generator = new BABYLON.CascadedShadowGenerator(resolution, light, false, camera);
    generator.numCascades = 4;
    generator.stabilizeCascades = isStable;
    generator.depthClamp = true;
    generator.freezeShadowCastersBoundingInfo = true;
    let current = -1;
    return (frame) => {
        if (frame.scene !== current) {
            current = frame.scene;
            const box = scenarios.scenes[current].aabb;
            const [low, high] = [BABYLON.Vector3.FromArray(box, 0), BABYLON.Vector3.FromArray(box, 3)];
            generator.shadowCastersBoundingInfo = new BABYLON.BoundingInfo(low, high);
        }
        light.direction = BABYLON.Vector3.FromArray(frame.light_dir);
        const view = BABYLON.Matrix.FromArray(frame.view);
        camera.minZ = frame.near;
        camera.maxZ = frame.far;
        camera.fov = (frame.fov_y_deg * Math.PI) / 180;
        camera.getViewMatrix = () => view;
        const projection = new BABYLON.Matrix();
        BABYLON.Matrix.PerspectiveFovRHToRef(camera.fov, frame.aspect, frame.near, frame.far, projection, true, false);
        camera.getProjectionMatrix = () => projection;
        camera.getTransformationMatrix = () => view.multiply(projection);
        generator.shadowMaxZ = frame.far;
        generator._splitFrustum();
        generator._computeMatrices();
        const matrices = [0, 1, 2, 3].map((index) => {
            const clip = new THREE.Matrix4().fromArray(generator.getCascadeTransformMatrix(index).asArray());
            return halfDepth.clone().multiply(clip).elements;
        });
        return maps(matrices, [0, 1, 2, 3].map((index) => generator._viewSpaceFrustumsZ[index]), resolution);
    };
}

const fits = [
    ['three-csm', `three r${THREE.REVISION}`, false, threeCsm],
    ['three-sunlight', `three r${THREE.REVISION}`, false, threeSunLight],
    ['babylon-stable', `babylonjs ${babylonVersion}`, true, babylonFit(true)],
    ['babylon-tight', `babylonjs ${babylonVersion}`, true, babylonFit(false)],
];
fs.mkdirSync(folder, { recursive: true });
for (const [peer, version, pancake, fit] of fits) {
    const frames = scenarios.frames.map((frame) => ({ id: frame.id, maps: fit(frame) }));
    const language = `JavaScript (Node ${process.versions.node})`;
    const file = { peer, language, version, note: 'default settings', pancake, frames };
    fs.writeFileSync(`${folder}/${peer}.json`, JSON.stringify(file));
    console.log(`${peer}: ${frames.length} frames`);
}
process.exit(0);
