//! Biases against self-shadowing for perspective maps.
//!
//! As for the sun ([`crate::bias`]), a map stores one depth per texel, and a bias covers the rise of a
//! slanted plane within the filter's radius. There are two differences: texels grow in proportion to the
//! distance from the light, and the stored depth is not linear in that distance.
//!
//! # Bias of a plane
//!
//! Light space has the light at its origin, looking along -z. A point at the distance d along the axis is
//! d · (a, b, -1), and the map's texels are a grid in (a, b) with the sides tx and ty, the
//! [texel size](SpotFit::texel_size) at 1 m. Let n be the plane's unit normal on the light's side and c > 0 the light's
//! distance from the plane. The plane's points have n·p = -c, so along the ray (a, b)
//!
//! ```text
//!   1/d = (n·z - a n·x - b n·y) / c         z = A - B/d,  B = near · far / (far - near)
//! ```
//!
//! Both 1/d and the stored depth z are *affine in texels*: the depth gradient per texel is the same
//! everywhere on a plane. A point lifted by h along n has n·p = h - c, thus (c - h) / d = n·z - a n·x - b n·y
//! at its own distance d. A texel centre (δa, δb) beside it stores a plane depth that is not nearer to the
//! light exactly when (c - h) / (c d) - (δa n·x + δb n·y) / c ≤ 1/d. For all centres |δa| ≤ E tx, |δb| ≤ E ty
//! within the filter radius E this means
//!
//! ```text
//!   h ≥ d · s,   s = E · (tx·|n·x| + ty·|n·y|)                                      as a lift along the normal
//!   B · s / c = E · (|∂z/∂u| + |∂z/∂v|)                                             as a depth bias
//! ```
//!
//! This is the sun's formula with the texel size at d. Here d is the *lifted* point's distance. With the
//! distance of the unlifted point, d₀ = d + h n·z, it becomes h = d₀ s / (1 + s n·z). Planes that face the
//! light but not its axis (n·z < 0, only off the axis) need slightly more than d₀ s. For square texels s is
//! at most √2 · E · t · sin α, where α is the angle between the normal and the light's **axis**, not the
//! direction to the point. A plane perpendicular to the axis has one depth everywhere and needs no bias at
//! any angle of incidence.
//!
//! # Rounding
//!
//! A depth error of e metres along the axis is an error of B e / d² in the map, and a step of the stored
//! depth is d² / B steps of a metre: coarse far from the light, unless depth is reversed and stored as a
//! float. So rounding has three parts: a number in the map, a number that falls with 1/d, and metres.
//! [`SpotBias::precision`] has all three.
//!
//! All of this holds for the **geometric** normal of the stored surface.

use glam::{DVec3, Vec2, Vec3};

use super::SpotFit;
use crate::base::checks::{MAX_LENGTH, MIN_LENGTH, UNIT};
use crate::base::{DepthConvention, FitError, checks};
use crate::bias::depth_storage::{DepthStorage, depth_step};
use crate::bias::{FilterRadius, HARDWARE_SNAP, MIN_COSINE, PlaneBias};
use crate::technique::settings::BiasSettings;

/// Biases for a shader. Let n be the geometric normal on the light's side, α its angle to the light's axis
/// (sin α = |n × axis|, which is more exact than √(1 - cos²)), d the receiver's distance along the axis and c
/// = n · (light - p) the light's distance from its plane, at least [`MIN_COSINE`] of |light - p|. The
/// receiver is looked up at `p + n · (normal_offset · d · sin α + constant_offset)`. Its depth is moved
/// toward the light by the following amount, where w is the lifted point's distance, the w of its look-up:
///
/// ```text
///   constant_depth + distance_depth / w + slope_depth · sin α / c + receiver_plane · (|∂z/∂u| + |∂z/∂v|)
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SpotBias {
    /// Depth bias, in units of the stored depth.
    pub constant_depth: f32,
    /// Depth bias to be divided by the distance along the axis, in units of the stored depth times metres. It
    /// is a constant number of texels, since texels grow with d while the stored depth changes by 1/d² per
    /// metre.
    pub distance_depth: f32,
    /// Depth bias to be multiplied by sin α and divided by c, in units of the stored depth times metres. On
    /// the axis, sin α / c is tan α / d.
    pub slope_depth: f32,
    /// Offset along the geometric normal to be multiplied by sin α and by the distance along the axis, in
    /// metres per metre.
    pub normal_offset: f32,
    /// Offset along the geometric normal at every slope and distance, in metres.
    pub constant_offset: f32,
    /// Depth bias to be multiplied by `|∂z/∂u| + |∂z/∂v|`, the [`depth_gradient`] of the receiver's plane per
    /// texel, in texels. If it is not 0, a filter compares each tap with the plane's depth at that tap.
    pub receiver_plane: f32,
}

