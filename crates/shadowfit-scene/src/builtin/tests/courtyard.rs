//! Facts about the courtyard: a sound skeleton, feet on the floor, its well-known start view.

use glam::Vec3;

use super::{bounds_below, drawn};
use crate::builtin::{default_camera, default_scene};
use crate::{Lens, Scene};

/// Index of the animation "walk".
const WALK: usize = 0;

/// Returns the node with a name.
fn node(scene: &Scene, name: &str) -> usize {
    scene.nodes.iter().position(|node| node.name == name).expect(name)
}

#[test]
fn the_figure_keeps_its_budget() {
    let scene = default_scene();
    let figure = drawn(&scene, scene.subject);
    assert!((15_000..=45_000).contains(&figure), "{figure}");
}

#[test]
fn the_figure_stands_at_the_origin_and_faces_z() {
    let scene = default_scene();
    let subject = scene.subject.expect("a subject");
    let (low, high) = bounds_below(&scene, subject, None, 0.0);
    assert!(low.y.abs() < 0.004, "{low}");
    assert!((1.75..1.95).contains(&high.y), "{high}");
    assert!(low.x < 0.0 && high.x > 0.0 && low.z < 0.0 && high.z > 0.0, "{low} {high}");
    let root = scene.pose(None, 0.0).world_from_node[subject];
    assert!(root.abs_diff_eq(glam::Mat4::IDENTITY, 1e-6));
}

#[test]
fn walking_feet_stay_within_a_centimetre_and_a_half_of_the_floor() {
    let scene = default_scene();
    let subject = scene.subject.expect("a subject");
    // A stride, at steps that also fall between the keyframes.
    for step in 0..100 {
        let low = bounds_below(&scene, subject, Some(WALK), step as f32 * 0.0109).0.y;
        assert!(low.abs() < 0.015, "{low} m at step {step}");
    }
}

#[test]
fn a_planted_foot_does_not_slide() {
    let scene = default_scene();
    for (name, start) in [("left foot", 0.0), ("right foot", 0.54)] {
        let foot = node(&scene, name);
        // From foot flat to heel off, for two strides of 1.08 s.
        for stride in 0..2 {
            let at = |step: usize| {
                let seconds = start + 1.08 * stride as f32 + 0.15 + step as f32 * 0.0133;
                scene.pose(Some(WALK), seconds).world_from_node[foot].w_axis.truncate()
            };
            let slide = (0..10).map(|step| at(step).distance(at(0))).fold(0.0, f32::max);
            assert!(slide < 0.003, "{name} slides {slide} m");
        }
    }
}

#[test]
fn the_walk_faces_where_it_goes_on_a_circle_of_two_metres() {
    let scene = default_scene();
    let subject = scene.subject.expect("a subject");
    let at = |seconds: f32| scene.pose(Some(WALK), seconds).world_from_node[subject];
    for step in 0..24 {
        let seconds = step as f32 * 0.49;
        let (root, later) = (at(seconds), at(seconds + 0.01));
        let ahead = (later.w_axis - root.w_axis).truncate().normalize();
        assert!(root.z_axis.truncate().dot(ahead) > 0.995, "at {seconds} s");
        let radius = root.w_axis.truncate().distance(Vec3::new(2.0, 0.0, 0.0));
        assert!((radius - 2.0).abs() < 0.005, "{radius}");
    }
}

#[test]
fn the_camera_is_that_of_the_function_and_the_sun_comes_from_its_right() {
    let scene = default_scene();
    let (eye, target) = default_camera();
    let camera = &scene.cameras[0];
    let world = scene.pose(None, 0.0).world_from_node[camera.node];
    assert!(world.w_axis.truncate().distance(eye) < 1e-5);
    assert!((-world.z_axis.truncate()).dot((target - eye).normalize()) > 0.9999);
    assert!(matches!(camera.lens, Lens::Perspective { .. }));
    let sun = scene.sun.expect("a sun").direction;
    assert!((sun.length() - 1.0).abs() < 1e-6 && sun.x < 0.0 && sun.y < 0.0 && sun.z < 0.0);
}

#[test]
fn the_scene_fits_on_its_floor() {
    let scene = default_scene();
    let bounds = scene.bounds(&scene.pose(None, 0.0)).expect("bounds");
    assert!(bounds.min.y > -0.1 && bounds.max.y < 15.0, "{bounds:?}");
    assert!(bounds.max.x - bounds.min.x < 121.0, "{bounds:?}");
}
