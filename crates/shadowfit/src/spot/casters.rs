//! Which casters the map of a spot light can store.

use glam::{DVec3, Vec4};

use super::SpotFit;
use crate::base::checks;
use crate::culling::CasterVolume;

impl SpotFit {
    /// Every caster that the map can store: the light's frustum, relative to [`Self::origin`], as planes -x, +x, -y,
    /// +y, far and near in the light's axes. Casters nearer to the light than the near plane are left out, as they are
    /// clipped. Also what the light can shine on at all: a receiver outside it needs no look-up.
    pub fn caster_volume(&self) -> CasterVolume {
        let [x, y, z] = self.axes();
        let [tangent_x, tangent_y] = self.tangents();
        let light = self.position - self.origin;
        // A side holds the light itself, and its normal leans toward the light by the tangent.
        let side = |axis: DVec3, tangent: f64| {
            let inward = axis - z * tangent;
            through(inward / checks::length(inward), light)
        };
        let far = through(z, light - z * f64::from(self.far));
        let near = through(-z, light - z * f64::from(self.near));
        let planes = [side(x, tangent_x), side(-x, tangent_x), side(y, tangent_y), side(-y, tangent_y), far, near];
        CasterVolume::of_planes(self.origin, planes)
    }
}

/// The plane through a point with a unit normal that points inward.
fn through(normal: DVec3, point: DVec3) -> Vec4 {
    normal.as_vec3().extend(-normal.dot(point) as f32)
}
