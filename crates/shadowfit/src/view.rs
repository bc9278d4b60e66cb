//! A view frustum in the form that fits use: f64, cut by view depth, clipped against boxes.
//!
//! The vertices of box ∩ frustum slice lie on three planes each. Those with two or three planes of
//! the box are ends of the box's edges clipped to the slice, those with two or three planes of the
//! slice are ends of the slice's edges clipped to the box, so that clipping 12 + 12 segments finds
//! them all, without building a polytope:
//!
//! ```text
//!        ┌───────────┐ box
//!        │     ╱●────┼──╲       ● ends of the slice's edges inside the box
//!        │   ╱ slice │    ╲     ○ ends of the box's edges inside the slice
//!        └──○────────○─────╲
//! ```

use glam::{DVec3, Vec3};

use crate::{Aabb, ViewFrustum, checks};

/// A range of view depths, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) near: f32,
    pub(crate) far: f32,
}

/// Corners of the part of a frustum between two view depths, relative to an origin; `None` where
/// they leave nothing of it.
#[inline(always)]
pub(crate) fn slice_corners(frustum: &ViewFrustum, origin: DVec3, near: f32, far: f32) -> Option<[DVec3; 8]> {
    let (near, far) = (near.max(frustum.near), far.min(frustum.far));
    if near >= far {
        return None;
    }
    let offset = frustum.origin - origin;
    let mut corners = [DVec3::ZERO; 8];
    for (corner, relative_to_eye) in corners.iter_mut().zip(&frustum.corners) {
        *corner = relative_to_eye.as_dvec3() + offset;
    }
    if near == frustum.near && far == frustum.far {
        return Some(corners);
    }
    let per_metre = 1.0 / (f64::from(frustum.far) - f64::from(frustum.near));
    let share = |depth: f32| (f64::from(depth) - f64::from(frustum.near)) * per_metre;
    let (t0, t1) = (share(near), share(far));
    for i in 0..4 {
        let (start, end) = (corners[i], corners[i + 4]);
        corners[i] = start * (1.0 - t0) + end * t0;
        corners[i + 4] = start * (1.0 - t1) + end * t1;
    }
    Some(corners)
}

/// A plane (n, d) with unit normal; a point is inside where n·p + d >= 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) normal: DVec3,
    pub(crate) d: f64,
}

impl Plane {
    pub(crate) fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) + self.d
    }
}

/// A view frustum relative to the origin that a fit uses for everything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Corners, near then far, in the order of [`ViewFrustum::corners`].
    corners: [DVec3; 8],
    pub(crate) near: f64,
    pub(crate) far: f64,
    /// View depth of a point, as the signed distance from a plane.
    pub(crate) depth: Plane,
    sides: [Plane; 4],
}

impl View {
    /// `frustum` has been checked.
    pub(crate) fn new(frustum: &ViewFrustum, origin: DVec3) -> Self {
        let offset = frustum.origin - origin;
        let corners = frustum.corners.map(|c| c.as_dvec3() + offset);
        let forward = frustum.forward.as_dvec3();
        let forward = forward / checks::length(forward);
        let (near, far) = (f64::from(frustum.near), f64::from(frustum.far));
        // Depths are measured from the near rectangle, whose rounding is the smallest.
        let middle = (corners[0] + corners[2]) * 0.5;
        let depth = Plane { normal: forward, d: near - forward.dot(middle) };
        let centre = corners.iter().copied().sum::<DVec3>() * 0.125;
        let mut sides = [depth; 4];
        for (i, side) in sides.iter_mut().enumerate() {
            let next = (i + 1) % 4;
            // The far rectangle is never the smaller one, so its side has the more precise
            // direction.
            let normal = (corners[i + 4] - corners[i]).cross(corners[next + 4] - corners[i + 4]);
            let normal = normal / checks::length(normal);
            let inward = if normal.dot(centre - corners[i + 4]) < 0.0 { -normal } else { normal };
            *side = Plane { normal: inward, d: -inward.dot(corners[i + 4]) };
        }
        Self { corners, near, far, depth, sides }
    }

    /// Position of a point in the picture: 0..1 from left to right and from top to bottom. The point
    /// must not lie before the near plane.
    pub(crate) fn picture_position(&self, p: DVec3) -> [f64; 2] {
        // Sides 0 to 3 are top, right, bottom, left; each distance is divided by that of the
        // opposite end of the far rectangle.
        let share = |one: usize, other: usize, at_other: usize, at_one: usize| {
            let a = self.sides[one].distance(p) / self.sides[one].distance(self.corners[at_other]);
            let b = self.sides[other].distance(p) / self.sides[other].distance(self.corners[at_one]);
            a / (a + b)
        };
        [share(3, 1, 5, 4), share(0, 2, 7, 4)]
    }

    /// Corners of the rectangle at a view depth.
    fn rectangle(&self, depth: f64) -> [DVec3; 4] {
        let t = (depth - self.near) / (self.far - self.near);
        core::array::from_fn(|i| self.corners[i] * (1.0 - t) + self.corners[i + 4] * t)
    }

    /// The part between two view depths, cut to the frustum's own.
    pub(crate) fn slice(&self, near: f64, far: f64) -> Slice {
        let (near, far) = (near.max(self.near).min(self.far), far.min(self.far).max(self.near));
        let mut corners = [DVec3::ZERO; 8];
        corners[..4].copy_from_slice(&self.rectangle(near));
        corners[4..].copy_from_slice(&self.rectangle(far));
        let Plane { normal, d } = self.depth;
        let [a, b, c, e] = self.sides;
        let planes = [a, b, c, e, Plane { normal, d: d - near }, Plane { normal: -normal, d: far - d }];
        Slice { corners, planes, near, far }
    }

