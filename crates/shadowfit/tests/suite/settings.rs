//! The sun's angles, and what follows from a technique's settings.

use proptest::prelude::*;
use shadowfit::glam::{DVec2, Vec3};
use shadowfit::settings::{
    BiasSettings, FilterKind, FitSettings, MapChoice, MapFormat, SoftRadius, Softness, SplitScheme, Stabilise,
};
use shadowfit::tool::{CameraSettings, LightSettings, Settings, ViewSettings};
use shadowfit::{FitInput, FittedMaps, MapFitter, Technique, Workspace};

use crate::support::{DIRECTION, any_direction, camera};

fn light(azimuth: f32, elevation: f32) -> Vec3 {
    LightSettings::default().with_azimuth(azimuth).with_elevation(elevation).direction()
}

#[test]
fn azimuth_is_counted_from_plus_z_toward_plus_x_and_the_light_travels_away() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let table = [
        (0.0, 0.0, Vec3::NEG_Z),
        (quarter, 0.0, Vec3::NEG_X),
        (2.0 * quarter, 0.0, Vec3::Z),
        (-quarter, 0.0, Vec3::X),
        (0.3, quarter, Vec3::NEG_Y),
        (0.3, -quarter, Vec3::Y),
    ];
    for (azimuth, elevation, expected) in table {
        let direction = light(azimuth, elevation);
        // π/2 rounded to f32 is off by 4e-8.
        assert!(direction.abs_diff_eq(expected, 2e-7), "{azimuth}, {elevation}: {direction}");
    }
}

#[test]
fn a_vertical_light_has_azimuth_zero() {
    for direction in [Vec3::NEG_Y, Vec3::Y, Vec3::new(-0.0, -1.0, -0.0), Vec3::new(0.0, -2.0, -0.0)] {
        assert_eq!(LightSettings::from_direction(direction).unwrap().azimuth, 0.0);
    }
}

#[test]
fn angles_that_are_not_finite_give_a_direction_that_is_not() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(!light(value, 0.5).is_finite());
        assert!(!light(0.5, value).is_finite());
    }
}

proptest! {
    /// Two angles rounded to f32: up to 1.2e-7 rad at π.
    #[test]
    fn angles_and_direction_convert_back_and_forth(direction in any_direction()) {
        let settings = LightSettings::from_direction(direction * 3.0).unwrap();
        prop_assert!(settings.direction().abs_diff_eq(direction, 1e-6), "{settings:?}");
    }
}

#[test]
fn the_sun_rises_in_the_east_stands_in_the_south_at_noon_and_sets_in_the_west() {
    let toward = |hour: f32| -LightSettings::default().with_hour(Some(hour)).direction();
    let (sin, cos) = 50_f32.to_radians().sin_cos();
    for (hour, expected) in [(6.0, Vec3::X), (12.0, Vec3::new(0.0, sin, cos)), (18.0, Vec3::NEG_X)] {
        assert!((toward(hour) - expected).length() < 1e-6, "{hour}: {}", toward(hour));
    }
    let angles = LightSettings::default().with_hour(Some(12.0)).by_angles();
    assert!(angles.hour.is_none() && angles.azimuth.abs() < 1e-6);
    assert!((angles.elevation.to_degrees() - 50.0).abs() < 1e-4, "{}", angles.elevation.to_degrees());
}

#[test]
fn an_animated_sun_circles_or_passes_over_the_day_and_a_still_one_stays() {
    use core::f32::consts::{FRAC_PI_2, PI};
    let moved = |light: LightSettings, seconds: f32| {
        let mut light = light;
        light.advance(seconds);
        light
    };
    let still = LightSettings::default();
    assert_eq!(moved(still, 5.0), still);
    let circling = still.with_animate(true).with_animate_speed(FRAC_PI_2).with_azimuth(PI - 0.1);
    assert!((moved(circling, 1.0).azimuth - (-FRAC_PI_2 - 0.1)).abs() < 1e-5);
    // A right angle is six hours, and the night has none.
    let day = circling.with_hour(Some(16.0));
    assert!((moved(day, 1.0).hour.unwrap() - 10.0).abs() < 1e-5);
    assert_eq!(moved(day, 1.0).azimuth, day.azimuth);
}

#[test]
fn with_methods_change_their_field_only() {
    let bias = BiasSettings::default().with_constant(1.0).with_slope(2.0).with_normal_offset(3.0);
    let bias = bias.with_receiver_plane(4.0).with_depth_steps(5.0);
    let written = BiasSettings { constant: 1.0, slope: 2.0, normal_offset: 3.0, receiver_plane: 4.0, depth_steps: 5.0 };
    assert_eq!(bias, written);
    let softness = Softness::default().with_radius(SoftRadius::Metres(0.1)).with_floor(0.5).with_ceiling(8.0);
    assert_eq!(softness, Softness { radius: SoftRadius::Metres(0.1), floor: 0.5, ceiling: 8.0 });
    let camera = CameraSettings::default().with_near(1.0);
    assert_eq!(camera, CameraSettings { near: 1.0, ..CameraSettings::default() });
    let view = ViewSettings::default().with_play(false);
    let technique = Technique::default().with_look_up(FilterKind::Point, bias).with_format(MapFormat::R32Float);
    let expected = Technique { bias, filter: FilterKind::Point, format: MapFormat::R32Float, ..Technique::default() };
    assert_eq!(technique, expected);
    let settings = Settings::default().with_technique(technique).with_camera(camera).with_view(view);
    assert_eq!(settings, Settings { technique, camera, view, ..Settings::default() });
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
