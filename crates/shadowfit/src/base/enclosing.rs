//! Hulls and spheres around points: the convex hull in the light's plane, from which a rectangle is chosen,
//! and the least sphere.
//!
//! The hull is A. M. Andrew's monotone chain ("Another efficient algorithm for convex hulls in two
//! dimensions", 1979). Most points fall inside the octagon of the extreme points so far and are dropped at
//! once, as S. G. Akl and G. T. Toussaint proposed ("A fast convex hull algorithm", 1978).
//!
//! The sphere of a symmetric frustum follows from a formula. The sphere of other points is constructed.
//! [`fits::sphere`](crate::settings::FitKind::Sphere) derives both.

use glam::{DVec2, DVec3};

use crate::base::{FitError, checks};

/// Directions of the extreme points: the axes and their diagonals, anticlockwise.
const DIRECTIONS: [DVec2; 8] = [
    DVec2::new(1.0, 0.0),
    DVec2::new(1.0, 1.0),
    DVec2::new(0.0, 1.0),
    DVec2::new(-1.0, 1.0),
    DVec2::new(-1.0, 0.0),
    DVec2::new(-1.0, -1.0),
    DVec2::new(0.0, -1.0),
    DVec2::new(1.0, -1.0),
];

/// Collects points in caller-owned storage and turns them into their hull.
pub(crate) struct HullBuilder<'a> {
    points: &'a mut [DVec2],
    len: usize,
    /// The most extreme point in each of [`DIRECTIONS`]. One corner is often the most extreme in several.
    extremes: [DVec2; 8],
    reach: [f64; 8],
}

impl<'a> HullBuilder<'a> {
    /// Number of points that the storage needs in addition to twice the corners of the final hull.
    pub(crate) const SLACK: usize = 64;

    pub(crate) fn new(points: &'a mut [DVec2]) -> Self {
        Self { points, len: 0, extremes: [DVec2::ZERO; 8], reach: [f64::MIN; 8] }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns whether a point lies inside the octagon of the extreme points so far, so that it cannot change
    /// the hull.
    pub(crate) fn holds(&self, p: DVec2) -> bool {
        if self.len == 0 {
            return false;
        }
        (0..8).all(|i| {
            let (a, b) = (self.extremes[i], self.extremes[(i + 1) % 8]);
            // Coinciding extremes span no edge.
            (b - a).perp_dot(p - a) >= 0.0
        }) && (0..8).all(|i| p.dot(DIRECTIONS[i]) <= self.reach[i])
    }

    /// Returns [`Self::holds`] for all points of an axis-aligned rectangle, given by its middle and half its
    /// size.
    pub(crate) fn holds_rectangle(&self, centre: DVec2, half: DVec2) -> bool {
        if self.len == 0 {
            return false;
        }
        (0..8).all(|i| {
            let (a, edge) = (self.extremes[i], self.extremes[(i + 1) % 8] - self.extremes[i]);
            edge.perp_dot(centre - a) >= edge.x.abs() * half.y + edge.y.abs() * half.x
        }) && (0..8).all(|i| centre.dot(DIRECTIONS[i]) + half.dot(DIRECTIONS[i].abs()) <= self.reach[i])
    }

    /// Returns whether an axis-aligned rectangle, given by its middle and half its size, lies inside the
    /// points' bounds.
    pub(crate) fn reaches_around(&self, centre: DVec2, half: DVec2) -> bool {
        // Every other direction is an axis.
        (0..8).step_by(2).all(|i| centre.dot(DIRECTIONS[i]) + half.dot(DIRECTIONS[i].abs()) <= self.reach[i])
    }

    /// Adds a point.
    ///
    /// # Errors
    ///
    /// [`FitError::ScratchTooSmall`] if the hull itself does not fit the storage.
    pub(crate) fn push(&mut self, p: DVec2) -> Result<(), FitError> {
        if self.holds(p) {
            return Ok(());
        }
        for (i, direction) in DIRECTIONS.into_iter().enumerate() {
            let reach = p.dot(direction);
            if reach > self.reach[i] {
                self.reach[i] = reach;
                self.extremes[i] = p;
            }
        }
        // The chain needs room for a copy and one more point, so at most half of the storage is filled.
        if 2 * (self.len + 1) + 1 > self.points.len() {
            self.compact();
            if 2 * (self.len + 1) + 1 > self.points.len() {
                return Err(FitError::ScratchTooSmall { given: self.points.len(), required: 2 * (self.len + 1) + 1 });
            }
        }
        self.points[self.len] = p;
        self.len += 1;
        Ok(())
    }

    fn compact(&mut self) {
        let (points, scratch) = self.points.split_at_mut(self.len);
        self.len = hull(points, scratch);
    }

    /// Returns the storage for reuse.
    pub(crate) fn into_storage(self) -> &'a mut [DVec2] {
        self.points
    }

