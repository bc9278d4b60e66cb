//! `SunShadows` from an engine's view: on minimal devices, twice in one shader, and with invalid input.

#[path = "door/ground.rs"]
mod ground;
#[path = "door/groups_gpu.rs"]
mod groups_gpu;
#[path = "door/off_gpu.rs"]
mod off_gpu;
#[path = "door/steps_gpu.rs"]
mod steps_gpu;
#[path = "door/texture_gpu.rs"]
mod texture_gpu;

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{CasterPolicy, FilterKind};
use shadowfit::{Aabb, Boxes, FitError, FittedMap, Technique, ViewFrustum};
use shadowfit_wgpu::{
    Casters, ShadowMapError, SunFrame, SunShadows, SunShadowsDescriptor, SunShadowsError, UpdateSchedule,
};

use crate::engine::Engine;
use ground::{BOXES, EYE, MOON, Painter, Quiet, SUN, camera, frame_of};

/// Returns a technique with small maps, because the software adapter draws them often.
fn technique() -> Technique {
    Technique::default().with_resolution(256, 256).with_max_distance(40.0)
}

/// Ground points in the block's shadow, by light, and a lit ground point.
const IN_SUN_SHADOW: [f32; 2] = [1.0, 0.0];
const IN_MOON_SHADOW: [f32; 2] = [-1.0, 0.0];
const LIT: [f32; 2] = [0.0, 5.0];

#[test]
fn gpu_the_default_technique_runs_on_a_device_of_webgl2_limits_without_an_error() {
    let device = Engine::with_webgl2_limits();
    let quiet = Quiet::new(&device);
    let mut sun =
        SunShadows::new(&device.device, &device.queue, &SunShadowsDescriptor::default()).expect("the default's maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let depth = device.depth_texture();
    for step in 0..4_u16 {
        let mut boxes = BOXES;
        boxes[2].min.z += 0.1 * f32::from(step);
        boxes[2].max.z += 0.1 * f32::from(step);
        let camera = camera(EYE + DVec3::X * 0.2 * f64::from(step));
        let views = [camera.frustum().expect("a camera")];
        let moves = [false, false, true];
        let boxes = Boxes { origin: DVec3::ZERO, boxes: &boxes };
        let frame = SunFrame::new(&views, SUN, boxes, Casters { moves: &moves, ..Casters::fixed(boxes) })
            .with_origin(DVec3::ZERO);
        sun.update(&device.queue, &frame).expect("a good frame");
        assert!(sun.prove(&frame).expect("a good frame").is_proven());
        let picture = painter.draw(&device, &[(&sun, boxes.boxes)]);
        assert_eq!([picture.at(IN_SUN_SHADOW)[0], picture.at(LIT)[0]], [0, 255], "frame {step}");
        let mut encoder = device.encoder();
        let convention = shadowfit::DepthConvention::Reversed;
        let recorded = sun.record_demand(&mut encoder, &depth, camera.clip_from_world(convention), convention);
        assert_eq!(recorded, Ok(false), "this device cannot count");
        assert_eq!(sun.wait_for_demand(), Ok(()));
    }
    quiet.assert("WebGL2's limits");
}

#[test]
fn gpu_two_suns_of_one_shader_module_cast_a_shadow_each() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let shadows =
        |technique: &Technique| SunShadows::new(&device.device, &device.queue, &(*technique).into()).expect("maps");
    let (mut sun, mut moon) =
        (shadows(&technique()), shadows(&technique().with_count(2).with_filter(FilterKind::Pcf3x3)));
    let painter = Painter::new(&device, &[(&sun, "sun"), (&moon, "moon")]);
    let views = [camera(EYE).frustum().expect("a camera")];
    for _ in 0..2 {
        sun.update(&device.queue, &frame_of(&views, SUN, &BOXES)).expect("a good frame");
        moon.update(&device.queue, &frame_of(&views, MOON, &BOXES)).expect("a good frame");
        let picture = painter.draw(&device, &[(&sun, &BOXES), (&moon, &BOXES)]);
        let factors = [IN_SUN_SHADOW, IN_MOON_SHADOW, LIT].map(|place| [picture.at(place)[0], picture.at(place)[1]]);
        assert_eq!(factors, [[0, 255], [255, 0], [255, 255]]);
    }
    quiet.assert("two suns");
}

