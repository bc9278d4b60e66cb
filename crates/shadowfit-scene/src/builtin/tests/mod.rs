//! Facts about all built-in scenes: sound meshes, budgets, cameras that see their subject, animations that loop.

mod coplanar;
mod courtyard;
mod motion;
mod samples;
mod shadow_mapping;
mod surface;
mod terrain;
mod view;

use glam::Vec3;

use super::{BuiltinScene, SampleScene};
use crate::{Primitive, Scene};

/// Every built-in scene, built.
fn all() -> impl Iterator<Item = (BuiltinScene, Scene)> {
    BuiltinScene::ALL.into_iter().map(|builtin| (builtin, builtin.build()))
}

/// Every scene that code makes, those of samples too, built, by its id.
fn every() -> impl Iterator<Item = (&'static str, Scene)> {
    let samples = SampleScene::ALL.into_iter().map(|sample| (sample.id(), sample.build()));
    all().map(|(builtin, scene)| (builtin.id(), scene)).chain(samples)
}

/// World bounds of what hangs below a node, from the vertices themselves.
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

/// All primitives with the names of their meshes.
fn primitives(scene: &Scene) -> impl Iterator<Item = (&str, &Primitive)> {
    scene.meshes.iter().flat_map(|mesh| mesh.primitives.iter().map(|primitive| (mesh.name.as_str(), primitive)))
}

/// Corners of a primitive's triangles.
fn triangles(primitive: &Primitive) -> impl Iterator<Item = [usize; 3]> {
    primitive.indices.chunks_exact(3).map(|t| [t[0] as usize, t[1] as usize, t[2] as usize])
}

/// Triangles that the scene draws, below `root` if given.
fn drawn(scene: &Scene, root: Option<usize>) -> usize {
    let instances = scene.instances();
    let counted = instances.iter().filter(|instance| root.is_none_or(|root| scene.is_descendant(instance.node, root)));
    counted.map(|instance| scene.meshes[instance.mesh].primitives[instance.primitive].indices.len() / 3).sum()
}

#[test]
fn every_scene_is_found_by_its_id_and_says_what_it_shows() {
    assert_eq!(BuiltinScene::default(), BuiltinScene::Courtyard);
    for (index, builtin) in BuiltinScene::ALL.into_iter().enumerate() {
        assert_eq!(BuiltinScene::from_id(builtin.id()), Some(builtin));
        assert_eq!(BuiltinScene::ALL.iter().position(|other| *other == builtin), Some(index));
        assert_eq!(builtin.label().to_lowercase(), builtin.id());
        assert!(builtin.help().ends_with('.') && builtin.help().len() > 40, "{}", builtin.help());
        assert_eq!(builtin.build().name, builtin.id());
    }
    for unknown in ["", "Courtyard", "courtyard ", "desert"] {
        assert_eq!(BuiltinScene::from_id(unknown), None, "{unknown}");
    }
}

#[test]
fn every_sample_scene_has_the_name_of_its_id() {
    for sample in SampleScene::ALL {
        assert_eq!(sample.build().name, sample.id());
        assert_eq!(BuiltinScene::from_id(sample.id()), None);
    }
}

#[test]
fn every_scene_is_the_same_every_time() {
    for ((id, a), (_, b)) in every().zip(every()) {
        let same = |(a, b): ((&str, &Primitive), (&str, &Primitive))| {
            a.0 == b.0
                && (&a.1.positions, &a.1.normals, &a.1.uvs) == (&b.1.positions, &b.1.normals, &b.1.uvs)
                && (&a.1.colors, &a.1.indices) == (&b.1.colors, &b.1.indices)
        };
        assert!(primitives(&a).zip(primitives(&b)).all(same), "{id}");
        assert!(a.images.iter().zip(&b.images).all(|(a, b)| a.rgba == b.rgba), "{id}");
        for seconds in [0.0, 1.3, 5.1] {
            assert_eq!(a.pose(Some(0), seconds), b.pose(Some(0), seconds), "{id}");
        }
        assert_eq!((a.sun, a.subject, a.instances()), (b.sun, b.subject, b.instances()), "{id}");
    }
}

#[test]
fn triangle_counts_keep_their_budget() {
    for (builtin, scene) in all() {
        let (low, high) = match builtin {
            BuiltinScene::Plain => (40_000, 60_000),
            BuiltinScene::Arcade => (60_000, 80_000),
            BuiltinScene::Courtyard | BuiltinScene::Forest => (100_000, 150_000),
        };
        let count = drawn(&scene, None);
        assert!((low..=high).contains(&count), "{builtin:?}: {count}");
    }
}

#[test]
fn parents_come_before_children_and_indices_exist() {
    for (id, scene) in every() {
        for (index, node) in scene.nodes.iter().enumerate() {
            assert!(node.parent.is_none_or(|parent| parent < index), "{id}: {}", node.name);
            assert!(node.mesh.is_none_or(|mesh| mesh < scene.meshes.len()), "{id}: {}", node.name);
            assert!(!node.name.is_empty(), "{id}: node {index}");
        }
        let used = |mesh: usize| scene.nodes.iter().any(|node| node.mesh == Some(mesh));
        assert!((0..scene.meshes.len()).all(used), "{id} has a mesh that nothing draws");
    }
}

#[test]
fn every_scene_lies_around_the_origin() {
    for (builtin, scene) in all() {
        let (side, tall) = match builtin {
            BuiltinScene::Courtyard => (120.0, 15.0),
            BuiltinScene::Plain => (2000.0, 60.0),
            BuiltinScene::Arcade => (120.0, 12.0),
            BuiltinScene::Forest => (120.0, 20.0),
        };
        let bounds = scene.bounds(&scene.pose(None, 0.0)).expect("bounds");
        assert!(bounds.min.is_finite() && bounds.max.is_finite());
        assert!((bounds.max.x - bounds.min.x - side).abs() < 1.0, "{builtin:?}: {bounds:?}");
        assert!((bounds.max.x + bounds.min.x).abs() < 1.0, "{builtin:?}: {bounds:?}");
        assert!(bounds.min.y > -5.0 && bounds.max.y < tall, "{builtin:?}: {bounds:?}");
    }
}
