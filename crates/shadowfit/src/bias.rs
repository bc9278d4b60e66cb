//! Biases against self-shadowing: the one place that turns texels into depth and metres.
//!
//! A map stores one depth per texel, but a slanted plane has many. A bias covers the difference
//! between the texel's centre and the sampled point; it is proportional to the texel, so it is
//! set in texels and converted here for each fit.

use core::f32::consts::SQRT_2;

use crate::settings::{BiasSettings, FilterKind};
use crate::{LightFit, checks};

/// Biases ready for a shader. With θ the angle between the geometric normal and the direction
/// toward the light, a receiver is looked up at `p + normal · normal_offset · sin θ`, and its
/// depth is moved toward the light by `constant_depth + slope_depth · tan θ`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bias {
    /// Depth bias, in units of the stored depth (0..1 over the fit's depth range).
    pub constant_depth: f32,
    /// Depth bias to be multiplied by tan θ, in units of the stored depth.
    pub slope_depth: f32,
    /// Offset along the geometric normal to be multiplied by sin θ, in metres.
    pub normal_offset: f32,
}

/// Roundings of 2⁻²⁴ that can part the depth stored for a point from the depth compared with it,
/// as a multiple of the farthest distance from the origin in the map's box: four operations a
/// term, in each of two transforms, on terms that sum to at most twice that distance.
const PRECISION_ROUNDINGS: f32 = 16.0;

/// Relative rounding of f32, 2⁻²⁴.
const ROUNDING: f32 = 1.0 / 16_777_216.0;

/// Constant bias of [`BiasSettings::automatic`], in texels: it covers [`PRECISION_ROUNDINGS`]
/// while no corner of the map's box is farther than 65536 texel sizes from the origin, 32 times
/// the width of a 2048² map.
const PRECISION_TEXELS: f32 = 1.0 / 16.0;

impl Bias {
    /// Converts biases in texels for one fit. Texels that are not square count by their longer
    /// side, which is on the safe side of acne.
    pub fn from_texels(settings: &BiasSettings, fit: &LightFit) -> Self {
        let texel = longer_side(fit);
        Self {
            constant_depth: settings.constant * texel / fit.depth_range,
            slope_depth: settings.slope * texel / fit.depth_range,
            normal_offset: settings.normal_offset * texel,
        }
    }

    /// A bias that clears self-shadowing on a plane whatever its slope's azimuth, for a filter of
    /// the given [`reach`] in texels: [`automatic_normal_offset`], the least that does, plus what
    /// f32 rounding can do to the depths of this very fit at its origin. It holds for geometric
    /// normals, not for interpolated or normal-mapped ones.
    pub fn automatic(reach: f32, fit: &LightFit) -> Self {
        let corners = fit.corners().map(|corner| checks::length(corner.as_dvec3()) as f32);
        let farthest = corners.into_iter().fold(0.0, f32::max);
        Self {
            constant_depth: PRECISION_ROUNDINGS * ROUNDING * farthest / fit.depth_range,
            slope_depth: 0.0,
            normal_offset: automatic_normal_offset(reach) * longer_side(fit),
        }
    }
}

impl BiasSettings {
    /// Biases in texels that clear self-shadowing on planes for a filter, at any fit whose box
    /// stays within 65536 texel sizes of the origin; [`Bias::automatic`] has no such limit.
    /// Geometric normals are assumed.
    pub fn automatic(filter: FilterKind) -> Self {
        Self { constant: PRECISION_TEXELS, slope: 0.0, normal_offset: automatic_normal_offset(reach(filter)) }
    }
}

/// Reach E of a filter: the greatest distance along one axis from the sampled point to a texel
/// centre of non-zero weight, in texels.
pub const fn reach(filter: FilterKind) -> f32 {
    match filter {
        FilterKind::Point => 0.5,
        FilterKind::Hardware2x2 => 1.0,
    }
}

/// Normal offset, in texels and to be multiplied by sin θ, that clears self-shadowing on a plane
/// whose slope runs at azimuth φ in the map's axes: `E · (|cos φ| + |sin φ|)`.
///
/// Within the reach E the plane's depth differs from that of the sampled point by up to
/// `tan θ · E · (|cos φ| + |sin φ|)`; a point that is lifted by h along the normal gains
/// `h / cos θ` of depth over the plane below it. Equate the two.
pub fn plane_normal_offset(reach: f32, azimuth: f32) -> f32 {
    reach * (libm::cosf(azimuth).abs() + libm::sinf(azimuth).abs())
}

/// [`plane_normal_offset`] at its worst azimuth, the map's diagonal: `√2 · E` texels.
pub const fn automatic_normal_offset(reach: f32) -> f32 {
    SQRT_2 * reach
}

fn longer_side(fit: &LightFit) -> f32 {
    fit.texel_size.x.max(fit.texel_size.y)
}
