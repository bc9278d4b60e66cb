//! Input of fits that describes the scene: boxes around its receivers and casters.
//!
//! Static instances are divided once into clusters that fit their surface closely, because a single box
//! around a level that is one mesh would be useless. An animated instance has one box, recomputed with every
//! pose.

use glam::{DVec3, Vec3};
use shadowfit::Clusters;
use shadowfit::NormalCone;
use shadowfit::{Aabb, Boxes, FitInput, ViewFrustum};
use shadowfit_scene::{Casting, Instance, Pose, Scene};

/// Number of triangles from which on no clusters are made. At a fifth of a microsecond each, they would delay
/// the opening of a scene by more than a second.
const MOST_TRIANGLES: usize = 6_000_000;

/// Greatest coordinate of a box that fits accept, in metres. Boxes beyond it are left out.
const FARTHEST: f32 = 1e18;

/// Boxes of a scene in its current pose, in world space.
#[derive(Clone, Debug, Default)]
pub(crate) struct SceneBoxes {
    /// Boxes of all receivers: the clusters first, then one box for each moving instance.
    receivers: Vec<Aabb>,
    /// Cones around the normals in the receivers' boxes.
    cones: Vec<NormalCone>,
    /// Boxes of all casters, in the same order.
    casters: Vec<Aabb>,
    /// Numbers of static receivers and static casters.
    still: [usize; 2],
    /// Index of each instance that has a single box, and whether it casts.
    moving: Vec<(usize, bool)>,
}

impl SceneBoxes {
    /// Divides static instances into clusters. Call [`Self::set_pose`] afterwards for the other instances.
    pub(crate) fn new(scene: &Scene, pose: &Pose) -> Self {
        let instances = scene.instances();
        let casts: Vec<bool> = instances.iter().map(|instance| casts(scene, instance)).collect();
        let mut moves = moving_instances(scene, &instances);
        let clusters = clusters(scene, pose, &instances, &moves).unwrap_or_else(|| {
            moves.fill(true);
            Clusters::default()
        });
        let receivers = clusters.boxes().to_vec();
        let of_casters = (0..receivers.len())
            .filter(|cluster| clusters.triangles(*cluster).next().is_some_and(|(object, _)| casts[object as usize]));
        let casters: Vec<Aabb> = of_casters.map(|cluster| receivers[cluster]).collect();
        let still = [receivers.len(), casters.len()];
        let moving = (0..instances.len()).filter(|index| moves[*index]).map(|index| (index, casts[index])).collect();
        let cones = clusters.cones().to_vec();
        Self { receivers, cones, casters, still, moving }
    }

    /// Gives each instance one box, whether it moves or not. Call [`Self::set_pose`] afterwards.
    pub(crate) fn of_instances(scene: &Scene) -> Self {
        let instances = scene.instances();
        let moving = instances.iter().enumerate().map(|(index, instance)| (index, casts(scene, instance))).collect();
        Self { moving, ..Self::default() }
    }

    /// Returns a fit's input with these boxes, for a light that travels in `direction` (world axes).
    pub(crate) fn input<'a>(&'a self, views: &'a [ViewFrustum], direction: Vec3) -> FitInput<'a> {
        FitInput {
            receivers: Some(Boxes::world(&self.receivers)),
            receiver_cones: &self.cones,
            casters: Some(Boxes::world(&self.casters)),
            ..FitInput::new(views, direction)
        }
    }

    /// Updates the boxes of moving instances. `bounds` returns the box of an instance by its index, in world
    /// space.
    pub(crate) fn set_pose(&mut self, bounds: impl Fn(usize) -> Option<Aabb>) {
        self.receivers.truncate(self.still[0]);
        self.cones.truncate(self.still[0]);
        self.casters.truncate(self.still[1]);
        for &(index, casts) in &self.moving {
            let is_near = |corner: Vec3| corner.abs().cmple(Vec3::splat(FARTHEST)).all();
            let Some(aabb) = bounds(index).filter(|aabb| is_near(aabb.min) && is_near(aabb.max)) else { continue };
            self.receivers.push(aabb);
            self.cones.push(NormalCone::ALL);
            if casts {
                self.casters.push(aabb);
            }
        }
    }
}

/// Returns whether any part of an instance casts shadows.
fn casts(scene: &Scene, instance: &Instance) -> bool {
    let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
    scene.casting(primitive) != Casting::Nothing
}

