//! Reasons why a light keeps Bevy's own cascades.

use std::fmt;

use bevy::prelude::*;
use shadowfit::FitError;

/// Problem of a light, a view or the scene.
#[derive(Debug)]
pub(crate) enum Problem {
    /// The light has no direction.
    Light,
    /// Bevy does not support this number of cascades.
    Cascades(usize),
    /// A camera's transform is not finite or scales, or a mesh that only this camera shows is invalid.
    View(Entity),
    /// A mesh's box is not finite.
    Mesh(Entity),
    /// A fit failed.
    Fit(FitError),
}

impl From<FitError> for Problem {
    fn from(error: FitError) -> Self {
        Self::Fit(error)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Light => write!(f, "its transform has no direction, because it scales by 0 or is not finite"),
            Self::Cascades(count) => write!(
                f,
                "its CascadeShadowConfig has {count} bounds, or bounds that are not positive, finite and ascending; 1 to {} are drawn",
                bevy::pbr::MAX_CASCADES_PER_LIGHT
            ),
            Self::View(camera) => {
                write!(f, "the transform of camera {camera} is not finite or scales; set the camera's scale to 1")
            }
            Self::Mesh(mesh) => write!(
                f,
                "the bounding box of mesh {mesh} is not finite (Aabb and GlobalTransform); NotShadowReceiver ignores it"
            ),
            Self::Fit(error) => write!(f, "{error}"),
        }
    }
}
