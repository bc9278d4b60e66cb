//! A view frustum in the form that fits use: in f64, cut at view depths, clipped against boxes.
//!
//! Each vertex of box ∩ frustum slice lies on three planes. If two or three of them belong to the box, it is
//! an end of a box edge clipped to the slice. Otherwise it is an end of a slice edge clipped to the box. So
//! clipping 12 + 12 segments finds all vertices, without building a polytope:
//!
//! ```text
//!        ┌───────────┐ box
//!        │     ╱●────┼──╲       ● ends of the slice's edges inside the box
//!        │   ╱ slice │    ╲     ○ ends of the box's edges inside the slice
//!        └──○────────○─────╲
//! ```

use core::ops;

use glam::DVec3;

use crate::base::{box_corners, checks};
use crate::view::ViewFrustum;

/// A range of view depths, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) near: f32,
    pub(crate) far: f32,
}

/// A range of view depths in f64, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Depths {
    pub(crate) near: f64,
    pub(crate) far: f64,
}

/// Returns the corners of the part of a frustum between two view depths, relative to an origin. `None` if the
/// part is empty.
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

/// A plane (n, d) with unit normal. A point is inside if n·p + d >= 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) normal: DVec3,
    pub(crate) d: f64,
}

/// A plane with every point outside.
const NOWHERE: Plane = Plane { normal: DVec3::ZERO, d: -1.0 };

impl Plane {
    pub(crate) fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) + self.d
    }

    /// Returns the distance of a box's farthest corner along the normal.
    pub(crate) fn farthest(&self, min: DVec3, max: DVec3) -> f64 {
        let n = self.normal;
        let x = n.x * if n.x < 0.0 { min.x } else { max.x };
        let y = n.y * if n.y < 0.0 { min.y } else { max.y };
        let z = n.z * if n.z < 0.0 { min.z } else { max.z };
        x + y + z + self.d
    }

    /// Returns the distance of a box's nearest corner along the normal.
    pub(crate) fn nearest(&self, min: DVec3, max: DVec3) -> f64 {
        self.farthest(max, min)
    }
}

/// A view frustum relative to the fit's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Corners, near then far, in the order of [`ViewFrustum::corners`].
    corners: [DVec3; 8],
    pub(crate) near: f64,
    pub(crate) far: f64,
    /// View depth of a point, as the signed distance from a plane.
    pub(crate) depth: Plane,
    /// Planes of the sides: top, right, bottom, left.
    pub(crate) sides: [Plane; 4],
}

impl View {
    /// Returns the view of a checked frustum. The view of an empty frustum holds no points.
    pub(crate) fn new(frustum: &ViewFrustum, origin: DVec3) -> Self {
        let offset = frustum.origin - origin;
        let corners = frustum.corners.map(|c| c.as_dvec3() + offset);
        let forward = frustum.forward.as_dvec3();
        let forward = forward / checks::length(forward);
        let (near, far) = (f64::from(frustum.near), f64::from(frustum.far));
        // Depths are measured from the near rectangle, which has the smallest rounding.
        let middle = (corners[0] + corners[2]) * 0.5;
        let depth = Plane { normal: forward, d: near - forward.dot(middle) };
        let centre = corners.iter().copied().sum::<DVec3>() * 0.125;
        if frustum.is_empty() {
            return Self { corners, near, far, depth, sides: [NOWHERE; 4] };
        }
        let mut sides = [depth; 4];
        for (i, side) in sides.iter_mut().enumerate() {
            let next = (i + 1) % 4;
            // The far rectangle is never smaller than the near one, so its side has the more precise
            // direction.
            let normal = (corners[i + 4] - corners[i]).cross(corners[next + 4] - corners[i + 4]);
            let normal = normal / checks::length(normal);
            let inward = if normal.dot(centre - corners[i + 4]) < 0.0 { -normal } else { normal };
            *side = Plane { normal: inward, d: -inward.dot(corners[i + 4]) };
        }
        Self { corners, near, far, depth, sides }
    }

