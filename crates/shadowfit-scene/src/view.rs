//! Cameras and suns of a scene in a pose. An animation moves them with their nodes.

use glam::{DVec3, Vec3};

use crate::{Pose, Scene, SceneCamera, SceneSun, Sun};

/// Weight of each colour in luminance (ITU-R BT.709).
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// Position and axes of a camera, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Position of the eye, in metres.
    pub eye: DVec3,
    /// Unit direction of view.
    pub forward: Vec3,
    /// Unit direction that points up in the picture, perpendicular to `forward`.
    pub up: Vec3,
}

impl SceneCamera {
    /// Returns the camera's placement in a pose, without the scale and shear of its node. Returns `None` if
    /// the node scales the view direction to zero.
    pub fn placement(&self, pose: &Pose) -> Option<Placement> {
        let world = pose.world_from_node.get(self.node)?;
        let eye = world.w_axis.truncate();
        let forward = (-world.z_axis.truncate()).try_normalize()?;
        // If the node scales its y axis to zero, or shears it into the view direction, any roll is valid.
        let up = world.y_axis.truncate();
        let up = up.normalize_or(Vec3::Y).reject_from_normalized(forward).try_normalize();
        let up = up.unwrap_or_else(|| forward.any_orthonormal_vector());
        eye.is_finite().then_some(Placement { eye: eye.as_dvec3(), forward, up })
    }
}

impl SceneSun {
    /// Returns the unit direction of travel of the light in a pose, in world space. Returns `None` if the
    /// node scales it to zero.
    pub fn direction(&self, pose: &Pose) -> Option<Vec3> {
        pose.world_from_node.get(self.node)?.transform_vector3(Vec3::NEG_Z).try_normalize()
    }

    /// Returns the brightness of its light: the intensity times the luminance of the colour, in lux.
    pub fn strength(&self) -> f32 {
        self.intensity * self.color.dot(LUMINANCE)
    }
}

impl SceneSun {
    /// Returns why the light does not shine in a pose, or `None` if it shines.
    pub(crate) fn fault(&self, pose: &Pose) -> Option<&'static str> {
        if self.strength() <= 0.0 {
            Some("it emits no light")
        } else if !(self.color * self.intensity).is_finite() {
            Some("its brightness is not finite")
        } else if self.direction(pose).is_none() {
            Some("its node has no size")
        } else {
            None
        }
    }
}

impl Scene {
    /// Returns the index of the strongest of [`Self::suns`] at rest, the first of equals. Returns `None` if
    /// none shines, because each has no intensity, an infinite one, or a node that scales its direction to
    /// zero.
    pub fn strongest_sun(&self) -> Option<usize> {
        self.strongest_sun_in(&self.pose(None, 0.0))
    }

    /// Returns the index of the strongest of [`Self::suns`] that shine in a pose.
    pub(crate) fn strongest_sun_in(&self, pose: &Pose) -> Option<usize> {
        let shining = self.suns.iter().enumerate().filter(|(_, sun)| sun.fault(pose).is_none());
        // `max_by` takes the last of equals.
        shining.rev().max_by(|(_, a), (_, b)| a.strength().total_cmp(&b.strength())).map(|(index, _)| index)
    }

    /// Returns the strongest of [`Self::suns`] in a pose.
    pub(crate) fn sun_of(&self, pose: &Pose) -> Option<Sun> {
        let sun = &self.suns[self.strongest_sun_in(pose)?];
        Some(Sun { direction: sun.direction(pose)?, color: sun.color, intensity: sun.intensity })
    }
}
