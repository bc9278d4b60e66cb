//! A scene with an animation, drawn by the samples' renderer with maps that are kept and with maps drawn anew: the pictures
//! are the same.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::FilterKind;
use shadowfit::{PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::Renderer;
use shadowfit_scene::builtin::{default_camera, default_scene};
use shadowfit_study::{Evaluator, Judging, PreparedScene, View};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::support::software_gpu;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [240, 135];

/// A pixel counts as different from this many levels on, and so many may be: edges of shadows that were drawn a frame
/// earlier, with matrices that are rounded otherwise.
const DIFFERENT: u8 = 12;
const DIFFERENT_SHARE: f64 = 2e-4;

fn view(frame: u32) -> View {
    let (eye, target) = default_camera();
    let along = f64::from(frame) * 0.06;
    let camera = PerspectiveCamera {
        eye: eye.as_dvec3() + DVec3::new(along, 0.0, -along),
        forward: (target - eye + Vec3::X * (frame as f32 * 0.02)).normalize(),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 120.0,
    };
    View { camera, direction: Vec3::new(0.45, -0.75, 0.35).normalize(), is_first: frame == 0 }
}

fn assert_same_pictures(technique: &Technique) {
    let gpu = software_gpu();
    let descriptor = ShadowMapDescriptor::from(technique);
    let evaluator = |keeps: bool| {
        let mut renderer = Renderer::new(&gpu, &descriptor, 1).expect("a renderer");
        renderer.sun_mut().set_caching(keeps);
        Evaluator::new(renderer, Judging { size: SIZE, ..Judging::default() })
    };
    let [mut kept, mut anew] = [true, false].map(evaluator);
    let layout = kept.renderer.material_layout();
    let mut scene = PreparedScene::new(&gpu, layout, default_scene()).expect("the built-in scene");
    let mut fitter = ShadowFitter::new(technique);
    let mut redrawn = 0;
    for frame in 0..24 {
        scene.set_time(&gpu, 0, frame as f32 * 0.11);
        let view = view(frame);
        let maps = scene.fit_next(&mut fitter, Inputs::default(), &view).expect("maps");
        let [a, b] = [&mut kept, &mut anew]
            .map(|evaluator| evaluator.picture(&gpu, &mut scene, &view, &maps).expect("a picture"));
        redrawn += usize::from(kept.renderer.sun().passes().any(|pass| pass.is_cleared()));
        let different = a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) >= DIFFERENT).count();
        let share = different as f64 / a.len() as f64;
        assert!(share <= DIFFERENT_SHARE, "frame {frame}: {different} of {} values differ", a.len());
    }
    assert!(redrawn < 16, "maps were drawn anew in {redrawn} of 24 frames");
}

#[test]
fn pictures_of_a_figure_that_walks_are_the_same_with_maps_that_are_kept() {
    let technique = Technique::default().with_resolution(512, 512);
    assert_same_pictures(&technique);
    assert_same_pictures(&technique.with_filter(FilterKind::Pcss));
}
