//! The axis-aligned box of the camera frustum in the light's axes: the fit that most engines use.
//! Depth is tight to the frustum, and the near plane is moved toward the light by a caster
//! extension, since objects between the light and the frustum cast shadows into it.
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

use crate::base::FitError;
use crate::fits::{LightFit, fit_as};
use crate::technique::settings::{FitKind, FitSettings};
use crate::view::ViewFrustum;

/// Fits the frustum's box in the light's axes; see the [module](self). `direction` is the light's
/// direction of travel in world axes.
///
/// # Errors
///
/// As [`fits::fit`](super::fit).
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    fit_as(FitKind::FrustumAabb, frustum, direction, settings)
}
