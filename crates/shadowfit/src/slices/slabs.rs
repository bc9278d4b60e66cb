//! What a box shows of itself in each bin of view depth: the corners of (box ∩ view ∩ bin), for all bins
//! in one pass over the box.
//!
//! Neighbouring bins share the plane between them, so each point on it is found once, for both:
//!
//! ```text
//!    bin 0   bin 1     bin 2
//!  │   ┌───┼───────┼────────┐   ●  the box's corners, in one bin
//!  │   ●   ○       ○        ●   ○  its edges at the planes, for the bins on both sides
//!  │   └───┼───────┼────────┘
//! ```

use core::ops::Range;

use glam::DVec3;

use super::bins::{BINS, Bins};
use crate::base::box_corners;
use crate::view::{EDGES, Plane, View, at, clip_to_box, inner_part};

/// The planes between the bins, as one view has them.
pub(super) struct Slabs {
    depth: Plane,
    sides: [Plane; 4],
    /// View depths of the planes in metres, within the view's own.
    pub(super) depths: [f64; BINS + 1],
    /// Corners of the view's cross-section at each plane.
    rectangles: [[DVec3; 4]; BINS + 1],
    /// The bins that hold a part of the view.
    filled: Range<usize>,
}

/// A box in the bins that it may reach into.
struct Body<'a> {
    corners: [DVec3; 8],
    min: DVec3,
    max: DVec3,
    /// Whether it crosses each side of the view.
    crossed: [bool; 4],
    /// Distances of the corners within the sides that are crossed.
    inside: [[f64; 8]; 4],
    /// Number of those sides.
    sides: usize,
    /// View depths of the corners, up to a constant.
    along: [f64; 8],
    /// Bins of the corners, one more than their index: 0 lies before all bins.
    bins: [usize; 8],
    slabs: &'a Slabs,
}

impl Slabs {
    pub(super) fn new(view: &View, bins: &Bins) -> Self {
        let depths = core::array::from_fn(|bin| f64::from(bins.start(bin) as f32).max(view.near).min(view.far));
        let is_filled = |bin: &usize| depths[*bin] < depths[bin + 1];
        let first = (0..BINS).find(is_filled).unwrap_or(BINS);
        let filled = first..(first..BINS).rev().find(is_filled).map_or(first, |last| last + 1);
        let rectangles = depths.map(|depth| view.rectangle(depth));
        Self { depth: view.depth, sides: view.sides, depths, rectangles, filled }
    }

    /// The bins that a range of view depths may reach into.
    pub(super) fn reached(&self, (near, far): (f64, f64)) -> Range<usize> {
        let first = self.depths[1..].partition_point(|plane| *plane < near);
        let end = self.depths[..BINS].partition_point(|plane| *plane <= far);
        first.max(self.filled.start)..end.min(self.filled.end)
    }

    /// Gives the corners of (box ∩ view) in each of the bins `reached`, each with the bins that it belongs to.
    /// The box must not lie outside a side of the view.
    pub(super) fn clip(
        &self,
        min: DVec3,
        max: DVec3,
        reached: &Range<usize>,
        mut emit: impl FnMut(Range<usize>, DVec3),
    ) {
        let body = Body::new(self, min, max, reached);
        body.add_corners(&mut emit);
        for (i, j) in EDGES {
            body.add_edge(i, j, &mut emit);
        }
        if body.crossed != [false; 4] {
            body.add_view(reached, &mut emit);
        }
    }

    /// Distance beyond a plane, for what [`Body::along`] has.
    fn beyond(&self, plane: usize, along: f64) -> f64 {
        along + (self.depth.d - self.depths[plane])
    }

    /// One more than the bin of a point.
    fn bin(&self, along: f64, reached: &Range<usize>) -> usize {
        let planes = &self.depths[reached.start..=reached.end];
        reached.start + planes.partition_point(|depth| along + (self.depth.d - depth) >= 0.0)
    }
}

impl<'a> Body<'a> {
    fn new(slabs: &'a Slabs, min: DVec3, max: DVec3, reached: &Range<usize>) -> Self {
        let corners = box_corners(min, max);
        let (mut inside, mut crossed, mut sides) = ([[0.0; 8]; 4], [false; 4], 0);
        for (side, crossed) in slabs.sides.iter().zip(&mut crossed) {
            *crossed = side.nearest(min, max) < 0.0;
            if *crossed {
                inside[sides] = corners.map(|corner| side.distance(corner));
                sides += 1;
            }
        }
        let along = corners.map(|corner| slabs.depth.normal.dot(corner));
        let bins = along.map(|along| slabs.bin(along, reached));
        Self { corners, min, max, crossed, inside, sides, along, bins, slabs }
    }

    /// Distances of the corners within the sides that are crossed.
    fn inside(&self) -> &[[f64; 8]] {
        &self.inside[..self.sides]
    }

    /// The box's own corners.
    fn add_corners(&self, emit: &mut impl FnMut(Range<usize>, DVec3)) {
        for (i, corner) in self.corners.into_iter().enumerate() {
            if self.inside().iter().all(|side| side[i] >= 0.0) {
                emit(self.bins[i]..self.bins[i] + 1, corner);
            }
        }
    }

    /// Where one of its edges crosses the sides and the planes.
    fn add_edge(&self, i: usize, j: usize, emit: &mut impl FnMut(Range<usize>, DVec3)) {
        let Some((enter, leave)) = inner_part(self.inside(), i, j) else { return };
        let (a, b) = (self.corners[i], self.corners[j]);
        let (first, last) = (self.bins[i].min(self.bins[j]), self.bins[i].max(self.bins[j]));
        for plane in first..last {
            let (da, db) = (self.slabs.beyond(plane, self.along[i]), self.slabs.beyond(plane, self.along[j]));
            let t = da / (da - db);
            if t >= enter && t <= leave {
                emit(plane..plane + 2, at(a, b, t));
            }
        }
        for t in [enter, leave] {
            if t > 0.0 && t < 1.0 {
                let p = at(a, b, t);
                let along = self.slabs.depth.normal.dot(p);
                let bin = (first..last).find(|plane| self.slabs.beyond(*plane, along) < 0.0).unwrap_or(last);
                emit(bin..bin + 1, p);
            }
        }
    }

    /// Where the view's own edges and those of its cross-sections cross the box.
    fn add_view(&self, reached: &Range<usize>, emit: &mut impl FnMut(Range<usize>, DVec3)) {
        let mut add = |bins: Range<usize>, a: DVec3, b: DVec3| {
            if let Some((a, b)) = clip_to_box(a, b, self.min, self.max) {
                emit(bins.clone(), a);
                emit(bins, b);
            }
        };
        let rectangles = &self.slabs.rectangles;
        let crossed_by = |side: usize| self.crossed[side % 4];
        let planes = self.bins.into_iter().fold((usize::MAX, 0), |(a, b), bin| (a.min(bin), b.max(bin)));
        for side in (0..4).filter(|side| crossed_by(*side)) {
            for (plane, rectangle) in rectangles.iter().enumerate().take(planes.1).skip(planes.0) {
                add(plane..plane + 2, rectangle[side], rectangle[(side + 1) % 4]);
            }
            // A corner of the view's cross-sections lies on the side of its number and on that before.
            for bin in reached.clone().filter(|_| crossed_by(side + 3)) {
                add(bin + 1..bin + 2, rectangles[bin][side], rectangles[bin + 1][side]);
            }
        }
    }
}
