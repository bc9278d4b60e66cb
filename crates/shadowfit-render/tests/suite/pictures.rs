//! A scene, a view of it with fitted maps, and the renderer that draws it.

use glam::{DVec3, Vec3};
use shadowfit::settings::FilterKind;
use shadowfit::{FitInput, FittedMap, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_render::{
    Atmosphere, Frame, Gpu, GpuScene, JudgedPicture, Marks, Overlay, PixelFacts, PixelQuery, Probe, ProbeTargets,
    RenderTarget, Renderer, Statistics, classes_texture,
};
use shadowfit_scene::builtin::{default_camera, default_scene};
use shadowfit_scene::{Scene, Triangle};
use shadowfit_testing::renderer_gpu;
use shadowfit_wgpu::ShadowMapDescriptor;

/// Size of the pictures, in pixels.
pub(crate) const SIZE: [u32; 2] = [160, 90];

/// The light's direction of travel: a low sun.
const SUNLIGHT: Vec3 = Vec3::new(0.45, -0.55, -0.35);

/// A scene on the GPU and its renderer.
pub(crate) struct Pictures {
    pub(crate) gpu: Gpu,
    pub(crate) renderer: Renderer,
    pub(crate) scene: GpuScene,
    pub(crate) target: RenderTarget,
    pub(crate) triangles: Vec<Triangle>,
}

/// A view with the maps of a technique.
pub(crate) struct Seen {
    pub(crate) camera: PerspectiveCamera,
    pub(crate) direction: Vec3,
    pub(crate) technique: Technique,
    pub(crate) fitted: FittedMaps,
    pub(crate) maps: Vec<FittedMap>,
    pub(crate) atmosphere: Atmosphere,
}

/// A scene and a view of it.
pub(crate) struct Stage {
    pub(crate) pictures: Pictures,
    pub(crate) seen: Seen,
}

/// Returns a technique for tests that do not depend on maps and their look-up. Software drivers compile the
/// look-up into one map in half a second, into four maps in four seconds and into eight in eleven, with wider
/// filters in more.
pub(crate) fn cheap_technique() -> Technique {
    Technique::default().with_count(1).with_resolution(256, 256).with_filter(FilterKind::Hardware2x2)
}

/// Returns a camera at `eye` that looks at `target`, in metres.
pub(crate) fn camera(eye: DVec3, target: DVec3) -> PerspectiveCamera {
    PerspectiveCamera {
        eye,
        forward: (target - eye).as_vec3().normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 120.0,
    }
}

impl Seen {
    /// Fits a technique's maps to a view of a scene under a low sun.
    pub(crate) fn new(technique: &Technique, scene: &GpuScene, camera: PerspectiveCamera) -> Self {
        let direction = SUNLIGHT.normalize();
        let casters = scene.casters();
        let views = [camera.frustum().expect("a camera")];
        let input = FitInput {
            receivers: Some(casters.boxes),
            casters: Some(casters.boxes),
            ..FitInput::new(&views, direction)
        };
        let fitted = *ShadowFitter::new(technique).fit(&input).expect("maps");
        let (maps, atmosphere) = (fitted.to_vec(), Atmosphere::default());
        Self { camera, direction, technique: *technique, fitted, maps, atmosphere }
    }

    pub(crate) fn frame(&self) -> Frame<'_> {
        Frame::new(self.camera, self.direction, &self.maps, &self.atmosphere)
    }
}

impl Stage {
    /// Creates a stage of the built-in scene from its default camera.
    pub(crate) fn new(technique: &Technique, samples: u32) -> Self {
        Self::of(technique, samples, &default_scene())
    }

    /// Creates a stage of a scene from the built-in scene's default camera.
    pub(crate) fn of(technique: &Technique, samples: u32, scene: &Scene) -> Self {
        let (eye, target) = default_camera();
        Self::on(renderer_gpu(), technique, samples, scene, camera(eye.as_dvec3(), target.as_dvec3()))
    }

