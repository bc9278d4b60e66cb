//! The filters that read a map: how far each reaches, and how wide those are whose width is no number of texels.
//!
//! A penumbra is as wide across the light in all maps, so its width in texels differs from map to map and
//! from axis to axis. A floor and a ceiling in texels keep it within what a map can show and a shader can pay for.

use crate::base::{FitError, checks};
use crate::technique::setters::setters;

/// How the stored depths are turned into a shadow factor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FilterKind {
    /// One comparison with the nearest texel.
    Point,
    /// Four comparisons, weighted bilinearly (the hardware's 2×2 percentage-closer filter).
    Hardware2x2,
    /// Tent of 3×3 hardware look-ups (16 texels), by four of them.
    Pcf3x3,
    /// Tent of 5×5 hardware look-ups (36 texels), by nine of them. The default.
    #[default]
    Pcf5x5,
    /// Tent of 7×7 hardware look-ups (64 texels), by sixteen of them.
    Pcf7x7,
    /// 8 hardware look-ups spread evenly over a disc of the technique's [softness](Softness), turned from
    /// pixel to pixel (H. Vogel, "A better way to construct the sunflower head", 1979).
    Vogel8,
    /// The same with 16 look-ups.
    Vogel16,
    /// The same with 32 look-ups.
    Vogel32,
    /// A disc as wide as the penumbra of the casters above the point, by the angle of the sun
    /// (percentage-closer soft shadows: R. Fernando, 2005). It needs the distance to the caster, so
    /// maps cannot be depth-clamped.
    Pcss,
}

impl FilterKind {
    /// All filters, the narrowest first.
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

    /// Whether its width is the technique's [softness](Softness), and not a number of texels.
    pub const fn is_soft(self) -> bool {
        matches!(self, Self::Vogel8 | Self::Vogel16 | Self::Vogel32 | Self::Pcss)
    }

    /// Filter radius E of the filter: the greatest distance along one axis from the sampled point to a texel
    /// centre of non-zero weight, in texels. Of a [soft](Self::is_soft) filter it is that of one of its look-ups: the
    /// disc over which they are spread is [`Softness`](crate::settings::Softness)'s, and
    /// [`Technique::filter_radius`](crate::Technique::filter_radius) has both.
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

/// How wide the filters are whose width is no number of texels ([`FilterKind::is_soft`]).
///
/// It is the same across the light for all maps, so that penumbrae agree where one map meets the
/// next, and stay when a fit changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Softness {
    /// What the width follows from. Default: the angle of the sun as seen from the earth.
    pub radius: SoftRadius,
    /// Least radius of a filter, in texels, 0..=64: a finer penumbra than a map can show is made this wide.
    /// Default: 1.
    pub floor: f32,
    /// Greatest radius of a filter, in texels, 1..=64. Maps have no finer texels than this allows
    /// ([`Technique::least_texel`](crate::Technique::least_texel)), so that no map needs a huge filter.
    /// Default: 16.
    pub ceiling: f32,
}

/// What the width of a [soft filter](Softness) follows from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SoftRadius {
    /// Radius of the penumbra across the light, in metres, of a shadow
    /// [5 m](crate::settings::Softness::USUAL_DISTANCE) from its caster; [`FilterKind::Pcss`] scales it with the distance.
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

/// Distance from a caster to its shadow up to which [`FilterKind::Pcss`] widens penumbrae, in metres: from there
/// on they stay as they are.
const GREATEST_DISTANCE: f32 = 20.0;

impl Softness {
    /// Distance from a caster to the shadow that a filter of fixed width is right for, in metres, where the
    /// width is given as the sun's angle: people and cars are about as high.
    pub const USUAL_DISTANCE: f32 = 5.0;

    /// Greatest radius of a filter, in texels, that [`Self::floor`] and [`Self::ceiling`] may have.
    pub const MAX_RADIUS: f32 = 64.0;

    /// Square of the radius of the disc that blurs as much as one look-up of four bilinear comparisons, in square
    /// texels. A step that is rasterised into texels and compared bilinearly becomes a tent two texels wide, whose
    /// variance along an axis is 1/6; that of a disc of radius r is r² / 4.
    pub const LOOK_UP_SQUARE: f32 = 4.0 / 6.0;

    /// Greatest radius of a penumbra across the light, in metres; 0 for filters that are not soft. It is that of a
    /// shadow [`Self::USUAL_DISTANCE`] from its caster, and for [`FilterKind::Pcss`] 20 m from it.
    pub fn metres(&self, filter: FilterKind) -> f32 {
        if !filter.is_soft() {
            return 0.0;
        }
        let distance = if filter == FilterKind::Pcss { GREATEST_DISTANCE } else { Self::USUAL_DISTANCE };
        self.tangent() * distance
    }

    /// Radius of a penumbra across the light, in metres, per metre between caster and shadow: the tangent of the
    /// sun's angular radius.
    pub fn tangent(&self) -> f32 {
        match self.radius {
            SoftRadius::Metres(metres) => metres / Self::USUAL_DISTANCE,
            SoftRadius::SunAngle(radians) => libm::tanf(radians),
        }
    }

    /// Greatest reach of a filter per axis, in texels, in any map: the [look-up's](FilterKind::filter_radius), and for
    /// soft filters the [ceiling](Self::ceiling) of their disc.
    pub const fn filter_radius(&self, filter: FilterKind) -> f32 {
        filter.filter_radius() + if filter.is_soft() { self.ceiling } else { 0.0 }
    }

    /// Least width of a texel, in metres, with which a filter needs no larger radius than the
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
