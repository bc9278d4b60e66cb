//! The filters that read a map: the radius of each, and the width of soft filters, which is set in metres or
//! by the sun's angle instead of in texels.
//!
//! A penumbra has the same width across the light in all maps, so its width in texels differs by map and
//! axis. A least radius keeps it within the precision of a map, and a greatest radius keeps it within the
//! cost that a shader can afford.

use crate::base::{FitError, checks};
use crate::technique::setters::setters;

/// Filter that turns the stored depths into a shadow factor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FilterKind {
    /// One comparison with the nearest texel.
    Point,
    /// Four comparisons, weighted bilinearly (the hardware's 2×2 percentage-closer filter).
    Hardware2x2,
    /// Tent of 3×3 hardware look-ups (16 texels), made of four look-ups.
    Pcf3x3,
    /// Tent of 5×5 hardware look-ups (36 texels), made of nine look-ups. The default.
    #[default]
    Pcf5x5,
    /// Tent of 7×7 hardware look-ups (64 texels), made of sixteen look-ups.
    Pcf7x7,
    /// 8 hardware look-ups, spread evenly over a disc and rotated from pixel to pixel (H. Vogel, "A better
    /// way to construct the sunflower head", 1979). The technique's [softness](Softness) sets the disc's
    /// radius.
    Vogel8,
    /// Like [`Self::Vogel8`], with 16 look-ups.
    Vogel16,
    /// Like [`Self::Vogel8`], with 32 look-ups.
    Vogel32,
    /// Disc as wide as the penumbra, computed from the sun's angle and the mean distance to the casters above
    /// the point (percentage-closer soft shadows: R. Fernando, 2005). It needs the distances of casters, so
    /// maps cannot be depth-clamped.
    Pcss,
}

impl FilterKind {
    /// All filters, narrowest first.
    pub const ALL: [Self; 9] = [
        Self::Point,
        Self::Hardware2x2,
        Self::Pcf3x3,
        Self::Pcf5x5,
        Self::Pcf7x7,
        Self::Vogel8,
        Self::Vogel16,
        Self::Vogel32,
        Self::Pcss,
    ];

    /// Returns whether the filter's width is the technique's [softness](Softness) instead of a number of
    /// texels.
    pub const fn is_soft(self) -> bool {
        matches!(self, Self::Vogel8 | Self::Vogel16 | Self::Vogel32 | Self::Pcss)
    }

    /// Returns the filter radius E: the greatest distance along one axis from the looked-up point to a texel
    /// centre of non-zero weight, in texels. For a [soft](Self::is_soft) filter it is the radius of a single
    /// look-up. The look-ups are spread over the disc of [`Softness`](crate::settings::Softness), and
    /// [`Technique::filter_radius`](crate::Technique::filter_radius) includes both.
    pub const fn filter_radius(self) -> f32 {
        match self {
            Self::Point => 0.5,
            Self::Hardware2x2 | Self::Vogel8 | Self::Vogel16 | Self::Vogel32 | Self::Pcss => 1.0,
            Self::Pcf3x3 => 2.0,
            Self::Pcf5x5 => 3.0,
            Self::Pcf7x7 => 4.0,
        }
    }
}

/// Width of soft filters, which is set in metres or by the sun's angle instead of in texels
/// ([`FilterKind::is_soft`]).
///
/// The width across the light is the same for all maps. Penumbrae therefore match where two maps meet, and do
/// not change when a fit changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Softness {
    /// Quantity that sets the width. Default: the angle of the sun as seen from the earth.
    pub radius: SoftRadius,
    /// Least radius of a filter, in texels, 0..=64. A penumbra that is finer than a map can show gets this
    /// radius. Default: 1.
    pub floor: f32,
    /// Greatest radius of a filter, in texels, 1..=64. Texels are made wide enough
    /// ([`Technique::least_texel`](crate::Technique::least_texel)) that no map needs a larger filter.
    /// Default: 16.
    pub ceiling: f32,
}

