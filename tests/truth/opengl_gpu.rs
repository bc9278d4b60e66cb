//! The generated GLSL finds the same shadows as the WGSL: rays find as few wrong pixels in the pictures of the example
//! `opengl` as in the renderer's picture with the same maps. Its compute shader counts the same demand as the CPU.

use std::process::Command;

use shadowfit::Technique;
use shadowfit_render::Renderer;
use shadowfit_scene::Scene;
use shadowfit_study::{Evaluator, Judging, PreparedScene, SharedTruth, View};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::support::{example_program, test_gpu};

#[path = "../../examples/opengl/courtyard.rs"]
mod courtyard;

use courtyard::Courtyard;

/// Size of the example's picture, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// Greatest ratio of the wrong pixels of OpenGL and of the renderer. The pictures have the same maps. Rasterisers place
/// texels and pixels at edges differently.
const MOST: f64 = 1.1;

/// Greatest percentage of points that rounding moves into another cell. 0.001% were found.
const MOST_MOVED: f64 = 0.1;

/// Runs the example and returns its output.
fn run_opengl(version: &str) -> String {
    let mut example = Command::new(example_program("opengl"));
    let output = example.arg(version).env("LIBGL_ALWAYS_SOFTWARE", "1").output().expect("the example starts");
    let [printed, errors] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "{version}: {errors}");
    print!("{printed}");
    printed
}

/// Returns the percentage before some words of the example's output.
fn percentage(printed: &str, words: &str) -> f64 {
    let before = printed.split_once(&format!(" % of the {words}")).map(|(before, _)| before);
    let number = before.and_then(|before| before.rsplit([' ', '\n']).next()?.parse().ok());
    number.unwrap_or_else(|| panic!("no percentage of {words}: {printed}"))
}

/// Returns the percentage of wrong pixels in the renderer's picture.
fn wrong_by_renderer() -> f64 {
    let (courtyard, technique) = (Courtyard::new(SIZE), Technique::default());
    let maps = courtyard.fit(&technique).expect("a fit");
    let gpu = &test_gpu();
    let renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&technique), 1).expect("a renderer");
    let scene = Scene::from_objects("courtyard", &courtyard.objects);
    let mut scene = PreparedScene::new(gpu, renderer.material_layout(), scene).expect("a scene");
    let judging = Judging { size: SIZE, crawl: false, ..Judging::default() };
    let view = View { camera: courtyard.camera.into(), direction: courtyard.sun, is_first: true };
    let mut evaluator = Evaluator::new(renderer, judging);
    let judged = evaluator.judge(gpu, &mut scene, &view, &maps, &mut SharedTruth::default()).expect("a judgement");
    judged.tally.figures().expect("judged pixels").wrong
}

#[test]
fn opengl_core_and_es_draw_as_few_wrong_pixels_as_the_renderer() {
    let renderer = wrong_by_renderer();
    println!("the renderer: {renderer:.3} %");
    for version in ["core", "es"] {
        let printed = run_opengl(version);
        let wrong = percentage(&printed, "pixels");
        assert!(wrong <= MOST * renderer, "{version}: {wrong} % instead of {renderer} %");
        if version == "core" {
            assert!(percentage(&printed, "visible points") <= MOST_MOVED, "{printed}");
        }
    }
}