/// Error bound of a position or a depth, in roundings of 2⁻²⁴. There are two transforms, of the caster and of
/// the receiver, with six operations per term (the rounded position and element, the product, three sums). A
/// texture coordinate is a sum of two rows, whose terms sum to at most 3.2 times the farthest coordinate,
/// which gives 39. Wide filters need up to half of that in addition, since a lift may move a point away from
/// the light.
const ROUNDINGS: f64 = 64.0;

/// Greatest f32 error of a coordinate, as a share of the terms that it is the sum of.
const TERMS: f64 = ROUNDINGS * UNIT;

/// Relative enlargement of an offset for the rounding of its factors in a shader: eight roundings of 2⁻²⁴.
const FACTORS: f64 = 8.0 * UNIT;

impl SpotBias {
    /// Converts biases in texels, and in depth steps, for one map. The depth storage may be given as the
    /// [`MapFormat`](crate::settings::MapFormat). A texel is the longer side of a texel at the receiver's
    /// distance. Settings that are not finite give biases that are not finite, which [`Self::checked`]
    /// rejects.
    ///
    /// A [step](BiasSettings::depth_steps) is the whole [`Self::precision`] here, because far from the light,
    /// f32 rounds a perspective depth by more than any constant in texels covers.
    pub fn from_texels(settings: &BiasSettings, storage: impl Into<DepthStorage>, fit: &SpotFit) -> Self {
        let texel = fit.texel_size.x.max(fit.texel_size.y);
        let texel_depth = texel * fit.depth_scale() as f32;
        let step = Self::precision(storage, fit);
        Self {
            constant_depth: settings.depth_steps * step.constant_depth,
            distance_depth: settings.constant * texel_depth + settings.depth_steps * step.distance_depth,
            slope_depth: settings.slope * texel_depth,
            normal_offset: settings.normal_offset * texel,
            constant_offset: settings.depth_steps * step.constant_offset,
            receiver_plane: settings.receiver_plane,
        }
    }

    /// Returns a fixed bias in units of the stored depth, independent of slope and distance: the classic
    /// form, such as 1/100 for an 8-bit map. In metres it grows with the square of the distance from the
    /// light. A negative bias moves the receiver away from the light, which maps of back faces may need.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`], and [`FitError::OutOfRange`] beyond the whole range of depths.
    pub fn fixed(depth: f32) -> Result<Self, FitError> {
        checks::within("the fixed depth bias", f64::from(depth), -1.0, 1.0)?;
        Ok(Self { constant_depth: depth, ..Self::default() })
    }

