//! The radius of a filter around the sampled point. Every bias is proportional to it.

use glam::Vec2;

use crate::base::checks::UNIT;
use crate::base::{FitError, checks};
use crate::projection::LightProjection;
use crate::technique::Technique;
use crate::technique::settings::{FilterKind, Softness};

/// Radius of a filter, in texels. It bounds the texel centres with a weight other than zero.
///
/// These centres lie within [`Self::taps`] per axis of a look-up, and the look-ups lie within the ellipse
/// [`Self::disc`] around the looked-up point. A number converts to the radius with these taps and no disc. A
/// [`FilterKind`] converts to its [`filter_radius`](FilterKind::filter_radius), without the disc of a
/// [soft](FilterKind::is_soft) filter. [`Technique::filter_radius_in`](crate::Technique::filter_radius_in)
/// returns the radius of a technique's filter in a map.
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
    /// Radii along u and v of the ellipse that the look-ups are spread over. Zero for one look-up.
    pub disc: Vec2,
}

/// Hardware rounding of every filter radius, in texels: rasterisers snap vertices, and samplers snap texture
/// coordinates, to the nearest 1/256 of a texel.
pub(crate) const HARDWARE_SNAP: f32 = 1.0 / 256.0;

/// Number of roundings of 2⁻²⁴ between a receiver's depth and the depth that its surface stores there, as a
/// multiple of the distance of the farthest corner of the map's box. The receiver's transform has four
/// operations per term, on terms that sum to twice that distance. The vertices' transform has four operations
/// on the translation, which is that distance.
const MAP_ROUNDINGS: f64 = 12.0;

/// Number of roundings of 2⁻²⁴ as a multiple of the distance of the farthest vertex: four operations per term
/// in its transform, three in the interpolation of a triangle's depths, and three in the interpolation of the
/// receiver's position.
const VERTEX_ROUNDINGS: f64 = 10.0;

impl FilterRadius {
    /// One comparison with the nearest texel: E = 0.5.
    pub const POINT: Self = Self::taps(0.5);

    /// The hardware's four comparisons, weighted bilinearly: E = 1.
    pub const HARDWARE_2X2: Self = Self::taps(1.0);

    /// Returns the radius of taps within `taps` texels per axis.
    pub const fn taps(taps: f32) -> Self {
        Self { taps, disc: Vec2::ZERO }
    }

    /// Returns the radius of `taps` × `taps` hardware 2×2 look-ups, one texel apart, centred on the looked-up
    /// point: E = (taps + 1) / 2.
    pub const fn kernel(taps: u32) -> Self {
        Self::taps((taps as f32 + 1.0) * 0.5)
    }

    /// Returns this radius with its look-ups spread over a disc (Poisson, Vogel, jittered) of `radius`
    /// texels. `FilterRadius::POINT.over_disc(r)` compares with nearest texels, E = r + 0.5 per axis.
    #[must_use]
    pub const fn over_disc(self, radius: f32) -> Self {
        Self { disc: Vec2::splat(radius), ..self }
    }

    /// Returns this radius with its look-ups spread over a disc of `radius` metres across the light in a map.
    #[must_use]
    pub fn over_disc_of_metres(self, radius: f32, fit: &LightProjection) -> Self {
        Self { disc: Vec2::splat(radius) / fit.texel_size, ..self }
    }

    /// Returns the greatest distance per axis, E: the taps plus the longer radius of the disc.
    pub fn per_axis(self) -> f32 {
        self.taps + self.disc.x.max(self.disc.y)
    }

    /// Returns this radius, enlarged by the rounding of a GPU: 1/256 of a texel and the rounding of f32
    /// texture coordinates at the corner of the map that is farthest from its origin. With exact arithmetic
    /// (a ray tracer, a test in f64) the plain radius is enough.
    #[must_use]
    pub fn on_hardware(self, fit: &LightProjection) -> Self {
        let texel = f64::from(fit.texel_size.x.min(fit.texel_size.y));
        Self { taps: self.taps + HARDWARE_SNAP + (rounding(fit) / texel) as f32, ..self }
    }

    /// Returns an error for a radius that is negative or not finite.
    pub(crate) fn checked(self) -> Result<Self, FitError> {
        checks::within("the reach of the filter's taps", f64::from(self.taps), 0.0, checks::MAX_LENGTH)?;
        for radius in self.disc.to_array() {
            checks::within("the radius of the filter's disc", f64::from(radius), 0.0, checks::MAX_LENGTH)?;
        }
        Ok(self)
    }

    /// Returns the greatest height change of a plane over the texels in the radius, the support function of a
    /// box plus an ellipse. The height changes by `a` per texel along u and by `b` along v. The result is in
    /// their unit.
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

/// The radius of one look-up, without the disc of a [soft](FilterKind::is_soft) filter.
impl From<FilterKind> for FilterRadius {
    fn from(filter: FilterKind) -> Self {
        Self::taps(filter.filter_radius())
    }
}

impl Softness {
    /// Returns the radii along u and v of the ellipse that a filter's look-ups are spread over in a map, in
    /// texels. For [`FilterKind::Pcss`] these are the greatest radii. The blur of a look-up itself
    /// ([`Softness::LOOK_UP_SQUARE`]) is subtracted, so that penumbrae have equal widths in maps with other
    /// texels.
    pub fn texels(&self, filter: FilterKind, fit: &LightProjection) -> Vec2 {
        if !filter.is_soft() {
            return Vec2::ZERO;
        }
        let radius = Vec2::splat(self.metres(filter)) / fit.texel_size;
        let own = |radius: f32| libm::sqrtf((radius * radius - Softness::LOOK_UP_SQUARE).max(0.0));
        // `clamp` would panic if the floor is above the ceiling.
        let within = |radius: f32| radius.max(self.floor).min(self.ceiling);
        Vec2::new(within(own(radius.x)), within(own(radius.y)))
    }

    /// Returns the radius of a filter in a map, in its texels: the [look-up's
    /// radius](FilterKind::filter_radius) with the disc of [`Self::texels`].
    pub fn filter_radius_in(&self, filter: FilterKind, fit: &LightProjection) -> FilterRadius {
        FilterRadius { disc: self.texels(filter, fit), ..FilterRadius::taps(filter.filter_radius()) }
    }
}

impl Technique {
    /// Returns the radius of the filter in one map, in its texels, for caster volumes, proofs and biases. For
    /// [`FilterKind::Pcss`] it is the radius of the widest penumbra.
    pub fn filter_radius_in(&self, fit: &LightProjection) -> FilterRadius {
        self.softness.filter_radius_in(self.filter, fit)
    }
}

/// Returns the greatest f32 rounding error between a receiver's position in the map's box and the stored
/// surface, in metres.
pub(crate) fn rounding(fit: &LightProjection) -> f64 {
    let farthest = fit.farthest_corner();
    UNIT * (MAP_ROUNDINGS * farthest + VERTEX_ROUNDINGS * farthest.max(f64::from(fit.vertex_distance)))
}
