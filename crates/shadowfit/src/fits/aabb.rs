//! The axis-aligned box of the camera frustum in the light's axes: the fit that most engines use.
//! Depth is tight to the frustum, and the near plane is moved toward the light by a caster
//! extension, since what stands between the light and the frustum throws shadows into it.
//!
//! ```text
//!   toward the light
//!          ▲ z
//!          ┌────●────┐  near plane with the light in its middle
//!          │ casters │  caster_extension
//!    max.z ┼─────────┤
//!          │ frustum │
//!    min.z └─────────┘  far plane
//! ```
//!
//! The roll about the light comes from the shortest arc from straight down, so the map turns
//! continuously with the sun.

use glam::Vec3;

use super::{Volume, bounds, prepare};
use crate::axes::LightAxes;
use crate::settings::FitSettings;
use crate::{FitError, LightFit, ViewFrustum};

/// Fits the frustum's box in the light's axes; see the [module](self). `direction` is the light's
/// direction of travel in world axes.
///
/// # Errors
///
/// As [`fits::fit`](super::fit).
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    let (frustum, direction) = prepare(frustum, direction, settings)?;
    let axes = LightAxes::shortest_arc(direction);
    let (min, mut max) = bounds(&frustum, &axes, settings.margin)?;
    max.z += f64::from(settings.caster_extension);
    let volume = Volume { axes, min, max, light_z: max.z, depth_range: max.z - min.z };
    LightFit::from_volume(frustum.origin, &volume, settings)
}
