//! The three demonstrations in the default scene, as numbers: each artefact is unmistakable, and its cure
//! removes nearly all of it, with several maps and with a single one. Judged against rays, which need no
//! shadow map.

use shadowfit::Technique;
use shadowfit::{Maps, SingleMap};
use shadowfit_scene::builtin::default_scene;
use shadowfit_truth::{Class, Judged};
use shadowfit_viewer::{Artefact, Stage};

use crate::support::test_gpu;

/// Size of the judged pictures, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// Size of pictures for comparing texels or stripes with pixels.
const FINE: [u32; 2] = [640, 360];

/// The recommended technique, a technique with cascades, and one with a single map.
const TECHNIQUES: [&str; 3] = ["windows-4", "calm-4", "xna-1"];

/// Greatest share of the artefact that may remain after a cure, relative to the same base.
const CURED: f64 = 0.001;

fn stage(technique: &str) -> Stage {
    let mut stage = Stage::new(test_gpu(), default_scene(), 1).expect("the default scene");
    stage.settings.technique = Technique::preset(technique).expect("a preset");
    stage
}

/// Shows an artefact. Its settings keep the technique's maps. Windows show no artefacts and are replaced.
fn show(stage: &mut Stage, artefact: Artefact) {
    let before = stage.settings.technique;
    stage.show_artefact(artefact);
    assert_eq!(stage.notice(), None);
    let shown = stage.settings.technique;
    match before.maps {
        Maps::Single(SingleMap { stabilise, .. }) => assert_eq!(shown.maps.as_single().stabilise, stabilise),
        Maps::Cascades(_) => assert_eq!(shown.maps, before.maps),
        Maps::Windows(_) => assert_eq!(shown.maps, before.maps.as_cascades().into()),
    }
}

fn judged(stage: &mut Stage, size: [u32; 2], subject_only: bool) -> Judged {
    let judged = stage.judge(size, subject_only).expect("an adapter that tells triangles apart");
    assert_eq!(stage.problem(), None);
    judged
}

/// Returns the share of the facing pixels that are wrong.
fn wrong(stage: &mut Stage) -> f64 {
    let tally = judged(stage, SIZE, false).tally;
    tally.share(tally.all.wrong)
}

/// Returns the share of all pixels, including the sky.
fn share_of_picture(judged: &Judged, class: Class) -> f64 {
    judged.classes.iter().filter(|other| **other == class).count() as f64 / judged.classes.len() as f64
}

#[test]
fn gpu_acne_covers_the_character_and_its_fix_clears_it() {
    for technique in TECHNIQUES {
        let mut stage = stage(technique);
        show(&mut stage, Artefact::Acne);
        let shown = judged(&mut stage, FINE, true).tally;
        stage.fix_artefact(Artefact::Acne);
        let fixed = judged(&mut stage, FINE, true).tally;
        let [acne, acne_fixed] = [&shown, &fixed].map(|tally| tally.share(tally.all.false_shadow));
        println!("{technique}: acne shown: {acne}, fixed: {acne_fixed}");
        assert!(
            shown.all.facing as f32 > 0.1 * (FINE[0] * FINE[1]) as f32,
            "{technique}: the character fills the picture: {}",
            shown.all.facing
        );
        assert!(acne >= 0.15, "{technique}: false shadow on the character: {acne}");
        assert!(acne_fixed < CURED, "{technique}: false shadow after the fix: {acne_fixed}");
        assert_eq!(shown.all.facing, fixed.all.facing, "{technique}: the same pixels are judged");
    }
}

/// Returns the share of the picture that a shadow map darkens.
fn shadowed(stage: &mut Stage) -> f64 {
    let target = stage.target(SIZE);
    let [with, without] = [true, false].map(|shadows| {
        stage.settings.view.shadows = shadows;
        stage.draw(&target);
        assert_eq!(stage.problem(), None);
        target.read(stage.gpu()).expect("a picture")
    });
    stage.settings.view.shadows = true;
    let differs = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 8);
    let differing = with.chunks_exact(4).zip(without.chunks_exact(4)).filter(|pair| differs(*pair)).count();
    differing as f64 / f64::from(SIZE[0] * SIZE[1])
}

#[test]
fn gpu_a_clipping_hole_breaks_off_a_shadow_whenever_it_is_shown() {
    let mut stage = stage("windows-4");
    for seconds in [0.0, 3.3, 11.0] {
        stage.reset();
        stage.set_time(seconds);
        show(&mut stage, Artefact::ClippingHole);
        let hole = share_of_picture(&judged(&mut stage, SIZE, false), Class::Hole);
        let left = shadowed(&mut stage);
        println!("{seconds} s: hole {hole}, shadow left {left}");
        assert!(hole >= 0.05 && left >= 0.05, "{seconds} s: hole {hole}, shadow left {left}");
        assert!(stage.narration().starts_with("The shadow breaks off"), "{seconds} s: {}", stage.narration());
    }
}

#[test]
fn gpu_a_clipping_hole_shows_and_its_fix_closes_it() {
    for technique in TECHNIQUES {
        let mut stage = stage(technique);
        show(&mut stage, Artefact::ClippingHole);
        let shown = judged(&mut stage, SIZE, false);
        stage.fix_artefact(Artefact::ClippingHole);
        let fixed = judged(&mut stage, SIZE, false);
        let [hole, hole_fixed] = [&shown, &fixed].map(|judged| share_of_picture(judged, Class::Hole));
        let acne = fixed.tally.share(fixed.tally.all.false_shadow);
        println!("{technique}: hole shown: {hole}, fixed: {hole_fixed}; false shadow {acne}");
        assert!(hole >= 0.02, "{technique}: hole in the picture: {hole}");
        assert_eq!(hole_fixed, 0.0, "{technique}: hole after the fix");
        assert!(acne < CURED, "{technique}: the fix brings no acne: {acne}");
    }
}

#[test]
fn gpu_aliasing_magnifies_the_shadow_edge_and_its_fix_sharpens_it() {
    for technique in TECHNIQUES {
        let mut stage = stage(technique);
        show(&mut stage, Artefact::Aliasing);
        let shown = median_at_edges(&mut stage);
        let wrong = wrong(&mut stage);
        stage.fix_artefact(Artefact::Aliasing);
        let fixed = median_at_edges(&mut stage);
        let wrong_fixed = self::wrong(&mut stage);
        println!(
            "{technique}: pixels per texel at the edge: {shown} shown, {fixed} fixed; wrong {wrong}, {wrong_fixed}"
        );
        assert!(shown >= 8.0, "{technique}: median pixels per texel at the shadow's edge: {shown}");
        assert!(fixed < 1.0, "{technique}: after the fix: {fixed}");
        assert!(wrong_fixed < wrong * 0.2, "{technique}: wrong pixels: {wrong}, after the fix {wrong_fixed}");
    }
}

/// Returns the median of pixels per texel along the worse axis, over the pixels at a change of the true
/// shadow.
fn median_at_edges(stage: &mut Stage) -> f32 {
    let mut figures = stage.pixels_per_texel_at_edges(FINE);
    assert!(figures.len() > 100, "the shadow's edge is in the picture: {} pixels", figures.len());
    figures.sort_by(f32::total_cmp);
    figures[figures.len() / 2]
}
