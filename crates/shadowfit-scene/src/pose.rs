//! A scene at a time: world transforms, morph weights and the resulting triangles.

use glam::{DMat4, DVec3, Mat4, Vec3};

use crate::limits::{MAX_COORDINATE, MAX_MORPH_WEIGHT};
use crate::sample::{Sample, sample};
use crate::{Mesh, Node, Scene, Transform};

/// One primitive drawn at one node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Instance {
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`crate::Mesh::primitives`].
    pub primitive: usize,
}

/// Transforms and morph weights of a scene at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// World from node, for each node. World positions are relative to [`Scene::origin`].
    pub world_from_node: Vec<Mat4>,
    /// For each node, the weight of each morph target of its mesh. Empty if the mesh has none.
    pub morph_weights: Vec<Vec<f32>>,
}

/// A triangle in world space. Its vertices are counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners, in metres.
    pub vertices: [Vec3; 3],
    /// Index into [`Scene::instances`].
    pub instance: u32,
    /// Index of the triangle within its primitive. Its vertex indices there begin at `3 * index`.
    pub index: u32,
}

impl Scene {
    /// Returns everything drawn, ordered by node, then by primitive. It is the same for every pose.
    pub fn instances(&self) -> Vec<Instance> {
        self.each_instance().collect()
    }

    /// Iterates over [`Scene::instances`].
    pub(crate) fn each_instance(&self) -> impl Iterator<Item = Instance> {
        let drawn = |node: &Node| node.mesh.and_then(|mesh| Some((mesh, self.meshes.get(mesh)?)));
        self.nodes.iter().enumerate().filter_map(move |(node, data)| Some((node, drawn(data)?))).flat_map(
            |(node, (mesh, drawn))| {
                (0..drawn.primitives.len()).map(move |primitive| Instance { node, mesh, primitive })
            },
        )
    }

    /// Returns the pose at a time of an animation (an index into [`Scene::animations`]), in seconds, which
    /// wraps at the animation's duration. A time that is not finite counts as 0.
    ///
    /// The pose is at rest for `None`, for an animation that does not exist, and at times when an animation
    /// moves anything beyond the range of exact f32 computations.
    pub fn pose(&self, animation: Option<usize>, seconds: f32) -> Pose {
        let mut locals: Vec<Transform> = self.nodes.iter().map(|node| node.rest).collect();
        let targets: Vec<usize> = self.meshes.iter().map(Mesh::targets).collect();
        let mut morph_weights: Vec<_> = self.nodes.iter().map(|node| self.rest_weights(node, &targets)).collect();
        if let Some(animation) = animation.and_then(|index| self.animations.get(index)) {
            let time = looped(seconds, animation.duration);
            for channel in &animation.channels {
                let Some(local) = locals.get_mut(channel.node) else { continue };
                match sample(channel, time) {
                    Some(Sample::Translation(translation)) => local.translation = translation.as_dvec3(),
                    Some(Sample::Rotation(rotation)) => local.rotation = rotation.as_dquat(),
                    Some(Sample::Scale(scale)) => local.scale = scale.as_dvec3(),
                    Some(Sample::MorphWeights(weights)) => {
                        overwrite(&mut morph_weights[channel.node], &weights);
                    }
                    None => {}
                }
            }
        }
        let pose = Pose { world_from_node: self.compose(&locals), morph_weights };
        if animation.is_none() || self.is_within_reach(&pose) { pose } else { self.pose(None, 0.0) }
    }

    /// Returns whether matrices and weights are small enough for the moved vertices to be finite. Import
    /// checks the file at rest. Between keys and below moving parents, an animation may reach any value.
    fn is_within_reach(&self, pose: &Pose) -> bool {
        let is_small = |matrix: &Mat4| matrix.to_cols_array().iter().all(|element| element.abs() <= MAX_COORDINATE);
        pose.world_from_node.iter().all(is_small)
            && self.skins.iter().all(|skin| pose.world_from_mesh_by_joint(skin).iter().all(is_small))
            && pose.morph_weights.iter().flatten().all(|weight| weight.abs() <= MAX_MORPH_WEIGHT)
    }

    /// Returns whether `node` is `root` or a descendant of it. Both are indices into [`Scene::nodes`].
    pub fn is_descendant(&self, node: usize, root: usize) -> bool {
        let parent_of = |&index: &usize| self.nodes.get(index).and_then(|n| n.parent);
        // Parents have smaller indices, so the search ends at or before `root`.
        std::iter::successors(Some(node), parent_of)
            .take_while(|&ancestor| ancestor >= root)
            .any(|ancestor| ancestor == root)
    }

    /// Returns one weight for each morph target of the node's mesh: the node's weight, else the mesh's, else
    /// 0. `targets` has the number of targets of each mesh.
    fn rest_weights(&self, node: &Node, targets: &[usize]) -> Vec<f32> {
        let Some((mesh, &targets)) = node.mesh.and_then(|index| self.meshes.get(index).zip(targets.get(index))) else {
            return Vec::new();
        };
        let own = !node.morph_weights.is_empty();
        let mut weights = vec![0.0; targets];
        overwrite(&mut weights, if own { &node.morph_weights } else { &mesh.morph_weights });
        weights
    }