/// Quantity that sets the width of a [soft filter](Softness).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SoftRadius {
    /// Radius of the penumbra across the light, in metres, of a shadow [5
    /// m](crate::settings::Softness::USUAL_DISTANCE) from its caster. [`FilterKind::Pcss`] scales it with the
    /// distance.
    Metres(f32),
    /// Angular radius of the sun, in radians.
    SunAngle(f32),
}

/// Angular radius of the sun as seen from the earth, in radians: half of 0.533°.
const SUN_RADIUS: f32 = 0.004_65;

impl Default for SoftRadius {
    fn default() -> Self {
        Self::SunAngle(SUN_RADIUS)
    }
}

impl Default for Softness {
    fn default() -> Self {
        Self { radius: SoftRadius::default(), floor: 1.0, ceiling: 16.0 }
    }
}

setters!(Softness {
    with_radius radius: SoftRadius,
    with_floor floor: f32,
    with_ceiling ceiling: f32,
});

/// Distance from a caster to its shadow, in metres, beyond which [`FilterKind::Pcss`] widens penumbrae no
/// further.
const GREATEST_DISTANCE: f32 = 20.0;

impl Softness {
    /// Assumed distance from a caster to its shadow, in metres: soft filters of fixed width get the penumbra
    /// at this distance. It suits the shadows of people and cars.
    pub const USUAL_DISTANCE: f32 = 5.0;

    /// Greatest value of [`Self::floor`] and [`Self::ceiling`], in texels.
    pub const MAX_RADIUS: f32 = 64.0;

    /// Square of the radius of the disc that blurs like one look-up of four bilinear comparisons, in square
    /// texels. A step that is rasterised into texels and compared bilinearly becomes a tent two texels wide,
    /// with variance 1/6 along an axis. A disc of radius r has variance r² / 4.
    pub const LOOK_UP_SQUARE: f32 = 4.0 / 6.0;

    /// Returns the greatest radius of a penumbra across the light, in metres; 0 for filters that are not
    /// soft. It is the penumbra of a shadow [`Self::USUAL_DISTANCE`] from its caster, or 20 m from it for
    /// [`FilterKind::Pcss`].
    pub fn metres(&self, filter: FilterKind) -> f32 {
        if !filter.is_soft() {
            return 0.0;
        }
        let distance = if filter == FilterKind::Pcss { GREATEST_DISTANCE } else { Self::USUAL_DISTANCE };
        self.tangent() * distance
    }

    /// Returns the radius of a penumbra across the light, in metres, per metre between caster and shadow: the
    /// tangent of the sun's angular radius.
    pub fn tangent(&self) -> f32 {
        match self.radius {
            SoftRadius::Metres(metres) => metres / Self::USUAL_DISTANCE,
            SoftRadius::SunAngle(radians) => libm::tanf(radians),
        }
    }

    /// Returns the greatest filter radius in any map, in texels: the [radius of one
    /// look-up](FilterKind::filter_radius), and for soft filters also the [ceiling](Self::ceiling) of their
    /// disc.
    pub const fn filter_radius(&self, filter: FilterKind) -> f32 {
        filter.filter_radius() + if filter.is_soft() { self.ceiling } else { 0.0 }
    }

    /// Returns the least texel width, in metres, at which a filter needs no larger radius than the
    /// [ceiling](Self::ceiling); 0 for filters that are not soft.
    pub fn least_texel(&self, filter: FilterKind) -> f32 {
        self.metres(filter) / self.ceiling
    }

    /// Refuses numbers that are not finite or out of range.
    pub(crate) fn checked(&self) -> Result<(), FitError> {
        match self.radius {
            SoftRadius::Metres(metres) => {
                checks::within("the softness in metres", f64::from(metres), 0.0, 1000.0)?;
            }
            SoftRadius::SunAngle(radians) => {
                checks::within("the sun's angular radius", f64::from(radians), 0.0, core::f64::consts::FRAC_PI_4)?;
            }
        }
        let ceiling = f64::from(self.ceiling);
        let ceiling = checks::within("the greatest radius of the filter", ceiling, 1.0, f64::from(Self::MAX_RADIUS))?;
        checks::within("the least radius of the filter", f64::from(self.floor), 0.0, ceiling)?;
        Ok(())
    }
}
