//! Values derived from a technique's settings.

use shadowfit::glam::DVec2;
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat, MapSelection, MapSettings, SoftRadius, Softness};
use shadowfit::{FitInput, FitState, FittedMaps, Maps, Scratch, Technique, Windows};

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
    assert_eq!(moved.with_fit(MapSettings::default().with_border(7.0)).border(), 7.0, "what is set stays");
    let soft = Technique::default().with_filter(FilterKind::Vogel16);
    assert_eq!((soft.filter_radius(), soft.border()), (17.0, 17.0), "a look-up over the widest disc");
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

/// Returns the maps of three frames of a flying camera.
fn fitted(technique: &Technique) -> Vec<FittedMaps> {
    let mut storage = [DVec2::ZERO; Scratch::required(0, 3)];
    let (mut fitter, mut camera) = (FitState::new(), camera());
    let mut next = || {
        camera.eye.x += 0.7;
        let views = [camera.frustum().expect("a frustum")];
        fitter.fit(&FitInput::new(&views, DIRECTION), technique, &mut Scratch::new(&mut storage)).expect("maps")
    };
    [(); 3].map(|()| next()).to_vec()
}

#[test]
fn the_border_has_an_effect_on_windows() {
    let windows = Technique::preset("windows-4").expect("a preset");
    assert_ne!(fitted(&windows.with_fit(windows.fit.with_border(9.0))), fitted(&windows));
}

#[test]
fn windows_are_read_by_coverage_and_slices_as_they_say() {
    let windows = Windows::default().with_blend(5.0);
    assert_eq!(Maps::from(windows).selection(), MapSelection::Coverage { blend: 5.0 });
    let by_depth = MapSelection::ViewDepth { overlap: 0.5 };
    let cascades = Technique::preset("focused-4").expect("a preset").maps;
    let chosen = [cascades, cascades.as_cascades().with_selection(by_depth).into()].map(|maps| maps.selection());
    assert_eq!(chosen, [MapSelection::default(), by_depth]);
}