    /// Returns the mapping of points to positions in the picture.
    pub(crate) fn picture(&self) -> Picture {
        // Sides 0 to 3 are top, right, bottom, left. Each distance is divided by the distance of the opposite
        // end of the far rectangle.
        let side = |side: usize, opposite: usize| (self.sides[side], self.sides[side].distance(self.corners[opposite]));
        Picture { axes: [[side(3, 5), side(1, 4)], [side(0, 7), side(2, 4)]] }
    }

    /// Returns the corners of the rectangle at a view depth. NaN for an empty view.
    pub(crate) fn rectangle(&self, depth: f64) -> [DVec3; 4] {
        let t = (depth - self.near) / (self.far - self.near);
        core::array::from_fn(|i| self.corners[i] * (1.0 - t) + self.corners[i + 4] * t)
    }

    /// Returns the part between two view depths, limited to the frustum.
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

    /// Returns the least and greatest view depth of a box that may touch the frustum, or `None` if it does
    /// not.
    pub(crate) fn depths(&self, min: DVec3, max: DVec3) -> Option<Depths> {
        if self.sides.iter().any(|plane| plane.farthest(min, max) < 0.0) {
            return None;
        }
        let flipped = Plane { normal: -self.depth.normal, d: -self.depth.d };
        let (near, far) = (-flipped.farthest(min, max), self.depth.farthest(min, max));
        if near > self.far || far < self.near { None } else { Some(Depths { near, far }) }
    }
}

/// The mapping of points to positions in the picture of a view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture {
    /// The planes of the sides at positions 0 and 1 of both axes, with the distances to divide by.
    axes: [[(Plane, f64); 2]; 2],
}

impl Picture {
    /// Returns the position of a point in the picture: 0..1 from left to right and from top to bottom. The
    /// point must not lie in front of the near plane.
    #[inline]
    pub(crate) fn position(&self, p: DVec3) -> [f64; 2] {
        self.axes.map(|[(one, most), (other, other_most)]| {
            let (a, b) = (one.distance(p) / most, other.distance(p) / other_most);
            a / (a + b)
        })
    }
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

/// Pairs of corners that an edge joins, for frusta and for boxes ([`box_corners`] has the same order).
pub(crate) const EDGES: [(usize, usize); 12] =
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)];

impl Slice {
    /// Calls `emit` for all vertices of box ∩ slice, for some more than once, and possibly for points on its
    /// edges. Makes no call if the intersection is empty.
    pub(crate) fn clip(&self, min: DVec3, max: DVec3, emit: &mut impl FnMut(DVec3)) {
        let mut crossed = [false; 6];
        for (plane, crossed) in self.planes.iter().zip(&mut crossed) {
            if plane.farthest(min, max) < 0.0 {
                return;
            }
            *crossed = plane.nearest(min, max) < 0.0;
        }
        let corners = box_corners(min, max);
        if crossed == [false; 6] {
            return corners.into_iter().for_each(emit);
        }
        self.clip_box(&corners, crossed, emit);
        // A slice edge meets only boxes that cross both of its planes.
        for ((i, j), (one, other)) in EDGES.into_iter().zip(PLANES_OF_EDGES) {
            if crossed[one]
                && crossed[other]
                && let Some((a, b)) = clip_to_box(self.corners[i], self.corners[j], min, max)
            {
                emit(a);
                emit(b);
            }
        }
    }

