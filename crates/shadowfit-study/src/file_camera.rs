//! A camera of a scene's file as a view takes it: with planes that suit the scene where the file leaves them open.

use shadowfit::{Aabb, Camera, Lens};
use shadowfit_scene::{Lens as FileLens, Pose, SceneCamera};

/// Far distance of a camera without a far plane, in half diagonals of the scene's bounds, at least.
const FAR: f32 = 20.0;
/// Room behind the scene that such a camera sees, as a multiple of the distance to its far side.
const ROOM_BEHIND: f32 = 1.25;
/// Least near distance of an orthographic camera, as a share of its far distance. Such a camera is moved back by the distance
/// that it lacks, which changes no pixel: several maps divide the logarithm of the depth.
const LEAST_NEAR: f32 = 1e-3;

/// Returns a camera of a scene in a pose in which the scene has these bounds, for pictures of `aspect` (width divided by
/// height). The picture keeps the camera's vertical field of view or height, and its width follows from `aspect`. `None` if
/// the camera's node has no size.
pub fn file_camera(camera: &SceneCamera, pose: &Pose, bounds: &Aabb, aspect: f32) -> Option<Camera> {
    let placement = camera.placement(pose)?;
    let radius = (bounds.max - bounds.min).length() * 0.5;
    let middle = ((bounds.min + bounds.max) * 0.5).as_dvec3();
    let behind = (placement.eye.distance(middle) as f32 + radius) * ROOM_BEHIND;
    let reach = |near: f32| behind.max(radius * FAR).max(near * 2.0);
    let (lens, near, far, back) = match camera.lens {
        FileLens::Perspective { fov_y, near, far } => {
            (Lens::Perspective { fov_y }, near, far.unwrap_or_else(|| reach(near)), 0.0)
        }
        FileLens::Orthographic { half_height, near, far } => {
            // Depths are spread evenly, so that a plane far behind the scene would leave it few of them.
            let far = far.min(reach(near));
            let back = ((LEAST_NEAR * far - near) / (1.0 - LEAST_NEAR)).max(0.0);
            (Lens::Orthographic { half_height }, near + back, far + back, back)
        }
    };
    let (forward, up) = (placement.forward, placement.up);
    let eye = placement.eye - forward.as_dvec3() * f64::from(back);
    Some(Camera { eye, forward, up, lens, aspect, near, far })
}