    /// Returns the bias that covers rounding only: one step of the map's depth storage (half for storing a
    /// depth, half because hardware may round the compared depth too), and the f32 error of the stored and of
    /// the compared depth.
    ///
    /// Let k be the distance of the frustum's corner at 1 m along the axis, D the light's distance from
    /// [`SpotFit::origin`] and ε 64 roundings of 2⁻²⁴. Positions have errors of up to ε k (2 D + k d). The
    /// part with D is [`Self::constant_offset`], in metres along the normal. The other part is a depth error
    /// along the axis, and across the axis it is in the [radius on hardware](on_hardware). The depth's row
    /// adds ε (A (2 D / d + k) + B / d), where A is the factor of the distance in it: about 1, or with
    /// reversed depth near / (far - near). Steps are the coarsest of the format, except for floats with
    /// reversed depth, where they shrink with the depth, as 2 · 2⁻ᵇ · B / d.
    pub fn precision(storage: impl Into<DepthStorage>, fit: &SpotFit) -> Self {
        let (near, far) = (f64::from(fit.near), f64::from(fit.far));
        let is_reversed = fit.depth == DepthConvention::Reversed;
        let factor = if is_reversed { near } else { far } / (far - near);
        let (stretch, scale, away) = (fit.stretch(), fit.depth_scale(), fit.away());
        let (step, falling_step) = steps(storage.into(), is_reversed);
        let falling = TERMS * (2.0 * factor * away + scale * (1.0 + stretch)) + falling_step * scale;
        Self {
            constant_depth: (TERMS * factor * stretch + step) as f32,
            distance_depth: falling as f32,
            constant_offset: (2.0 * TERMS * stretch * away) as f32,
            ..Self::default()
        }
    }

    /// Returns a bias that prevents self-shadowing on a plane whose slope has any azimuth: an offset along
    /// the normal for the filter's radius [on hardware](on_hardware), and the [`Self::precision`]. If a
    /// shader knows the azimuth, [`normal_offset`] needs up to √2 less. The lift is at most 1 / (1 - S/2)
    /// times the need of the worst plane, with S the filter radius in metres at 1 m: 0.3% more for a filter
    /// of four texels in a 2048² map of 90°. Geometric normals are assumed.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the radius, for a radius that is
    /// wider than the distance from the light (a map of very few texels), and for a fit with fields that are
    /// not finite.
    pub fn automatic(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &SpotFit,
    ) -> Result<Self, FitError> {
        let reach = on_hardware(fit, reach)?;
        let (x, y) = (f64::from(fit.texel_size.x), f64::from(fit.texel_size.y));
        let disc = (f64::from(reach.disc.x) * x).max(f64::from(reach.disc.y) * y);
        let widest = f64::from(reach.taps) * libm::sqrt(x * x + y * y) + disc;
        checks::within("the filter's reach at 1 m from the light", widest, 0.0, 1.0)?;
        // |n·z| sin α is at most 1/2.
        let normal_offset = widest / (1.0 - 0.5 * widest) * (1.0 + FACTORS);
        Self { normal_offset: normal_offset as f32, ..Self::precision(storage, fit) }.checked()
    }

    /// Returns a bias as [`Self::automatic`] does, with the receiver plane's gradient over the filter's
    /// radius on hardware. It prevents self-shadowing on planes whose normal has a cosine of at least
    /// [`MIN_COSINE`] with the light, and is very large near that limit. Only rounding needs an offset:
    /// [`Self::constant_offset`], which is 0 for a map relative to its light.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the radius, and for a fit with fields
    /// that are not finite.
    pub fn automatic_receiver_plane(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &SpotFit,
    ) -> Result<Self, FitError> {
        let receiver_plane = on_hardware(fit, reach)?.per_axis();
        Self { receiver_plane, ..Self::precision(storage, fit) }.checked()
    }

    /// Returns the offset and depth of this bias at a world position (f64, metres) on a plane with the given
    /// geometric normal (world axes, any length, either side), as a shader computes it.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`], [`FitError::OutOfRange`] if the point or the lifted point is not in
    /// front of the light, and [`FitError::BadDirection`] for the normal.
    pub fn on_plane(&self, fit: &SpotFit, point: DVec3, normal: Vec3) -> Result<PlaneBias, FitError> {
        let bias = self.checked()?;
        let plane = Plane::of(fit, point, normal)?;
        let offset = f64::from(bias.normal_offset) * plane.distance * plane.sine + f64::from(bias.constant_offset);
        let lifted = plane.lifted(offset);
        checks::within("the lifted point's distance along the light's axis", lifted, checks::MIN_LENGTH, f64::MAX)?;
        let [u, v] = plane.gradient(fit);
        let depth = f64::from(bias.constant_depth)
            + f64::from(bias.distance_depth) / lifted
            + f64::from(bias.slope_depth) * plane.sine / plane.height
            + f64::from(bias.receiver_plane) * (u.abs() + v.abs());
        Ok(PlaneBias {
            offset: checks::rounded("the offset on the plane", offset)?,
            depth: checks::rounded("the depth bias on the plane", depth)?,
        })
    }

