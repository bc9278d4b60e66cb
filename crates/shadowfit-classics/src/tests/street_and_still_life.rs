//! Facts about the street and the still life: places and sizes of the source, and the views of their lamps.

use std::f32::consts::{FRAC_PI_4, PI};

use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec2, Vec3};
use shadowfit::Aabb;

use shadowfit_scene::{Instance, Lens, Material, Scene, Wrap};

use super::facts::{drawn, triangles};
use super::scene_of;
use crate::comparison::lamp_of_the_scene;

/// Returns the world bounds of the nodes with a name, in order.
fn bounds_of(scene: &Scene, name: &str) -> Vec<Aabb> {
    let pose = scene.pose(None, 0.0);
    let nodes = (0..scene.nodes.len()).filter(|&node| scene.nodes[node].name == name);
    nodes.map(|node| scene.node_bounds(&pose, node).expect(name)).collect()
}

/// Returns the world matrices of the nodes with a name, in order.
fn places_of(scene: &Scene, name: &str) -> Vec<Mat4> {
    let pose = scene.pose(None, 0.0);
    let nodes = (0..scene.nodes.len()).filter(|&node| scene.nodes[node].name == name);
    nodes.map(|node| pose.world_from_node[node]).collect()
}

/// Returns the display value of a linear value by the sRGB curve (all here are above its linear part).
fn displayed(linear: f32) -> f32 {
    1.055 * linear.powf(1.0 / 2.4) - 0.055
}

fn still_life() -> Scene {
    scene_of("comparison-sampler")
}

fn street() -> Scene {
    scene_of("headlight-projective")
}

#[test]
fn street_and_still_life_have_fewer_than_sixty_thousand_triangles() {
    for scene in [street(), still_life()] {
        let count = drawn(&scene, None);
        assert!((20_000..60_000).contains(&count), "{}: {count}", scene.name);
    }
}

/// The source's own list of vertex pairs, from z = 10 to z = -100.
const STRIP: [([f32; 3], [f32; 2], [f32; 3]); 18] = [
    ([-20.0, 0.0, 10.0], [-0.25, 25.0], [0.0, 1.0, 0.0]),
    ([-20.0, 0.0, -100.0], [-0.25, 0.0], [0.0, 1.0, 0.0]),
    ([2.0, 0.0, 10.0], [0.25, 25.0], [0.0, 1.0, 0.0]),
    ([2.0, 0.0, -100.0], [0.25, 0.0], [0.0, 1.0, 0.0]),
    ([2.0, 0.0, 10.0], [0.25, 25.0], [-1.0, 0.0, 0.0]),
    ([2.0, 0.0, -100.0], [0.25, 0.0], [-1.0, 0.0, 0.0]),
    ([2.0, 1.0, 10.0], [0.375, 25.0], [-1.0, 0.0, 0.0]),
    ([2.0, 1.0, -100.0], [0.375, 0.0], [-1.0, 0.0, 0.0]),
    ([2.0, 1.0, 10.0], [0.375, 25.0], [0.0, 1.0, 0.0]),
    ([2.0, 1.0, -100.0], [0.375, 0.0], [0.0, 1.0, 0.0]),
    ([3.0, 1.0, 10.0], [0.5, 25.0], [0.0, 1.0, 0.0]),
    ([3.0, 1.0, -100.0], [0.5, 0.0], [0.0, 1.0, 0.0]),
    ([13.0, 1.0, 10.0], [0.75, 25.0], [0.0, 1.0, 0.0]),
    ([13.0, 1.0, -100.0], [0.75, 0.0], [0.0, 1.0, 0.0]),
    ([13.0, 1.0, 10.0], [0.75, 25.0], [-1.0, 0.0, 0.0]),
    ([13.0, 1.0, -100.0], [0.75, 0.0], [-1.0, 0.0, 0.0]),
    ([13.0, 21.0, 10.0], [1.25, 25.0], [-1.0, 0.0, 0.0]),
    ([13.0, 21.0, -100.0], [1.25, 0.0], [-1.0, 0.0, 0.0]),
];

