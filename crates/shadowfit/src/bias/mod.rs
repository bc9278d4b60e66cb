//! Biases against self-shadowing: the one place that turns texels into depth and metres.
//!
//! A map stores one depth per texel, but a slanted plane has many. A bias covers the difference
//! between the texel's centre and the sampled point; it is proportional to the texel, so it is
//! set in texels and converted here for each fit.
//!
//! # What a plane needs
//!
//! Let n be the plane's unit normal on the light's side, x and y the map's axes in the world (the
//! first two rows of `light_from_world`), tx and ty the texel's sides and E the filter's
//! [`FilterRadius`]. A point lifted by h along n has no texel centre in reach whose stored plane depth is
//! nearer to the light exactly when
//!
//! ```text
//!   h ≥ E · (tx·|n·x| + ty·|n·y|)  =  texel · E · sin θ · (|cos φ| + |sin φ|)  for square texels
//! ```
//!
//! with θ the angle between n and the light, φ the slope's azimuth in the map. Proof: a texel
//! centre (dx, dy) beside the *lifted* point lies on the plane at a height dz over it with
//! n·(dx, dy, dz) = -h, so dz ≤ 0 means h ≥ -(dx n·x + dy n·y), and |dx| ≤ E tx, |dy| ≤ E ty.
//! The same clearance as depth, without moving the point, is h / cos θ: the receiver-plane form
//! `E · (|∂z/∂u| + |∂z/∂v|)` with the plane's depth gradient per texel.
//!
//! All of this holds for the **geometric** normal of the surface that is stored. With normals that
//! are interpolated or come from a normal map nothing is guaranteed.

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

/// Biases ready for a shader. With θ the angle between the geometric normal and the direction
/// toward the light, a receiver is looked up at `p + normal · normal_offset · sin θ`, and its
/// depth is moved toward the light by
/// `constant_depth + slope_depth · tan θ + receiver_plane · (|∂z/∂u| + |∂z/∂v|)`.
///
/// cos θ is held at [`MIN_COSINE`] or above, so that a grazing surface gets a finite bias.
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
    /// Depth bias to be multiplied by `|∂z/∂u| + |∂z/∂v|`, the [`depth_gradient`] of the
    /// receiver's plane per texel: in texels. Where it is not 0, each comparison of a filter is made
    /// with the plane's own depth where it reads.
    pub receiver_plane: f32,
}

/// The offset and depth that a [`Bias`] gives on a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlaneBias {
    /// Offset of the looked-up point along the normal that faces the light, in metres.
    pub offset: f32,
    /// How far its depth is moved toward the light, in units of the stored depth.
    pub depth: f32,
}

/// Below this cosine between normal and light (89.7°) a depth bias grows no more: such a surface
/// receives next to no light. Normal offsets need no such limit.
pub const MIN_COSINE: f32 = 0.005;

/// Constant bias of [`BiasSettings::automatic`], in texels: room for inexact surface normals.
/// The rounding of depths and positions, which is less in most maps, is covered by [`BiasSettings::depth_steps`].
const SPARE_TEXELS: f32 = 1.0 / 32.0;

/// Error of the square of a sine that a shader computes from an f32 cosine: four roundings of 2⁻²⁴.
pub(crate) const SQUARED_SINE_ROUNDING: f64 = 4.0 * checks::UNIT;

/// Greatest error of the sine itself, reached where that error is as large as the square: its root,
/// 2⁻¹¹, rounded up.
const SINE_ROUNDING: f64 = 5e-4;

