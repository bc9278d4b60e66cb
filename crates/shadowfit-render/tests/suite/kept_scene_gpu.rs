//! An animated scene, drawn with kept maps and with newly drawn maps, gives the same pictures.

use glam::{DVec3, Vec3};
use shadowfit::settings::FilterKind;
use shadowfit::{FitInput, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_render::{Atmosphere, Frame, GpuScene, Renderer};
use shadowfit_scene::builtin::{default_camera, default_scene};
use shadowfit_testing::renderer_gpu;
use shadowfit_wgpu::ShadowMapDescriptor;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [160, 90];

/// Smallest difference of two values of a pixel that counts, in levels, and the greatest allowed share of
/// such values. They occur at edges of shadows that were drawn a frame earlier, where matrix rounding
/// differs.
const DIFFERENT: u8 = 12;
const DIFFERENT_SHARE: f64 = 2e-4;

/// Number of frames in which the figure walks.
const FRAMES: u8 = 12;

fn camera(frame: u8) -> PerspectiveCamera {
    let (eye, target) = default_camera();
    let along = f64::from(frame) * 0.06;
    PerspectiveCamera {
        eye: eye.as_dvec3() + DVec3::new(along, 0.0, -along),
        forward: (target - eye + Vec3::X * (f32::from(frame) * 0.02)).normalize(),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 120.0,
    }
}

fn assert_same_pictures(technique: &Technique) {
    let (gpu, scene) = (renderer_gpu(), default_scene());
    let [mut kept, mut anew] = [true, false].map(|keeps| {
        let mut renderer = Renderer::new(&gpu, &ShadowMapDescriptor::from(technique), 1).expect("a renderer");
        renderer.sun_mut().set_caching(keeps);
        renderer
    });
    let mut gpu_scene = GpuScene::new(&gpu, kept.material_layout(), &scene, &scene.pose(Some(0), 0.0)).expect("memory");
    let target = kept.target(&gpu, SIZE);
    let direction = Vec3::new(0.45, -0.75, 0.35).normalize();
    let atmosphere = Atmosphere::default();
    let mut fitter = ShadowFitter::new(technique);
    let mut redrawn = 0;
    for frame in 0..FRAMES {
        gpu_scene.set_pose(&gpu, &scene, &scene.pose(Some(0), f32::from(frame) * 0.11));
        let camera = camera(frame);
        let views = [camera.frustum().expect("a camera")];
        let boxes = Some(gpu_scene.casters().boxes);
        let input = FitInput { receivers: boxes, casters: boxes, ..FitInput::new(&views, direction) };
        let maps = *fitter.fit(&input).expect("maps");
        let shown = Frame::new(camera, direction, &maps, &atmosphere);
        let [a, b] = [&mut kept, &mut anew].map(|renderer| {
            renderer.draw(&gpu, &mut gpu_scene, &shown, &target).expect("a frame");
            target.read(&gpu).expect("pixels")
        });
        redrawn += usize::from(kept.sun().passes().any(|pass| pass.is_cleared()));
        let different = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) >= DIFFERENT).count();
        let share = different as f64 / a.len() as f64;
        assert!(share <= DIFFERENT_SHARE, "frame {frame}: {different} of {} values differ", a.len());
    }
    println!("maps were drawn anew in {redrawn} of {FRAMES} frames");
    assert!(redrawn * 3 < usize::from(FRAMES) * 2, "maps were drawn anew in {redrawn} of {FRAMES} frames");
}

#[test]
fn pictures_of_a_figure_that_walks_are_the_same_with_maps_that_are_kept() {
    let technique = Technique::default().with_count(2).with_resolution(512, 512);
    assert_same_pictures(&technique);
    assert_same_pictures(&technique.with_filter(FilterKind::Pcss));
}
