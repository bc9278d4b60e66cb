//! Facts about the shadow mapping sample's scene: size, place, camera and sun of the source.

use glam::Vec3;
use shadowfit_scene::{Lens, Pose};

use super::facts::{bounds_below, drawn};
use super::scene_of;

#[test]
fn the_character_is_about_seventy_units_tall_and_stands_at_the_origin() {
    let scene = scene_of("xna-shadow-mapping");
    let (low, high) = bounds_below(&scene, scene.subject.expect("a subject"), None, 0.0);
    assert!((65.0..=75.0).contains(&(high.y - low.y)), "{low} {high}");
    // Boots touch the floor, to within 0.15 units.
    assert!(low.y.abs() < 0.15, "{low}");
    assert!(low.x < 0.0 && high.x > 0.0 && low.z < 0.0 && high.z > 0.0, "{low} {high}");
}

#[test]
fn the_floor_is_a_flat_square_of_two_hundred_and_sixty_units() {
    let scene = scene_of("xna-shadow-mapping");
    let floor = scene.nodes.iter().position(|node| node.name == "grid floor").expect("a floor");
    let (low, high) = bounds_below(&scene, floor, None, 0.0);
    let across = high - low;
    assert!((255.0..=265.0).contains(&across.x) && across.x == across.z && across.y == 0.0, "{across}");
    assert!((low + high).length() < 1e-3 && low.y == 0.0, "{low} {high}");
}

#[test]
fn only_the_character_hangs_on_the_subject_and_it_keeps_its_budget() {
    let scene = scene_of("xna-shadow-mapping");
    let (figure, all) = (drawn(&scene, scene.subject), drawn(&scene, None));
    assert!((15_000..=45_000).contains(&figure), "{figure}");
    assert_eq!(all - figure, 2, "the floor is two triangles");
}

#[test]
fn its_animation_turns_the_character_alone_once_in_one_and_eight_tenths_of_a_second() {
    let scene = scene_of("xna-shadow-mapping");
    let root = scene.subject.expect("a subject");
    assert_eq!(scene.animations.len(), 1);
    assert!((scene.animations[0].duration - 360.0 / 200.0).abs() < 1e-6);
    // A quarter turn about the vertical moves +z to +x, and leaves the floor.
    let (rest, turned) = (scene.pose(None, 0.0), scene.pose(Some(0), 0.45));
    let ahead = |pose: &Pose| pose.world_from_node[root].z_axis.truncate().normalize();
    assert!(ahead(&rest).abs_diff_eq(Vec3::Z, 1e-5) && ahead(&turned).abs_diff_eq(Vec3::X, 1e-5));
    let floor = scene.nodes.iter().position(|node| node.name == "grid floor").expect("a floor");
    assert_eq!(rest.world_from_node[floor], turned.world_from_node[floor]);
}

#[test]
fn the_camera_and_the_sun_are_those_of_the_sample() {
    let scene = scene_of("xna-shadow-mapping");
    let camera = &scene.cameras[0];
    let world = scene.pose(None, 0.0).world_from_node[camera.node];
    assert_eq!(world.w_axis.truncate(), Vec3::new(0.0, 70.0, 100.0));
    // One down for each two forward: 1/√5 = 0.4472136 and 2/√5 = 0.8944272.
    assert!((-world.z_axis.truncate()).distance(Vec3::new(0.0, -0.447_213_6, -0.894_427_2)) < 1e-5);
    let Lens::Perspective { fov_y, near, far } = camera.lens else { panic!("a perspective camera") };
    assert_eq!((fov_y.to_degrees(), near, far), (45.0, 1.0, Some(1000.0)));
    // The length of (-1/3, 2/3, 2/3) is 1: 1/9 + 4/9 + 4/9.
    let sun = scene.sun.expect("a sun").direction;
    assert!(sun.distance(Vec3::new(1.0, -2.0, -2.0) / 3.0) < 1e-6, "{sun}");
}