    /// Emits the corners of a box and the ends of its clipped edges, inside the planes that the box crosses.
    #[inline]
    fn clip_box(&self, corners: &[DVec3; 8], crossed: [bool; 6], emit: &mut impl FnMut(DVec3)) {
        // Distances of the corners from the planes, positive inside.
        let mut inside = [[0.0; 8]; 6];
        let mut count = 0;
        for (plane, _) in self.planes.iter().zip(crossed).filter(|(_, crossed)| *crossed) {
            inside[count] = corners.map(|corner| plane.distance(corner));
            count += 1;
        }
        let inside = &inside[..count];
        for (i, corner) in corners.iter().enumerate() {
            if inside.iter().all(|plane| plane[i] >= 0.0) {
                emit(*corner);
            }
        }
        for (i, j) in EDGES {
            let Some((enter, leave)) = inner_part(inside, i, j) else { continue };
            if enter > 0.0 {
                emit(at(corners[i], corners[j], enter));
            }
            if leave < 1.0 {
                emit(at(corners[i], corners[j], leave));
            }
        }
    }
}

/// The two planes of each of a slice's [edges](EDGES).
const PLANES_OF_EDGES: [(usize, usize); 12] =
    [(0, 4), (1, 4), (2, 4), (3, 4), (0, 5), (1, 5), (2, 5), (3, 5), (3, 0), (0, 1), (1, 2), (2, 3)];

/// Returns the range of an edge inside some planes, as shares of its length. `inside` has the distances of
/// all corners from each plane.
#[inline]
pub(crate) fn inner_part(inside: &[[f64; 8]], i: usize, j: usize) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for plane in inside {
        let (a, b) = (plane[i], plane[j]);
        if a < 0.0 && b < 0.0 {
            return None;
        }
        if a < 0.0 {
            enter = enter.max(a / (a - b));
        } else if b < 0.0 {
            leave = leave.min(a / (a - b));
        }
    }
    if enter > leave { None } else { Some((enter, leave)) }
}

/// Returns the point of a segment at a share of its length. Exact at both ends.
pub(crate) fn at(a: DVec3, b: DVec3, t: f64) -> DVec3 {
    a * (1.0 - t) + b * t
}

/// Returns the part of a segment inside a box.
pub(crate) fn clip_to_box(a: DVec3, b: DVec3, min: DVec3, max: DVec3) -> Option<(DVec3, DVec3)> {
    let (enter, leave) = crossing(a, b - a, min, max)?;
    Some((at(a, b, enter), at(a, b, leave)))
}

/// Returns the shares of a segment, given by its start and a vector, at its entry into a box and its exit.
#[inline]
pub(crate) fn crossing(start: DVec3, along: DVec3, min: DVec3, max: DVec3) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let (start, along) = (start[axis], along[axis]);
        if along == 0.0 {
            if start < min[axis] || start > max[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((min[axis] - start) / along, (max[axis] - start) / along);
        let (first, last) = if a < b { (a, b) } else { (b, a) };
        enter = if first > enter { first } else { enter };
        leave = if last < leave { last } else { leave };
    }
    if enter > leave { None } else { Some((enter, leave)) }
}

/// Number of rays across and down the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayCount {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl RayCount {
    /// Rays for maps that are read by view depth.
    pub(crate) const FINE: Self = Self { columns: 32, rows: 18 };
    /// Rays for maps that are read by coverage, with less influence of the splits.
    pub(crate) const COARSE: Self = Self { columns: 20, rows: 11 };
}

/// Returns the columns and rows of rays that may meet a box. All of them if a part of it lies in front of the
/// near plane.
pub(crate) fn covered(
    view: &View,
    picture: &Picture,
    count: RayCount,
    min: DVec3,
    max: DVec3,
) -> Option<(ops::Range<usize>, ops::Range<usize>)> {
    let corners = box_corners(min, max);
    if corners.into_iter().any(|corner| view.depth.distance(corner) < view.near) {
        return Some((0..count.columns, 0..count.rows));
    }
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for corner in corners {
        let position = picture.position(corner);
        for axis in 0..2 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let range = |axis: usize, count: usize| {
        let first = libm::ceil(low[axis] * count as f64 - 0.5).max(0.0);
        let last = libm::floor(high[axis] * count as f64 - 0.5).min(count as f64 - 1.0);
        if first > last { None } else { Some(first as usize..last as usize + 1) }
    };
    Some((range(0, count.columns)?, range(1, count.rows)?))
}
