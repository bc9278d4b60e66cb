//! Facts about the built-in scene: sound meshes, a sound skeleton, feet on the floor, a budget.

use std::collections::HashMap;

use glam::{Quat, Vec3};

use super::{default_camera, default_scene};
use crate::{AlphaMode, ChannelValues, Lens, Primitive, Scene};

/// Index of the animation "walk".
const WALK: usize = 0;

/// All primitives with the names of their meshes.
fn primitives(scene: &Scene) -> impl Iterator<Item = (&str, &Primitive)> {
    scene.meshes.iter().flat_map(|mesh| mesh.primitives.iter().map(|primitive| (mesh.name.as_str(), primitive)))
}

/// Corners of a primitive's triangles.
fn triangles(primitive: &Primitive) -> impl Iterator<Item = [usize; 3]> {
    primitive.indices.chunks_exact(3).map(|t| [t[0] as usize, t[1] as usize, t[2] as usize])
}

/// Node with a name.
fn node(scene: &Scene, name: &str) -> usize {
    scene.nodes.iter().position(|node| node.name == name).expect(name)
}

/// Triangles that the scene draws, below `root` if given.
fn drawn(scene: &Scene, root: Option<usize>) -> usize {
    let instances = scene.instances();
    let counted = instances.iter().filter(|instance| root.is_none_or(|root| scene.is_descendant(instance.node, root)));
    counted.map(|instance| scene.meshes[instance.mesh].primitives[instance.primitive].indices.len() / 3).sum()
}

/// World bounds of what hangs below a node, from the triangles themselves.
fn bounds_below(scene: &Scene, root: usize, animation: Option<usize>, seconds: f32) -> (Vec3, Vec3) {
    let pose = scene.pose(animation, seconds);
    let mut bounds = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for instance in scene.instances() {
        if scene.is_descendant(instance.node, root) {
            let world = pose.world_from_instance(scene, &instance);
            for &position in &scene.meshes[instance.mesh].primitives[instance.primitive].positions {
                let at = world.transform_point3(position);
                bounds = (bounds.0.min(at), bounds.1.max(at));
            }
        }
    }
    bounds
}

#[test]
fn vertex_arrays_agree_and_every_index_is_in_range() {
    let scene = default_scene();
    for (name, primitive) in primitives(&scene) {
        let count = primitive.positions.len();
        assert_eq!((primitive.normals.len(), primitive.uvs.len()), (count, count), "{name}");
        assert!(primitive.indices.iter().all(|&index| (index as usize) < count), "{name}");
        assert_eq!(primitive.indices.len() % 3, 0, "{name}");
        assert!(primitive.material < scene.materials.len(), "{name}");
    }
    for material in &scene.materials {
        assert!(material.base_color_texture.is_none_or(|texture| texture.image < scene.images.len()));
    }
    for image in &scene.images {
        assert_eq!(image.rgba.len(), (image.width * image.height * 4) as usize, "{}", image.name);
    }
}

#[test]
fn every_triangle_has_area_and_normals_on_its_outer_side() {
    let scene = default_scene();
    for (name, primitive) in primitives(&scene) {
        for corners in triangles(primitive) {
            let [a, b, c] = corners.map(|index| primitive.positions[index]);
            let area = (b - a).cross(c - a);
            // A hundredth of a square millimetre, twice.
            assert!(area.length() > 2e-8, "{name}: {a} {b} {c}");
            for index in corners {
                let normal = primitive.normals[index];
                assert!((normal.length() - 1.0).abs() < 1e-4, "{name}: {normal}");
                assert!(normal.dot(area) > 0.0, "{name}: {normal} at {a}");
            }
        }
    }
}

