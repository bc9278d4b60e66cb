//! Biases against self-shadowing. All conversions from texels to depth and metres are here.
//!
//! A map stores one depth per texel, but a slanted plane has many. A bias covers the difference between the
//! texel's centre and the sampled point. It is proportional to the texel size, so it is set in texels and
//! converted here for each fit.
//!
//! # Bias of a plane
//!
//! Let n be the plane's unit normal on the light's side, x and y the map's axes in the world (the first two
//! rows of `light_from_world`), tx and ty the texel's sides and E the filter's [`FilterRadius`]. Lift a point
//! of the plane by h along n. No texel centre within the radius then stores a plane depth that is nearer to the
//! light than the lifted point, if and only if
//!
//! ```text
//!   h ≥ E · (tx·|n·x| + ty·|n·y|)  =  texel · E · sin θ · (|cos φ| + |sin φ|)  for square texels
//! ```
//!
//! with θ the angle between n and the light and φ the slope's azimuth in the map. Proof: relative to the
//! *lifted* point, the plane's point at a texel centre is (dx, dy, dz) with n·(dx, dy, dz) = -h. It is not
//! nearer to the light if dz ≤ 0, that is, if h ≥ -(dx n·x + dy n·y). Since |dx| ≤ E tx and |dy| ≤ E ty, the
//! right side is at most the bound above. As a depth bias, without moving the point, the same clearance is h
//! / cos θ: the receiver-plane form `E · (|∂z/∂u| + |∂z/∂v|)` with the plane's depth gradient per texel.
//!
//! All of this holds for the **geometric** normal of the stored surface. Interpolated normals and normal maps
//! give no guarantee.

mod classic;
pub(crate) mod depth_storage;
mod filter_radius;

use core::f32::consts::SQRT_2;

use glam::{DVec3, Vec2, Vec3, Vec4};

pub use self::classic::{ACOS_BIAS_LIMIT, XNA_DEPTH_BIAS, acos_bias, acos_epsilon};
pub use self::filter_radius::FilterRadius;
pub(crate) use self::filter_radius::{HARDWARE_SNAP, rounding};
use crate::base::{DepthConvention, FitError, checks};
use crate::bias::depth_storage::{DepthStorage, depth_step};
use crate::projection::LightProjection;
use crate::technique::settings::{BiasSettings, FilterKind, Softness};

/// Biases for a shader. With θ the angle between the geometric normal and the direction toward the light, a
/// receiver is looked up at `p + normal · normal_offset · sin θ`, and its depth is moved toward the light by
/// `constant_depth + slope_depth · tan θ + receiver_plane · (|∂z/∂u| + |∂z/∂v|)`.
///
/// cos θ is at least [`MIN_COSINE`], so that a grazing surface gets a finite bias.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Bias {
    /// Depth bias, in units of the stored depth (0..1 over the fit's depth range).
    pub constant_depth: f32,
    /// Depth bias to be multiplied by tan θ, in units of the stored depth.
    pub slope_depth: f32,
    /// Offset along the geometric normal to be multiplied by sin θ, in metres.
    pub normal_offset: f32,
    /// Depth bias to be multiplied by `|∂z/∂u| + |∂z/∂v|`, the [`depth_gradient`] of the receiver's plane per
    /// texel, in texels. If it is not 0, a filter compares each look-up with the plane's depth at that
    /// look-up's position.
    pub receiver_plane: f32,
}

/// The offset and depth of a [`Bias`] on a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlaneBias {
    /// Offset of the looked-up point along the normal that faces the light, in metres.
    pub offset: f32,
    /// Depth bias toward the light, in units of the stored depth.
    pub depth: f32,
}

/// Least cosine between normal and light (89.7°) for depth biases. Biases are constant below it, because such
/// a surface receives almost no light. Normal offsets need no such limit.
pub const MIN_COSINE: f32 = 0.005;

/// Constant bias of [`BiasSettings::automatic`], in texels: room for inexact surface normals.
/// [`BiasSettings::depth_steps`] covers the rounding of depths and positions, which is less in most maps.
const SPARE_TEXELS: f32 = 1.0 / 32.0;