#[test]
fn gpu_a_technique_that_no_maps_can_be_made_of_is_refused_with_its_value_and_the_limit() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let mut clamped = technique().with_filter(FilterKind::Pcss);
    clamped.fit.casters = CasterPolicy::DepthClamp;
    let bad = [
        (technique().with_resolution(0, 2048), vec!["0 × 2048", "256 to 8192"]),
        (technique().with_resolution(2048, 100_000), vec!["2048 × 100000", "256 to 8192"]),
        (technique().with_count(0), vec!["0 shadow maps", "1 to 8"]),
        (technique().with_count(9), vec!["9 shadow maps", "1 to 8"]),
        (clamped, vec!["PCSS with depth clamp", "another filter"]),
    ];
    let views = [camera(EYE).frustum().expect("a camera")];
    for (technique, words) in bad {
        let error = SunShadows::new(&device.device, &device.queue, &technique.into()).expect_err("no maps");
        assert_eq!(sun.set_technique(&technique), Err(error.clone()));
        for word in words {
            assert!(error.to_string().contains(word), "{error}: {word}");
        }
        sun.update(&device.queue, &frame_of(&views, SUN, &BOXES)).expect("a good frame");
        let picture = painter.draw(&device, &[(&sun, &BOXES)]);
        assert_eq!([picture.at(IN_SUN_SHADOW)[0], picture.at(LIT)[0]], [0, 255], "after {error}");
    }
    quiet.assert("techniques that are refused");
}

/// Returns invalid frames, and the words that their errors must contain.
fn bad_frames<'a>(good: &SunFrame<'a>, views: &'a [[ViewFrustum; 1]; 3]) -> Vec<(SunFrame<'a>, &'static str)> {
    vec![
        (SunFrame { views: &[], ..*good }, "view"),
        (SunFrame { views: &views[0], ..*good }, "NaN"),
        (SunFrame { views: &views[1], ..*good }, "NaN"),
        (SunFrame { views: &views[2], ..*good }, "inf"),
        (SunFrame { direction: Vec3::NAN, ..*good }, "NaN"),
        (SunFrame { direction: Vec3::ZERO, ..*good }, "length 0"),
        (SunFrame { eye: DVec3::NAN, ..*good }, "the frame's eye is NaN"),
        (SunFrame { origin: DVec3::new(0.0, f64::INFINITY, 0.0), ..*good }, "the frame's origin is inf"),
        (SunFrame { forward: Vec3::Y * 3.0, ..*good }, "length 3"),
        (SunFrame { forward: Vec3::NAN, ..*good }, "NaN"),
    ]
}

#[test]
fn gpu_a_frame_that_makes_no_sense_is_refused_with_its_value_and_the_next_one_is_drawn() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let views = [camera(EYE).frustum().expect("a camera")];
    let mut odd = [views; 3];
    odd[0][0].corners[5].x = f32::NAN;
    odd[1][0].origin.y = f64::NAN;
    odd[2][0].corners[2].z = f32::INFINITY;
    let good = frame_of(&views, SUN, &BOXES);
    let depth = device.depth_texture();
    for (bad, word) in bad_frames(&good, &odd) {
        let error = sun.update(&device.queue, &bad).expect_err(word);
        assert!(error.to_string().contains(word), "{error}: {word}");
        assert_eq!(sun.passes().len(), 0, "{word}: the frame has passes");
        let mut encoder = device.encoder();
        let convention = shadowfit::DepthConvention::Reversed;
        let clip_from_world = camera(EYE).clip_from_world(convention);
        assert_eq!(sun.record_demand(&mut encoder, &depth, clip_from_world, convention), Ok(false), "{word}");
        sun.update(&device.queue, &good).expect("a good frame");
        let picture = painter.draw(&device, &[(&sun, &BOXES)]);
        assert_eq!([picture.at(IN_SUN_SHADOW)[0], picture.at(LIT)[0]], [0, 255], "after {error}");
    }
    quiet.assert("frames that are refused");
}

#[test]
fn gpu_scenes_without_casters_or_receivers_and_lists_of_other_lengths_are_drawn() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let views = [camera(EYE).frustum().expect("a camera")];
    let good = frame_of(&views, SUN, &BOXES);
    let boxes = good.casters.boxes;
    let odd_boxes = [BOXES[0], BOXES[1], Aabb::new(Vec3::NAN, Vec3::ONE)];
    let empty_boxes = [BOXES[0], BOXES[1], Aabb::EMPTY];
    let with = |moves| SunFrame { casters: Casters { moves, ..Casters::fixed(boxes) }, ..good };
    let frames = [
        ("moves that are too short", with(&[true]), true),
        ("moves that are too long", with(&[false, true, false, true, true, true]), true),
        ("unknown receivers", SunFrame { receivers: None, ..good }, true),
        ("an empty box", frame_of(&views, SUN, &empty_boxes), true),
        ("no casters", SunFrame { casters: Casters::default(), ..good }, false),
    ];
    for (what, frame, has_shadow) in frames {
        sun.update(&device.queue, &frame).unwrap_or_else(|error| panic!("{what}: {error}"));
        let picture = painter.draw(&device, &[(&sun, frame.casters.boxes.boxes)]);
        assert_eq!([picture.at(IN_SUN_SHADOW)[0] == 0, picture.at(LIT)[0] == 255], [has_shadow, true], "{what}");
    }
    let nothing_receives = SunFrame { receivers: Some(Boxes::default()), ..good };
    sun.update(&device.queue, &nothing_receives).expect("a scene in which nothing receives shadows");
    painter.draw(&device, &[(&sun, &BOXES)]);
    // A box with NaN may be refused or ignored, and must not affect later frames.
    let refused = sun.update(&device.queue, &frame_of(&views, SUN, &odd_boxes));
    assert!(matches!(refused, Ok(()) | Err(SunShadowsError::Fit(FitError::NotFinite { .. }))), "{refused:?}");
    sun.update(&device.queue, &good).expect("a good frame");
    let picture = painter.draw(&device, &[(&sun, &BOXES)]);
    assert_eq!([picture.at(IN_SUN_SHADOW)[0], picture.at(LIT)[0]], [0, 255]);
    quiet.assert("odd scenes");
}

