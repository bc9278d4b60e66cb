//! How far a bias is from self-shadowing, predicted from the plane of the surface.

use glam::{DVec3, Vec3};

use super::coverage::coverage;
use crate::base::{FitError, checks};
use crate::bias::depth_storage::DepthStorage;
use crate::bias::{Bias, Reach, SQUARED_SINE_ROUNDING, Slope, depth_precision};
use crate::fits::LightFit;

/// Bias less what a plane needs. Where it is negative, so much bias is missing, and the plane
/// shadows itself in stripes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AcneMargin {
    /// In metres along the normal: the distance by which the point could sink into its surface
    /// without acne.
    pub metres: f32,
    /// The same in texels, by the longer side of a texel, as biases are set.
    pub texels: f32,
}

/// Predicted margin of a bias against acne at a world position (f64, metres) on a surface with the
/// given **geometric** normal (world axes, any length, either side): the bias given there less the
/// bias that its plane needs for a filter of the given reach [on hardware](Reach::on_hardware) and
/// a map of the given storage. `None` where the map does not cover the point.
///
/// With the normal offset h, the depth bias d of [`Bias::on_plane`] and the depth range R the
/// margin is `h + (d - precision) · R · cos θ - E · (tx·|n·x| + ty·|n·y|)`. At 0 or more a plane
/// cannot shadow itself; below, part of its points do. Curved surfaces need more than their
/// tangent plane.
///
/// # Errors
///
/// [`FitError::NotFinite`], [`FitError::OutOfRange`] for the point or the reach, and
/// [`FitError::BadDirection`] for the normal.
pub fn acne_margin(
    fit: &LightFit,
    bias: &Bias,
    reach: impl Into<Reach>,
    storage: impl Into<DepthStorage>,
    point: DVec3,
    normal: Vec3,
) -> Result<Option<AcneMargin>, FitError> {
    let reach = reach.into().checked()?;
    let given = bias.on_plane(fit, normal)?;
    let plane = Slope::of(fit, normal)?;
    if !coverage(fit, reach, point)?.is_inside() {
        return Ok(None);
    }
    // The sine that a shader takes from an f32 cosine may be less than the one of `on_plane`.
    let squared_sine = 1.0 - plane.cosine * plane.cosine;
    let sine = libm::sqrt((squared_sine - SQUARED_SINE_ROUNDING).max(0.0));
    let offset = f64::from(given.offset).min(f64::from(bias.normal_offset) * sine);
    let depth = f64::from(given.depth) - f64::from(depth_precision(fit, storage));
    let along_normal = depth * f64::from(fit.depth_range) * plane.cosine;
    let metres = offset + along_normal - reach.on_hardware(fit).rise(plane.u, plane.v);
    let texel = f64::from(fit.texel_size.x.max(fit.texel_size.y));
    let rounded = |margin| checks::rounded("the acne margin", margin);
    Ok(Some(AcneMargin { metres: rounded(metres)?, texels: rounded(metres / texel)? }))
}
