//! The least rectangle around what the camera can see of the receivers' boxes.
//!
//! Most of a frustum is empty air. Each receiver's box is clipped to the frustum and seen from the
//! light; the rectangle lies around the outlines of all of them, and depth ends at the lowest one.
//! No pixel of a receiver lies outside its box, so none is missed; the more closely the boxes hug
//! the surfaces, the finer the texels, which is why it pays to cut a large mesh into clusters
//! (`Clusters`, with the feature `alloc`).

use glam::Vec3;

use crate::base::FitError;
use crate::fits::{LightFit, fit_as};
use crate::technique::settings::{FitKind, FitSettings};
use crate::view::ViewFrustum;

/// Fits a frustum without known receivers, which gives the [oriented](super::oriented) fit;
/// [`fit_scene`](crate::fits::fit_scene) takes boxes. `direction` is the light's direction of
/// travel in world axes.
///
/// # Errors
///
/// As [`fits::fit`](super::fit).
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    fit_as(FitKind::Focused, frustum, direction, settings)
}