#[test]
fn gpu_maps_of_another_size_or_number_are_refused_by_the_drawing_half() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let views = [camera(EYE).frustum().expect("a camera")];
    let frame = frame_of(&views, SUN, &BOXES);
    let maps = |technique: &Technique| -> Vec<FittedMap> {
        let mut sun = SunShadows::new(&device.device, &device.queue, &(*technique).into()).expect("maps");
        sun.update(&device.queue, &frame).expect("a good frame");
        sun.fitted().to_vec()
    };
    let (own, larger, more) =
        (maps(&technique()), maps(&technique().with_resolution(512, 512)), maps(&technique().with_count(5)));
    let mut kept = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let refused = kept.prepare(&device.queue, &frame, &larger).expect_err("larger maps");
    assert!(matches!(refused, ShadowMapError::Fit { index: 0, .. }), "{refused:?}");
    assert!(refused.to_string().contains("[512, 512]") && refused.to_string().contains("[256, 256]"), "{refused}");
    assert_eq!(kept.passes().len(), 0);
    let refused = kept.prepare(&device.queue, &frame, &more).expect_err("more maps");
    assert_eq!(refused, ShadowMapError::TooManyFits { fits: 5, layers: 4 });
    kept.prepare(&device.queue, &frame, &own).expect("its own maps");
    assert_eq!(kept.passes().len(), 4);
    // Another shadow distance needs no new maps, and an invalid fade is refused.
    let nearer = technique().with_max_distance(30.0).with_fade(0.5);
    assert_eq!(kept.set_technique(&nearer), Ok(false));
    assert_eq!(kept.map().descriptor().fade, [15.0, 30.0]);
    let backward = shadowfit_wgpu::ShadowMapDescriptor { fade: [2.0, 1.0], ..*kept.map().descriptor() };
    let refused = SunShadowsDescriptor { maps: Some(backward), ..technique().into() };
    assert!(matches!(kept.set_descriptor(&refused), Err(ShadowMapError::Fade(_))));
    quiet.assert("maps of another size");
}

#[test]
fn gpu_a_proof_fails_where_shaders_take_positions_from_too_far_away() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique().into()).expect("maps");
    let nothing = frame_of(&[], SUN, &BOXES);
    assert_eq!(sun.prove(&nothing), Err(SunShadowsError::NoFrame));
    // f32 numbers at this distance are half a metre apart.
    let place = DVec3::X * 8_000_000.0;
    let views = [ViewFrustum { origin: EYE + place, ..camera(EYE).frustum().expect("a camera") }];
    let boxes = Boxes { origin: place, boxes: &BOXES };
    let frame = SunFrame::new(&views, SUN, boxes, Casters::fixed(boxes));
    for (frame, is_proven) in [(frame, true), (frame.with_origin(DVec3::ZERO), false)] {
        sun.update(&device.queue, &frame).expect("a good frame");
        let proof = sun.prove(&frame).expect("a good frame");
        assert_eq!(proof.is_proven(), is_proven, "{proof:?}");
    }
    quiet.assert("proofs");
}

/// The bias of a map that waits must cover the rounding of positions relative to the new eye. A ground of 40
/// km makes that rounding larger than any other part of the bias.
#[test]
fn gpu_maps_that_wait_over_a_large_ground_stay_proven() {
    let device = Engine::shared();
    let mut boxes = BOXES;
    (boxes[0].min.x, boxes[0].min.z, boxes[0].max.x, boxes[0].max.z) = (-2e4, -2e4, 2e4, 2e4);
    let technique = technique().with_max_distance(200.0);
    let mut sun = SunShadows::new(&device.device, &device.queue, &technique.into()).expect("maps");
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    sun.set_schedule(UpdateSchedule::Texels(1));
    let mut waited = 0;
    for step in 0..20_u16 {
        let views = [camera(EYE + DVec3::X * 0.5 * f64::from(step)).frustum().expect("a camera")];
        let frame = frame_of(&views, SUN, &boxes).with_origin(views[0].origin);
        sun.update(&device.queue, &frame).expect("a good frame");
        painter.draw(&device, &[(&sun, &boxes)]);
        waited += sun.maps().iter().zip(sun.fitted().iter()).filter(|(shown, fitted)| shown != fitted).count();
        let proof = sun.prove(&frame).expect("a good frame");
        assert!(proof.is_proven(), "frame {step}: {proof:?}");
    }
    assert!(waited > 0, "no map waited");
}
