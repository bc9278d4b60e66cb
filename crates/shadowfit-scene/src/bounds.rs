//! World-space bounds of posed scenes, exact to the vertex.

use glam::{Mat4, Vec3};
use shadowfit::Aabb;

use crate::{Instance, Pose, Scene};

impl Scene {
    /// Returns the world-space bounds of everything drawn, in metres, deformed as in `pose`. Returns `None`
    /// if nothing is drawn.
    pub fn bounds(&self, pose: &Pose) -> Option<Aabb> {
        self.bounds_where(pose, |_| true)
    }

    /// Returns the world-space bounds of the meshes of `root` (an index into [`Scene::nodes`]) and its
    /// descendants, in metres, deformed as in `pose`. Returns `None` if they draw nothing.
    pub fn node_bounds(&self, pose: &Pose, root: usize) -> Option<Aabb> {
        self.bounds_where(pose, |node| self.is_descendant(node, root))
    }

    fn bounds_where(&self, pose: &Pose, wanted: impl Fn(usize) -> bool) -> Option<Aabb> {
        self.instances()
            .iter()
            .filter(|instance| wanted(instance.node))
            .filter_map(|instance| self.instance_bounds(pose, instance))
            .reduce(Aabb::union)
    }

    /// Returns the world-space bounds of one instance, in metres, deformed as in `pose`. Returns `None` if it
    /// has no triangles.
    pub fn instance_bounds(&self, pose: &Pose, instance: &Instance) -> Option<Aabb> {
        let primitive = self.meshes.get(instance.mesh)?.primitives.get(instance.primitive)?;
        let world_from_local = pose.world_from_instance(self, instance);
        match pose.deform(self, instance) {
            Some(deformed) => used_bounds(&deformed.positions, &primitive.indices, world_from_local),
            None => used_bounds(&primitive.positions, &primitive.indices, world_from_local),
        }
    }
}

/// Returns the bounds of the indexed vertices only: files may contain vertices that no triangle uses.
fn used_bounds(positions: &[Vec3], indices: &[u32], world_from_local: Mat4) -> Option<Aabb> {
    let used = indices.iter().filter_map(|&i| positions.get(i as usize));
    Aabb::from_points(used.map(|&p| world_from_local.transform_point3(p)))
}
