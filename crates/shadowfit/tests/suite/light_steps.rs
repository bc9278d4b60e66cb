//! A held light keeps its bits, steps when necessary, and fades without a jump.

use proptest::prelude::*;
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::settings::FitKind;
use shadowfit::{FitError, LightProjection};

use crate::support::{DIRECTION, camera, double, exact, fitted};

/// One texel at the edge of a map of 2048.
const SETTINGS: LightSteps = LightSteps { texels: 1.0, extent: 2048.0, fade: 0.0 };

/// Returns the direction of a sun on a circle around the vertical, at an angle in radians.
fn sun(angle: f64) -> Vec3 {
    (DVec3::new(angle.cos(), 0.0, angle.sin()) - DVec3::Y).normalize().as_vec3()
}

/// Returns the angle on the circle for a turn of the light that moves the edge by the given texels.
fn texels(texels: f64) -> f64 {
    // The sun is at an elevation of 45°, so its direction turns by 1/√2 of the circle's angle.
    texels * SETTINGS.angle().unwrap() * std::f64::consts::SQRT_2
}

fn bits(direction: Vec3) -> [u32; 3] {
    direction.to_array().map(f32::to_bits)
}

#[test]
fn a_light_is_held_to_the_bit_until_it_moves_the_edge_by_more_than_is_set() {
    let mut steps = LightStepState::default();
    let first = steps.update(sun(0.0), &SETTINGS, 0.016).unwrap();
    assert_eq!((first.previous, first.blend), (None, 1.0));
    for i in 0..=98 {
        let step = steps.update(sun(texels(f64::from(i) / 100.0)), &SETTINGS, 0.016).unwrap();
        assert_eq!(bits(step.direction), bits(first.direction), "at {i} hundredths of a texel");
        assert_eq!((step.previous, step.blend), (None, 1.0));
    }
    let beyond = sun(texels(1.02));
    let step = steps.update(beyond, &SETTINGS, 0.016).unwrap();
    assert!((step.direction - beyond).length() < 1e-7, "the light steps to where it is");
    assert_eq!((step.previous, step.blend), (None, 1.0), "without a fade there is one direction");
    let held = steps.update(sun(texels(1.9)), &SETTINGS, 0.016).unwrap();
    assert_eq!(bits(held.direction), bits(step.direction), "and is held there again");
}

#[test]
fn a_day_has_as_many_steps_as_its_turn_has_texels() {
    let mut steps = LightStepState::default();
    let mut directions = Vec::new();
    for i in 0..100_000 {
        let step = steps.update(sun(texels(f64::from(i) * 0.01)), &SETTINGS, 0.016).unwrap();
        if directions.last() != Some(&step.direction) {
            directions.push(step.direction);
        }
    }
    // 1000 texels, with an overshoot of up to 0.01 in each step.
    assert!((980..=1000).contains(&directions.len()), "{}", directions.len());
}

#[test]
fn zero_texels_follow_every_change_and_hold_what_does_not_change() {
    let settings = SETTINGS.with_texels(0.0).with_fade(1.0);
    let mut steps = LightStepState::default();
    for _ in 0..3 {
        let step = steps.update(DIRECTION, &settings, 0.1).unwrap();
        assert_eq!((step.previous, step.blend), (None, 1.0));
    }
    assert!(steps.update(sun(1e-6), &settings, 0.1).unwrap().previous.is_some());
}

#[test]
fn a_fade_grows_from_zero_to_one_and_joins_the_steps_without_a_jump() {
    let settings = SETTINGS.with_fade(0.5);
    let mut steps = LightStepState::default();
    let mut last = steps.update(sun(0.0), &settings, 0.0).unwrap();
    let (mut begun, mut ended) = (0, 0);
    for i in 1..1000 {
        // 0.02 texels per frame: a step every 51 frames, a fade of 31.
        let step = steps.update(sun(texels(f64::from(i) * 0.02)), &settings, 1.0 / 60.0).unwrap();
        assert!((0.0..=1.0).contains(&step.blend), "{step:?}");
        match (last.previous, step.previous) {
            (None, Some(previous)) => {
                assert_eq!(bits(previous), bits(last.direction), "the old direction goes on as it was");
                assert_eq!(step.blend, 0.0);
                begun += 1;
            }
            (Some(a), Some(b)) => {
                assert_eq!((bits(a), bits(last.direction)), (bits(b), bits(step.direction)));
                assert!(step.blend > last.blend && step.blend - last.blend < 0.034, "{last:?} then {step:?}");
            }
            (Some(_), None) => {
                assert!(last.blend > 0.96 && step.blend == 1.0, "{last:?} then {step:?}");
                assert_eq!(bits(step.direction), bits(last.direction));
                ended += 1;
            }
            (None, None) => assert_eq!(bits(step.direction), bits(last.direction)),
        }
        last = step;
    }
    assert!((19..=20).contains(&begun) && (begun - 1..=begun).contains(&ended), "{begun} and {ended}");
}

