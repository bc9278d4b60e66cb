//! A camera of a scene's file as a view, with near and far planes for the scene if the file does not set
//! them.

use shadowfit::{Aabb, Camera, Lens};
use shadowfit_scene::{Lens as FileLens, Pose, Scene, SceneCamera};

/// Smallest far distance of a camera without a far plane, in half diagonals of the scene's bounds.
const FAR: f32 = 20.0;
/// Room behind the scene within such a camera's far plane, as a multiple of the distance to the scene's far
/// side. It also covers parts that turn, and poses between two samples of an animation.
const ROOM_BEHIND: f32 = 1.25;
/// Number of sampled poses per animation.
const SAMPLES: usize = 17;
/// Greatest number of nodes in all sampled poses. Later animations are skipped.
const MOST_NODES: usize = 4_000_000;
/// Smallest near distance of an orthographic camera, as a share of its far distance, because several maps
/// divide the logarithm of the depth. A camera with less is moved back by the missing distance, which changes
/// no pixel.
const LEAST_NEAR: f32 = 1e-3;

/// Returns the far distance, in metres, at which each of a scene's cameras sees past the whole scene in its
/// rest pose and throughout its animations. One distance for all poses keeps splits and depths steady.
/// `bounds` are the scene's world bounds in its rest pose. They are widened by the motion of the nodes, but
/// not by morph targets.
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
            // The end itself is the start of the next cycle.
            let (step, last) = (animation.duration / (SAMPLES - 1) as f32, animation.duration.next_down());
            (0..SAMPLES).for_each(|sample| widen(&scene.pose(Some(index), (sample as f32 * step).min(last))));
        }
    }
    reaches
}

/// Returns the near distance of a perspective lens for a scene with these bounds, in metres.
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
            // Depths are spread evenly, so a plane far behind the scene would leave few depth steps for the
            // scene.
            let far = far.min(reach.max(near * 2.0));
            let back = ((LEAST_NEAR * far - near) / (1.0 - LEAST_NEAR)).max(0.0);
            (Lens::Orthographic { half_height }, near + back, far + back, back)
        }
    };
    let (forward, up) = (placement.forward, placement.up);
    let eye = placement.eye - forward.as_dvec3() * f64::from(back);
    Some(Camera { eye, forward, up, lens, aspect, near, far })
}
