//! What follows from a technique's settings.

use shadowfit::glam::DVec2;
use shadowfit::settings::{
    BiasSettings, FilterKind, FitSettings, MapChoice, MapFormat, SoftRadius, Softness, SplitScheme, Stabilise,
};
use shadowfit::{FitInput, FittedMaps, MapFitter, Technique, Workspace};

use crate::support::{DIRECTION, camera};

#[test]
fn with_methods_change_their_field_only() {
    let bias = BiasSettings::default().with_constant(1.0).with_slope(2.0).with_normal_offset(3.0);
    let bias = bias.with_receiver_plane(4.0).with_depth_steps(5.0);
    let written = BiasSettings { constant: 1.0, slope: 2.0, normal_offset: 3.0, receiver_plane: 4.0, depth_steps: 5.0 };
    assert_eq!(bias, written);
    let softness = Softness::default().with_radius(SoftRadius::Metres(0.1)).with_floor(0.5).with_ceiling(8.0);
    assert_eq!(softness, Softness { radius: SoftRadius::Metres(0.1), floor: 0.5, ceiling: 8.0 });
    let technique = Technique::default().with_look_up(FilterKind::Point, bias).with_format(MapFormat::R32Float);
    let expected = Technique { bias, filter: FilterKind::Point, format: MapFormat::R32Float, ..Technique::default() };
    assert_eq!(technique, expected);
}

#[test]
fn another_filter_brings_its_bias_and_its_border() {
    let technique = Technique::default().with_filter(FilterKind::Point);
    assert_eq!(technique.bias, BiasSettings::automatic(FilterKind::Point));
    assert_eq!((technique.border(), Technique::default().border()), (0.5, 3.0));
    let offset = BiasSettings::automatic_normal_offset(FilterKind::Point, &Softness::default());
    let moved = technique.with_look_up(FilterKind::Point, offset);
    assert_eq!(moved.border(), 0.5 + offset.normal_offset, "the looked-up point moves by the offset");
    assert_eq!(moved.with_fit(FitSettings::default().with_border(7.0)).border(), 7.0, "what is set stays");
    let soft = Technique::default().with_filter(FilterKind::Vogel16);
    assert_eq!((soft.reach(), soft.border()), (17.0, 17.0), "a look-up over the widest disc");
}

#[test]
fn the_lengths_of_another_technique_are_the_shadow_distance_and_the_caster_extension_alone() {
    let mut scene = Technique::default().with_max_distance(80.0).with_count(2);
    scene.fit.caster_extension = 7.0;
    for preset in shadowfit::PRESETS {
        let suited = preset.technique().with_lengths_of(&scene);
        let lengths = (suited.fit.max_distance, suited.fit.caster_extension);
        assert_eq!(lengths, (80.0, 7.0), "{}", preset.name);
        assert_eq!(suited.with_lengths_of(&preset.technique()), preset.technique(), "{}", preset.name);
    }
}

/// The maps of three frames of a camera that flies on.
fn fitted(technique: &Technique) -> Vec<FittedMaps> {
    let mut storage = [DVec2::ZERO; Workspace::required(0, 3)];
    let (mut fitter, mut camera) = (MapFitter::new(), camera());
    let mut next = || {
        camera.eye.x += 0.7;
        let views = [camera.frustum().expect("a frustum")];
        fitter.fit(&FitInput::new(&views, DIRECTION), technique, &mut Workspace::new(&mut storage)).expect("maps")
    };
    [(); 3].map(|()| next()).to_vec()
}

#[test]
fn what_has_no_effect_on_windows_has_none() {
    let windows = Technique::preset("windows-4").expect("a preset");
    let same = |name: &str, other: Technique| assert_eq!(fitted(&other), fitted(&windows), "{name}");
    same("splits", windows.with_splits(SplitScheme::Uniform));
    same("overlap", windows.with_overlap(0.5));
    same("choice", windows.with_choice(MapChoice::ViewDepth));
    same("stabilise", windows.with_stabilise(Stabilise::Off));
    same("margin, growth, horizon", windows.with_hold(windows.hold.with_margin(1.0).with_growth(3.0).with_horizon(7)));
    same("texel ratio", windows.with_fit(windows.fit.with_max_texel_ratio(1.0)));
    assert_ne!(fitted(&windows.with_fit(windows.fit.with_border(9.0))), fitted(&windows));
}

#[test]
fn windows_are_read_by_coverage_whatever_the_choice() {
    let technique = Technique::preset("windows-4").expect("a preset").with_choice(MapChoice::ViewDepth);
    assert_eq!(technique.map_choice(), MapChoice::Coverage);
    let slices = Technique::preset("focused-4").expect("a preset");
    let by_depth = slices.with_choice(MapChoice::ViewDepth);
    assert_eq!((by_depth.map_choice(), slices.map_choice()), (MapChoice::ViewDepth, MapChoice::Coverage));
    let maps = fitted(&technique)[0];
    let by_coverage = technique.with_choice(MapChoice::Coverage);
    for depth in 1..150 {
        let point = maps[0].fit.origin + (camera().forward.normalize() * depth as f32).as_dvec3();
        assert_eq!(maps.read(&technique, point, depth.into()), maps.read(&by_coverage, point, depth.into()));
    }
}