#[test]
fn a_light_that_outruns_its_fade_lags_by_no_more_than_the_fade() {
    let settings = SETTINGS.with_fade(0.25);
    let mut steps = LightStepState::default();
    let frame = |i: i32| sun(texels(f64::from(i) * 3.0));
    for i in 0..200 {
        let step = steps.update(frame(i), &settings, 1.0 / 60.0).unwrap();
        let lag = f64::from(step.direction.angle_between(frame(i)));
        // 15 frames of fade, and one in which it ends.
        assert!(lag <= 16.5 * texels(3.0), "frame {i}: {lag}");
    }
}

#[test]
fn reset_takes_the_next_direction_as_it_is() {
    let settings = SETTINGS.with_fade(10.0);
    let mut steps = LightStepState::default();
    steps.update(sun(0.0), &settings, 0.1).unwrap();
    assert!(steps.update(sun(1.0), &settings, 0.1).unwrap().previous.is_some());
    steps.reset();
    assert_eq!(steps, LightStepState::default());
    let step = steps.update(sun(texels(0.1)), &settings, 0.1).unwrap();
    assert_eq!((bits(step.direction), step.previous, step.blend), (bits(sun(texels(0.1))), None, 1.0));
}

#[test]
fn an_error_leaves_the_state_as_it_was() {
    let mut steps = LightStepState::default();
    steps.update(sun(0.0), &SETTINGS.with_fade(1.0), 0.1).unwrap();
    steps.update(sun(1.0), &SETTINGS.with_fade(1.0), 0.1).unwrap();
    let before = steps;
    let bad = [
        steps.update(Vec3::NAN, &SETTINGS, 0.1),
        steps.update(DIRECTION, &SETTINGS, f32::NAN),
        steps.update(DIRECTION, &SETTINGS, -1.0),
        steps.update(DIRECTION, &SETTINGS.with_texels(f32::NAN), 0.1),
    ];
    assert!(bad.iter().all(Result::is_err), "{bad:?}");
    assert_eq!(steps, before);
    let mut filled = LightStepState { held: Some(Vec3::NAN), ..LightStepState::default() };
    assert!(matches!(filled.update(DIRECTION, &SETTINGS, 0.1), Err(FitError::NotFinite { .. })));
}

/// Returns by how many texels a world point moves across the map when the light turns, relative to the map's
/// middle.
fn movement(from: &LightProjection, to: &LightProjection, point: Vec3) -> f64 {
    let at = |fit: &LightProjection| {
        let m = fit.light_from_world.as_dmat4();
        (m.transform_vector3(point.as_dvec3()).truncate() / from.texel_size.as_dvec2()).abs()
    };
    (at(from) - at(to)).abs().max_element()
}

proptest! {
    /// The bound is linear in the angle. The tolerance allows for a thousandth of a radian squared.
    #[test]
    fn no_point_of_the_box_moves_by_more_than_the_extent_says(
        azimuth in double(0.0, 6.3), elevation in double(0.01, 1.57), (along, up) in (double(-1e-3, 1e-3), double(-1e-3, 1e-3)),
    ) {
        let light = |azimuth: f64, elevation: f64| {
            DVec3::new(azimuth.cos() * elevation.cos(), -elevation.sin(), azimuth.sin() * elevation.cos()).as_vec3()
        };
        let (a, b) = (light(azimuth, elevation), light(azimuth + along, (elevation + up).clamp(0.0, 1.57)));
        let [from, to] = [a, b].map(|direction| fitted(&camera(), direction, &exact(FitKind::FrustumAabb)));
        let angle = DVec3::angle_between(a.as_dvec3(), b.as_dvec3());
        let bound = angle * f64::from(LightSteps::extent_of(&from)) / 2.0;
        let corners = from.corners();
        let middle = corners.iter().sum::<Vec3>() / 8.0;
        for corner in corners {
            let moved = movement(&from, &to, corner - middle);
            prop_assert!(moved <= bound * 1.01 + 0.01, "{moved} texels, bound {bound}");
        }
    }
}