/// Error of the square of a sine that a shader computes from an f32 cosine: four roundings of 2⁻²⁴.
pub(crate) const SQUARED_SINE_ROUNDING: f64 = 4.0 * checks::UNIT;

/// Greatest error of the sine itself, where the error is as large as the square: its root, 2⁻¹¹, rounded up.
const SINE_ROUNDING: f64 = 5e-4;

impl Bias {
    /// Converts biases in texels, and in depth steps, for one map. The depth storage may be given as the
    /// [`MapFormat`](crate::settings::MapFormat). Texels that are not square count with their longer side,
    /// the safe choice against acne. Settings that are not finite give biases that are not finite, which
    /// [`Self::checked`] rejects.
    ///
    /// A [`BiasSettings::depth_steps`] of 1 covers the rounding of stored depths and of f32 positions for any
    /// positions of the map and of the receivers' vertices. A constant bias that is greater than the rounding
    /// of positions covers it already, so only a smaller one is raised.
    pub fn from_texels(settings: &BiasSettings, storage: impl Into<DepthStorage>, fit: &LightProjection) -> Self {
        let texel = fit.texel_size.x.max(fit.texel_size.y);
        let rounding = settings.depth_steps * rounding(fit) as f32;
        let constant = settings.constant * texel;
        // The constant covers rounding up to its own size. A negative constant is a deliberate reduction and
        // is not changed.
        let constant = if (0.0..rounding).contains(&constant) { rounding } else { constant };
        let bias = Self {
            constant_depth: 0.0,
            slope_depth: settings.slope * texel / fit.depth_range,
            normal_offset: settings.normal_offset * texel,
            receiver_plane: settings.receiver_plane,
        };
        let constant_depth = constant / fit.depth_range + settings.depth_steps * depth_step(storage, 1.0);
        Self { constant_depth, ..bias.widened(rounding, fit) }
    }

    /// Returns this bias, enlarged by a rounding of positions in metres. Biases of 0 stay 0. A shift of a
    /// surface across the light changes its depth by the slope times the shift, so the other forms grow, too.
    pub(crate) fn widened(self, rounding: f32, fit: &LightProjection) -> Self {
        let more = |bias: f32, rounding: f32| if bias > 0.0 { bias + rounding } else { bias };
        Self {
            constant_depth: more(self.constant_depth, rounding / fit.depth_range),
            slope_depth: more(self.slope_depth, rounding / fit.depth_range),
            normal_offset: more(self.normal_offset, rounding),
            receiver_plane: more(self.receiver_plane, rounding / fit.texel_size.min_element()),
        }
    }

    /// Returns a fixed bias in units of the stored depth, independent of the slope: the classic form, such as
    /// [`XNA_DEPTH_BIAS`]. In metres it changes with the depth range of each fit. A negative bias moves the
    /// receiver away from the light, which maps of back faces may need.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`], and [`FitError::OutOfRange`] beyond the whole range of depths.
    pub fn fixed(depth: f32) -> Result<Self, FitError> {
        checks::within("the fixed depth bias", f64::from(depth), -1.0, 1.0)?;
        Ok(Self { constant_depth: depth, ..Self::default() })
    }

    /// Returns the least bias that prevents self-shadowing on a plane whose slope has any azimuth: a normal
    /// offset for the filter's radius [on hardware](FilterRadius::on_hardware) at the worst azimuth, `E ·
    /// √(tx² + ty²)`, and a constant for the [`depth_precision`] and for a sine that a shader computes from
    /// an f32 cosine. If a shader knows the azimuth, [`normal_offset`] needs up to √2 less. Geometric normals
    /// are assumed.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the radius, and for a fit with fields
    /// that are not finite.
    pub fn automatic(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &LightProjection,
    ) -> Result<Self, FitError> {
        let reach = reach.into().checked()?.on_hardware(fit);
        let (x, y) = (f64::from(fit.texel_size.x), f64::from(fit.texel_size.y));
        // Sum of the greatest terms of the box and of the ellipse over all azimuths. Their azimuths may
        // differ.
        let taps = f64::from(reach.taps) * libm::sqrt(x * x + y * y);
        let disc = (f64::from(reach.disc.x) * x).max(f64::from(reach.disc.y) * y);
        let sine = SINE_ROUNDING * (taps + disc) / f64::from(fit.depth_range);
        let bias = Self {
            constant_depth: depth_precision(fit, storage) + sine as f32,
            normal_offset: (taps + disc) as f32,
            ..Self::default()
        };
        bias.checked()
    }

