// Draws casters into layers of the maps.
//
// A pass renders a separate scene, whose children are the highest casters. So the pass visits only casters and their
// descendants. It visits no lights, no levels of detail, which would follow the map's camera, and no render bundles, which
// would draw the casters of the pass that recorded them.

import { Box3, DoubleSide, OrthographicCamera, RendererUtils, Scene, Vector3 } from 'three/webgpu';

const region = new Box3();
const corner = new Vector3();

/** Draws the passes of one sun. */
export class Passes {
  constructor() {
    this.scene = new Scene();
    this.scene.name = 'shadowfit casters';
    this.scene.matrixWorldAutoUpdate = false;
    /** One camera per layer, since the renderer keeps a render list per camera. @type {OrthographicCamera[]} */
    this.cameras = [];
    this.state = {};
    /** Number of passes of the latest frame. */
    this.count = 0;
  }

  /**
   * Draws with the renderer's state for shadow passes, and restores its state.
   * @param {import('three/webgpu').Renderer} renderer
   * @param {import('three/webgpu').NodeMaterial} material Material of the casters.
   * @param {() => void} draw
   */
  within(renderer, material, draw) {
    this.count = 0;
    this.state = RendererUtils.resetRendererState(renderer, this.state);
    this.scene.overrideMaterial = material;
    // Both faces in one draw.
    material.forceSinglePass = true;
    renderer.setClearColor(0x000000, 0);
    try {
      draw();
    } finally {
      this.scene.children.length = 0;
      RendererUtils.restoreRendererState(renderer, this.state);
    }
  }

  /**
   * Draws rows of a scan into a layer.
   * @param {import('three/webgpu').Renderer} renderer
   * @param {import('three').RenderTarget} target
   * @param {number} layer
   * @param {import('../fitter.d.ts').FittedMap} map
   * @param {{ scan: import('../three/scan.js').SceneScan, rows: Uint8Array, view: import('three').Camera, casting:
   * import('three').Layers, isOver: boolean }} casters `isOver` draws over the layer's content.
   */
  draw(renderer, target, layer, map, { scan, rows, view, casting, isOver }) {
    const camera = this.camera(layer, map, renderer);
    camera.layers.mask = casting.mask;
    this.scene.children = rootsOf(scan, rows);
    renderer.autoClear = !isOver;
    renderer.setRenderObjectFunction((object, scene, shadowCamera, geometry, material, group, ...rest) => {
      const row = scan.entries.get(object)?.row ?? -1;
      if (object.castShadow && rows[row] === 1) {
        const { overrideMaterial } = scene;
        object.onBeforeShadow(renderer, object, view, shadowCamera, geometry, overrideMaterial, group);
        withAllFaces(material, () => {
          renderer.renderObject(object, scene, shadowCamera, geometry, material, group, ...rest);
        });
        object.onAfterShadow(renderer, object, view, shadowCamera, geometry, overrideMaterial, group);
      }
    });
    renderer.setRenderTarget(target, layer);
    renderer.render(this.scene, camera);
    this.count += 1;
  }

  /** Returns the camera of a layer, over a map. */
  camera(layer, { x, y, z, position: p, width, height, depthRange }, renderer) {
    const camera = this.cameras[layer] ??= new OrthographicCamera();
    camera.matrixAutoUpdate = false;
    camera.matrixWorldAutoUpdate = false;
    camera.matrix.set(x[0], y[0], z[0], p[0], x[1], y[1], z[1], p[1], x[2], y[2], z[2], p[2], 0, 0, 0, 1);
    camera.matrix.decompose(camera.position, camera.quaternion, camera.scale);
    camera.matrixWorld.copy(camera.matrix);
    camera.matrixWorldInverse.copy(camera.matrixWorld).invert();
    [camera.left, camera.right, camera.bottom, camera.top] = [-width / 2, width / 2, -height / 2, height / 2];
    [camera.near, camera.far] = [0, depthRange];
    camera.coordinateSystem = renderer.coordinateSystem;
    camera._reversedDepth = renderer.reversedDepthBuffer === true;
    camera.updateProjectionMatrix();
    return camera;
  }

  /** Copies a whole layer between textures of the same size. */
  copy(renderer, from, to, layer) {
    const { width, height } = from.image;
    region.min.set(0, 0, layer);
    region.max.set(width, height, layer + 1);
    renderer.copyTextureToTexture(from, to, region, corner.set(0, 0, layer));
  }
}

/**
 * Draws with all faces of a material that states none for shadows. three.js would draw only the faces that its materials
 * hide, and light would leak in where these touch the ground. The fitter's biases allow for all faces.
 * @param {import('three').Material} material
 */
function withAllFaces(material, draw) {
  const { shadowSide } = material;
  material.shadowSide ??= DoubleSide;
  try {
    draw();
  } finally {
    material.shadowSide = shadowSide;
  }
}

/**
 * Returns the highest casters of the rows. Others are their descendants. A caster inside a clipping group is drawn through
 * that group, which clips it.
 */
function rootsOf(scan, rows) {
  const isListed = (object) => rows[scan.entries.get(object)?.row ?? -1] === 1;
  const roots = new Set();
  rows.forEach((isDrawn, row) => {
    const object = scan.rows[row]?.object;
    if (isDrawn !== 1 || object === undefined) {
      return;
    }
    let root = object;
    for (let parent = object.parent; parent !== null; parent = parent.parent) {
      root = parent.isClippingGroup || isListed(parent) ? parent : root;
    }
    roots.add(root);
  });
  return [...roots];
}
