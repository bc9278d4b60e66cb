use super::*;

/// Maps of this width step after 2 / SIDE rad.
const SIDE: u32 = 1000;
const ANGLE: f32 = 0.002;
const MAPS: usize = 3;

/// Returns the direction of a sun that has turned by an angle since the first frame.
fn sun(angle: f32) -> Vec3 {
    Vec3::new(angle.sin(), -angle.cos(), 0.0) * 3.0
}

/// Returns whether a direction is the sun's direction at an angle.
fn is_at(direction: Vec3, angle: f32) -> bool {
    (direction - sun(angle) / 3.0).length() < 1e-6
}

/// Returns a state that holds the sun at the angle 0.
fn held(fade: u32) -> StepState {
    let mut state = StepState::new(LightSteps::default().with_fade(fade));
    let step = next(&mut state, 0.0);
    assert!(is_at(step.now, 0.0) && step.other.is_none());
    state
}

fn next(state: &mut StepState, angle: f32) -> Step {
    state.next(sun(angle), SIDE, MAPS).expect("a direction")
}

#[test]
fn a_sun_is_held_until_an_edge_would_be_a_texel_off() {
    let mut state = held(0);
    for angle in [0.3, -0.9, 0.99] {
        let step = next(&mut state, angle * ANGLE);
        assert!(is_at(step.now, 0.0) && step.other.is_none(), "{step:?}");
    }
    let step = next(&mut state, 1.01 * ANGLE);
    assert_eq!((is_at(step.now, 1.01 * ANGLE), step.other, step.begins), (true, None, false), "at once");
    let two = state.with_settings(LightSteps::default().with_texels(2.0));
    let step = next(&mut two.clone(), 3.0 * ANGLE);
    assert!(is_at(step.now, 1.01 * ANGLE), "two texels allow twice the angle");
}

#[test]
fn the_next_maps_are_drawn_one_by_one_then_faded_in_then_alone() {
    let mut state = held(4);
    for drawn in 1..=MAPS {
        // The sun moves on during the step, and the maps do not follow it.
        let step = next(&mut state, (1.0 + drawn as f32) * ANGLE);
        assert!(is_at(step.now, 0.0) && step.other.is_some_and(|other| is_at(other, 2.0 * ANGLE)), "{step:?}");
        assert_eq!((step.begins, step.swaps), (drawn == 1, false));
        assert!(matches!(state.stage(), Stage::Drawing { drawn: now, .. } if now == drawn));
    }
    for frame in 1..4_u8 {
        let step = next(&mut state, 6.0 * ANGLE);
        assert!(is_at(step.now, 2.0 * ANGLE) && step.other.is_some_and(|other| is_at(other, 0.0)), "{step:?}");
        assert_eq!((step.begins, step.swaps), (false, frame == 1));
        assert!(matches!(state.stage(), Stage::Fading { share, .. } if share == f32::from(frame) / 4.0));
    }
    let step = next(&mut state, 6.0 * ANGLE);
    assert_eq!((is_at(step.now, 2.0 * ANGLE), step.other, state.stage()), (true, None, Stage::Held));
    // The sun is far enough for another step.
    assert!(next(&mut state, 6.0 * ANGLE).begins);
}

#[test]
fn what_is_seen_serves_the_newest_direction_from_the_first_frame_of_a_step_on() {
    let mut state = held(4);
    assert!(!state.is_drawing() && state.newest().is_some_and(|newest| is_at(newest, 0.0)));
    for frame in 0..MAPS + 5 {
        next(&mut state, 1.5 * ANGLE);
        assert_eq!(state.is_drawing(), frame < MAPS, "frame {frame}");
        assert!(state.newest().is_some_and(|newest| is_at(newest, 1.5 * ANGLE)), "frame {frame}");
    }
}

#[test]
fn a_fade_of_one_frame_changes_from_one_set_to_the_other() {
    let mut state = held(1);
    for _ in 0..MAPS {
        assert!(is_at(next(&mut state, 1.5 * ANGLE).now, 0.0));
    }
    let step = next(&mut state, 1.5 * ANGLE);
    assert_eq!((is_at(step.now, 1.5 * ANGLE), step.other, step.swaps), (true, None, true));
}

#[test]
fn maps_that_are_redrawn_anyway_are_faded_from_the_first_frame_on() {
    let mut state = held(2);
    let step = state.next(sun(1.5 * ANGLE), SIDE, 0).expect("a direction");
    assert!(step.begins && step.swaps && is_at(step.now, 1.5 * ANGLE), "{step:?}");
    assert!(step.other.is_some_and(|other| is_at(other, 0.0)));
}

#[test]
fn a_sun_that_stands_still_ends_its_step_and_begins_no_other() {
    let mut state = held(4);
    next(&mut state, 1.5 * ANGLE);
    for _ in 0..20 {
        next(&mut state, 1.5 * ANGLE);
    }
    assert_eq!(state.stage(), Stage::Held);
}

#[test]
fn a_sun_that_is_set_elsewhere_is_there_at_once_whatever_is_under_way() {
    for frames in 0..12 {
        let mut state = held(4);
        for _ in 0..frames {
            next(&mut state, 1.5 * ANGLE);
        }
        let step = next(&mut state, 0.5);
        assert_eq!((is_at(step.now, 0.5), step.other, step.swaps), (true, None, false), "after {frames} frames");
        assert_eq!(next(&mut state, 0.5).other, None);
    }
}

#[test]
fn a_cut_ends_a_step_with_the_newest_direction_and_keeps_what_is_held() {
    for frames in 1..12 {
        let mut state = held(4);
        for _ in 0..frames {
            next(&mut state, 1.5 * ANGLE);
        }
        state.cut();
        let step = next(&mut state, 2.0 * ANGLE);
        assert_eq!((is_at(step.now, 1.5 * ANGLE), step.other), (true, None), "after {frames} frames");
        // A turn by more than a step is not faded either.
        state.cut();
        let step = next(&mut state, 3.0 * ANGLE);
        assert_eq!((is_at(step.now, 3.0 * ANGLE), step.other), (true, None));
    }
}

#[test]
fn a_direction_that_makes_no_sense_is_refused_in_every_stage() {
    for frames in 0..12 {
        let mut state = held(4);
        for _ in 0..frames {
            next(&mut state, 1.5 * ANGLE);
        }
        let before = state.stage();
        state.next(Vec3::ZERO, SIDE, MAPS).expect_err("no direction");
        state.next(Vec3::NAN, SIDE, MAPS).expect_err("no number");
        assert_eq!(state.stage(), before);
    }
    for texels in [-1.0, f32::NAN, f32::INFINITY] {
        LightSteps::default().with_texels(texels).check().expect_err("no texels");
    }
}
