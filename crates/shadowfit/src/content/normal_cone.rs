//! Cones around the surface normals of clusters, and a test whether surfaces face away from the light.
//!
//! Both sides of a surface count, so a normal and its opposite are equivalent: each cone is a double cone,
//! joined at the tips.

use glam::{DVec3, Vec3};

use crate::base::Aabb;
use crate::base::checks::length;

/// A double cone that holds the geometric normal of each triangle of a cluster, or its opposite.
///
/// Zero-area triangles are ignored, since they have no normal and are not drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct NormalCone {
    /// Axis of the cone, a unit vector in the axes of the triangles.
    pub axis: Vec3,
    /// Cosine of the angle between the axis and the cone's side, from 0 (the double cone holds every
    /// direction) to just under 1 (all triangles are parallel).
    pub cos_half_angle: f32,
}

impl NormalCone {
    /// The cone that holds every direction, so that it proves nothing.
    pub const ALL: Self = Self { axis: Vec3::Y, cos_half_angle: 0.0 };

    /// Returns whether all visible surfaces within a box, with normals in this cone, face away from the
    /// light. They are dark without a map, so a fit may ignore the box.
    ///
    /// `bounds` and `eye` are in metres relative to one origin. `to_light` is the direction **toward** the
    /// light, of any length. All are in the axes of the triangles. `true` is proven for this eye: (n · (eye -
    /// p)) (n · `to_light`) <= 0 for every point p of the box and every normal n of the cone. `false` may
    /// also be returned for surfaces that face away. It is returned for NaN, an empty box and an axis of zero
    /// length. Shading normals that differ from the geometric normals, and light through leaves, are not
    /// taken into account.
    ///
    /// ```text
    ///          eye          The product is never above 0 if the eye is before every such plane and
    ///           *           the light behind it, or the other way round. For a vector v at the
    ///           :  n        angle f to the axis a, the least n · v over a cone of half angle h is
    ///         v :  /   a
    ///           : / _-'         |v| cos(f + h) = cos h (a · v) - sin h |v - (a · v) a|,
    ///        ___:/-'___
    ///       |   p      |    a linear function less a norm, so concave in v: over the box its least
    ///       |__________|    value is at a corner, and 8 corners prove it for all points.
    ///             \
    ///              \ to_light
    /// ```
    ///
    /// Beyond f + h = 180° the formula exceeds the least value, -|v|, but both are below 0. Source: the cone
    /// test of mesh clusters (Kubisch, Christoph: "Introduction to Turing Mesh Shaders", 2018), made exact
    /// for boxes and used twice, for the eye and for the light.
    pub fn faces_away(&self, bounds: &Aabb, eye: Vec3, to_light: Vec3) -> bool {
        self.faces_away_from(bounds, eye.as_dvec3(), to_light.as_dvec3())
    }

    /// Computes [`Self::faces_away`] for an eye far from the box's origin. Rounding such an eye to f32 could
    /// move it to the other side of a surface.
    pub(crate) fn faces_away_from(&self, bounds: &Aabb, eye: DVec3, to_light: DVec3) -> bool {
        let axis = self.axis.as_dvec3() / length(self.axis.as_dvec3());
        let cos = f64::from(self.cos_half_angle);
        let sin = libm::sqrt((1.0 - cos * cos).max(0.0));
        // Whether n · v is above 0 for all normals on the axis' side, by more than the rounding of the
        // products and of v, a difference of numbers up to |v| + `reach`.
        let is_before = |v: DVec3, reach: f64| {
            let along = axis.dot(v);
            cos * along - sin * length(v - axis * along) > CONE_ROUNDING * (length(v) + reach)
        };
        let reach = length(eye);
        let corner = |i: usize| {
            let pick = |bit: usize, min: f32, max: f32| f64::from(if i & bit == 0 { min } else { max });
            let (min, max) = (bounds.min, bounds.max);
            DVec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
        };
        let parts =
            |side: f64| is_before(to_light * -side, 0.0) && (0..8).all(|i| is_before((eye - corner(i)) * side, reach));
        !bounds.is_empty() && cos > 0.0 && (parts(1.0) || parts(-1.0))
    }
}

/// Products below this share of their factors' lengths count as zero: a few steps of f64.
const CONE_ROUNDING: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_eye_far_from_the_origin_is_not_put_on_the_other_side() {
        // A facet 100 km away, where the step of f32 is 1/128 m, and an eye 2 mm behind it.
        let place = Vec3::splat(100_000.0);
        let facet = Aabb::new(place, place);
        let eye = place.as_dvec3() + DVec3::new(0.004, 0.004, -0.0116);
        let cone = NormalCone { axis: Vec3::ONE, cos_half_angle: 1.0 - f32::EPSILON };
        let light_behind = -Vec3::ONE;
        assert!(!cone.faces_away_from(&facet, eye, light_behind.as_dvec3()), "the eye is on the lit side");
        assert!(cone.faces_away(&facet, eye.as_vec3(), light_behind), "f32 rounds the eye to the other side");
    }
}