    /// Returns a bias as [`Self::automatic`] does, but as depth bias alone, for shaders that do not offset
    /// the looked-up point: the receiver plane's gradient over the filter's radius on hardware. It prevents
    /// self-shadowing on planes whose normal has a cosine of at least [`MIN_COSINE`] with the light. It is
    /// very large near that limit.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Self::automatic`].
    pub fn automatic_receiver_plane(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &LightProjection,
    ) -> Result<Self, FitError> {
        let reach = reach.into().checked()?.on_hardware(fit);
        let constant_depth = depth_precision(fit, storage);
        Self { constant_depth, receiver_plane: reach.per_axis(), ..Self::default() }.checked()
    }

    /// Returns a bias as [`Self::automatic`] does, but as a constant depth alone, for shaders that can only
    /// subtract a constant. It covers a plane with the given geometric normal (world axes, any length, on the
    /// light's side), usually the ground, and all planes that face the light at least as directly. Other
    /// planes may shadow themselves. For the ground under a sun of elevation e it is about
    /// `√2 · E · texel · cot e` along the light.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Self::automatic`], and [`FitError::BadDirection`] for the normal.
    pub fn automatic_constant(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &LightProjection,
        normal: Vec3,
    ) -> Result<Self, FitError> {
        let cosine = Slope::of(fit, normal)?.cosine.max(f64::from(MIN_COSINE));
        let tangent = libm::sqrt((1.0 - cosine * cosine).max(0.0)) / cosine;
        let offset = Self::automatic(reach, storage, fit)?;
        let depth = f64::from(offset.normal_offset) * tangent / f64::from(fit.depth_range);
        Self { constant_depth: offset.constant_depth + depth as f32, ..Self::default() }.checked()
    }

    /// Returns the bias for maps that store only the back faces of closed casters. A lit surface is nearer to
    /// the light than the back faces behind it, so the bias only covers the [`depth_precision`].
    pub fn back_faces(storage: impl Into<DepthStorage>, fit: &LightProjection) -> Self {
        Self { constant_depth: depth_precision(fit, storage), ..Self::default() }
    }

    /// Returns the offset and depth of this bias on a plane with the given geometric normal (world axes, any
    /// length, on the light's side), as a shader computes it.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`] and [`FitError::BadDirection`] for the normal, and the former for a
    /// bias that is not finite.
    pub fn on_plane(&self, fit: &LightProjection, normal: Vec3) -> Result<PlaneBias, FitError> {
        let bias = self.checked()?;
        let plane = Slope::of(fit, normal)?;
        let cosine = plane.cosine.max(f64::from(MIN_COSINE));
        let sine = libm::sqrt((1.0 - cosine * cosine).max(0.0));
        let gradient = plane.gradient(fit);
        let depth = f64::from(bias.constant_depth)
            + f64::from(bias.slope_depth) * sine / cosine
            + f64::from(bias.receiver_plane) * (gradient[0].abs() + gradient[1].abs());
        let offset = f64::from(bias.normal_offset) * sine;
        Ok(PlaneBias {
            offset: checks::rounded("the offset on a plane", offset)?,
            depth: checks::rounded("the depth bias on a plane", depth)?,
        })
    }

    /// Returns this bias if all its numbers are finite. Call it after [`Self::from_texels`] for settings from
    /// outside.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] with the first number that is not finite.
    pub fn checked(self) -> Result<Self, FitError> {
        let Self { constant_depth, slope_depth, normal_offset, receiver_plane } = self;
        for (input, value) in [
            ("the constant depth bias", constant_depth),
            ("the slope-scaled depth bias", slope_depth),
            ("the normal offset", normal_offset),
            ("the receiver-plane bias", receiver_plane),
        ] {
            checks::finite(input, f64::from(value))?;
        }
        Ok(self)
    }
}

