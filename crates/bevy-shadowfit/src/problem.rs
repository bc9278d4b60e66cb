//! Why a light keeps Bevy's own cascades.

use std::fmt;

use bevy::prelude::*;
use shadowfit::FitError;

/// What is wrong with a light, a view or the scene.
#[derive(Debug)]
pub(crate) enum Problem {
    /// The light has no direction.
    Light,
    /// The number of its cascades is not one that Bevy draws.
    Cascades(usize),
    /// A camera whose transform is not finite or scales, or a mesh that only it knows.
    View(Entity),
    /// A mesh whose box is not finite.
    Mesh(Entity),
    /// A fit that was refused.
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
            Self::Light => write!(f, "its transform has no direction (it scales by 0 or is not finite)"),
            Self::Cascades(count) => write!(
                f,
                "its CascadeShadowConfig has {count} bounds, or bounds that are not positive, finite and ascending; 1 to {} are drawn",
                bevy::pbr::MAX_CASCADES_PER_LIGHT
            ),
            Self::View(camera) => {
                write!(f, "the transform of camera {camera} is not finite or scales; a camera's scale has to be 1")
            }
            Self::Mesh(mesh) => write!(
                f,
                "the bounding box of mesh {mesh} is not finite (Aabb and GlobalTransform); NotShadowReceiver leaves it out"
            ),
            Self::Fit(error) => write!(f, "{error}"),
        }
    }
}
