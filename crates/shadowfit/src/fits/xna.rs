//! The fit of the XNA "Shadow Mapping" sample (Microsoft, XNA Creators Club, 2008):
//! `CreateLightViewProjectionMatrix`, kept exact so that its pictures and flaws can be reproduced.
//! Tight across the light, twice the depth it needs, and blind to casters outside the frustum.
//!
//! The light stands at the centre of the box's x and y at its *minimum* z, which is the face
//! **away** from where the light comes from, since view space looks along -z; the projection then
//! runs from -depth to +depth:
//!
//! ```text
//!   toward the light
//!         ▲ z
//!   max.z ┼───────┐  near plane, depth 0
//!         │frustum│
//!   min.z ┼───●───┤  the light, depth 0.5
//!         │ empty │
//!         └───────┘  far plane, depth 1
//! ```
//!
//! Deviations from the source, none of which changes a number of its own scene: corners are
//! relative to the eye and the box is measured in f64 (the source rounds world coordinates to
//! f32), a vertical light takes another up axis (the source divides by zero), reversed and -1..1
//! depth are offered, and `margin` is the cure that the source's text suggests.

use glam::{DVec3, Vec3};

use super::{Content, Light, Range, Volume, checked, fit_as};
use crate::checks::MIN_LENGTH;
use crate::light_fit::Constraint;
use crate::settings::{FitKind, FitSettings};
use crate::view::slice_corners;
use crate::{FitError, FitInput, LightFit, ViewFrustum};

/// Fits as the XNA sample does; see the [module](self). `direction` is the light's direction of
/// travel in world axes. Of the settings the caster policy, the rectangle and the kernel margin
/// are not used.
///
/// # Errors
///
/// As [`fits::fit`](super::fit).
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    fit_as(FitKind::XnaSample, frustum, direction, settings)
}

pub(crate) fn volume(
    content: &Content,
    light: &Light,
    settings: &FitSettings,
    range: Range,
) -> Result<Volume, FitError> {
    around(content.slices(range), light, settings)
}

/// The map around the only view of an input.
pub(crate) fn of_view(input: &FitInput, settings: &FitSettings) -> Result<LightFit, FitError> {
    let (direction, up) = checked(input, settings)?;
    let light = Light::new(direction, up, FitKind::XnaSample);
    let view = &input.views[0];
    let corners = slice_corners(view, view.origin, view.near, settings.max_distance);
    let volume = around(corners.into_iter(), &light, settings)?;
    LightFit::from_volume(view.origin, &volume, settings)
}

/// The sample's box around the corners of views' slices.
#[inline(always)]
pub(crate) fn around(
    slices: impl Iterator<Item = [DVec3; 8]>,
    light: &Light,
    settings: &FitSettings,
) -> Result<Volume, FitError> {
    let axes = light.axes;
    let (mut min, mut max) = (DVec3::MAX, DVec3::MIN);
    for slice in slices {
        for corner in slice {
            let p = axes.project(corner);
            (min, max) = (min.min(p), max.max(p));
        }
    }
    let size = max - min;
    if size.min_element() < MIN_LENGTH {
        return Err(FitError::EmptyFrustum { size: size.as_vec3() });
    }
    let margin = DVec3::splat(f64::from(settings.margin));
    let (min, max) = (min - margin, max + margin);
    let depth_range = 2.0 * (max.z - min.z);
    let set_by = [Constraint::View; 6];
    Ok(Volume { axes, min, max, light_z: min.z, depth_range, set_by, is_empty: false, grid: None })
}