impl BiasSettings {
    /// Returns biases that prevent self-shadowing on planes for a filter, in any map. Geometric normals are
    /// assumed.
    ///
    /// It uses the receiver-plane form, which only has to cover the radius of one comparison, so a wider disc
    /// of a soft filter needs no more. Compared with ray tracing, for [`FilterKind::Pcf5x5`], it leaves a
    /// tenth (fine texels) to two fifths (coarse texels) of the wrong pixels that the [normal
    /// offset](Self::automatic_normal_offset) leaves.
    pub fn automatic(filter: FilterKind) -> Self {
        let one_comparison = if filter == FilterKind::Point { FilterRadius::POINT } else { FilterRadius::HARDWARE_2X2 };
        Self {
            constant: SPARE_TEXELS,
            slope: 0.0,
            normal_offset: 0.0,
            receiver_plane: one_comparison.taps + HARDWARE_SNAP,
            depth_steps: 1.0,
        }
    }

    /// Returns biases as [`Self::automatic`] does, but as an offset along the normal over the filter's whole
    /// radius in any map, for shaders without a receiver-plane bias. For a [soft](FilterKind::is_soft) filter
    /// this is the [ceiling](Softness::ceiling) of its disc, a large offset.
    pub fn automatic_normal_offset(filter: FilterKind, softness: &Softness) -> Self {
        Self {
            constant: SPARE_TEXELS,
            slope: 0.0,
            normal_offset: automatic_normal_offset(softness.filter_radius(filter)),
            receiver_plane: 0.0,
            depth_steps: 1.0,
        }
    }
}

impl BiasSettings {
    /// Returns biases as [`Self::automatic_normal_offset`] does, but as a constant alone, for shaders that can
    /// only subtract a constant. It covers level ground under a sun of this elevation, in radians, and all
    /// planes that face the light at least as directly. Other planes may shadow themselves.
    /// [`Bias::automatic_constant`] computes the bias of one map.
    pub fn automatic_constant(filter: FilterKind, softness: &Softness, elevation: f32) -> Self {
        let sine = libm::sinf(elevation).clamp(MIN_COSINE, 1.0);
        let tangent = libm::sqrtf(1.0 - sine * sine) / sine;
        let offset = automatic_normal_offset(softness.filter_radius(filter) + HARDWARE_SNAP);
        Self { constant: SPARE_TEXELS + offset * tangent, ..Self::back_faces() }
    }

    /// Returns biases for maps that store only the back faces of closed casters. A lit surface is nearer to
    /// the light than the back faces behind it, so the biases only cover rounding.
    pub const fn back_faces() -> Self {
        Self { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 1.0 }
    }
}

/// Returns the normal offset for a plane, in metres along its normal on the light's side (including sin θ):
/// `E · (tx·|n·x| + ty·|n·y|)`, and for a disc the ellipse's part, `√((rx tx n·x)² + (ry ty n·y)²)`. The
/// [module](self) derives it.
///
/// `normal` is the geometric one, in world axes, of any length and on either side. The offset is the least
/// one in exact arithmetic. [`FilterRadius::on_hardware`] and [`depth_precision`] add the needs of a GPU.
///
/// # Errors
///
/// Returns [`FitError::NotFinite`], [`FitError::OutOfRange`] for the filter radius, and
/// [`FitError::BadDirection`] for the normal.
pub fn normal_offset(fit: &LightProjection, reach: impl Into<FilterRadius>, normal: Vec3) -> Result<f32, FitError> {
    let reach = reach.into().checked()?;
    let plane = Slope::of(fit, normal)?;
    checks::rounded("the plane's normal offset", reach.rise(plane.u, plane.v))
}

