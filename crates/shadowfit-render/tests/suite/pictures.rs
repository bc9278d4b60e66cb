//! A scene, its maps, and what draws it.

use glam::{DVec3, Vec3};
use shadowfit::{FitInput, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_render::{
    Atmosphere, Frame, Gpu, GpuScene, JudgedPicture, Marks, Overlay, PixelFacts, PixelQuery, Probe, ProbeTargets,
    RenderTarget, Renderer, classes_texture,
};
use shadowfit_scene::Scene;
use shadowfit_wgpu::ShadowMapDescriptor;

/// Size of the pictures, in pixels.
pub(crate) const SIZE: [u32; 2] = [160, 90];

/// The way the light travels.
const SUNLIGHT: Vec3 = Vec3::new(0.45, -0.75, -0.35);

/// A scene, its maps, and what draws it.
pub(crate) struct Pictures {
    pub(crate) gpu: Gpu,
    pub(crate) renderer: Renderer,
    pub(crate) scene: GpuScene,
    pub(crate) camera: PerspectiveCamera,
    target: Option<RenderTarget>,
    maps: FittedMaps,
}

impl Pictures {
    /// A scene at rest, seen from a place.
    pub(crate) fn new(gpu: Gpu, technique: &Technique, samples: u32, scene: &Scene, eye: DVec3) -> Self {
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::from(technique), samples).expect("a renderer");
        let gpu_scene = GpuScene::new(&gpu, renderer.material_layout(), scene, &scene.pose(None, 0.0)).expect("memory");
        let camera = PerspectiveCamera {
            eye,
            forward: (DVec3::Y - eye).as_vec3().normalize(),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: SIZE[0] as f32 / SIZE[1] as f32,
            near: 0.1,
            far: 120.0,
        };
        let casters = gpu_scene.casters();
        let views = [camera.frustum().expect("a view")];
        let input = FitInput {
            receivers: Some(casters.boxes),
            casters: Some(casters.boxes),
            ..FitInput::new(&views, SUNLIGHT.normalize())
        };
        let maps = *ShadowFitter::new(technique).fit(&input).expect("maps");
        Self { gpu, renderer, scene: gpu_scene, camera, target: None, maps }
    }

    pub(crate) fn probe(&mut self) -> Probe {
        let atmosphere = Atmosphere::default();
        let frame = Frame::new(&self.camera, SUNLIGHT.normalize(), &self.maps, &atmosphere);
        let targets = ProbeTargets::new(&self.gpu.device, SIZE);
        self.renderer.probe(&self.gpu, &mut self.scene, &frame, &targets).expect("a probe")
    }

    /// The facts of a pixel, with the depths around a texel.
    pub(crate) fn pixel(&mut self, query: &PixelQuery) -> PixelFacts {
        let atmosphere = Atmosphere::default();
        let frame = Frame::new(&self.camera, SUNLIGHT.normalize(), &self.maps, &atmosphere);
        let mut read = self.renderer.probe_pixel(&self.gpu, &mut self.scene, &frame, query).expect("a question");
        for _ in 0..10_000 {
            if let Some(facts) = read.take(&self.gpu) {
                return facts.expect("facts");
            }
            std::thread::sleep(core::time::Duration::from_millis(1));
        }
        panic!("no answer in ten seconds");
    }

    /// The display values of a picture with marks, some metres beside the place where the present view was judged.
    pub(crate) fn judged(&mut self, overlay: Overlay, step: DVec3) -> Vec<[u8; 4]> {
        let atmosphere = Atmosphere::default();
        let frame = Frame::new(&self.camera, SUNLIGHT.normalize(), &self.maps, &atmosphere);
        let targets = ProbeTargets::new(&self.gpu.device, SIZE);
        self.renderer.draw_probe(&self.gpu, &mut self.scene, &frame, &targets).expect("a probe");
        let classes: Vec<u32> = (0..SIZE[0] * SIZE[1]).map(|pixel| pixel / 7 % 6 + 8 * (pixel / 50 % 2)).collect();
        let classes = classes_texture(&self.gpu, &classes, SIZE);
        let camera = PerspectiveCamera { eye: self.camera.eye + step, ..self.camera };
        let judged =
            JudgedPicture { classes: &classes, size: SIZE, camera: self.camera, depth: Some(targets.depth_view()) };
        let marks = Some(Marks::default());
        let frame = Frame { camera: &camera, overlay, judged: Some(judged), marks, ..frame };
        let target = self.renderer.target(&self.gpu, SIZE);
        self.renderer.draw(&self.gpu, &mut self.scene, &frame, &target).expect("a frame");
        target.read(&self.gpu).expect("pixels").as_chunks().0.to_vec()
    }

    /// The display values of a frame with what `change` adds.
    pub(crate) fn picture(&mut self, change: impl Fn(&mut Frame<'_>)) -> Vec<[u8; 4]> {
        let atmosphere = Atmosphere::default();
        let mut frame = Frame::new(&self.camera, SUNLIGHT.normalize(), &self.maps, &atmosphere);
        change(&mut frame);
        let target = self.target.get_or_insert_with(|| self.renderer.target(&self.gpu, SIZE));
        self.renderer.draw(&self.gpu, &mut self.scene, &frame, target).expect("a frame");
        target.read(&self.gpu).expect("pixels").as_chunks().0.to_vec()
    }
}
