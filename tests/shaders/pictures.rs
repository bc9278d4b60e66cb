//! Pictures of the built-in scene by the samples' renderer, for tests of its views.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{FittedMap, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::{Atmosphere, Frame, Gpu, GpuScene, Probe, ProbeTargets, RenderTarget, Renderer, Statistics};
use shadowfit_scene::builtin::{default_camera, default_scene};
use shadowfit_scene::{Scene, Triangle};
use shadowfit_study::{PreparedScene, View};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::support::software_gpu;

/// Size of the pictures, in pixels.
pub(super) const SIZE: [u32; 2] = [160, 90];

/// A scene and what draws it.
pub(super) struct Pictures {
    pub(super) gpu: Gpu,
    pub(super) renderer: Renderer,
    pub(super) scene: GpuScene,
    pub(super) target: RenderTarget,
    pub(super) triangles: Vec<Triangle>,
}

/// A view with the maps of a technique.
pub(super) struct Seen {
    pub(super) camera: PerspectiveCamera,
    pub(super) direction: Vec3,
    pub(super) technique: Technique,
    pub(super) fitted: FittedMaps,
    pub(super) maps: Vec<FittedMap>,
    pub(super) atmosphere: Atmosphere,
}

pub(super) fn camera() -> PerspectiveCamera {
    let (eye, target) = default_camera();
    PerspectiveCamera {
        eye: eye.as_dvec3(),
        forward: (target - eye).normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 120.0,
    }
}

impl Seen {
    /// The default camera's view under a low sun.
    pub(super) fn new(gpu: &Gpu, technique: &Technique, scene: Scene) -> Self {
        Self::walked(gpu, technique, scene, camera(), DVec3::ZERO)
    }

    /// The same, for a camera after a step.
    pub(super) fn walked(
        gpu: &Gpu,
        technique: &Technique,
        scene: Scene,
        camera: PerspectiveCamera,
        step: DVec3,
    ) -> Self {
        let camera = PerspectiveCamera { eye: camera.eye + step, ..camera };
        let direction = Vec3::new(0.45, -0.55, -0.35).normalize();
        let renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(technique), 1).expect("a renderer");
        let prepared = PreparedScene::new(gpu, renderer.material_layout(), scene).expect("a scene");
        let view = View { camera, direction, is_first: true };
        let fitted = prepared.fit_next(&mut ShadowFitter::new(technique), Inputs::default(), &view).expect("maps");
        let (maps, atmosphere) = (fitted.to_vec(), Atmosphere::default());
        Self { camera, direction, technique: *technique, fitted, maps, atmosphere }
    }

    pub(super) fn frame(&self) -> Frame<'_> {
        Frame::new(&self.camera, self.direction, &self.maps, &self.atmosphere)
    }
}

impl Pictures {
    /// The built-in scene with a technique's maps, in pictures of so many samples per pixel.
    pub(super) fn new(technique: &Technique, samples: u32) -> (Self, Seen) {
        Self::of(technique, samples, default_scene())
    }

    pub(super) fn of(technique: &Technique, samples: u32, scene: Scene) -> (Self, Seen) {
        let gpu = software_gpu();
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::from(technique), samples).expect("a renderer");
        let pose = scene.pose(None, 0.0);
        let triangles = pose.triangles(&scene);
        let gpu_scene = GpuScene::new(&gpu, renderer.material_layout(), &scene, &pose).expect("memory");
        let target = renderer.target(&gpu, SIZE);
        let seen = Seen::new(&gpu, technique, scene);
        (Self { gpu, renderer, scene: gpu_scene, target, triangles }, seen)
    }

    pub(super) fn draw(&mut self, frame: &Frame<'_>) -> Statistics {
        self.renderer.draw(&self.gpu, &mut self.scene, frame, &self.target).expect("a frame")
    }

    /// The sRGB pixels of a frame.
    pub(super) fn picture(&mut self, frame: &Frame<'_>) -> Vec<[u8; 3]> {
        self.draw(frame);
        self.read()
    }

    /// Those of what was drawn last.
    pub(super) fn read(&self) -> Vec<[u8; 3]> {
        let bytes = self.target.read(&self.gpu).expect("pixels");
        bytes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
    }

    pub(super) fn probe(&mut self, frame: &Frame<'_>) -> Probe {
        let targets = ProbeTargets::new(&self.gpu.device, SIZE);
        self.renderer.probe(&self.gpu, &mut self.scene, frame, &targets).expect("a probe")
    }

    /// Where the ray through a pixel's middle meets a triangle, relative to the eye, and the triangle's normal.
    pub(super) fn point(&self, camera: &PerspectiveCamera, pixel: usize, triangle: u32) -> (DVec3, DVec3) {
        let [a, b, c] = self.triangles[triangle as usize].vertices.map(|vertex| vertex.as_dvec3() - camera.eye);
        let normal = (b - a).cross(c - a).normalize();
        let ray = ray(camera, pixel);
        (ray * (normal.dot(a) / normal.dot(ray)), normal)
    }
}

/// The direction through a pixel's middle, of length 1 along the view.
fn ray(camera: &PerspectiveCamera, pixel: usize) -> DVec3 {
    let forward = camera.forward.as_dvec3().normalize();
    let right = forward.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize].map(|place| place as f64 + 0.5);
    let [u, v] = [x / f64::from(SIZE[0]) * 2.0 - 1.0, 1.0 - y / f64::from(SIZE[1]) * 2.0];
    let half_height = (f64::from(camera.fov_y) * 0.5).tan();
    forward + right * (u * half_height * f64::from(camera.aspect)) + up * (v * half_height)
}

/// Bits of a pixel of a judged picture: a class, and whether it is lit in truth.
pub(super) fn bits(class: u32, is_lit: bool) -> u32 {
    class | if is_lit { 8 } else { 0 }
}

/// A linear channel from an sRGB byte, and back without rounding.
pub(super) fn linear(byte: u8) -> f32 {
    let encoded = f32::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

pub(super) fn encoded(linear: f32) -> f32 {
    255.0 * if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Numbers that look random, below a bound.
pub(super) fn random(count: usize, below: u32) -> impl Iterator<Item = u32> {
    (0..count as u64).map(move |index| {
        let mixed = (index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        ((mixed ^ (mixed >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 33) as u32 % below
    })
}
