//! Depth clamp on devices without it: pictures are the same as on devices with it.

use glam::Vec3;
use shadowfit::settings::{CasterPolicy, FilterKind, FitKind, MapFormat, MapSettings, Shape};
use shadowfit::{Cascades, FitInput, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_render::{Atmosphere, Frame, Gpu, GpuScene, Renderer, Wanted};
use shadowfit_scene::builtin;
use shadowfit_testing::renderer_gpu;
use shadowfit_wgpu::ShadowMapDescriptor;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// Opens the software adapter without depth clamp.
fn without_clamp() -> Gpu {
    let gpu = renderer_gpu();
    let features = gpu.device.features() - wgpu::Features::DEPTH_CLIP_CONTROL;
    pollster::block_on(Gpu::of_adapter(gpu.adapter, &Wanted { features, limits: None })).expect("fewer features")
}

/// Draws the courtyard with depth-clamped maps, whose near planes cut through its objects.
fn picture(gpu: &Gpu, format: MapFormat) -> Vec<u8> {
    let fit = MapSettings { casters: CasterPolicy::DepthClamp, max_distance: 30.0, ..MapSettings::default() };
    let maps = Cascades { count: 2, shape: Shape::new(FitKind::FrustumAabb), ..Cascades::default() }.into();
    let technique = Technique { maps, fit, filter: FilterKind::Pcf3x3, format, ..Technique::default() };
    let technique = technique.with_resolution(512, 512);
    let (eye, target) = builtin::default_camera();
    let camera = PerspectiveCamera {
        eye: eye.as_dvec3(),
        forward: (target - eye).normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 90.0,
    };
    let direction = Vec3::new(0.5, -0.6, -0.4).normalize();
    let views = [camera.frustum().expect("a camera")];
    let maps = *ShadowFitter::new(&technique).fit(&FitInput::new(&views, direction)).expect("maps");
    let mut renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&technique), 1).expect("a renderer");
    let scene = builtin::default_scene();
    let mut gpu_scene = GpuScene::new(gpu, renderer.material_layout(), &scene, &scene.pose(None, 0.0)).expect("memory");
    let target = renderer.target(gpu, SIZE);
    let atmosphere = Atmosphere::default();
    renderer.draw(gpu, &mut gpu_scene, &Frame::new(camera, direction, &maps, &atmosphere), &target).expect("a frame");
    target.read(gpu).expect("pixels")
}

#[test]
fn the_courtyard_looks_the_same_without_depth_clamp() {
    let devices = [renderer_gpu(), without_clamp()];
    for format in [MapFormat::Depth32Float, MapFormat::R32Float] {
        let [clamped, emulated] = devices.each_ref().map(|gpu| picture(gpu, format));
        let pairs = clamped.as_chunks::<4>().0.iter().zip(emulated.as_chunks::<4>().0);
        let differ = pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2)).count();
        let pixels = clamped.len() / 4;
        assert!(differ * 1000 <= pixels, "{format:?}: {differ} of {pixels} pixels");
    }
}