    /// Returns the bias if all its numbers are finite. Call it after [`Self::from_texels`] for settings from
    /// outside.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] with the first number that is not finite.
    pub fn checked(self) -> Result<Self, FitError> {
        for (input, value) in [
            ("the constant depth bias", self.constant_depth),
            ("the depth bias by distance", self.distance_depth),
            ("the slope-scaled depth bias", self.slope_depth),
            ("the normal offset", self.normal_offset),
            ("the constant offset", self.constant_offset),
            ("the receiver-plane bias", self.receiver_plane),
        ] {
            checks::finite(input, f64::from(value))?;
        }
        Ok(self)
    }
}

/// Returns a filter radius, enlarged by the rounding of a GPU: 1/256 of a texel, and the f32 error of texture
/// coordinates per metre of distance from the light. [`SpotBias::precision`] has the error by the distance
/// between light and origin. With exact arithmetic the plain radius is enough.
///
/// # Errors
///
/// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the radius.
pub fn on_hardware(fit: &SpotFit, reach: impl Into<FilterRadius>) -> Result<FilterRadius, FitError> {
    let reach = reach.into().checked()?;
    let texel = f64::from(fit.texel_size.x.min(fit.texel_size.y));
    let rounding = TERMS * fit.stretch() * fit.stretch() / texel;
    FilterRadius { taps: reach.taps + HARDWARE_SNAP + rounding as f32, ..reach }.checked()
}

/// Returns the normal offset for a plane at a world position (f64, metres), in metres along its normal on the
/// light's side (including sin α): d s / (1 + s n·z). The head of `spot/bias.rs` derives it. For a disc, s
/// includes the ellipse's part.
///
/// `normal` is the geometric one, in world axes, of any length and on either side. The offset is the least
/// one in exact arithmetic. [`on_hardware`] and [`SpotBias::precision`] add the needs of a GPU.
///
/// # Errors
///
/// Returns [`FitError::NotFinite`], [`FitError::BadDirection`] for the normal, and [`FitError::OutOfRange`]
/// for the filter radius, for a point that is not in front of the light, and for a filter so wide that any
/// lift fails.
pub fn normal_offset(
    fit: &SpotFit,
    reach: impl Into<FilterRadius>,
    point: DVec3,
    normal: Vec3,
) -> Result<f32, FitError> {
    let plane = Plane::of(fit, point, normal)?;
    let rise = plane.rise(reach.into().checked()?);
    let rest = 1.0 + rise * plane.along;
    checks::within("the share of the light's distance beyond the filter's reach", rest, f64::MIN_POSITIVE, f64::MAX)?;
    checks::rounded("the plane's normal offset", plane.distance * rise / rest)
}

/// Returns the depth bias for a plane, in units of the stored depth toward the light: `E · (|∂z/∂u| +
/// |∂z/∂v|)` with the [`depth_gradient`] per texel, and for a disc the ellipse's part. It is the same at all
/// points of a plane, up to [`MIN_COSINE`].
///
/// # Errors
///
/// Returns the errors of [`normal_offset`].
pub fn receiver_plane_depth(
    fit: &SpotFit,
    reach: impl Into<FilterRadius>,
    point: DVec3,
    normal: Vec3,
) -> Result<f32, FitError> {
    let reach = reach.into().checked()?;
    let [u, v] = Plane::of(fit, point, normal)?.gradient(fit);
    checks::rounded("the plane's depth bias", reach.rise(u, v))
}