    /// Returns the world-from-node matrices. Products are computed in f64, and rounded after subtraction of
    /// the scene's origin.
    fn compose(&self, locals: &[Transform]) -> Vec<Mat4> {
        let world_from_file = DMat4::from_translation(-self.origin);
        let mut world_from_node: Vec<DMat4> = Vec::with_capacity(locals.len());
        for (node, local) in self.nodes.iter().zip(locals) {
            let parent = node.parent.and_then(|index| world_from_node.get(index));
            world_from_node.push(parent.copied().unwrap_or(world_from_file) * local.matrix());
        }
        world_from_node.iter().map(DMat4::as_mat4).collect()
    }
}

impl Pose {
    /// Returns the matrix from the space of the instance's vertices to world space. Skinned instances get the
    /// identity, since [`Pose::deform`] returns their vertices in world space.
    pub fn world_from_instance(&self, scene: &Scene, instance: &Instance) -> Mat4 {
        match scene.instance_skin(instance) {
            Some(_) => Mat4::IDENTITY,
            None => self.world_from(instance.node),
        }
    }

    /// Returns whether the instance is mirrored, so that its triangles are clockwise seen from outside. This
    /// is the case if the determinant of the node's matrix is negative, or of the first joint's matrix for
    /// skinned instances. Renderers must then swap front and back faces. [`Pose::triangles`] swaps two
    /// corners.
    pub fn is_mirrored(&self, scene: &Scene, instance: &Instance) -> bool {
        let matrix = match scene.instance_skin(instance) {
            Some(skin) => match (skin.joints.first(), skin.joint_from_mesh.first()) {
                (Some(&joint), Some(&joint_from_mesh)) => self.world_from(joint) * joint_from_mesh,
                _ => Mat4::IDENTITY,
            },
            None => self.world_from(instance.node),
        };
        glam::Mat3::from_mat4(matrix).determinant() < 0.0
    }

    /// Returns every triangle of every instance, in instance order, deformed, in world space and metres.
    ///
    /// Mirrored instances ([`Pose::is_mirrored`]) have their second and third corner swapped, so
    /// that all geometric normals point outward.
    pub fn triangles(&self, scene: &Scene) -> Vec<Triangle> {
        self.triangles_from(scene, DVec3::ZERO)
    }

    /// Returns triangles like [`Pose::triangles`], with corners relative to `origin`, a world position in
    /// metres. Far from the world's origin, where world positions in f32 are coarse, this keeps the precision
    /// of vertices near their node.
    pub fn triangles_from(&self, scene: &Scene, origin: DVec3) -> Vec<Triangle> {
        let instances = scene.instances();
        let count = |i: &Instance| scene.meshes[i.mesh].primitives[i.primitive].indices.len() / 3;
        let mut triangles = Vec::with_capacity(instances.iter().map(count).sum());
        for (instance, number) in instances.iter().zip(0..) {
            let deformed = self.deform(scene, instance);
            let corners = self.corners_from(scene, instance, deformed.as_ref(), origin);
            let numbered = corners.zip(0..).map(|(vertices, index)| Triangle { vertices, instance: number, index });
            triangles.extend(numbered);
        }
        triangles
    }

    /// Returns the world-from-node matrix, or the identity for a node that does not exist.
    pub(crate) fn world_from(&self, node: usize) -> Mat4 {
        self.world_from_node.get(node).copied().unwrap_or(Mat4::IDENTITY)
    }
}

/// Wraps `seconds` to 0..`duration`. Returns 0 for times that are not finite and durations that are not
/// positive and finite.
fn looped(seconds: f32, duration: f32) -> f32 {
    if seconds.is_finite() && duration.is_finite() && duration > 0.0 { seconds.rem_euclid(duration) } else { 0.0 }
}

/// Copies values up to the shorter length.
fn overwrite(target: &mut [f32], source: &[f32]) {
    for (to, &from) in target.iter_mut().zip(source) {
        *to = from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Animation, Channel, ChannelValues, Interpolation};

    #[test]
    fn what_an_animation_throws_beyond_f32_rests() {
        let triangle = [Vec3::X * 10.0, Vec3::Y, Vec3::Z];
        let mut scene = Scene::from_objects("thrown", &[vec![triangle]]);
        let values = ChannelValues::Scale(vec![Vec3::ONE, Vec3::splat(2.0), Vec3::splat(3e38)]);
        let (times, interpolation) = (vec![0.0, 1.0, 2.0], Interpolation::Step);
        let channels = vec![Channel { node: 0, times, interpolation, values }];
        scene.animations.push(Animation { name: String::new(), duration: 3.0, channels });
        assert_eq!(scene.pose(Some(0), 1.5).triangles(&scene)[0].vertices, triangle.map(|corner| corner * 2.0));
        assert_eq!(scene.pose(Some(0), 2.5), scene.pose(None, 0.0));
    }
}