    /// Returns the hull's corners, anticlockwise and without collinear ones.
    pub(crate) fn finish(mut self) -> &'a mut [DVec2] {
        self.compact();
        &mut self.points[..self.len]
    }
}

/// Replaces points by their hull, anticlockwise from the least x, and returns the number of corners.
/// `scratch` must be at least as long as `points`.
fn hull(points: &mut [DVec2], scratch: &mut [DVec2]) -> usize {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let n = points.len();
    if n < 3 {
        return if n == 2 && points[0] == points[1] { 1 } else { n };
    }
    let reach = points.iter().fold(0.0_f64, |most, p| most.max(p.abs().max_element()));
    let same = reach * SAME_PLACE;
    // The lower chain grows in `scratch`. The upper chain follows it there, back to the first point. In a
    // sliver, rounding may put a point on both chains, so the upper one skips points of the lower one.
    let order = |a: DVec2, b: DVec2| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
    let lower = chain(points.iter().copied(), scratch, same) - 1;
    let (low, up) = scratch.split_at_mut(lower);
    let mut met = lower;
    let is_free = |p: &DVec2| {
        while met > 1 && order(*p, low[met - 1]).is_lt() {
            met -= 1;
        }
        met <= 1 || *p != low[met - 1]
    };
    let upper = chain(points.iter().rev().copied().filter(is_free), up, same);
    // The last point of the upper chain is the first of the lower one.
    let corners = (lower + upper - 1).max(1);
    points[..corners].copy_from_slice(&scratch[..corners]);
    corners
}

/// Distance within which two points count as the same, as a share of the greatest coordinate. The direction
/// of a shorter edge is rounding noise. A chain could not tell its left turns from right turns, and would
/// keep corners far inside the following ones. The error is a small part of the room that fits leave for
/// rounding.
const SAME_PLACE: f64 = 1.0 / 1_073_741_824.0;

/// Writes a chain of left turns from the first to the last of the points, and returns its length.
fn chain(points: impl Iterator<Item = DVec2>, out: &mut [DVec2], same: f64) -> usize {
    let mut len = 0;
    let mut points = points.peekable();
    while let Some(p) = points.next() {
        let is_same = |other: DVec2| (p - other).abs().max_element() <= same;
        if len > 0 && is_same(out[len - 1]) && points.peek().is_some() {
            continue;
        }
        while len >= 2 && (is_same(out[len - 1]) || (out[len - 1] - out[len - 2]).perp_dot(p - out[len - 2]) <= 0.0) {
            len -= 1;
        }
        // A chain of n sorted points, with the other chain's corners, never needs more than n + 1
        // elements.
        if len < out.len() && !(len == 1 && is_same(out[0])) {
            out[len] = p;
            len += 1;
        }
    }
    len
}

/// A sphere, in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnclosingSphere {
    pub(crate) centre: DVec3,
    pub(crate) radius: f64,
}

/// Tolerated difference of a symmetric frustum's four half diagonals, as a share of a half diagonal: a few
/// roundings of f32 corners.
pub(crate) const SYMMETRY: f64 = 1e-6;

/// A frustum whose rectangles are perpendicular to one axis and symmetric about it. The spheres of its slices
/// follow from their depths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SymmetricFrustum {
    /// Middle of the near rectangle.
    near: DVec3,
    /// Vector from there to the middle of the far rectangle.
    axis: DVec3,
    length: f64,
    /// Half diagonals of the near and the far rectangle.
    radii: (f64, f64),
}

impl SymmetricFrustum {
    /// Creates a symmetric frustum, or returns `None` if the corners are not symmetric.
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

    /// Computes the sphere around the part between two positions on the axis, given as shares of its length.
    pub(crate) fn sphere(&self, from: f64, to: f64) -> EnclosingSphere {
        let radius = |t: f64| self.radii.0 * (1.0 - t) + self.radii.1 * t;
        // The formula holds for either end being the wider one.
        let (r0, r1, length) = (radius(from), radius(to), self.length * (to - from));
        let x = ((length * length + r1 * r1 - r0 * r0) / (2.0 * length)).min(length);
        let radius = libm::sqrt((length - x) * (length - x) + r1 * r1);
        EnclosingSphere { centre: self.near + self.axis * (from + x / self.length), radius }
    }
}

