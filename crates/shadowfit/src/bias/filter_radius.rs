//! How far a filter reads from the sampled point: every bias is proportional to it.

use glam::Vec2;

use crate::base::checks::UNIT;
use crate::base::{FitError, checks};
use crate::projection::LightProjection;
use crate::technique::Technique;
use crate::technique::settings::{FilterKind, Softness};

/// Radius of a filter, in texels: which texel centres have a weight that is not zero.
///
/// They lie within [`Self::taps`] per axis of a look-up, and the look-ups within the ellipse
/// [`Self::disc`] around the sampled point. A number converts to the reach with these taps and no
/// disc, a [`FilterKind`] to its [`filter_radius`](FilterKind::filter_radius), which leaves out the disc of a
/// [soft](FilterKind::is_soft) one: [`Technique::filter_radius_in`](crate::Technique::filter_radius_in) has that of a
/// technique's filter in a map.
///
/// ```text
///   ┌───────┐  taps = E      ╭───────╮  disc = r, and each of the look-ups
///   │   ·───┤  each way      │   ·───┤  in it has taps of its own around it
///   └───────┘                ╰───────╯
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FilterRadius {
    /// Greatest distance along one axis from a look-up to a texel centre that it reads: E.
    pub taps: f32,
    /// Radii along u and v of the ellipse that the look-ups are spread over; zero for one look-up.
    pub disc: Vec2,
}

/// What hardware rounding adds to every reach, in texels: the rasteriser snaps vertices, and the
/// sampler texture coordinates, to the nearest 1/256 of a texel.
pub(crate) const HARDWARE_SNAP: f32 = 1.0 / 256.0;

/// Roundings of 2⁻²⁴ between a receiver's depth and the depth that its surface stores there, as a multiple of the
/// distance of the farthest corner of the map's box: four operations a term on terms that sum to twice that distance in
/// the receiver's transform, and four on the translation in the vertices' transform, which is one such distance.
const MAP_ROUNDINGS: f64 = 12.0;

/// Roundings of 2⁻²⁴ as a multiple of the distance of the farthest vertex: four operations a term in its transform, three
/// in the interpolation of a triangle's depths, and three in the interpolation of the receiver's position.
const VERTEX_ROUNDINGS: f64 = 10.0;

impl FilterRadius {
    /// One comparison with the nearest texel: E = 0.5.
    pub const POINT: Self = Self::taps(0.5);

    /// The hardware's four comparisons, weighted bilinearly: E = 1.
    pub const HARDWARE_2X2: Self = Self::taps(1.0);

    /// Taps that reach `taps` texels per axis.
    pub const fn taps(taps: f32) -> Self {
        Self { taps, disc: Vec2::ZERO }
    }

    /// `taps` × `taps` hardware 2×2 look-ups one texel apart, centred on the sampled point:
    /// E = (taps + 1) / 2.
    pub const fn kernel(taps: u32) -> Self {
        Self::taps((taps as f32 + 1.0) * 0.5)
    }

    /// This reach with its look-ups spread over a disc (Poisson, Vogel, jittered) of `radius`
    /// texels: `FilterRadius::POINT.over_disc(r)` compares with nearest texels, E = r + 0.5 per axis.
    #[must_use]
    pub const fn over_disc(self, radius: f32) -> Self {
        Self { disc: Vec2::splat(radius), ..self }
    }

    /// Greatest distance per axis, E: the taps and the longer radius of the disc.
    pub fn per_axis(self) -> f32 {
        self.taps + self.disc.x.max(self.disc.y)
    }

    /// This reach, enlarged by the rounding of a GPU: 1/256 of a texel and the rounding of f32
    /// texture coordinates at this fit's farthest corner from its origin. With exact arithmetic (a
    /// ray tracer, a test in f64) the plain reach is enough.
    #[must_use]
    pub fn on_hardware(self, fit: &LightProjection) -> Self {
        let texel = f64::from(fit.texel_size.x.min(fit.texel_size.y));
        Self { taps: self.taps + HARDWARE_SNAP + (rounding(fit) / texel) as f32, ..self }
    }

    /// Refuses reaches that are negative or not finite.
    pub(crate) fn checked(self) -> Result<Self, FitError> {
        checks::within("the reach of the filter's taps", f64::from(self.taps), 0.0, checks::MAX_LENGTH)?;
        for radius in self.disc.to_array() {
            checks::within("the radius of the filter's disc", f64::from(radius), 0.0, checks::MAX_LENGTH)?;
        }
        Ok(self)
    }

    /// Greatest height change, over the texels in reach, of a plane whose height changes by `a` per
    /// texel along u and by `b` along v, in the unit of `a` and `b`: the support function of a box
    /// plus that of an ellipse.
    pub(crate) fn rise(self, a: f64, b: f64) -> f64 {
        let (x, y) = (f64::from(self.disc.x) * a, f64::from(self.disc.y) * b);
        f64::from(self.taps) * (a.abs() + b.abs()) + libm::sqrt(x * x + y * y)
    }
}

impl From<f32> for FilterRadius {
    fn from(taps: f32) -> Self {
        Self::taps(taps)
    }
}

/// The reach of one look-up, without the disc of a [soft](FilterKind::is_soft) filter.
impl From<FilterKind> for FilterRadius {
    fn from(filter: FilterKind) -> Self {
        Self::taps(filter.filter_radius())
    }
}

impl Softness {
    /// Radii along u and v of the ellipse over which a filter's look-ups are spread in a map, in texels: for
    /// [`FilterKind::Pcss`] the greatest. Look-ups blur by themselves ([`Softness::LOOK_UP_SQUARE`]), which is
    /// taken off, so that penumbrae are as wide in maps of other texels.
    pub fn texels(&self, filter: FilterKind, fit: &LightProjection) -> Vec2 {
        if !filter.is_soft() {
            return Vec2::ZERO;
        }
        let radius = Vec2::splat(self.metres(filter)) / fit.texel_size;
        let own = |radius: f32| libm::sqrtf((radius * radius - Softness::LOOK_UP_SQUARE).max(0.0));
        // Not clamp, which panics where a floor lies above its ceiling.
        let within = |radius: f32| radius.max(self.floor).min(self.ceiling);
        Vec2::new(within(own(radius.x)), within(own(radius.y)))
    }

    /// Filter radius of a filter in a map, in its texels: the [look-up's](FilterKind::filter_radius) over the disc of
    /// [`Self::texels`].
    pub fn filter_radius_in(&self, filter: FilterKind, fit: &LightProjection) -> FilterRadius {
        FilterRadius { disc: self.texels(filter, fit), ..FilterRadius::taps(filter.filter_radius()) }
    }
}

impl Technique {
    /// Radius of the filter in one map, in its texels: for caster volumes, proofs and biases. Of
    /// [`FilterKind::Pcss`] it is that of the widest penumbra.
    pub fn filter_radius_in(&self, fit: &LightProjection) -> FilterRadius {
        self.softness.filter_radius_in(self.filter, fit)
    }
}

/// Greatest f32 rounding error between a receiver's position in the map's box and the surface that the map stores
/// there, in metres.
pub(crate) fn rounding(fit: &LightProjection) -> f64 {
    let farthest = fit.farthest_corner();
    UNIT * (MAP_ROUNDINGS * farthest + VERTEX_ROUNDINGS * farthest.max(f64::from(fit.vertex_distance)))
}
