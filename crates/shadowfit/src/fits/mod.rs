//! The family of fits, one file per algorithm, and what they share.
//!
//! A fit measures the camera frustum in the light's axes and decides which box of them the shadow
//! map stores. [`fit`] takes the rule from the settings.

pub mod aabb;
pub mod xna;

use glam::{DVec3, Vec3};

use crate::axes::LightAxes;
use crate::checks::{self, MAX_LENGTH, MIN_LENGTH};
use crate::settings::{FitKind, FitSettings};
use crate::{FitError, LightFit, ViewFrustum};

/// Fits the light's orthographic view-projection to a camera frustum, by the rule that
/// [`FitSettings::kind`] names.
///
/// The frustum is cut at [`FitSettings::max_distance`] first (`f32::MAX` leaves it whole; infinity
/// is refused like every number that is not finite). `direction` is the light's
/// **direction of travel** in world axes (right-handed); sources that speak of the direction
/// toward the light use the opposite sign. Its length is of no account.
///
/// # Errors
///
/// Every input that is NaN or infinite, [`FitError::BadDirection`], [`FitError::ZeroResolution`],
/// [`FitError::NearNotBelowFar`] when the maximum distance ends before the near plane, and
/// [`FitError::EmptyFrustum`].
pub fn fit(frustum: &ViewFrustum, direction: Vec3, settings: &FitSettings) -> Result<LightFit, FitError> {
    match settings.kind {
        FitKind::XnaSample => xna::fit(frustum, direction, settings),
        FitKind::FrustumAabb => aabb::fit(frustum, direction, settings),
    }
}

/// A fit's decision: a box along the light's axes and how it is stored.
pub(crate) struct Volume {
    pub(crate) axes: LightAxes,
    /// Corner of the fitted box with the least coordinates, along the light's axes and relative
    /// to the frustum's origin, in metres.
    pub(crate) min: DVec3,
    /// The opposite corner; its z is the map's near plane.
    pub(crate) max: DVec3,
    /// Coordinate of the light along its z axis.
    pub(crate) light_z: f64,
    /// Distance between near and far plane, in metres.
    pub(crate) depth_range: f64,
}

/// Checks what all fits take, and cuts the frustum at the shadows' end.
pub(crate) fn prepare(
    frustum: &ViewFrustum,
    direction: Vec3,
    settings: &FitSettings,
) -> Result<(ViewFrustum, DVec3), FitError> {
    let direction = checks::unit("the light's direction", direction)?;
    checks::within("the fit's margin", f64::from(settings.margin), 0.0, MAX_LENGTH)?;
    let extension = f64::from(settings.caster_extension);
    checks::within("the fit's caster extension", extension, 0.0, MAX_LENGTH)?;
    if settings.resolution.x == 0 || settings.resolution.y == 0 {
        return Err(FitError::ZeroResolution { resolution: settings.resolution });
    }
    checks::finite("the maximum shadow distance", f64::from(settings.max_distance))?;
    Ok((frustum.slice(frustum.near, settings.max_distance)?, direction))
}

/// The box of the frustum's corners along the light's axes, with `margin` metres added on all
/// six sides.
pub(crate) fn bounds(frustum: &ViewFrustum, axes: &LightAxes, margin: f32) -> Result<(DVec3, DVec3), FitError> {
    let mut min = DVec3::MAX;
    let mut max = DVec3::MIN;
    for corner in frustum.corners {
        let p = axes.project(corner.as_dvec3());
        min = min.min(p);
        max = max.max(p);
    }
    let size = max - min;
    if size.min_element() < MIN_LENGTH {
        return Err(FitError::EmptyFrustum { size: size.as_vec3() });
    }
    let margin = DVec3::splat(f64::from(margin));
    Ok((min - margin, max + margin))
}
