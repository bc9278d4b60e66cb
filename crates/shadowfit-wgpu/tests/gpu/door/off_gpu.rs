//! A sun that the engine turns off: it has no pass and gives no light, and its maps are correct in the first
//! frame afterwards.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera, ViewFrustum};
use shadowfit_wgpu::{MapView, SunShadows, SunShadowsError};

use super::ground::{BOXES, EYE, MOON, Painter, Picture, Quiet, SUN, camera, frame_of};
use super::{IN_SUN_SHADOW, LIT, technique};
use crate::engine::Engine;

/// Positions on the ground, in shadow and lit.
const EVERYWHERE: [[f32; 2]; 5] = [IN_SUN_SHADOW, LIT, [-7.9, -7.9], [7.9, -7.9], [7.9, 7.9]];

fn factors(picture: &Picture) -> [u8; 5] {
    EVERYWHERE.map(|place| picture.at(place)[0])
}

#[test]
fn gpu_a_sun_that_is_off_has_no_pass_and_gives_no_light_from_anywhere() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let views = [camera(EYE).frustum().expect("a camera")];
    let frame = frame_of(&views, SUN, &BOXES);
    // Test before the first frame, and after it.
    for is_first in [true, false] {
        if !is_first {
            sun.update(&device.queue, &frame).expect("a good frame");
            assert!(!sun.is_off());
            assert_eq!(factors(&painter.draw(&device, &[(&sun, &BOXES)]))[..2], [0, 255]);
        }
        for _ in 0..2 {
            sun.turn_off(&device.queue);
            assert!(sun.is_off());
            assert_eq!((sun.passes().len(), sun.maps().len()), (0, 0));
            assert_eq!(factors(&painter.draw(&device, &[(&sun, &BOXES)])), [0; 5]);
            let elsewhere = MapView::from_eye(EYE + DVec3::X, Vec3::NEG_Z);
            sun.set_view(&device.queue, &elsewhere).expect("a good view");
            assert_eq!(factors(&painter.draw(&device, &[(&sun, &BOXES)])), [0; 5]);
            assert_eq!(sun.prove(&frame), Err(SunShadowsError::NoFrame));
            let mut encoder = device.encoder();
            let clip_from_world = camera(EYE).clip_from_world(DepthConvention::Reversed);
            let depth = device.depth_texture();
            let recorded = sun.record_demand(&mut encoder, &depth, clip_from_world, DepthConvention::Reversed);
            assert_eq!(recorded, Ok(false));
        }
        let refused = sun.update(&device.queue, &frame_of(&[], SUN, &BOXES));
        assert!(refused.is_err() && sun.is_off(), "a refused frame does not turn the sun on");
    }
    quiet.assert("a sun that is off");
}

/// Returns views of the same eye that begin beyond the shadow distance: one is created with this distance,
/// the other exceeds the technique's distance.
fn views_beyond() -> [ViewFrustum; 2] {
    let camera = PerspectiveCamera { near: 50.0, far: 90.0, ..camera(EYE) };
    let eye_from_clip = camera.clip_from_world(DepthConvention::Reversed).inverse();
    let empty = ViewFrustum::from_eye_from_clip(&eye_from_clip, EYE, DepthConvention::Reversed, 40.0);
    [empty.expect("a good matrix"), camera.frustum().expect("a camera")]
}

#[test]
fn gpu_views_beyond_the_shadow_distance_have_no_pass_and_are_lit_until_they_come_near() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let near = [camera(EYE).frustum().expect("a camera")];
    let mut moved = BOXES;
    moved[1].min.z += 4.0;
    moved[1].max.z += 4.0;
    let frame = frame_of(&near, SUN, &BOXES);
    for view in views_beyond() {
        let views = [view];
        for _ in 0..3 {
            sun.update(&device.queue, &frame).expect("a good frame");
            assert_eq!(factors(&painter.draw(&device, &[(&sun, &BOXES)]))[..2], [0, 255]);
        }
        // A caster moves meanwhile.
        for boxes in [&BOXES, &moved] {
            let beyond = frame_of(&views, SUN, boxes);
            sun.update(&device.queue, &beyond).expect("a frame without shadows");
            assert_eq!((sun.passes().len(), sun.maps().len(), sun.is_off()), (0, 0, false));
            assert!(sun.prove(&beyond).expect("a frame").is_proven());
            assert_eq!(factors(&painter.draw(&device, &[(&sun, boxes)])), [255; 5]);
            let mut encoder = device.encoder();
            let clip_from_world = camera(EYE).clip_from_world(DepthConvention::Reversed);
            let depth = device.depth_texture();
            let recorded = sun.record_demand(&mut encoder, &depth, clip_from_world, DepthConvention::Reversed);
            assert_eq!(recorded, Ok(false));
        }
        let again = frame_of(&near, SUN, &moved);
        sun.update(&device.queue, &again).expect("a good frame");
        assert!(sun.prove(&again).expect("a frame").is_proven());
        let kept = painter.draw(&device, &[(&sun, &moved)]);
        let mut fresh = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
        fresh.update(&device.queue, &again).expect("a good frame");
        let fresh = painter.draw(&device, &[(&fresh, &moved)]);
        assert_eq!(factors(&kept), factors(&fresh), "a stale map");
        sun.update(&device.queue, &again).expect("a good frame");
        assert_eq!(sun.passes().len(), 0, "static casters are kept");
        painter.draw(&device, &[(&sun, &moved)]);
    }
    quiet.assert("views beyond the shadow distance");
}

#[test]
fn gpu_a_sun_that_comes_back_has_the_maps_of_a_new_one_in_its_first_frame() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let near = [camera(EYE).frustum().expect("a camera")];
    let far = [camera(EYE + DVec3::X * 3.0).frustum().expect("a camera")];
    let mut moved = BOXES;
    moved[1].min.z += 4.0;
    moved[1].max.z += 4.0;
    let mornings = [
        ("the same", frame_of(&near, SUN, &BOXES), &BOXES),
        ("another direction", frame_of(&near, MOON, &BOXES), &BOXES),
        ("another view", frame_of(&far, SUN, &BOXES), &BOXES),
        ("another scene", frame_of(&near, SUN, &moved), &moved),
    ];
    for (what, morning, boxes) in mornings {
        for _ in 0..3 {
            sun.update(&device.queue, &frame_of(&near, SUN, &BOXES)).expect("a good frame");
            painter.draw(&device, &[(&sun, &BOXES)]);
        }
        sun.turn_off(&device.queue);
        painter.draw(&device, &[(&sun, &BOXES)]);
        sun.update(&device.queue, &morning).expect("a good frame");
        assert!(sun.prove(&morning).expect("a good frame").is_proven(), "{what}");
        let picture = painter.draw(&device, &[(&sun, boxes)]);
        let mut new = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
        new.update(&device.queue, &morning).expect("a good frame");
        assert_eq!(sun.fitted(), new.fitted(), "{what}");
        let expected = painter.draw(&device, &[(&new, boxes)]);
        assert!(picture.difference(&expected) <= 1, "{what}: {}", picture.difference(&expected));
    }
    quiet.assert("a sun that comes back");
}
