//! A plane as a spot light's map sees it at one of its points: what biases and figures are made of.

use glam::{DVec3, Vec3};

use super::SpotFit;
use crate::base::checks::{MAX_LENGTH, MIN_LENGTH};
use crate::base::{DepthConvention, FitError, checks};
use crate::bias::{MIN_COSINE, Reach};

/// A plane with the unit normal n on the light's side, in light axes and in texels.
pub(super) struct Plane {
    /// Texel sizes at 1 m times n·x and n·y: the height over the plane, in metres along n, that a texel along u, or
    /// against v, gains at 1 m along the axis.
    pub(super) u: f64,
    pub(super) v: f64,
    /// n·z, the cosine between n and the direction back along the light's axis. Below 0 for planes that face the light
    /// and not its axis, as there are off the axis.
    pub(super) along: f64,
    /// Sine of the angle between n and the axis.
    pub(super) sine: f64,
    /// Distance of the point along the axis, in metres: d.
    pub(super) distance: f64,
    /// Distance of the light from the plane, in metres: c, held at [`MIN_COSINE`] of its distance from the point.
    pub(super) height: f64,
}

impl Plane {
    /// The plane through a world position, in metres, with a normal of any length on either side; refuses positions
    /// that are not before the light.
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

    /// Greatest height of the plane over itself within a filter's reach, per metre along the axis: s.
    pub(super) fn rise(&self, reach: Reach) -> f64 {
        reach.rise(self.u, self.v)
    }

    /// Distance along the axis of the point lifted along the normal, in metres.
    pub(super) fn lifted(&self, offset: f64) -> f64 {
        self.distance - offset * self.along
    }

    /// Change of the stored depth over one texel along u and along v, the same everywhere on the plane.
    pub(super) fn gradient(&self, fit: &SpotFit) -> [f64; 2] {
        let sign = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
        let per_height = sign * fit.depth_scale() / self.height;
        [self.u * per_height, -self.v * per_height]
    }
}