/// Returns the change of the stored depth of a plane through a world position (f64, metres) over one texel
/// along u and along v (∂z/∂u, ∂z/∂v). It is exact over any number of texels, because a perspective maps
/// planes to planes. The light's distance from the plane is at least [`MIN_COSINE`] of its distance from the
/// point.
///
/// # Errors
///
/// Returns the errors of [`normal_offset`].
pub fn depth_gradient(fit: &SpotFit, point: DVec3, normal: Vec3) -> Result<Vec2, FitError> {
    let [u, v] = Plane::of(fit, point, normal)?.gradient(fit);
    let rounded = |gradient| checks::rounded("the plane's depth gradient", gradient);
    Ok(Vec2::new(rounded(u)?, rounded(v)?))
}

/// Returns two steps of a map's stored depth: a constant one, and one to be multiplied by the depth.
fn steps(storage: DepthStorage, is_reversed: bool) -> (f64, f64) {
    let coarsest = f64::from(depth_step(storage, 1.0));
    match storage {
        // Floats in 1/2..1 have the coarsest step. Relative to the depth it is at most twice as large at 1/2
        // as at 1.
        DepthStorage::Float16 if is_reversed => (LEAST_FLOAT16, 2.0 * coarsest),
        DepthStorage::Float32 if is_reversed => (LEAST_FLOAT32, 2.0 * coarsest),
        _ => (coarsest, 0.0),
    }
}

/// Smallest 16-bit float: the step around 0.
const LEAST_FLOAT16: f64 = 1.0 / 16_777_216.0;

/// Smallest normal 32-bit float. GPUs may flush smaller ones to zero.
const LEAST_FLOAT32: f64 = f32::MIN_POSITIVE as f64;

/// A plane with the unit normal n on the light's side, in light axes and in texels.
pub(super) struct Plane {
    /// Texel sizes at 1 m times n·x and n·y: the height over the plane, in metres along n, that one texel
    /// along u, or against v, adds at 1 m along the axis.
    pub(super) u: f64,
    pub(super) v: f64,
    /// n·z, the cosine between n and the direction back along the light's axis. Negative for planes off the
    /// axis that face the light but not its axis.
    pub(super) along: f64,
    /// Sine of the angle between n and the axis.
    pub(super) sine: f64,
    /// Distance of the point along the axis, in metres: d.
    pub(super) distance: f64,
    /// Distance of the light from the plane, in metres: c, at least [`MIN_COSINE`] of its distance from the
    /// point.
    pub(super) height: f64,
}

impl Plane {
    /// Returns the plane through a world position, in metres, with a normal of any length on either side.
    /// Returns an error for positions that are not in front of the light.
    pub(super) fn of(fit: &SpotFit, point: DVec3, normal: Vec3) -> Result<Self, FitError> {
        let p = fit.project(checks::point("the point", point)?);
        let distance = checks::within("the point's distance along the light's axis", -p.z, MIN_LENGTH, MAX_LENGTH)?;
        let n = fit.turn(checks::unit("the surface normal", normal)?);
        let toward_light = -n.dot(p);
        let n = if toward_light < 0.0 { -n } else { n };
        let height = toward_light.abs().max(f64::from(MIN_COSINE) * checks::length(p));
        let (u, v) = (n.x * f64::from(fit.texel_size.x), n.y * f64::from(fit.texel_size.y));
        for share in [u, v, n.z, height] {
            checks::finite("the plane's slope in the map", share)?;
        }
        Ok(Self { u, v, along: n.z, sine: libm::sqrt(n.x * n.x + n.y * n.y), distance, height })
    }

    /// Returns the greatest rise of the plane within a filter's radius, per metre along the axis: s.
    pub(super) fn rise(&self, reach: FilterRadius) -> f64 {
        reach.rise(self.u, self.v)
    }

    /// Returns the distance along the axis of the point lifted along the normal, in metres.
    pub(super) fn lifted(&self, offset: f64) -> f64 {
        self.distance - offset * self.along
    }

    /// Returns the change of the stored depth over one texel along u and along v, which is constant on the
    /// plane.
    pub(super) fn gradient(&self, fit: &SpotFit) -> [f64; 2] {
        let sign = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
        let per_height = sign * fit.depth_scale() / self.height;
        [self.u * per_height, -self.v * per_height]
    }
}
