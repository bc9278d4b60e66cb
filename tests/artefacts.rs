//! The three demonstrations in the default scene, as numbers: each artefact is unmistakable, and
//! its cure leaves next to nothing of it. Judged against rays, which need no shadow map.

use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_scene::builtin::default_scene;
use shadowfit_truth::{Class, Judged};
use shadowfit_viewer::{Artefact, Stage};

/// Size of the judged pictures, in pixels.
const SIZE: [u32; 2] = [640, 360];

/// Share of what is left after a cure, of the base that the artefact was measured on.
const CURED: f32 = 0.001;

fn stage() -> Stage {
    let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
    Stage::new(gpu, default_scene(), 1).expect("the default scene")
}

/// Share of all pixels, sky included.
fn share_of_picture(judged: &Judged, class: Class) -> f32 {
    judged.classes.iter().filter(|other| **other == class).count() as f32 / judged.classes.len() as f32
}

#[test]
fn gpu_acne_covers_the_character_and_its_fix_clears_it() {
    let mut stage = stage();
    stage.show_artefact(Artefact::Acne);
    let shown = stage.judge(SIZE, true).shares;
    stage.fix_artefact(Artefact::Acne);
    let fixed = stage.judge(SIZE, true).shares;
    println!("acne shown: {shown:?}\nacne fixed: {fixed:?}");
    assert!(shown.counted as f32 > 0.1 * (SIZE[0] * SIZE[1]) as f32, "the character fills the picture: {shown:?}");
    assert!(shown.false_shadow >= 0.15, "false shadow on the character: {shown:?}");
    assert!(fixed.false_shadow < CURED, "false shadow after the fix: {fixed:?}");
    assert_eq!(shown.facing, fixed.facing, "the same pixels are judged");
}

#[test]
fn gpu_a_clipping_hole_shows_and_its_fix_closes_it() {
    let mut stage = stage();
    stage.show_artefact(Artefact::ClippingHole);
    let shown = stage.judge(SIZE, false);
    stage.fix_artefact(Artefact::ClippingHole);
    let fixed = stage.judge(SIZE, false);
    println!("hole shown: {:?}\nhole fixed: {:?}", shown.shares, fixed.shares);
    assert!(share_of_picture(&shown, Class::Hole) >= 0.02, "hole in the picture: {:?}", shown.shares);
    assert!(share_of_picture(&fixed, Class::Hole) < CURED, "hole after the fix: {:?}", fixed.shares);
    assert!(fixed.shares.false_shadow < CURED, "the fix brings no acne: {:?}", fixed.shares);
}

#[test]
fn gpu_aliasing_magnifies_the_shadow_edge_and_its_fix_sharpens_it() {
    let mut stage = stage();
    stage.show_artefact(Artefact::Aliasing);
    let shown = median_at_edges(&mut stage);
    let wrong = stage.judge(SIZE, false).shares.wrong;
    stage.fix_artefact(Artefact::Aliasing);
    let fixed = median_at_edges(&mut stage);
    let wrong_fixed = stage.judge(SIZE, false).shares.wrong;
    println!("pixels per texel at the edge: {shown} shown, {fixed} fixed; wrong {wrong} and {wrong_fixed}");
    assert!(shown >= 8.0, "median pixels per texel at the shadow's edge: {shown}");
    assert!(fixed < 2.0, "after the fix: {fixed}");
    assert!(wrong_fixed < wrong * 0.2, "wrong pixels: {wrong}, after the fix {wrong_fixed}");
}

/// Median, over the pixels at a change of the true shadow, of the pixels per texel along the worse
/// axis.
fn median_at_edges(stage: &mut Stage) -> f32 {
    let mut figures = stage.pixels_per_texel_at_edges(SIZE);
    assert!(figures.len() > 100, "the shadow's edge is in the picture: {} pixels", figures.len());
    figures.sort_by(f32::total_cmp);
    figures[figures.len() / 2]
}
