//! Facts about the terrain sample's scene: its height map, the level ground, the vehicles' places, sizes and shadows.

use glam::{Mat4, Quat, Vec3};
use shadowfit_scene::Scene;

use super::facts::{bounds_below, drawn, primitives};
use super::scene_of;
use crate::terrain::{HeightMap, PLACES};

/// Texels along a side of the height map.
const SIDE: usize = 256;
/// Position of the sample's light.
const LIGHT: Vec3 = Vec3::new(128.0, 100.0, 0.0);

fn node(scene: &Scene, name: &str) -> usize {
    scene.nodes.iter().position(|node| node.name == name).expect(name)
}

/// Returns the world positions of all triangles of a node's descendants.
fn triangles_below(scene: &Scene, root: usize) -> Vec<[Vec3; 3]> {
    let instances = scene.instances();
    let hangs = |instance: u32| scene.is_descendant(instances[instance as usize].node, root);
    let all = scene.pose(None, 0.0).triangles(scene);
    all.into_iter().filter(|triangle| hangs(triangle.instance)).map(|triangle| triangle.vertices).collect()
}

/// Returns whether the ray from the light through `through` hits a triangle beyond it (Tomas Möller and Ben
/// Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
fn is_shadowed(through: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let ray = through - LIGHT;
    let (ab, ac) = (b - a, c - a);
    let across = ray.cross(ac);
    let area = ab.dot(across);
    let from = LIGHT - a;
    let u = from.dot(across) / area;
    let v = ray.dot(from.cross(ab)) / area;
    let t = ac.dot(from.cross(ab)) / area;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 1.0
}

#[test]
fn each_vertex_is_a_texel_at_a_fifth_of_its_red_value() {
    let (map, scene) = (HeightMap::new(), scene_of("terrain-vehicles"));
    let land = primitives(&scene).find(|(name, _)| *name == "land").expect("land").1;
    assert_eq!((map.red.len(), land.positions.len()), (65_536, 65_536));
    // Two triangles for each of the 255 × 255 cells.
    assert_eq!(land.indices.len(), 255 * 255 * 6);
    for (index, (&red, &position)) in map.red.iter().zip(&land.positions).enumerate() {
        let (x, z) = (index % SIDE, index / SIDE);
        assert_eq!(position, Vec3::new(x as f32, f32::from(red) / 5.0, z as f32));
    }
}

#[test]
fn the_hills_use_most_of_the_height_map_s_range() {
    let map = HeightMap::new();
    let highest = map.red.iter().max().expect("texels");
    assert!((200..=255).contains(highest), "{highest}");
    let hills = map.red.iter().filter(|&&red| red > 75).count();
    assert!(hills > map.red.len() / 5, "{hills} texels are more than 15 units high");
}

#[test]
fn the_ground_is_level_where_the_vehicles_stand() {
    let map = HeightMap::new();
    for place in &PLACES {
        for (index, &red) in map.red.iter().enumerate() {
            let texel = Vec3::new((index % SIDE) as f32, 0.0, (index / SIDE) as f32);
            assert!(red == 0 || texel.distance(place.at) > 25.0, "{}: {red} at {texel}", place.name);
        }
    }
}

#[test]
fn the_vehicles_stand_where_the_sample_has_them() {
    let scene = scene_of("terrain-vehicles");
    let world = scene.pose(None, 0.0).world_from_node;
    for (name, yaw, at) in [
        ("tractor", 0.5, Vec3::new(150.0, 0.0, 100.0)),
        ("helicopter", -0.3, Vec3::new(120.0, 0.0, 140.0)),
        ("jeep", 0.3, Vec3::new(140.0, 0.0, 170.0)),
    ] {
        let expected = Mat4::from_scale_rotation_translation(Vec3::splat(2.0), Quat::from_rotation_y(yaw), at);
        assert!(world[node(&scene, name)].abs_diff_eq(expected, 1e-4), "{name}");
    }
}

#[test]
fn the_vehicles_are_of_a_size_stand_on_the_ground_and_keep_their_budget() {
    let scene = scene_of("terrain-vehicles");
    for place in &PLACES {
        let root = node(&scene, place.name);
        let (low, high) = bounds_below(&scene, root, None, 0.0);
        assert!(low.y.abs() < 0.02, "{}: {low}", place.name);
        assert!((7.0..=12.0).contains(&high.y), "{}: {high}", place.name);
        // Greatest horizontal extent, with room for rotated vehicles and a rotor.
        let across = (high - low).with_y(0.0).max_element();
        assert!((12.0..=30.0).contains(&across), "{}: {across}", place.name);
        let count = drawn(&scene, Some(root));
        assert!((2000..15_000).contains(&count), "{}: {count}", place.name);
        assert!(scene.subject.is_some_and(|subject| scene.is_descendant(root, subject)));
    }
}

#[test]
fn no_hill_stands_between_the_light_and_a_vehicle() {
    let (map, scene) = (HeightMap::new(), scene_of("terrain-vehicles"));
    for place in &PLACES {
        let (low, high) = bounds_below(&scene, node(&scene, place.name), None, 0.0);
        for corner in [low, high, low.with_x(high.x), low.with_z(high.z)] {
            for step in 0..100 {
                let at = LIGHT.lerp(corner.with_y(corner.y.max(0.1)), step as f32 / 100.0);
                assert!(at.y > map.height(at.x.round() as i32, at.z.round() as i32), "{}: {at}", place.name);
            }
        }
    }
}

#[test]
fn the_helicopter_s_rotor_throws_its_shadow_on_the_jeep() {
    let scene = scene_of("terrain-vehicles");
    let jeep = triangles_below(&scene, node(&scene, "jeep"));
    // Only blades and hub are so high. Samples points along the edges of their triangles.
    let is_high = |triangle: &[Vec3; 3]| triangle.iter().all(|vertex| vertex.y > 11.4);
    let blades = triangles_below(&scene, node(&scene, "helicopter")).into_iter().filter(is_high);
    let along = blades.flat_map(|[a, b, _]| (0..=20).map(move |step| a.lerp(b, step as f32 / 20.0)));
    let casts: Vec<Vec3> = along.filter(|&point| jeep.iter().any(|&triangle| is_shadowed(point, triangle))).collect();
    let (low, high) =
        casts.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &at| (low.min(at), high.max(at)));
    assert!(high.distance(low) > 3.0, "{low} {high}");
    assert!(high.distance(low) < 8.0, "the end of one blade: {low} {high}");
}

#[test]
fn the_start_view_sees_all_three_vehicles() {
    let scene = scene_of("terrain-vehicles");
    let camera = scene.cameras[0].node;
    let view = scene.pose(None, 0.0).world_from_node[camera].inverse();
    // 45° vertically, in a picture of 3:2.
    let half = (22.5_f32).to_radians().tan();
    for place in &PLACES {
        let (low, high) = bounds_below(&scene, node(&scene, place.name), None, 0.0);
        for corner in [low, high] {
            let seen = view.transform_point3(corner);
            let [x, y] = [seen.x / -seen.z / half / 1.5, seen.y / -seen.z / half];
            assert!(x.abs() < 0.95 && y.abs() < 0.95 && seen.z < 0.0, "{}: {x} {y}", place.name);
        }
    }
}
