//! Where the surfaces of a cluster face, and whether that is away from the light.
//!
//! Both sides of a surface count, so a normal and its opposite are the same here: a cone stands
//! for the double cone of two tips at one point, which a box's front and back share.

use glam::{DVec3, Vec3};

use crate::Aabb;
use crate::checks::length;

/// A double cone that holds the geometric normal of each triangle of a cluster, or its opposite.
///
/// Zero-area triangles have no normal and are not drawn; they count for nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NormalCone {
    /// Middle of the cone, a unit vector in the axes of the triangles.
    pub axis: Vec3,
    /// Cosine of the angle between the axis and the cone's side, from 0 (every direction is in the
    /// double cone) to just under 1 (all triangles are parallel).
    pub cos_half_angle: f32,
}

impl NormalCone {
    /// The cone that holds every direction, of which nothing can be said.
    pub const ALL: Self = Self { axis: Vec3::Y, cos_half_angle: 0.0 };

    /// Whether all that can be seen of surfaces within a box, with normals in this cone, is turned
    /// away from the light: dark without a map, so that a fit may pass the box over.
    ///
    /// `bounds` and `eye` are in metres relative to one origin, `to_light` is the direction
    /// **toward** the light, of any length; all in the axes of the triangles. `true` is proven:
    /// (n · (eye - p)) (n · `to_light`) <= 0 for every point p of the box and every normal n of the
    /// cone, wherever the eye is. `false` may be said of a surface that is turned away, and is what
    /// NaN, an empty box and an axis without length get. Shading normals that lean from the
    /// geometric ones, and light through leaves, are not known here.
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
    /// Beyond f + h = 180° the formula is above the least value, -|v|, but below 0 like it.
    /// Source: the cone test of mesh clusters (Kubisch, Christoph: "Introduction to Turing Mesh
    /// Shaders", 2018), made exact for boxes and asked twice, of the eye and of the light.
    pub fn faces_away(&self, bounds: &Aabb, eye: Vec3, to_light: Vec3) -> bool {
        let axis = self.axis.as_dvec3() / length(self.axis.as_dvec3());
        let cos = f64::from(self.cos_half_angle);
        let sin = libm::sqrt((1.0 - cos * cos).max(0.0));
        // Whether n · v is above 0, by more than rounding, for all normals on the axis' side.
        let is_before = |v: DVec3| {
            let along = axis.dot(v);
            cos * along - sin * length(v - axis * along) > ROUNDING * length(v)
        };
        let (eye, to_light) = (eye.as_dvec3(), to_light.as_dvec3());
        let corner = |i: usize| {
            let pick = |bit: usize, min: f32, max: f32| f64::from(if i & bit == 0 { min } else { max });
            let (min, max) = (bounds.min, bounds.max);
            DVec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
        };
        let parts = |side: f64| is_before(to_light * -side) && (0..8).all(|i| is_before((eye - corner(i)) * side));
        !bounds.is_empty() && cos > 0.0 && (parts(1.0) || parts(-1.0))
    }

    /// A narrow cone around the normals of triangles; not the narrowest.
    pub(super) fn around<'a, I: Iterator<Item = &'a [Vec3; 3]>>(triangles: impl Fn() -> I) -> Self {
        let normals = || triangles().map(area_normal).filter(|normal| *normal != DVec3::ZERO);
        // The side of the largest triangle, then of the mean, decides which normals are turned round.
        let largest = normals().fold(DVec3::ZERO, |most, n| if n.dot(n) > most.dot(most) { n } else { most });
        let mean = normals().fold(DVec3::ZERO, |sum, n| sum + toward(largest, n / length(n)));
        let axis = (mean / length(mean)).as_vec3();
        if mean == DVec3::ZERO || !axis.is_finite() {
            return Self::ALL;
        }
        let unit = axis.as_dvec3() / length(axis.as_dvec3());
        let cos = normals().fold(1.0_f64, |least, n| least.min(unit.dot(n).abs() / length(n)));
        Self { axis, cos_half_angle: (cos as f32 - COSINE_STEP).max(0.0) }
    }
}

/// What is subtracted from a cosine in f32 so that rounding never narrows a cone: two steps just
/// below 1. It widens the cone of parallel normals to 0.03°.
const COSINE_STEP: f32 = 2.0 * f32::EPSILON;

/// What a product counts as zero within, as a share of its factors' lengths: some steps of f64.
const ROUNDING: f64 = 1e-14;

/// The normal of a triangle by the right-hand rule, twice its area long.
fn area_normal([a, b, c]: &[Vec3; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}

/// The normal or its opposite, whichever is on the side of `reference`.
fn toward(reference: DVec3, normal: DVec3) -> DVec3 {
    if reference.dot(normal) < 0.0 { -normal } else { normal }
}
