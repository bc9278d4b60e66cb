//! The cone of a cluster, built from its triangles.

use glam::{DVec3, Vec3};

use crate::base::checks::length;
use crate::content::normal_cone::NormalCone;

impl NormalCone {
    /// A narrow cone around the normals of triangles; not the narrowest.
    pub(super) fn around<'a, I: Iterator<Item = &'a [Vec3; 3]>>(triangles: impl Fn() -> I) -> Self {
        let normals = || triangles().map(area_normal).filter(|normal| *normal != DVec3::ZERO);
        // The side of the largest triangle, then of the mean, decides which normals are flipped.
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

/// The normal of a triangle by the right-hand rule, twice its area long.
fn area_normal([a, b, c]: &[Vec3; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}

/// The normal or its opposite, whichever is on the side of `reference`.
fn toward(reference: DVec3, normal: DVec3) -> DVec3 {
    if reference.dot(normal) < 0.0 { -normal } else { normal }
}