/// Returns the depth bias for a plane, in units of the stored depth toward the light: `E · (|∂z/∂u| +
/// |∂z/∂v|)` with the [`depth_gradient`] per texel, and for a disc the ellipse's part. It is
/// [`normal_offset`] / cos θ in units of depth, with cos θ at least [`MIN_COSINE`].
///
/// # Errors
///
/// Returns the errors of [`normal_offset`].
pub fn receiver_plane_depth(
    fit: &LightProjection,
    reach: impl Into<FilterRadius>,
    normal: Vec3,
) -> Result<f32, FitError> {
    let reach = reach.into().checked()?;
    let [u, v] = Slope::of(fit, normal)?.gradient(fit);
    checks::rounded("the plane's depth bias", reach.rise(u, v))
}

/// Returns the change of the stored depth of a plane over one texel along u and along v (∂z/∂u, ∂z/∂v), with
/// cos θ at least [`MIN_COSINE`]. A filter can add `gradient · (look-up - centre)`, in texels, to the
/// compared depth of each look-up around its centre. Each look-up is then compared with the plane's depth at
/// its own position, so the bias only has to cover the radius of one look-up, [`FilterRadius::POINT`] or
/// [`FilterRadius::HARDWARE_2X2`].
///
/// # Errors
///
/// Returns the errors of [`normal_offset`].
pub fn depth_gradient(fit: &LightProjection, normal: Vec3) -> Result<Vec2, FitError> {
    let [u, v] = Slope::of(fit, normal)?.gradient(fit);
    let rounded = |gradient| checks::rounded("the plane's depth gradient", gradient);
    Ok(Vec2::new(rounded(u)?, rounded(v)?))
}

/// Returns the depth bias that covers rounding, in units of the stored depth: the greatest f32 error between
/// the stored and the compared depth of a point, for positions relative to the map's origin, plus the
/// coarsest step of the format (half for storing a depth, half because hardware may round the compared depth
/// too).
pub fn depth_precision(fit: &LightProjection, storage: impl Into<DepthStorage>) -> f32 {
    (rounding(fit) / f64::from(fit.depth_range)) as f32 + depth_step(storage, 1.0)
}

/// Returns the normal offset, in texels and to be multiplied by sin θ, that prevents self-shadowing on a
/// plane whose slope has any azimuth. It is the greatest value of `E · (|cos φ| + |sin φ|)`, reached at the
/// map's diagonal: `√2 · E`. Square texels are assumed. [`normal_offset`] accepts any texels.
pub const fn automatic_normal_offset(reach: f32) -> f32 {
    SQRT_2 * reach
}

/// A plane's slope, measured in the map's texels.
pub(crate) struct Slope {
    /// Component of one texel's side, along the map's x (u) and y (against v), along the normal on the
    /// light's side, in metres.
    pub(crate) u: f64,
    pub(crate) v: f64,
    /// Cosine of the angle between that normal and the direction toward the light: 0..=1.
    pub(crate) cosine: f64,
}

impl Slope {
    pub(crate) fn of(fit: &LightProjection, normal: Vec3) -> Result<Self, FitError> {
        let normal = checks::unit("the surface normal", normal)?;
        let along = |row: fn(Vec4) -> f32| {
            let m = &fit.light_from_world;
            let axis = [m.x_axis, m.y_axis, m.z_axis].map(|column| f64::from(row(column)));
            DVec3::from_array(axis).dot(normal)
        };
        let (x, y, z) = (along(|c| c.x), along(|c| c.y), along(|c| c.z));
        let side = if z < 0.0 { -1.0 } else { 1.0 };
        let (u, v) = (side * x * f64::from(fit.texel_size.x), side * y * f64::from(fit.texel_size.y));
        for share in [u, v, z] {
            checks::finite("the plane's slope in the fit", share)?;
        }
        Ok(Self { u, v, cosine: z.abs().min(1.0) })
    }

    /// Returns the change of the stored depth over one texel along u and v. Height falls by n·x / n·z along
    /// x, and v points against y.
    pub(crate) fn gradient(&self, fit: &LightProjection) -> [f64; 2] {
        let sign = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
        let per_metre = sign / (self.cosine.max(f64::from(MIN_COSINE)) * f64::from(fit.depth_range));
        [self.u * per_metre, -self.v * per_metre]
    }
}
