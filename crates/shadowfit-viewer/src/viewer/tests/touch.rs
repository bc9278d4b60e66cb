//! Fingers on the picture, as windows report them: touches, the first of which is a pointer as well.

use egui::{Event, Modifiers, PointerButton, TouchDeviceId, TouchId, TouchPhase};
use glam::{DVec3, Vec3};

use super::*;

fn touch(id: u64, phase: TouchPhase, pos: Pos2) -> Event {
    Event::Touch { device_id: TouchDeviceId(0), id: TouchId(id), phase, pos, force: None }
}

/// Returns the events of the first finger, which is a pointer as well.
fn first(phase: TouchPhase, pos: Pos2) -> Vec<Event> {
    let button =
        |pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    let pointer = match phase {
        TouchPhase::Start => vec![Event::PointerMoved(pos), button(true)],
        TouchPhase::Move => vec![Event::PointerMoved(pos)],
        TouchPhase::End => vec![button(false), Event::PointerGone],
        TouchPhase::Cancel => vec![Event::PointerGone],
    };
    [touch(0, phase, pos)].into_iter().chain(pointer).collect()
}

fn tap(viewer: &mut Viewer, pos: Pos2) {
    frame_with(viewer, first(TouchPhase::Start, pos));
    frame_with(viewer, first(TouchPhase::End, pos));
}

/// A place on the picture.
const AT: Pos2 = Pos2::new(200.0, 180.0);

#[test]
fn gpu_one_finger_takes_the_picture_with_it() {
    let mut viewer = ready(&[], None);
    let before = viewer.stage.camera;
    frame_with(&mut viewer, first(TouchPhase::Start, AT));
    frame_with(&mut viewer, first(TouchPhase::Move, AT + vec2(50.0, 0.0)));
    frame_with(&mut viewer, first(TouchPhase::End, AT + vec2(50.0, 0.0)));
    let after = viewer.stage.camera;
    assert_eq!(after.position, before.position);
    assert!((after.yaw - before.yaw - 0.2).abs() < 1e-3, "{} and {}", before.yaw, after.yaw);
}

/// Moves two fingers, and returns the movement of the eye along the camera's axes.
fn two_fingers(viewer: &mut Viewer, from: [Pos2; 2], to: [Pos2; 2]) -> Vec3 {
    let before = viewer.stage.camera;
    frame_with(viewer, first(TouchPhase::Start, from[0]));
    frame_with(viewer, vec![touch(1, TouchPhase::Start, from[1])]);
    for step in 1..=10 {
        let [a, b] = [0, 1].map(|finger: usize| from[finger].lerp(to[finger], step as f32 / 10.0));
        let events = first(TouchPhase::Move, a).into_iter().chain([touch(1, TouchPhase::Move, b)]);
        frame_with(viewer, events.collect());
    }
    frame_with(viewer, vec![touch(1, TouchPhase::End, to[1])]);
    frame_with(viewer, first(TouchPhase::End, to[0]));
    let after = viewer.stage.camera;
    assert_eq!((after.yaw, after.pitch), (before.yaw, before.pitch), "two fingers do not turn the head");
    let moved: DVec3 = after.position - before.position;
    let moved = moved.as_vec3();
    Vec3::new(moved.dot(before.right()), moved.y, moved.dot(before.forward()))
}

#[test]
fn gpu_two_fingers_move_and_pinching_flies() {
    let mut viewer = ready(&[], None);
    let b = AT + vec2(60.0, 0.0);
    let right = vec2(60.0, 0.0);
    let moved = two_fingers(&mut viewer, [AT, b], [AT + right, b + right]);
    assert!(moved.x < -0.1 && moved.y.abs() < 1e-3, "the scene goes with the fingers: {moved}");
    let down = vec2(0.0, 60.0);
    let moved = two_fingers(&mut viewer, [AT, b], [AT + down, b + down]);
    assert!(moved.y > 0.1 && moved.x.abs() < 1e-3, "{moved}");
    let moved = two_fingers(&mut viewer, [AT, b], [AT - right, b + right]);
    assert!(moved.z > 0.5 && moved.x.abs() < 1e-2, "fingers that part fly forward: {moved}");
    let moved = two_fingers(&mut viewer, [AT - right, b + right], [AT, b]);
    assert!(moved.z < -0.5, "{moved}");
}

#[test]
fn gpu_a_tap_asks_why_a_second_one_flies_there_and_a_drag_forgets_it() {
    let mut viewer = ready(&[], None);
    until(&mut viewer, "rays", |viewer| viewer.stage.prepared_scene().ready_rays().is_some());
    tap(&mut viewer, Pos2::new(320.0, 230.0));
    until(&mut viewer, "the reason", |viewer| viewer.stage.why().is_some());
    frame_with(&mut viewer, first(TouchPhase::Start, AT));
    frame_with(&mut viewer, first(TouchPhase::Move, AT + vec2(40.0, 0.0)));
    frame_with(&mut viewer, first(TouchPhase::End, AT + vec2(40.0, 0.0)));
    frame(&mut viewer);
    assert_eq!(viewer.stage.why(), None);
    (0..30).for_each(|_| frame(&mut viewer));
    let before = viewer.stage.camera;
    tap(&mut viewer, Pos2::new(320.0, 230.0));
    tap(&mut viewer, Pos2::new(320.0, 230.0));
    frame(&mut viewer);
    assert_ne!(viewer.stage.camera.position, before.position);
}

#[test]
fn gpu_a_finger_beside_the_bar_between_a_and_b_drags_it() {
    let mut viewer = ready(&[], None);
    run(&mut viewer, Command::Compare(Toggle::On));
    (0..3).for_each(|_| frame(&mut viewer));
    // The first touch reveals a touch screen.
    tap(&mut viewer, AT);
    let before = viewer.stage.camera;
    let bar = Pos2::new(320.0 + 14.0, 180.0);
    frame_with(&mut viewer, first(TouchPhase::Start, bar));
    frame_with(&mut viewer, first(TouchPhase::Move, bar + vec2(40.0, 0.0)));
    frame_with(&mut viewer, first(TouchPhase::Move, bar + vec2(80.0, 0.0)));
    frame_with(&mut viewer, first(TouchPhase::End, bar + vec2(80.0, 0.0)));
    assert!((viewer.stage.split - 0.625).abs() < 0.01, "{}", viewer.stage.split);
    assert_eq!(viewer.stage.camera, before);
}
