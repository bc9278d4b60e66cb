//! The light's own axes: where its roll comes from.
//!
//! A direction leaves the rotation about itself open. Which one a fit picks decides whether the
//! map turns smoothly with the sun and where it flips.

use glam::{DVec3, Vec3};

use crate::checks;

/// Right-handed orthonormal axes of a light in world space. The light looks along -z, so `z` is
/// the direction *toward* the light.
///
/// The axes are rounded to f32 here, once: boxes are measured along the very numbers that the
/// matrices hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightAxes {
    pub(crate) x: Vec3,
    pub(crate) y: Vec3,
    pub(crate) z: Vec3,
}

/// Sine of the angle to the vertical below which the look-at roll is taken from a fixed axis: an
/// f32 unit vector's own rounding is 1e-7, so its azimuth is noise there.
const VERTICAL_SINE: f64 = 1e-6;

impl LightAxes {
    /// Look-at axes with up +y, as the XNA sample has them: `x = direction × up`.
    ///
    /// Within 1e-6 radians of the vertical, where the sample divides by zero, up is -z. The roll
    /// flips there: it follows the azimuth on every side, so no choice at the pole is continuous.
    pub(crate) fn look_at(direction: DVec3) -> Self {
        let mut right = direction.cross(DVec3::Y);
        if checks::length(right) < VERTICAL_SINE {
            right = direction.cross(DVec3::NEG_Z);
        }
        let right = right / checks::length(right);
        Self::from_f64(right, right.cross(direction), -direction)
    }

    /// The axes of a light straight down (x = +x, y = -z, so that the map reads like a plan with
    /// -z at its top), turned by the shortest arc from straight down to `direction`.
    ///
    /// ```text
    ///   down d₀ = (0,-1,0)  ──k = d₀ × d──▶  d       R v = v + k × v + k × (k × v) / (1 + d₀·d)
    /// ```
    ///
    /// Continuous everywhere but for light straight up, where the arc's axis is fixed as +x.
    pub(crate) fn shortest_arc(direction: DVec3) -> Self {
        let k = DVec3::NEG_Y.cross(direction);
        let horizontal = direction.x * direction.x + direction.z * direction.z;
        // 1 + d₀·d = 1 - d.y, which cancels for light from below; this form does not.
        let one_plus_cos = if direction.y > 0.0 { horizontal / (1.0 + direction.y) } else { 1.0 - direction.y };
        if one_plus_cos <= 0.0 {
            return Self { x: Vec3::X, y: Vec3::Z, z: Vec3::NEG_Y };
        }
        let turn = |v: DVec3| v + k.cross(v) + k.cross(k.cross(v)) / one_plus_cos;
        Self::from_f64(turn(DVec3::X), turn(DVec3::NEG_Z), -direction)
    }

    fn from_f64(x: DVec3, y: DVec3, z: DVec3) -> Self {
        Self { x: x.as_vec3(), y: y.as_vec3(), z: z.as_vec3() }
    }

    /// World axes to light axes, both from the same origin.
    pub(crate) fn project(&self, v: DVec3) -> DVec3 {
        let (x, y, z) = (self.x.as_dvec3(), self.y.as_dvec3(), self.z.as_dvec3());
        DVec3::new(x.dot(v), y.dot(v), z.dot(v))
    }
}
