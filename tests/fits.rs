//! All fits in the viewer, on the default scene. No shadow has a hole if the casters are in the map, and fits
//! that use the scene's boxes have finer texels. Pictures are judged against rays, which need no shadow map.

use shadowfit::settings::{CasterPolicy, FitKind, Shape, Stabilise};
use shadowfit::{Cascades, Maps, SingleMap};
use shadowfit_scene::builtin::default_scene;
use shadowfit_truth::Class;
use shadowfit_viewer::{Artefact, Stage};

use crate::support::test_gpu;

/// Size of the judged pictures, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// Share of the picture's pixels that may be wrong: single ones along edges.
const STRAY: f32 = 0.001;

const KINDS: [FitKind; 4] = [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];

/// Returns the default scene with a caster between the sun and the view.
fn stage() -> Stage {
    let mut stage = Stage::new(test_gpu(), default_scene(), 1).expect("the default scene");
    stage.show_artefact(Artefact::ClippingHole);
    stage
}

/// Returns the shares of the picture that are holes, and that are wrong away from shadow edges.
fn wrong(stage: &mut Stage) -> [f32; 2] {
    let classes = stage.judge(SIZE, false).expect("an adapter that tells triangles apart").classes;
    assert_eq!(stage.problem(), None);
    let share =
        |wanted: &[Class]| classes.iter().filter(|class| wanted.contains(class)).count() as f32 / classes.len() as f32;
    [share(&[Class::Hole]), share(&[Class::FalseLight, Class::FalseShadow])]
}

#[test]
fn gpu_every_policy_that_thinks_of_casters_closes_the_holes_of_every_fit() {
    let mut stage = stage();
    let (windows, cascades) = (Maps::default(), Maps::from(Cascades::default()));
    for maps in KINDS.map(|kind| cascades.with_kind(kind)).into_iter().chain([windows]) {
        let kind = maps.shape().map(|shape| shape.kind);
        for casters in
            [CasterPolicy::Extend, CasterPolicy::PerObject, CasterPolicy::SceneBounds, CasterPolicy::DepthClamp]
        {
            let technique = stage.settings.technique;
            stage.settings.technique = technique.with_maps(maps).with_fit(technique.fit.with_casters(casters));
            let [hole, other] = wrong(&mut stage);
            let fit = stage.maps(SIZE)[0].projection;
            println!("{kind:?} {casters:?}: hole {hole}, false {other}, {} {}", fit.texel_size, fit.depth_range);
            assert!(hole < STRAY && other < STRAY, "{kind:?} {casters:?}: hole {hole}, false light or shadow {other}");
        }
    }
}

#[test]
fn gpu_without_a_thought_for_casters_the_tight_fits_leave_holes() {
    let mut stage = stage();
    for kind in [FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Focused] {
        let technique = &mut stage.settings.technique;
        (technique.maps, technique.fit.casters) = (technique.maps.with_kind(kind), CasterPolicy::None);
        let [hole, _] = wrong(&mut stage);
        println!("{kind:?}: hole {hole}");
        assert!(hole > 10.0 * STRAY, "{kind:?}: {hole}");
    }
}

#[test]
fn gpu_texels_are_finest_with_the_focused_fit_and_depth_is_shortest_with_depth_clamp() {
    let mut stage = stage();
    let single = stage.settings.technique;
    let mut fit = |kind, casters| {
        let one = SingleMap { shape: Shape::new(kind), stabilise: Stabilise::Off };
        stage.settings.technique = single.with_maps(one).with_fit(single.fit.with_casters(casters));
        let fit = stage.maps(SIZE)[0].projection;
        (fit.texel_size.x * fit.texel_size.y, fit.depth_range)
    };
    let [boxed, oriented, sphere, focused] = KINDS.map(|kind| fit(kind, CasterPolicy::PerObject).0);
    assert!(focused < oriented && oriented < boxed && boxed < sphere, "{focused} {oriented} {boxed} {sphere}");
    let policies = [CasterPolicy::DepthClamp, CasterPolicy::PerObject, CasterPolicy::SceneBounds, CasterPolicy::Extend];
    let [clamped, list, bounds, extended] = policies.map(|casters| fit(FitKind::Focused, casters).1);
    assert!(clamped < list && list <= bounds && bounds < extended, "{clamped} {list} {bounds} {extended}");
}
