//! A camera of a scene's file as a view takes it: with planes that suit the scene where the file leaves them open.

use shadowfit::{Aabb, Camera, Lens};
use shadowfit_scene::{Lens as FileLens, Pose, Scene, SceneCamera};

/// Far distance of a camera without a far plane, in half diagonals of the scene's bounds, at least.
const FAR: f32 = 20.0;
/// Room behind the scene that such a camera sees, as a multiple of the distance to its far side. It also covers parts that
/// turn, and poses between two samples of an animation.
const ROOM_BEHIND: f32 = 1.25;
/// Number of poses that an animation is measured in.
const SAMPLES: usize = 17;
/// Number of nodes that these poses may place in all. Later animations do not count.
const MOST_NODES: usize = 4_000_000;
/// Least near distance of an orthographic camera, as a share of its far distance. Such a camera is moved back by the distance
/// that it lacks, which changes no pixel: several maps divide the logarithm of the depth.
const LEAST_NEAR: f32 = 1e-3;

/// Returns the far distance, in metres, with which each of a scene's cameras sees past the whole scene in its rest pose and
/// throughout its animations. One distance for all poses keeps splits and depths steady. `bounds` are the scene's world
/// bounds in its rest pose. Parts that move widen the bounds by the way that their nodes go. Morph targets do not.
pub fn camera_reaches(scene: &Scene, bounds: &Aabb) -> Vec<f32> {
    let radius = (bounds.max - bounds.min).length() * 0.5;
    let middle = ((bounds.min + bounds.max) * 0.5).as_dvec3();
    let rest = scene.pose(None, 0.0);
    let drawn = scene.nodes.iter().enumerate().filter(|(_, node)| node.mesh.is_some()).map(|(index, _)| index);
    let joints = scene.skins.iter().flat_map(|skin| skin.joints.iter().copied());
    let parts: Vec<usize> = drawn.chain(joints).collect();
    let mut reaches = vec![radius * FAR; scene.cameras.len()];
    let mut widen = |pose: &Pose| {
        let place = |pose: &Pose, node: usize| pose.world_from_node[node].w_axis.truncate();
        let moved = parts.iter().map(|&node| place(pose, node).distance(place(&rest, node))).fold(0.0, f32::max);
        for (camera, reach) in scene.cameras.iter().zip(&mut reaches) {
            let Some(placement) = camera.placement(pose) else { continue };
            let behind = placement.eye.distance(middle) as f32 + radius + moved;
            *reach = reach.max(behind * ROOM_BEHIND);
        }
    };
    widen(&rest);
    let is_open = |camera: &SceneCamera| !matches!(camera.lens, FileLens::Perspective { far: Some(_), .. });
    if scene.cameras.iter().any(is_open) {
        // A file may have any number of animations.
        let poses = (MOST_NODES / scene.nodes.len().max(1)).max(SAMPLES);
        for (index, animation) in scene.animations.iter().enumerate().take(poses / SAMPLES) {
            // The end itself is the start of the next turn.
            let (step, last) = (animation.duration / (SAMPLES - 1) as f32, animation.duration.next_down());
            (0..SAMPLES).for_each(|sample| widen(&scene.pose(Some(index), (sample as f32 * step).min(last))));
        }
    }
    reaches
}

/// Returns the near distance of a perspective lens that suits a scene's bounds, in metres.
pub fn near_of(bounds: &Aabb) -> f32 {
    // A scene of one point has no size.
    let radius = (bounds.max - bounds.min).length() * 0.5;
    if radius > 0.0 { radius * 0.005 } else { 5e-6 }
}

/// Returns a camera of a scene in a pose, for pictures of `aspect` (width divided by height). `reach` is the camera's
/// distance from [`camera_reaches`], in metres. The picture keeps the camera's vertical field of view or height, and its
/// width follows from `aspect`. `None` if the camera's node has no size.
pub fn file_camera(camera: &SceneCamera, pose: &Pose, reach: f32, aspect: f32) -> Option<Camera> {
    let placement = camera.placement(pose)?;
    let (lens, near, far, back) = match camera.lens {
        FileLens::Perspective { fov_y, near, far } => {
            (Lens::Perspective { fov_y }, near, far.unwrap_or_else(|| reach.max(near * 2.0)), 0.0)
        }
        FileLens::Orthographic { half_height, near, far } => {
            // Depths are spread evenly, so that a plane far behind the scene would leave it few of them.
            let far = far.min(reach.max(near * 2.0));
            let back = ((LEAST_NEAR * far - near) / (1.0 - LEAST_NEAR)).max(0.0);
            (Lens::Orthographic { half_height }, near + back, far + back, back)
        }
    };
    let (forward, up) = (placement.forward, placement.up);
    let eye = placement.eye - forward.as_dvec3() * f64::from(back);
    Some(Camera { eye, forward, up, lens, aspect, near, far })
}