    /// Least and greatest view depth of a box that may touch the frustum; `None` when it does not.
    pub(crate) fn depths(&self, min: DVec3, max: DVec3) -> Option<(f64, f64)> {
        if self.sides.iter().any(|plane| farthest(plane, min, max) < 0.0) {
            return None;
        }
        let flipped = Plane { normal: -self.depth.normal, d: -self.depth.d };
        let (least, greatest) = (-farthest(&flipped, min, max), farthest(&self.depth, min, max));
        if least > self.far || greatest < self.near { None } else { Some((least, greatest)) }
    }
}

/// Distance of a box's farthest corner along a plane's normal.
fn farthest(plane: &Plane, min: DVec3, max: DVec3) -> f64 {
    let n = plane.normal;
    let x = n.x * if n.x < 0.0 { min.x } else { max.x };
    let y = n.y * if n.y < 0.0 { min.y } else { max.y };
    let z = n.z * if n.z < 0.0 { min.z } else { max.z };
    x + y + z + plane.d
}

/// Distance of a box's nearest corner along a plane's normal.
fn nearest(plane: &Plane, min: DVec3, max: DVec3) -> f64 {
    farthest(plane, max, min)
}

/// A part of a view frustum between two view depths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slice {
    pub(crate) corners: [DVec3; 8],
    /// Four sides, then near and far.
    pub(crate) planes: [Plane; 6],
    pub(crate) near: f64,
    pub(crate) far: f64,
}

/// Pairs of corners that an edge joins, for frusta and boxes alike ([`box_corners`] has the same
/// order).
const EDGES: [(usize, usize); 12] =
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)];

/// Corners of a box: the four with the least z around, then the four with the greatest.
pub(crate) fn box_corners(min: DVec3, max: DVec3) -> [DVec3; 8] {
    let (a, b) = (min, max);
    [
        DVec3::new(a.x, a.y, a.z),
        DVec3::new(b.x, a.y, a.z),
        DVec3::new(b.x, b.y, a.z),
        DVec3::new(a.x, b.y, a.z),
        DVec3::new(a.x, a.y, b.z),
        DVec3::new(b.x, a.y, b.z),
        DVec3::new(b.x, b.y, b.z),
        DVec3::new(a.x, b.y, b.z),
    ]
}

impl Slice {
    /// Passes on all vertices of box ∩ slice, some of them more than once, and possibly points of
    /// its edges. Nothing when they do not meet.
    pub(crate) fn clip<E>(
        &self,
        min: DVec3,
        max: DVec3,
        emit: &mut impl FnMut(DVec3) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut crossed = [false; 6];
        for (plane, crossed) in self.planes.iter().zip(&mut crossed) {
            if farthest(plane, min, max) < 0.0 {
                return Ok(());
            }
            *crossed = nearest(plane, min, max) < 0.0;
        }
        let corners = box_corners(min, max);
        if crossed == [false; 6] {
            return corners.into_iter().try_for_each(emit);
        }
        for (i, j) in EDGES {
            if let Some((a, b)) = self.clip_segment(corners[i], corners[j], crossed) {
                emit(a)?;
                emit(b)?;
            }
        }
        for (i, j) in EDGES {
            if let Some((a, b)) = clip_to_box(self.corners[i], self.corners[j], min, max) {
                emit(a)?;
                emit(b)?;
            }
        }
        Ok(())
    }

    /// The part of a segment inside those planes that the box crosses.
    fn clip_segment(&self, a: DVec3, b: DVec3, crossed: [bool; 6]) -> Option<(DVec3, DVec3)> {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (plane, _) in self.planes.iter().zip(crossed).filter(|(_, crossed)| *crossed) {
            let (da, db) = (plane.distance(a), plane.distance(b));
            if da < 0.0 && db < 0.0 {
                return None;
            }
            if da < 0.0 {
                enter = enter.max(da / (da - db));
            } else if db < 0.0 {
                leave = leave.min(da / (da - db));
            }
        }
        if enter > leave { None } else { Some((at(a, b, enter), at(a, b, leave))) }
    }
}

/// The point of a segment at a share of its length; exact at both ends.
fn at(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    a * (1.0 - t) + b * t
}

/// The part of a segment inside a box.
fn clip_to_box(a: DVec3, b: DVec3, min: DVec3, max: DVec3) -> Option<(DVec3, DVec3)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let (start, along) = (a[axis], b[axis] - a[axis]);
        if along == 0.0 {
            if start < min[axis] || start > max[axis] {
                return None;
            }
            continue;
        }
        let (first, second) = ((min[axis] - start) / along, (max[axis] - start) / along);
        let (first, second) = if along > 0.0 { (first, second) } else { (second, first) };
        enter = enter.max(first);
        leave = leave.min(second);
    }
    if enter > leave { None } else { Some((at(a, b, enter), at(a, b, leave))) }
}

/// A box's corners relative to another origin, in f64.
pub(crate) fn moved(aabb: &Aabb, offset: DVec3) -> (DVec3, DVec3) {
    let to = |v: Vec3| v.as_dvec3() + offset;
    (to(aabb.min), to(aabb.max))
}