#[test]
fn every_mesh_but_the_floor_is_closed_and_faces_outwards() {
    let scene = default_scene();
    for (name, primitive) in primitives(&scene).filter(|(name, _)| *name != "floor") {
        let key = |index: usize| primitive.positions[index].to_array().map(|value| (value + 0.0).to_bits());
        let mut edges: HashMap<_, i32> = HashMap::new();
        let mut volume = 0.0;
        for [a, b, c] in triangles(primitive) {
            let [pa, pb, pc] = [a, b, c].map(|index| primitive.positions[index]);
            volume += pa.dot(pb.cross(pc));
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((key(from), key(to))).or_default() += 1;
                *edges.entry((key(to), key(from))).or_default() -= 1;
            }
        }
        // Each edge is passed as often one way as the other.
        assert!(edges.values().all(|&count| count == 0), "{name} has an open edge");
        assert!(volume > 0.0, "{name} is inside out");
    }
}

#[test]
fn parents_come_before_children() {
    let scene = default_scene();
    for (index, node) in scene.nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < index), "{}", node.name);
        assert!(node.mesh.is_none_or(|mesh| mesh < scene.meshes.len()), "{}", node.name);
    }
}

#[test]
fn triangle_counts_keep_their_budget() {
    let scene = default_scene();
    let (all, figure) = (drawn(&scene, None), drawn(&scene, scene.subject));
    assert!(all <= 150_000, "{all}");
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
    // A stride at steps that fall between the keyframes too.
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
fn animations_end_where_they_begin() {
    let scene = default_scene();
    assert_eq!(scene.animations.iter().map(|a| a.name.as_str()).collect::<Vec<_>>(), ["walk", "turn"]);
    for animation in &scene.animations {
        for channel in &animation.channels {
            assert_eq!(channel.times.first(), Some(&0.0));
            assert!((channel.times[channel.times.len() - 1] - animation.duration).abs() < 1e-4);
            assert!(channel.times.windows(2).all(|pair| pair[0] < pair[1]));
            match &channel.values {
                ChannelValues::Translation(values) => assert!(values[0].distance(values[values.len() - 1]) < 1e-4),
                ChannelValues::Rotation(values) => assert!(same_turn(values[0], values[values.len() - 1])),
                _ => panic!("the figure only moves and turns"),
            }
        }
    }
}

/// Whether two rotations agree; a quaternion and its negative are one rotation.
fn same_turn(a: Quat, b: Quat) -> bool {
    a.dot(b).abs() > 1.0 - 1e-5
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
fn camera_sun_and_mask_are_there() {
    let scene = default_scene();
    let (eye, target) = default_camera();
    let camera = &scene.cameras[0];
    let world = scene.pose(None, 0.0).world_from_node[camera.node];
    assert!(world.w_axis.truncate().distance(eye) < 1e-5);
    assert!((-world.z_axis.truncate()).dot((target - eye).normalize()) > 0.9999);
    assert!(matches!(camera.lens, Lens::Perspective { .. }));
    let sun = scene.sun.expect("a sun").direction;
    assert!((sun.length() - 1.0).abs() < 1e-6 && sun.x < 0.0 && sun.y < 0.0 && sun.z < 0.0);
    let masked = |material: &crate::Material| matches!(material.alpha, AlphaMode::Mask { .. }) && material.double_sided;
    assert!(scene.materials.iter().any(masked));
}

#[test]
fn the_scene_is_the_same_every_time() {
    let (a, b) = (default_scene(), default_scene());
    assert!(primitives(&a).zip(primitives(&b)).all(|(a, b)| a.1.positions == b.1.positions));
    assert!(a.images.iter().zip(&b.images).all(|(a, b)| a.rgba == b.rgba));
}

#[test]
fn the_scene_fits_on_its_floor() {
    let scene = default_scene();
    let bounds = scene.bounds(&scene.pose(None, 0.0)).expect("bounds");
    assert!(bounds.min.y > -0.1 && bounds.max.y < 15.0, "{bounds:?}");
    assert!(bounds.max.x - bounds.min.x < 121.0, "{bounds:?}");
}