#[test]
fn the_strip_has_the_vertices_of_its_source_and_one_mirrored_image() {
    let scene = street();
    let mesh = scene.meshes.iter().find(|mesh| mesh.name == "strip").expect("a strip");
    let [strip] = &mesh.primitives[..] else { panic!("one primitive") };
    assert_eq!(strip.positions, STRIP.map(|vertex| Vec3::from_array(vertex.0)));
    assert_eq!(strip.uvs, STRIP.map(|vertex| Vec2::from_array(vertex.1)));
    assert_eq!(strip.normals, STRIP.map(|vertex| Vec3::from_array(vertex.2)));
    // Road 22, kerb 1 up and 1 across, pavement 10, wall 20, each 110 long.
    let area = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|index| strip.positions[index]);
        (b - a).cross(c - a).length() / 2.0
    };
    let areas: Vec<f32> = triangles(strip).map(area).collect();
    assert_eq!(areas.len(), 10);
    assert!((areas.iter().sum::<f32>() - 54.0 * 110.0).abs() < 0.1);
    assert!(places_of(&scene, "strip")[0].abs_diff_eq(Mat4::IDENTITY, 0.0));
    let texture = scene.materials[strip.material].base_color_texture.expect("a texture");
    assert_eq!(texture.wrap, [Wrap::Mirror; 2]);
    assert_eq!(texture.uv_from_texcoord, [Vec3::X, Vec3::Y]);
}

#[test]
fn cars_and_lamp_posts_stand_where_their_source_has_them() {
    let scene = street();
    let car = |at: [f32; 3], turn: f32| {
        Mat4::from_translation(at.into()) * Mat4::from_rotation_y(turn) * Mat4::from_scale(Vec3::splat(4.0))
    };
    let lamp_post = |at: [f32; 3]| Mat4::from_translation(at.into()) * Mat4::from_scale(Vec3::splat(0.05));
    let cars = [car([-3.0, 0.0, -15.0], PI), car([-28.0, 0.0, -1.9], 5.0 * PI / 8.0)];
    let lamp_posts = [lamp_post([4.0, 1.0, -35.0]), lamp_post([4.0, 1.0, -5.0])];
    for (name, expected) in [("car", cars), ("lamp post", lamp_posts)] {
        let places = places_of(&scene, name);
        assert_eq!(places.len(), 2);
        assert!(places.iter().zip(expected).all(|(place, expected)| place.abs_diff_eq(expected, 1e-4)), "{name}");
    }
    // The second car faces (sin 5π/8, cos 5π/8) = (0.924, -0.383) in x and z. The headlight shines along (16,
    // -8) / √320 = (0.894, -0.447).
    let ahead = places_of(&scene, "car")[1].z_axis.truncate().normalize();
    assert!(ahead.dot(Vec3::new(16.0, 0.0, -8.0).normalize()) > 0.99, "{ahead}");
}

#[test]
fn a_car_stands_on_the_road_and_has_the_size_of_one() {
    let bounds = bounds_of(&street(), "car")[0];
    let size = bounds.max - bounds.min;
    assert!(bounds.min.y.abs() < 0.01, "{bounds:?}");
    assert!((5.0..7.5).contains(&size.x) && (4.0..5.0).contains(&size.y) && (12.0..14.0).contains(&size.z), "{size}");
    assert!(bounds.max.x < 2.0 && bounds.min.x > -9.0, "on the right half of the road: {bounds:?}");
    // Its headlights, at (-18, 5, -2), are outside both.
    let headlight = Vec3::new(-18.0, 5.0, -2.0);
    let is_outside = |bounds: &Aabb| headlight.clamp(bounds.min, bounds.max) != headlight;
    assert!(bounds_of(&street(), "car").iter().all(is_outside));
}

#[test]
fn a_lamp_post_is_brown_and_slender_and_reaches_over_the_road_below_the_top_of_the_wall() {
    let scene = street();
    let bounds = bounds_of(&scene, "lamp post")[1];
    assert!((0.9..=1.0).contains(&bounds.min.y) && (16.0..21.0).contains(&bounds.max.y), "{bounds:?}");
    assert!(bounds.min.x < 2.0 && bounds.max.x < 5.0 && bounds.max.z - bounds.min.z < 2.0, "{bounds:?}");
    let mesh = scene.meshes.iter().find(|mesh| mesh.name == "lamp post").expect("a lamp post");
    let [post] = &mesh.primitives[..] else { panic!("one primitive") };
    let Material { base_color, base_color_texture: None, .. } = scene.materials[post.material] else { panic!("plain") };
    let shown = base_color.truncate().to_array().map(displayed);
    assert!(shown.iter().zip([0.25, 0.21, 0.20]).all(|(a, b)| (a - b).abs() < 1e-4), "{shown:?}");
    // Between foot and bend its radius is about a third of a unit.
    let shaft = post.positions.iter().filter(|position| (100.0..250.0).contains(&position.y));
    assert!(shaft.map(|position| position.with_y(0.0).length()).fold(0.0, f32::max) < 8.0);
}

