//! The least rectangle around the camera frustum as seen from the light, turned about it: by area,
//! or made square. It is the tightest a fit can be without knowing the scene.
//!
//! The frustum's outline has four to eight corners, along whose edges the rectangle is sought. It
//! turns and changes its size with every movement of the camera, so shadow edges crawl unless the
//! fit is [held](crate::settings::Stabilise::Hysteresis).

use glam::Vec3;

use crate::base::FitError;
use crate::fits::{LightFit, fit_as};
use crate::technique::settings::{FitKind, FitSettings};
use crate::view::ViewFrustum;

/// Fits the least rectangle of the frustum; see the [module](self). `direction` is the light's
/// direction of travel in world axes.
///
/// # Errors
///
/// As [`fits::fit`](super::fit).
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    fit_as(FitKind::Oriented, frustum, direction, settings)
}
