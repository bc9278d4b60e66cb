//! The sun's angles and hours, and the names of views.

use proptest::prelude::*;
use shadowfit::glam::Vec3;
use shadowfit_params::tool::{LightSettings, ViewMode};
use shadowfit_params::view_option;

fn light(azimuth: f32, elevation: f32) -> Vec3 {
    LightSettings { azimuth, elevation, ..LightSettings::default() }.direction()
}

fn at(hour: f32) -> LightSettings {
    LightSettings { hour: Some(hour), ..LightSettings::default() }
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

#[test]
fn a_direction_that_is_none_has_no_angles() {
    for direction in [Vec3::ZERO, Vec3::new(0.0, f32::NAN, 1.0), Vec3::new(f32::INFINITY, 0.0, 0.0)] {
        assert_eq!(LightSettings::from_direction(direction), None);
    }
}

proptest! {
    /// Rounding error of two angles in f32: up to 1.2e-7 rad at π.
    #[test]
    fn angles_and_direction_convert_back_and_forth(direction in prop::array::uniform3(-1.0_f32..=1.0)) {
        let direction = Vec3::from(direction);
        prop_assume!(direction.length() > 1e-3);
        let direction = direction.normalize();
        let settings = LightSettings::from_direction(direction * 3.0).unwrap();
        prop_assert!(settings.direction().abs_diff_eq(direction, 1e-6), "{settings:?}");
    }
}

#[test]
fn the_sun_rises_in_the_east_stands_in_the_south_at_noon_and_sets_in_the_west() {
    let toward = |hour: f32| -at(hour).direction();
    let (sin, cos) = 50_f32.to_radians().sin_cos();
    for (hour, expected) in [(6.0, Vec3::X), (12.0, Vec3::new(0.0, sin, cos)), (18.0, Vec3::NEG_X)] {
        assert!((toward(hour) - expected).length() < 1e-6, "{hour}: {}", toward(hour));
    }
    let angles = at(12.0).by_angles();
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
    let circling = LightSettings { animate: true, animate_speed: FRAC_PI_2, azimuth: PI - 0.1, ..still };
    assert!((moved(circling, 1.0).azimuth - (-FRAC_PI_2 - 0.1)).abs() < 1e-5);
    // A right angle takes six hours, and the animated day has no night.
    let day = LightSettings { hour: Some(16.0), ..circling };
    assert!((moved(day, 1.0).hour.unwrap() - 10.0).abs() < 1e-5);
    assert_eq!(moved(day, 1.0).azimuth, day.azimuth);
}

#[test]
fn every_view_has_a_name_of_its_own() {
    let mut labels: Vec<&str> = ViewMode::ALL.into_iter().map(|mode| view_option(mode).label).collect();
    labels.sort_unstable();
    labels.dedup();
    assert_eq!(labels.len(), ViewMode::ALL.len());
    assert_eq!(view_option(ViewMode::Outside).label, "Outside");
}
