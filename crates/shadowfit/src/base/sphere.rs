//! The least sphere around a view: by a formula for a symmetric frustum, by construction for any
//! points. [`fits::sphere`](crate::fits::sphere) derives both.

use glam::DVec3;

use crate::base::checks;

/// A sphere, in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnclosingSphere {
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
}

/// Share of a half diagonal by which the four half diagonals may differ for the frustum to count as
/// symmetric: a few roundings of f32 corners.
pub(crate) const SYMMETRY: f64 = 1e-6;

/// A frustum whose rectangles are symmetric about one axis and perpendicular to it, so that the
/// spheres of its slices follow from their depths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SymmetricFrustum {
    /// Middle of the near rectangle.
    near: DVec3,
    /// From there to the middle of the far one.
    axis: DVec3,
    length: f64,
    /// Half diagonals of the near and the far rectangle.
    radii: (f64, f64),
}

impl SymmetricFrustum {
    /// `None` for frusta that are not symmetric.
    #[inline(always)]
    pub(crate) fn new(corners: &[DVec3; 8]) -> Option<Self> {
        let centre = |c: &[DVec3]| (c[0] + c[1] + c[2] + c[3]) * 0.25;
        let (near, far) = (centre(&corners[..4]), centre(&corners[4..]));
        let axis = far - near;
        let length = checks::length(axis);
        let squared = |c: DVec3, middle: DVec3| (c - middle).dot(c - middle);
        let (r0, r1) = (libm::sqrt(squared(corners[0], near)), libm::sqrt(squared(corners[4], far)));
        let is_symmetric = corners[4..].iter().all(|corner| {
            let from_axis = *corner - far;
            (from_axis.dot(from_axis) - r1 * r1).abs() <= 2.0 * SYMMETRY * r1 * r1
                && from_axis.dot(axis).abs() <= SYMMETRY * length * r1
        });
        if is_symmetric && length > 0.0 { Some(Self { near, axis, length, radii: (r0, r1) }) } else { None }
    }

    /// The sphere of the part between two positions on the axis, as shares of its length.
    pub(crate) fn sphere(&self, from: f64, to: f64) -> EnclosingSphere {
        let radius = |t: f64| self.radii.0 * (1.0 - t) + self.radii.1 * t;
        // Which end is the wider one does not matter to the formula.
        let (r0, r1, length) = (radius(from), radius(to), self.length * (to - from));
        let x = ((length * length + r1 * r1 - r0 * r0) / (2.0 * length)).min(length);
        let radius = libm::sqrt((length - x) * (length - x) + r1 * r1);
        EnclosingSphere { centre: self.near + self.axis * (from + x / self.length), radius }
    }
}

/// Share of a squared radius by which a point may lie outside and still count as inside.
const INSIDE: f64 = 1e-12;

/// Least sphere around points: when a point lies outside the sphere so far, the sphere is built
/// anew with that point on its surface; up to four such points determine it.
pub(crate) fn minimal(points: &[DVec3]) -> EnclosingSphere {
    let mut support = [DVec3::ZERO; 4];
    grow(points, &mut support, 0)
}

fn grow(points: &[DVec3], support: &mut [DVec3; 4], fixed: usize) -> EnclosingSphere {
    let mut sphere = through(&support[..fixed]);
    if fixed == 4 {
        return sphere;
    }
    for (i, p) in points.iter().enumerate() {
        let d = *p - sphere.centre;
        if sphere.radius < 0.0 || d.dot(d) > sphere.radius * sphere.radius * (1.0 + INSIDE) {
            support[fixed] = *p;
            sphere = grow(&points[..i], support, fixed + 1);
        }
    }
    sphere
}

/// The least sphere with up to four points on its surface; without points, one of negative radius.
fn through(points: &[DVec3]) -> EnclosingSphere {
    let Some(first) = points.first() else { return EnclosingSphere { centre: DVec3::ZERO, radius: -1.0 } };
    // The centre is first + Σ λᵢ eᵢ with 2 eᵢ·(Σ λⱼ eⱼ) = eᵢ·eᵢ, solved by Gram-Schmidt: each new
    // point moves the centre along the part of its edge that is across the earlier ones.
    let mut centre = *first;
    let mut across = [DVec3::ZERO; 3];
    for (k, p) in points[1..].iter().enumerate() {
        let edge = *p - *first;
        let mut u = edge;
        for v in &across[..k] {
            let vv = v.dot(*v);
            if vv > 0.0 {
                u -= *v * (u.dot(*v) / vv);
            }
        }
        across[k] = u;
        let uu = u.dot(u);
        if uu > INSIDE * edge.dot(edge) {
            let (to_point, to_first) = (*p - centre, *first - centre);
            centre += u * ((to_point.dot(to_point) - to_first.dot(to_first)) / (2.0 * u.dot(edge)));
        }
    }
    EnclosingSphere { centre, radius: checks::length(*first - centre) }
}
