//! Facts about any scene that code generates, and helpers that read scenes. The parent module's `every` lists
//! the scenes, so other crates check their own scenes with the same file.

use glam::Vec3;

use super::{Primitive, Scene, every};

/// Returns the world bounds of a node's descendants, computed from their vertices.
pub(super) fn bounds_below(scene: &Scene, root: usize, animation: Option<usize>, seconds: f32) -> (Vec3, Vec3) {
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

/// Returns all primitives with the names of their meshes.
pub(super) fn primitives(scene: &Scene) -> impl Iterator<Item = (&str, &Primitive)> {
    scene.meshes.iter().flat_map(|mesh| mesh.primitives.iter().map(|primitive| (mesh.name.as_str(), primitive)))
}

/// Returns the vertex indices of a primitive's triangles.
pub(super) fn triangles(primitive: &Primitive) -> impl Iterator<Item = [usize; 3]> {
    primitive.indices.chunks_exact(3).map(|t| [t[0] as usize, t[1] as usize, t[2] as usize])
}

/// Returns the number of triangles that the scene draws, below `root` if given.
pub(super) fn drawn(scene: &Scene, root: Option<usize>) -> usize {
    let instances = scene.instances();
    let counted = instances.iter().filter(|instance| root.is_none_or(|root| scene.is_descendant(instance.node, root)));
    counted.map(|instance| scene.meshes[instance.mesh].primitives[instance.primitive].indices.len() / 3).sum()
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