#[test]
fn the_street_is_seen_as_in_its_source() {
    let scene = street();
    let camera = &scene.cameras[0];
    let Lens::Perspective { fov_y, near, far } = camera.lens else { panic!("a perspective camera") };
    assert_eq!((fov_y, near, far), (FRAC_PI_4, 1.0, Some(200.0)));
    let expected = look_at_mat4(Vec3::new(-25.0, 13.0, 18.0), Vec3::new(0.0, 2.0, -12.0), Vec3::Y).inverse();
    assert!(scene.pose(None, 0.0).world_from_node[camera.node].abs_diff_eq(expected, 1e-4));
}

#[test]
fn the_streets_image_joins_where_it_is_mirrored_and_differs_from_face_to_face() {
    let image = &street().images[0];
    assert!(image.width * image.height <= 512 * 512);
    let mean = |from: f32, to: f32| {
        let columns = (from * image.width as f32) as u32..(to * image.width as f32) as u32;
        let texel = |x: u32, y: u32| &image.rgba[((y * image.width + x) * 4) as usize..][..3];
        let count = (columns.len() as u32 * image.height) as f32;
        let texels = columns.flat_map(|x| (0..image.height).map(move |y| (x, y)));
        texels.fold(Vec3::ZERO, |sum, (x, y)| sum + Vec3::from_slice(&[0, 1, 2].map(|c| f32::from(texel(x, y)[c]))))
            / count
    };
    let [asphalt, kerb, paving, brick] = [(0.02, 0.22), (0.4, 0.5), (0.5, 0.75), (0.8, 1.0)].map(|(a, b)| mean(a, b));
    assert!(asphalt.max_element() < 110.0 && kerb.y > paving.y && paving.y > asphalt.y + 30.0);
    assert!(brick.x > brick.z + 30.0, "bricks are red: {brick}");
}

#[test]
fn the_lamp_of_the_still_life_holds_all_that_stands_there_in_sixty_degrees() {
    let scene = still_life();
    let (lamp, target) = lamp_of_the_scene();
    let down = (lamp.y - target.y).atan2((target - lamp).with_y(0.0).length());
    assert!((0.55..0.75).contains(&down), "{down}");
    let lamp_from_world = look_at_mat4(lamp, target, Vec3::Y);
    let pose = scene.pose(None, 0.0);
    let half = (PI / 6.0).tan();
    let mut seen = 0;
    let instances = scene.instances();
    let name = |instance: &Instance| scene.nodes[instance.node].name.as_str();
    for instance in instances.iter().filter(|at| !["floor", "wall", "skirting board"].contains(&name(at))) {
        let lamp_from_mesh = lamp_from_world * pose.world_from_node[instance.node];
        for &position in &scene.meshes[instance.mesh].primitives[instance.primitive].positions {
            let at = lamp_from_mesh.transform_point3(position);
            let is_held = at.x.abs().max(at.y.abs()) < -at.z * half;
            assert!(is_held && (-20.0..-4.0).contains(&at.z), "{}: {at}", name(instance));
        }
        seen += 1;
    }
    // Five stones and the pedestal's ball, the board and its frame, seven pieces.
    assert_eq!(seen, 15);
}

#[test]
fn what_stands_in_the_still_life_stands_on_its_floor() {
    let scene = still_life();
    for name in ["column", "arch", "pedestal", "ring", "vase", "chess board"] {
        let bounds = bounds_of(&scene, name)[0];
        assert!((-0.02..0.0).contains(&bounds.min.y), "{name}: {bounds:?}");
        assert!(bounds.min.abs().max(bounds.max.abs()).with_y(0.0).max_element() < 6.0, "{name}: {bounds:?}");
    }
    let (board, king) = (bounds_of(&scene, "chess board")[0], bounds_of(&scene, "king")[0]);
    assert!(king.min.y > 0.08 && king.min.y < 0.12 && king.max.y > 1.3, "{king:?}");
    assert!(king.min.x > board.min.x && king.max.x < board.max.x && king.max.z < board.max.z);
}
