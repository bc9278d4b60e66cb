//! A lost device: reading returns an error, not a picture of zeros that would pass as sky and be judged
//! right.

use shadowfit_render::{Atmosphere, Frame, Gpu, GpuScene, ProbeError, ProbeTargets, ReadError, Renderer};
use shadowfit_scene::builtin::{default_camera, default_scene};
use shadowfit_testing::open_renderer_gpu;
use shadowfit_viewer::Stage;
use shadowfit_wgpu::ShadowMapDescriptor;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [64, 36];

/// Returns the default scene's own camera.
fn camera() -> shadowfit::PerspectiveCamera {
    let (eye, target) = default_camera();
    shadowfit_render::FlyCamera::look_at(eye.as_dvec3(), target.as_dvec3())
        .perspective(&shadowfit_params::tool::CameraSettings::default(), SIZE[0] as f32 / SIZE[1] as f32)
}

fn renderer(gpu: &Gpu) -> (Renderer, GpuScene) {
    let descriptor = ShadowMapDescriptor { resolution: [256; 2], ..ShadowMapDescriptor::default() };
    let renderer = Renderer::new(gpu, &descriptor, 1).expect("a renderer");
    let scene = default_scene();
    let gpu_scene = GpuScene::new(gpu, renderer.material_layout(), &scene, &scene.pose(None, 0.0)).expect("memory");
    (renderer, gpu_scene)
}

#[test]
fn what_was_drawn_before_the_device_was_lost_cannot_be_read_after_it() {
    let gpu = open_renderer_gpu();
    let (mut renderer, mut scene) = renderer(&gpu);
    let (camera, atmosphere) = (camera(), Atmosphere::default());
    let frame = Frame::new(camera, glam::Vec3::NEG_Y, &[], &atmosphere);
    let (target, probe) = (renderer.target(&gpu, SIZE), ProbeTargets::new(&gpu.device, SIZE));
    renderer.draw(&gpu, &mut scene, &frame, &target).expect("a frame");
    renderer.draw_probe(&gpu, &mut scene, &frame, &probe).expect("a probe");
    assert!(target.read(&gpu).is_ok_and(|pixels| pixels.iter().any(|byte| *byte != 0)));
    assert!(probe.read(&gpu).is_ok_and(|probe| probe.pixels.iter().any(Option::is_some)));
    gpu.device.destroy();
    assert_eq!(target.read(&gpu), Err(ReadError::Lost));
    assert_eq!(probe.read(&gpu).map(|probe| probe.pixels), Err(ReadError::Lost));
    let error = ReadError::Lost.to_string();
    assert!(error.contains("graphics device") && error.contains("lost"), "{error}");
}

#[test]
fn a_probe_on_a_lost_device_is_an_error() {
    let gpu = open_renderer_gpu();
    let (mut renderer, mut scene) = renderer(&gpu);
    let (camera, atmosphere) = (camera(), Atmosphere::default());
    let frame = Frame::new(camera, glam::Vec3::NEG_Y, &[], &atmosphere);
    let targets = ProbeTargets::new(&gpu.device, SIZE);
    gpu.device.destroy();
    let probed = renderer.probe(&gpu, &mut scene, &frame, &targets);
    assert_eq!(probed.map(|probe| probe.pixels), Err(ProbeError::Read(ReadError::Lost)));
}

#[test]
fn a_stage_on_a_lost_device_judges_nothing_and_says_why() {
    let mut stage = Stage::new(open_renderer_gpu(), default_scene(), 1).expect("the default scene");
    assert!(stage.judge(SIZE, false).is_some_and(|judged| judged.tally.all.facing > 0));
    stage.gpu().device.destroy();
    assert!(stage.judge(SIZE, false).is_none());
    assert!(stage.problem().is_some_and(|problem| problem.contains("lost")), "{:?}", stage.problem());
}