    /// Creates a stage of a scene in its rest pose on a device, with `samples` samples per pixel.
    pub(crate) fn on(gpu: Gpu, technique: &Technique, samples: u32, scene: &Scene, camera: PerspectiveCamera) -> Self {
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::from(technique), samples).expect("a renderer");
        let pose = scene.pose(None, 0.0);
        let triangles = pose.triangles(scene);
        let gpu_scene = GpuScene::new(&gpu, renderer.material_layout(), scene, &pose).expect("memory");
        let target = renderer.target(&gpu, SIZE);
        let seen = Seen::new(technique, &gpu_scene, camera);
        Self { pictures: Pictures { gpu, renderer, scene: gpu_scene, target, triangles }, seen }
    }

    pub(crate) fn probe(&mut self) -> Probe {
        self.pictures.probe(&self.seen.frame())
    }

    /// Returns the data of a pixel, with the depths around a texel.
    pub(crate) fn pixel(&mut self, query: &PixelQuery) -> PixelFacts {
        self.pictures.pixel(&self.seen.frame(), query)
    }

    /// Draws the frame with the changes of `change`.
    pub(crate) fn picture(&mut self, change: impl Fn(&mut Frame<'_>)) -> Vec<[u8; 3]> {
        let mut frame = self.seen.frame();
        change(&mut frame);
        self.pictures.picture(&frame)
    }

    /// Draws a picture with marks from a camera `step` metres beside the judged view.
    pub(crate) fn judged(&mut self, overlay: Overlay, step: DVec3) -> Vec<[u8; 3]> {
        let Self { pictures, seen } = self;
        let targets = ProbeTargets::new(&pictures.gpu.device, SIZE);
        pictures.renderer.draw_probe(&pictures.gpu, &mut pictures.scene, &seen.frame(), &targets).expect("a probe");
        let classes: Vec<u32> = (0..SIZE[0] * SIZE[1]).map(|pixel| pixel / 7 % 6 + 8 * (pixel / 50 % 2)).collect();
        let classes = classes_texture(&pictures.gpu, &classes, SIZE);
        let camera = PerspectiveCamera { eye: seen.camera.eye + step, ..seen.camera };
        let judged = JudgedPicture {
            classes: &classes,
            size: SIZE,
            camera: seen.camera.into(),
            depth: Some(targets.depth_view()),
        };
        let marks = Some(Marks::default());
        pictures.picture(&Frame { camera: camera.into(), overlay, judged: Some(judged), marks, ..seen.frame() })
    }
}

impl Pictures {
    pub(crate) fn draw(&mut self, frame: &Frame<'_>) -> Statistics {
        self.renderer.draw(&self.gpu, &mut self.scene, frame, &self.target).expect("a frame")
    }

    /// Draws a frame and returns its sRGB pixels.
    pub(crate) fn picture(&mut self, frame: &Frame<'_>) -> Vec<[u8; 3]> {
        self.draw(frame);
        self.read()
    }

    /// Returns the sRGB pixels of the last frame.
    pub(crate) fn read(&self) -> Vec<[u8; 3]> {
        let bytes = self.target.read(&self.gpu).expect("pixels");
        bytes.as_chunks::<4>().0.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
    }

    pub(crate) fn probe(&mut self, frame: &Frame<'_>) -> Probe {
        let targets = ProbeTargets::new(&self.gpu.device, SIZE);
        self.renderer.probe(&self.gpu, &mut self.scene, frame, &targets).expect("a probe")
    }

    /// Returns the data of a pixel.
    pub(crate) fn pixel(&mut self, frame: &Frame<'_>, query: &PixelQuery) -> PixelFacts {
        let mut read = self.renderer.probe_pixel(&self.gpu, &mut self.scene, frame, query).expect("a question");
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        let facts = read.take(&self.gpu).expect("the work is done").expect("facts");
        assert_eq!(read.take(&self.gpu), None, "taken twice");
        facts
    }

    /// Returns the point where the ray through a pixel's middle meets a triangle, relative to the eye.
    pub(crate) fn point(&self, camera: &PerspectiveCamera, pixel: usize, triangle: u32) -> DVec3 {
        let [corner, ..] = self.triangles[triangle as usize].vertices;
        let normal = self.normal(triangle);
        let ray = ray(camera, pixel);
        ray * (normal.dot(corner.as_dvec3() - camera.eye) / normal.dot(ray))
    }

    /// Returns the unit normal of a triangle.
    pub(crate) fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.triangles[triangle as usize].vertices.map(Vec3::as_dvec3);
        (b - a).cross(c - a).normalize()
    }
}

/// Returns the direction through a pixel's middle, of length 1 along the view.
fn ray(camera: &PerspectiveCamera, pixel: usize) -> DVec3 {
    let forward = camera.forward.as_dvec3().normalize();
    let right = forward.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize].map(|place| place as f64 + 0.5);
    let [u, v] = [x / f64::from(SIZE[0]) * 2.0 - 1.0, 1.0 - y / f64::from(SIZE[1]) * 2.0];
    let half_height = (f64::from(camera.fov_y) * 0.5).tan();
    forward + right * (u * half_height * f64::from(camera.aspect)) + up * (v * half_height)
}

/// Returns the bits of a pixel of a judged picture: a class, and whether rays find it lit.
pub(crate) fn bits(class: u32, is_lit: bool) -> u32 {
    class | if is_lit { 8 } else { 0 }
}

/// Returns a linear channel from an sRGB byte.
pub(crate) fn linear(byte: u8) -> f32 {
    let encoded = f32::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Returns an sRGB level from a linear channel, without rounding.
pub(crate) fn encoded(linear: f32) -> f32 {
    255.0 * if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Returns pseudorandom numbers below a bound.
pub(crate) fn random(count: usize, below: u32) -> impl Iterator<Item = u32> {
    (0..count as u64).map(move |index| {
        let mixed = (index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        ((mixed ^ (mixed >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 33) as u32 % below
    })
}