/// Returns for each instance whether an animation moves or deforms it.
fn moving_instances(scene: &Scene, instances: &[Instance]) -> Vec<bool> {
    let mut moves = vec![false; scene.nodes.len()];
    for channel in scene.animations.iter().flat_map(|animation| &animation.channels) {
        if let Some(moves) = moves.get_mut(channel.node) {
            *moves = true;
        }
    }
    // Parents come before their children.
    for node in 0..moves.len() {
        moves[node] |= scene.nodes[node].parent.is_some_and(|parent| moves[parent]);
    }
    let skin_moves = |instance: &Instance| {
        let joints = scene.instance_skin(instance).map_or(&[][..], |skin| &skin.joints);
        joints.iter().any(|joint| moves.get(*joint).is_none_or(|moves| *moves))
    };
    instances.iter().map(|instance| moves[instance.node] || skin_moves(instance)).collect()
}

/// Divides the static instances into clusters, each as an object. Returns `None` if there are too many
/// triangles, or if fits cannot take some of them.
fn clusters(scene: &Scene, pose: &Pose, instances: &[Instance], moves: &[bool]) -> Option<Clusters> {
    let count = |instance: &Instance| scene.meshes[instance.mesh].primitives[instance.primitive].indices.len() / 3;
    if instances.iter().map(count).sum::<usize>() > MOST_TRIANGLES {
        return None;
    }
    let corners = |(instance, moves): (&Instance, &bool)| {
        if *moves {
            return Vec::new();
        }
        let deformed = pose.deform(scene, instance);
        pose.corners_from(scene, instance, deformed.as_ref(), DVec3::ZERO).collect()
    };
    let objects: Vec<Vec<[Vec3; 3]>> = instances.iter().zip(moves).map(corners).collect();
    let objects: Vec<&[[Vec3; 3]]> = objects.iter().map(Vec::as_slice).collect();
    Clusters::build(&objects, Clusters::DEFAULT_LIMIT).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_scene::{AlphaMode, BlendedCasters};

    fn boxes(scene: &Scene, pose: &Pose) -> SceneBoxes {
        let mut boxes = SceneBoxes::new(scene, pose);
        let instances = scene.instances();
        boxes.set_pose(|index| scene.instance_bounds(pose, &instances[index]));
        boxes
    }

    #[test]
    fn every_point_of_a_triangle_is_in_a_box_at_any_time_of_the_animation() {
        let scene = default_scene();
        let mut boxes = boxes(&scene, &scene.pose(None, 0.0));
        assert!(
            !boxes.moving.is_empty() && boxes.still[0] > boxes.moving.len(),
            "the figure moves, the court does not"
        );
        let instances = scene.instances();
        for seconds in [0.0, 0.37, 5.1] {
            let pose = scene.pose(Some(0), seconds);
            boxes.set_pose(|index| scene.instance_bounds(&pose, &instances[index]));
            for triangle in pose.triangles(&scene).into_iter().step_by(7) {
                let [a, b, c] = triangle.vertices;
                // Rounding may move these points out of a box without thickness.
                for point in [a, b, c, (a + b) * 0.5, (b + c) * 0.5, (a + b + c) / 3.0] {
                    let slack = Vec3::splat(1e-5);
                    let holds =
                        |aabb: &Aabb| (aabb.min - slack).cmple(point).all() && (aabb.max + slack).cmpge(point).all();
                    assert!(boxes.receivers.iter().any(holds), "{point} of {triangle:?} at {seconds} s");
                }
            }
        }
    }

    #[test]
    fn blended_surfaces_receive_and_cast_where_they_may() {
        let mut scene = default_scene();
        let pose = scene.pose(None, 0.0);
        let all = boxes(&scene, &pose);
        assert_eq!(all.receivers.len(), all.casters.len());
        for material in &mut scene.materials {
            material.alpha = AlphaMode::Blend;
        }
        assert_eq!(boxes(&scene, &pose).casters, all.casters, "they are opaque enough");
        scene.blended_casters = BlendedCasters::Never;
        let blended = boxes(&scene, &pose);
        assert_eq!(blended.receivers, all.receivers);
        assert!(blended.casters.is_empty());
    }

    #[test]
    fn children_and_skins_of_what_is_animated_move_too() {
        let scene = default_scene();
        let moves = moving_instances(&scene, &scene.instances());
        let rest = scene.pose(None, 0.0);
        let later = scene.pose(Some(0), 0.8);
        for (instance, moves) in scene.instances().iter().zip(moves) {
            let bounds = [&rest, &later].map(|pose| scene.instance_bounds(pose, instance));
            assert!(moves || bounds[0] == bounds[1], "{instance:?} stands still and moved");
        }
    }
}
