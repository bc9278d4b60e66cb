//! Traced edges: their figures, their view, and the message if they are filtered instead.

use shadowfit::Technique;
use shadowfit_params::tool::{InsetMaps, ViewMode};
use shadowfit_scene::builtin::default_scene;
use shadowfit_testing::renderer_gpu;
use shadowfit_wgpu::demand::Unsupported;
use shadowfit_wgpu::exact_edges::{EdgeCounts, EdgeOutcome, FallbackReason};

use super::side::draw::filtered_edges;
use super::*;

const SIZE: [u32; 2] = [160, 90];

/// Returns a stage with the default scene and traced edges, and nothing over its picture.
fn stage() -> (Stage, RenderTarget) {
    let mut stage = Stage::new(renderer_gpu(), default_scene(), 1).expect("the default scene");
    stage.wait_for_rays();
    stage.settings.technique = Technique::preset("exact-4").expect("a preset").with_resolution(256, 256);
    let view = &mut stage.settings.view;
    (view.play, view.judge, view.inset) = (false, false, InsetMaps::Off);
    let target = stage.target(SIZE);
    (stage, target)
}

/// Draws a picture and waits for its counts.
fn counts(stage: &mut Stage, target: &RenderTarget) -> Option<EdgeCounts> {
    stage.draw(target);
    stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
    stage.side.evaluator.renderer.take_edge_counts()
}

#[test]
fn gpu_figures_say_how_many_pixels_were_traced_and_nothing_where_edges_are_filtered() {
    let (mut stage, target) = stage();
    let counts = counts(&mut stage, &target).expect("pixels were traced");
    assert_eq!(stage.problem(), None);
    assert!(0 < counts.unsure && counts.unsure < counts.facing && counts.facing < SIZE[0] * SIZE[1], "{counts:?}");
    let figures = stage.figures(SIZE, None);
    let share = counts.unsure as f32 / counts.facing as f32 * 100.0;
    assert!(figures.traced.is_some_and(|traced| (traced / share - 1.0).abs() < 1e-5), "{figures:?}");
    stage.settings.technique = Technique::default().with_resolution(256, 256);
    stage.draw(&target);
    assert_eq!(stage.problem(), None);
    let figures = stage.figures(SIZE, None);
    assert_eq!((figures.traced, figures.edges_ms), (None, None));
}

#[test]
fn gpu_the_view_of_traced_pixels_colours_those_that_were_traced_and_no_others() {
    let (mut stage, target) = stage();
    stage.settings.view.mode = ViewMode::Traced;
    let counts = counts(&mut stage, &target).expect("pixels were traced");
    let pixels = |stage: &Stage| target.read(stage.gpu()).expect("a picture");
    // Orange, blue, or grey.
    let coloured = |pixels: &[u8], is_it: fn([i32; 3]) -> bool| {
        let colors = pixels.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]].map(i32::from));
        colors.filter(|color| is_it(*color)).count()
    };
    let orange = |[red, _, blue]: [i32; 3]| red > blue + 16;
    let blue = |[red, _, blue]: [i32; 3]| blue > red + 16;
    let picture = pixels(&stage);
    assert_eq!(coloured(&picture, orange), counts.unsure as usize, "{counts:?}");
    assert_eq!(coloured(&picture, blue), counts.filtered as usize, "{counts:?}");
    stage.settings.technique = Technique::default().with_resolution(256, 256);
    stage.draw(&target);
    let picture = pixels(&stage);
    assert_eq!(coloured(&picture, orange), 0, "nothing is traced");
    assert!(coloured(&picture, blue) > 1000, "the filter makes all edges");
}

#[test]
fn edges_that_are_filtered_though_the_technique_traces_them_are_told_with_the_reason() {
    let exact = Technique::preset("exact-4").expect("a preset");
    let mut settings = Settings::default().with_technique(exact);
    let lacking = EdgeOutcome::Filtered(FallbackReason::Device(Unsupported::Compute));
    let text = filtered_edges(&settings, lacking).expect("they are told");
    assert_eq!(text, "Edges are filtered: this graphics device has no compute shaders");
    assert_eq!(filtered_edges(&settings, EdgeOutcome::Traced), None);
    settings.view.shadows = false;
    assert_eq!(filtered_edges(&settings, lacking), None, "there are none");
    assert_eq!(filtered_edges(&Settings::default(), lacking), None, "the technique has them filtered");
}
