//! Cameras and suns of all scenes: at eye height, with the subject in sight, in daylight.

use glam::{Mat4, Vec3};

use super::all;
use crate::builtin::BuiltinScene;
use crate::{Lens, Scene};

/// Aspect ratio for which the start views were designed.
const ASPECT: f32 = 16.0 / 9.0;

/// Returns the world-from-camera matrix of the scene's first camera, which looks along -z, and its vertical
/// field of view.
fn camera(scene: &Scene) -> (Mat4, f32) {
    let camera = &scene.cameras[0];
    let Lens::Perspective { fov_y, near, far } = camera.lens else { panic!("a perspective camera") };
    assert!(near <= 0.1 && far.is_some_and(|far| far > 50.0));
    (scene.pose(None, 0.0).world_from_node[camera.node], fov_y)
}

#[test]
fn the_start_view_sees_the_subject() {
    for (builtin, scene) in all() {
        let (world_from_camera, fov_y) = camera(&scene);
        let subject = scene.subject.expect("a subject");
        let bounds = scene.node_bounds(&scene.pose(None, 0.0), subject).expect("bounds");
        // The subject's middle, but at the height of the eye: trees are taller than the picture.
        let middle = (bounds.min + bounds.max) / 2.0;
        let height = world_from_camera.w_axis.y.clamp(bounds.min.y, bounds.max.y);
        let seen = world_from_camera.inverse().transform_point3(middle.with_y(height));
        let half = (fov_y / 2.0).tan();
        assert!(seen.z < -0.5 && seen.z > -25.0, "{builtin:?}: {seen}");
        assert!(seen.x.abs() < -seen.z * half * ASPECT && seen.y.abs() < -seen.z * half, "{builtin:?}: {seen}");
    }
}

#[test]
fn the_eye_stands_at_the_height_of_a_person_with_nothing_before_it() {
    for (builtin, scene) in all() {
        let eye = camera(&scene).0.w_axis.truncate();
        let triangles = scene.pose(None, 0.0).triangles(&scene);
        // The highest surface below the eye.
        let below = triangles.iter().filter_map(|triangle| height_at(triangle.vertices, eye));
        let ground = below.filter(|height| *height < eye.y).fold(f32::NEG_INFINITY, f32::max);
        assert!((1.4..1.8).contains(&(eye.y - ground)), "{builtin:?}: {} m", eye.y - ground);
        let nearest = triangles.iter().flat_map(|t| t.vertices).map(|vertex| vertex.distance(eye));
        let nearest = nearest.fold(f32::INFINITY, f32::min);
        assert!(nearest > 0.45, "{builtin:?}: {nearest} m");
    }
}

/// Returns the height of a triangle at the x and z of a point. Returns `None` if the triangle is not above or
/// below it.
fn height_at([a, b, c]: [Vec3; 3], point: Vec3) -> Option<f32> {
    let side = |from: Vec3, to: Vec3| (to.x - from.x) * (point.z - from.z) - (to.z - from.z) * (point.x - from.x);
    let [u, v, w] = [side(b, c), side(c, a), side(a, b)];
    let area = u + v + w;
    let is_inside = [u, v, w].iter().all(|share| share * area >= 0.0) && area.abs() > 1e-9;
    is_inside.then(|| (a.y * u + b.y * v + c.y * w) / area)
}

#[test]
fn the_sun_is_above_the_horizon_and_low_over_the_plain() {
    for (builtin, scene) in all() {
        let direction = scene.sun.expect("a sun").direction;
        assert!((direction.length() - 1.0).abs() < 1e-6, "{builtin:?}");
        let elevation = (-direction.y).asin();
        let range = if builtin == BuiltinScene::Plain { 0.2..0.42 } else { 0.3..1.0 };
        assert!(range.contains(&elevation), "{builtin:?}: {elevation}");
    }
}