impl Bias {
    /// Converts biases in texels for one fit, and those in steps of how its map stores depths, which may be given as
    /// the [`MapFormat`](crate::settings::MapFormat). Texels that are not square count with their longer
    /// side, which is conservative against acne. Settings that are not finite give biases that are
    /// not finite; [`Self::checked`] refuses those.
    ///
    /// [`BiasSettings::depth_steps`] of 1 covers the rounding of stored depths and of f32 positions wherever the map
    /// and the receivers' vertices are. Up to its size, the constant in texels covers the rounding of positions too.
    pub fn from_texels(settings: &BiasSettings, storage: impl Into<DepthStorage>, fit: &LightProjection) -> Self {
        let texel = fit.texel_size.x.max(fit.texel_size.y);
        let rounding = settings.depth_steps * rounding(fit) as f32;
        let constant = settings.constant * texel;
        // The constant covers rounding up to its own size. A negative one asks for less than that, and stays.
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

    /// Returns this bias with room for more rounding of positions, in metres. Biases of 0 stay 0. A shift of a surface
    /// across the light changes its depth by the slope times the shift, so the other forms grow, too.
    pub(crate) fn widened(self, rounding: f32, fit: &LightProjection) -> Self {
        let more = |bias: f32, rounding: f32| if bias > 0.0 { bias + rounding } else { bias };
        Self {
            constant_depth: more(self.constant_depth, rounding / fit.depth_range),
            slope_depth: more(self.slope_depth, rounding / fit.depth_range),
            normal_offset: more(self.normal_offset, rounding),
            receiver_plane: more(self.receiver_plane, rounding / fit.texel_size.min_element()),
        }
    }

    /// A fixed number of the stored depth, independent of the slope: the classic form, such as
    /// [`XNA_DEPTH_BIAS`]. In metres it changes with the depth range of each fit. A negative one
    /// moves the receiver away from the light, as maps of back faces may want it.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`], and [`FitError::OutOfRange`] beyond the whole range of depths.
    pub fn fixed(depth: f32) -> Result<Self, FitError> {
        checks::within("the fixed depth bias", f64::from(depth), -1.0, 1.0)?;
        Ok(Self { constant_depth: depth, ..Self::default() })
    }

    /// The least bias that clears self-shadowing on a plane whose slope has any azimuth: a normal
    /// offset for the filter's reach [on hardware](FilterRadius::on_hardware), at the worst azimuth `E ·
    /// √(tx² + ty²)`, and a constant for the [`depth_precision`] and for a sine that a shader takes
    /// from an f32 cosine. Where a shader knows the azimuth, [`normal_offset`] needs up to √2 less.
    /// Geometric normals are assumed.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the reach, or for a fit that was
    /// filled by hand with what is not finite.
    pub fn automatic(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &LightProjection,
    ) -> Result<Self, FitError> {
        let reach = reach.into().checked()?.on_hardware(fit);
        let (x, y) = (f64::from(fit.texel_size.x), f64::from(fit.texel_size.y));
        // Greatest over all azimuths of the box's part and of the ellipse's, which may differ.
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

    /// As [`Self::automatic`], by depth bias alone, for shaders that do not offset the looked-up
    /// point: the receiver plane's gradient over the filter's reach on hardware. It clears planes
    /// up to [`MIN_COSINE`], and grows without bound toward it.
    ///
    /// # Errors
    ///
    /// As [`Self::automatic`].
    pub fn automatic_receiver_plane(
        reach: impl Into<FilterRadius>,
        storage: impl Into<DepthStorage>,
        fit: &LightProjection,
    ) -> Result<Self, FitError> {
        let reach = reach.into().checked()?.on_hardware(fit);
        let constant_depth = depth_precision(fit, storage);
        Self { constant_depth, receiver_plane: reach.per_axis(), ..Self::default() }.checked()
    }

    /// The offset and depth that this bias gives on a plane with the given geometric normal (world
    /// axes, any length, turned toward the light), as a shader computes it.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::BadDirection`] for the normal, and the former for a
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

    /// Returns this bias if all its numbers are finite. Use it after [`Self::from_texels`] when the
    /// settings come from outside.
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
    /// Biases that clear self-shadowing on planes for a filter, in any map. Geometric normals are assumed.
    ///
    /// It is the receiver-plane form, which needs to cover only the reach of one comparison, so that a wider disc of
    /// a soft filter needs no more. Compared
    /// with ray tracing, with [`FilterKind::Pcf5x5`], it leaves a tenth (fine texels) to two fifths
    /// (coarse ones) of the wrong pixels that the [normal offset](Self::automatic_normal_offset)
    /// leaves.
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

    /// As [`Self::automatic`], by an offset along the normal over the filter's whole reach in any map, for
    /// shaders without a receiver-plane bias: of a [soft](FilterKind::is_soft) filter over the
    /// [ceiling](Softness::ceiling) of its disc, which is far.
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

/// Normal offset that a plane needs, in metres along its normal on the light's side (sin θ is
/// in it): `E · (tx·|n·x| + ty·|n·y|)`, and for a disc the ellipse's own part,
/// `√((rx tx n·x)² + (ry ty n·y)²)`, as the [module](self) derives it.
///
/// `normal` is the geometric one, in world axes, of any length and on either side. It is the least
/// offset in exact arithmetic; [`FilterRadius::on_hardware`] and [`depth_precision`] add what a GPU needs.
///
/// # Errors
///
/// [`FitError::NotFinite`], [`FitError::OutOfRange`] for the reach and [`FitError::BadDirection`]
/// for the normal.
pub fn normal_offset(fit: &LightProjection, reach: impl Into<FilterRadius>, normal: Vec3) -> Result<f32, FitError> {
    let reach = reach.into().checked()?;
    let plane = Slope::of(fit, normal)?;
    checks::rounded("the plane's normal offset", reach.rise(plane.u, plane.v))
}

/// Depth bias that a plane needs, in units of the stored depth toward the light:
/// `E · (|∂z/∂u| + |∂z/∂v|)` with the [`depth_gradient`] per texel, and for a disc the ellipse's
/// own part. It is [`normal_offset`] / cos θ in units of depth, with cos θ held at [`MIN_COSINE`].
///
/// # Errors
///
/// As [`normal_offset`].
pub fn receiver_plane_depth(
    fit: &LightProjection,
    reach: impl Into<FilterRadius>,
    normal: Vec3,
) -> Result<f32, FitError> {
    let reach = reach.into().checked()?;
    let [u, v] = Slope::of(fit, normal)?.gradient(fit);
    checks::rounded("the plane's depth bias", reach.rise(u, v))
}

/// Change of the stored depth of a plane over one texel along u and along v (∂z/∂u, ∂z/∂v), with
/// cos θ held at [`MIN_COSINE`]. A filter that adds `gradient · (tap - centre)`, in texels, to the
/// depth that each tap is compared with compares with the plane's own depth there, so the bias only
/// has to cover the reach of one look-up, [`FilterRadius::POINT`] or [`FilterRadius::HARDWARE_2X2`].
///
/// # Errors
///
/// As [`normal_offset`].
pub fn depth_gradient(fit: &LightProjection, normal: Vec3) -> Result<Vec2, FitError> {
    let [u, v] = Slope::of(fit, normal)?.gradient(fit);
    let rounded = |gradient| checks::rounded("the plane's depth gradient", gradient);
    Ok(Vec2::new(rounded(u)?, rounded(v)?))
}

/// Depth bias that covers rounding, in units of the stored depth: the greatest difference that f32
/// can make between the stored and the compared depth of one point at this fit's origin, and one
/// step of the format where it is coarsest (half for storing a depth, half where hardware rounds
/// the compared one too).
pub fn depth_precision(fit: &LightProjection, storage: impl Into<DepthStorage>) -> f32 {
    (rounding(fit) / f64::from(fit.depth_range)) as f32 + depth_step(storage, 1.0)
}

/// Normal offset, in texels and to be multiplied by sin θ, that clears self-shadowing on a plane whose slope has any
/// azimuth: `E · (|cos φ| + |sin φ|)` at its worst, the map's diagonal, which is `√2 · E`. Square texels are assumed;
/// [`normal_offset`] takes any.
pub const fn automatic_normal_offset(reach: f32) -> f32 {
    SQRT_2 * reach
}

/// A plane measured in the map's texels.
pub(crate) struct Slope {
    /// Share of one texel's side, along the map's x (u) and y (against v), that lies along the
    /// normal on the light's side, in metres.
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

    /// Change of the stored depth over one texel along u and v: height falls by n·x / n·z along
    /// x, and v runs against y.
    pub(crate) fn gradient(&self, fit: &LightProjection) -> [f64; 2] {
        let sign = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
        let per_metre = sign / (self.cosine.max(f64::from(MIN_COSINE)) * f64::from(fit.depth_range));
        [self.u * per_metre, -self.v * per_metre]
    }
}