/// Tolerance for points outside a sphere that still count as inside, as a share of its squared radius.
const INSIDE: f64 = 1e-12;

/// Computes the least sphere around points. If a point lies outside the sphere so far, the sphere is rebuilt
/// with that point on its surface. Up to four such points determine it.
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

/// Returns the least sphere with up to four points on its surface. Without points its radius is negative.
fn through(points: &[DVec3]) -> EnclosingSphere {
    let Some(first) = points.first() else { return EnclosingSphere { centre: DVec3::ZERO, radius: -1.0 } };
    // The centre is first + Σ λᵢ eᵢ with 2 eᵢ·(Σ λⱼ eⱼ) = eᵢ·eᵢ, solved by Gram-Schmidt: each new point moves
    // the centre along the part of its edge that is perpendicular to the earlier ones.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn hull_of(points: &[DVec2], storage: &mut [DVec2]) -> usize {
        let mut builder = HullBuilder::new(storage);
        for p in points {
            builder.push(*p).unwrap();
        }
        builder.finish().len()
    }

    #[test]
    fn a_grid_has_four_corners() {
        let mut points = [DVec2::ZERO; 100];
        for (i, p) in points.iter_mut().enumerate() {
            *p = DVec2::new((i % 10) as f64, (i / 10) as f64);
        }
        let mut storage = [DVec2::ZERO; HullBuilder::SLACK];
        assert_eq!(hull_of(&points, &mut storage), 4);
        assert_eq!(&storage[..4], &[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)].map(|(x, y)| DVec2::new(x, y)));
    }

    #[test]
    fn points_that_coincide_or_line_up_are_no_trouble() {
        let mut storage = [DVec2::ZERO; HullBuilder::SLACK];
        assert_eq!(hull_of(&[DVec2::ONE; 5], &mut storage), 1);
        let line = [0.0, 3.0, 1.0, 2.0, 3.0].map(|t| DVec2::new(t, 2.0 * t));
        assert_eq!(hull_of(&line, &mut storage), 2);
        assert_eq!(hull_of(&[], &mut storage), 0);
    }

    /// Points on a line except for the last bits of their coordinates, from a linear congruential generator.
    #[test]
    fn slivers_as_thin_as_rounding_have_no_more_corners_than_points() {
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..20_000 {
            let (slope, offset) = (random() - 0.5, random() * 100.0);
            let mut points = [DVec2::ZERO; 7];
            for p in &mut points {
                let x = libm::floor(random() * 6.0) * 0.1 + offset;
                *p = DVec2::new(x, x * slope);
            }
            let mut storage = [DVec2::ZERO; HullBuilder::SLACK];
            assert!(hull_of(&points, &mut storage) <= points.len());
        }
    }

    /// Both ends of two edges of a quadrilateral occur twice, apart by rounding, as clipping produces them.
    #[test]
    fn corners_that_come_twice_but_for_rounding_hide_no_others() {
        let corners = [(-405.085, 288.375), (-384.280, 257.947), (-33.662, 29.217), (-24.330, 15.568)];
        for noise in 0..256_i32 {
            let mut points = [DVec2::ZERO; 8];
            for (i, p) in points.iter_mut().enumerate() {
                let bit = f64::from((noise >> i) & 1) * 1e-14;
                *p = DVec2::new(corners[i / 2].0 + bit, corners[i / 2].1 - 0.7 * bit);
            }
            let mut storage = [DVec2::ZERO; HullBuilder::SLACK];
            let n = hull_of(&points, &mut storage);
            for i in 0..n {
                let (a, b) = (storage[i], storage[(i + 1) % n]);
                for p in &storage[..n] {
                    let left = (b - a).perp_dot(*p - a);
                    assert!(left >= -1e-9, "{noise}: {p} is right of {a} to {b}");
                }
            }
        }
    }

    #[test]
    fn a_circle_larger_than_the_storage_is_an_error() {
        let mut storage = [DVec2::ZERO; 16];
        let mut builder = HullBuilder::new(&mut storage);
        let pushed = (0..64).map(|i| f64::from(i) * 0.098).map(|a| DVec2::new(libm::cos(a), libm::sin(a)));
        let result: Result<(), FitError> = pushed.into_iter().try_for_each(|p| builder.push(p));
        assert!(matches!(result, Err(FitError::ScratchTooSmall { given: 16, .. })));
    }
}
