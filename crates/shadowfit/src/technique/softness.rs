//! The width of soft filters: from metres or the sun's angle to texels of a map.
//!
//! A penumbra is as wide across the light in all maps, so its width in texels differs from map to map and
//! from axis to axis. A floor and a ceiling in texels keep it within what a map can show and a shader can pay for.

use crate::base::{FitError, checks};
use crate::technique::settings::{FilterKind, SoftRadius, Softness};

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
        let distance = match filter {
            FilterKind::Vogel8 | FilterKind::Vogel16 | FilterKind::Vogel32 => Self::USUAL_DISTANCE,
            FilterKind::Pcss => GREATEST_DISTANCE,
            FilterKind::Point
            | FilterKind::Hardware2x2
            | FilterKind::Pcf3x3
            | FilterKind::Pcf5x5
            | FilterKind::Pcf7x7 => return 0.0,
        };
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

    /// Greatest reach of a filter per axis, in texels, in any map: the [look-up's](FilterKind::reach), and for soft filters the
    /// [ceiling](Self::ceiling) of their disc.
    pub const fn reach(&self, filter: FilterKind) -> f32 {
        filter.reach() + if filter.is_soft() { self.ceiling } else { 0.0 }
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

impl FilterKind {
    /// Reach E of the filter: the greatest distance along one axis from the sampled point to a texel
    /// centre of non-zero weight, in texels. Of a [soft](Self::is_soft) filter it is that of one of its look-ups: the
    /// disc over which they are spread is [`Softness`](crate::settings::Softness)'s, and
    /// [`Technique::reach`](crate::Technique::reach) has both.
    pub const fn reach(self) -> f32 {
        match self {
            Self::Point => 0.5,
            Self::Hardware2x2 | Self::Vogel8 | Self::Vogel16 | Self::Vogel32 | Self::Pcss => 1.0,
            Self::Pcf3x3 => 2.0,
            Self::Pcf5x5 => 3.0,
            Self::Pcf7x7 => 4.0,
        }
    }
}
