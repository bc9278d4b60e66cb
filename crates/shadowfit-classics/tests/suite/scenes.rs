//! Scenes of a few quadrilaterals, and pictures of them with ambient occlusion.

use glam::{DVec3, Vec2, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit_classics::occlusion::{
    OcclusionFrame, OcclusionLight, OcclusionPasses, OcclusionSettings, OcclusionView,
};
use shadowfit_render::{Gpu, GpuScene, RenderTarget, Renderer};
use shadowfit_scene::{Material, Mesh, Node, Primitive, Scene};
use shadowfit_testing::renderer_gpu;
use shadowfit_wgpu::ShadowMapDescriptor;

/// Width and height of the pictures, in pixels.
pub(crate) const SIZE: [u32; 2] = [128, 96];

/// Returns a scene of white quadrilaterals from their corners, counter-clockwise seen from the front.
pub(crate) fn scene(quads: &[[Vec3; 4]]) -> Scene {
    let mut primitive = Primitive::default();
    for (first, quad) in (0..).step_by(4).zip(quads) {
        let [a, b, c, _] = *quad;
        let normal = (b - a).cross(c - a).normalize();
        primitive.positions.extend(quad);
        primitive.normals.extend([normal; 4]);
        primitive.uvs.extend([Vec2::ZERO; 4]);
        primitive.indices.extend([0, 1, 2, 0, 2, 3].map(|corner: u32| first + corner));
    }
    let meshes =
        if quads.is_empty() { Vec::new() } else { vec![Mesh { primitives: vec![primitive], ..Mesh::default() }] };
    let nodes = (0..meshes.len()).map(|mesh| Node { mesh: Some(mesh), ..Node::default() }).collect();
    Scene { nodes, meshes, materials: vec![Material::default()], ..Scene::default() }
}

/// Returns a floor at height 0, 40 m wide.
pub(crate) fn floor() -> [Vec3; 4] {
    [(-20.0, 20.0), (20.0, 20.0), (20.0, -20.0), (-20.0, -20.0)].map(|(x, z)| Vec3::new(x, 0.0, z))
}

/// Returns a wall across the floor that faces +z.
pub(crate) fn wall(z: f32) -> [Vec3; 4] {
    [(-20.0, 0.0), (20.0, 0.0), (20.0, 10.0), (-20.0, 10.0)].map(|(x, y)| Vec3::new(x, y, z))
}

/// Returns a box of the given half width at the origin, without a bottom.
pub(crate) fn cube(half: f32) -> Vec<[Vec3; 4]> {
    let side = |turn: f32| {
        let place = glam::Quat::from_rotation_y(turn);
        [(-1.0, 0.0), (1.0, 0.0), (1.0, 2.0), (-1.0, 2.0)].map(|(x, y)| place * Vec3::new(x, y, 1.0) * half)
    };
    let top = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, z)| Vec3::new(x, 2.0, z) * half);
    let quarter = core::f32::consts::FRAC_PI_2;
    let mut quads: Vec<_> = (0..4).map(|index| side(index as f32 * quarter)).collect();
    quads.push(top);
    quads
}

/// Returns a camera that looks down at the origin at an angle.
pub(crate) fn camera() -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(0.0, 3.0, 5.0),
        forward: Vec3::new(0.0, -3.0, -5.0),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 100.0,
    }
}

/// A scene and its renderer.
pub(crate) struct Pictures {
    pub(crate) gpu: Gpu,
    pub(crate) renderer: Renderer,
    pub(crate) scene: GpuScene,
    pub(crate) passes: OcclusionPasses,
    pub(crate) target: RenderTarget,
}

impl Pictures {
    pub(crate) fn new(quads: &[[Vec3; 4]], samples: u32) -> Self {
        let gpu = renderer_gpu();
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), 1).expect("a renderer");
        let layout = renderer.material_layout();
        let scene = scene(quads);
        let scene = GpuScene::new(&gpu, layout, &scene, &scene.pose(None, 0.0)).expect("memory");
        let passes = OcclusionPasses::new(&gpu, samples);
        let target = RenderTarget::new(&gpu.device, SIZE, samples);
        Self { gpu, renderer, scene, passes, target }
    }

    pub(crate) fn draw(&mut self, camera: &PerspectiveCamera, frame: &OcclusionFrame) -> Vec<[u8; 3]> {
        self.passes.draw(&self.gpu, &mut self.scene, frame, camera, None, &self.target);
        self.read()
    }

    pub(crate) fn read(&self) -> Vec<[u8; 3]> {
        let bytes = self.target.read(&self.gpu).expect("pixels");
        bytes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
    }

    pub(crate) fn occlusion(&mut self, camera: &PerspectiveCamera, settings: OcclusionSettings) -> Vec<f32> {
        self.draw(camera, &frame(Some(settings)));
        pollster::block_on(self.passes.read_occlusion(&self.gpu)).expect("occlusion")
    }
}

/// Returns the frame of a picture in display values on black.
pub(crate) fn frame(settings: Option<OcclusionSettings>) -> OcclusionFrame {
    OcclusionFrame {
        light: OcclusionLight::new(Vec3::new(0.0, 0.8, 0.6)),
        settings,
        view: OcclusionView::Classic,
        background: Vec3::ZERO,
    }
}
