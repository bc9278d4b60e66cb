//! Which depths are visible, estimated from the boxes alone: the nearest few boxes along each ray
//! of a coarse grid, each spread over the depths that the ray is in it.
//!
//! A box is not its surface, so this is an estimate; where it is wrong, maps are less sharp than
//! they could be, and nothing worse.

use glam::DVec3;

use super::bins::{BINS, Bins, CLASSES, Weights};
use crate::base::box_corners;
use crate::content::Content;
use crate::view::{Picture, View};

/// Rays across and down the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayCount {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

/// Most rays through a picture.
const MOST_RAYS: usize = RayCount::FINE.columns * RayCount::FINE.rows;

impl RayCount {
    /// For maps that are read by view depth.
    pub(crate) const FINE: Self = Self { columns: 32, rows: 18 };
    /// For maps that are read by coverage, whose splits matter less.
    pub(super) const COARSE: Self = Self { columns: 20, rows: 11 };
}

/// Boxes kept along each ray. A box is mostly air, so what is behind the first one may be seen.
const LAYERS: usize = 4;

/// Factor by which each further box counts less. Chosen together with the constants before and
/// after it on ten scenes: counting the first box alone gives bad splits where boxes are loose.
const FURTHER: f64 = 0.85;

/// Weight of the boxes that a ray begins in, which may hold a surface anywhere up to their ends.
const AROUND: f64 = 1.0 / 3.0;

/// Shares of the rays that first meet a box in each bin; equal shares where no box is known.
pub(super) fn weights(content: &Content, bins: &Bins, rays: RayCount) -> Weights {
    let mut spread = Spread::new(bins);
    for (view_index, view) in content.views().enumerate() {
        let mut grid = Grid::new(&view, rays);
        content.each_receiver(view_index, |depths, min, max| grid.meet(&view, bins, depths.0, min, max));
        for ray in &grid.rays[..rays.columns * rays.rows] {
            let mut weight = 1.0;
            for (enter, leave) in ray.layers.into_iter().filter(|layer| layer.0 < NOWHERE) {
                spread.add(enter, leave, weight);
                weight *= FURTHER;
            }
            if ray.around < NOWHERE {
                spread.add(0, ray.around, weight * AROUND);
            }
        }
    }
    spread.shares()
}

/// Room for the rounding of shares of a ray.
const ROUNDING: f64 = 1e-9;

/// Marks the absence of a bin.
const NOWHERE: u8 = u8::MAX;

/// What a ray meets.
#[derive(Clone, Copy)]
struct Ray {
    /// From the near to the far plane.
    start: DVec3,
    along: DVec3,
    /// Bins of the view depths at which it enters and leaves the nearest boxes.
    layers: [(u8, u8); LAYERS],
    /// Shares of the ray at which it enters these boxes.
    enters: [f64; LAYERS],
    /// Bin of the view depth at which it leaves the boxes that it begins in.
    around: u8,
}

impl Ray {
    fn new(start: DVec3, end: DVec3) -> Self {
        let (layers, enters) = ([(NOWHERE, NOWHERE); LAYERS], [f64::MAX; LAYERS]);
        Self { start, along: end - start, layers, enters, around: NOWHERE }
    }

    /// Adds a box that it enters and leaves at these shares.
    fn add(&mut self, (mut enter, leave): (f64, f64), bin: impl Fn(f64) -> u8) {
        if enter <= 0.0 {
            // The farther of two ends; there is none yet at first.
            let leave = bin(leave);
            self.around = if self.around == NOWHERE { leave } else { self.around.max(leave) };
            return;
        }
        if enter >= self.enters[LAYERS - 1] {
            return;
        }
        let mut layer = (bin(enter), bin(leave));
        for (kept, kept_enter) in self.layers.iter_mut().zip(&mut self.enters) {
            if layer.0 < kept.0 {
                core::mem::swap(&mut layer, kept);
                core::mem::swap(&mut enter, kept_enter);
            }
        }
    }
}

/// Shares of a ray, from its start along a vector, at which it enters and leaves a box.
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

/// Weights spread over bins.
struct Spread {
    /// View depths at which the bins begin and the last one ends, in metres.
    starts: [f64; BINS + 1],
    /// Lengths of the bins, in metres.
    lengths: [f64; BINS],
    weights: [f64; BINS],
    /// Number of bins.
    count: usize,
}

impl Spread {
    fn new(bins: &Bins) -> Self {
        let starts: [f64; BINS + 1] = core::array::from_fn(|bin| bins.start(bin));
        let lengths = core::array::from_fn(|bin| starts[bin + 1] - starts[bin]);
        Self { starts, lengths, weights: [0.0; BINS], count: bins.count }
    }

    /// Adds a weight, evenly over the depths of a range of bins.
    fn add(&mut self, first: u8, last: u8, weight: f64) {
        let (first, last) = (usize::from(first), usize::from(last));
        let per_metre = weight / (self.starts[last + 1] - self.starts[first]);
        if per_metre.is_finite() {
            for (weight, length) in self.weights[first..=last].iter_mut().zip(&self.lengths[first..=last]) {
                *weight += per_metre * length;
            }
        } else {
            // Depths that are too close to distinguish.
            self.weights[first] += weight;
        }
    }

    /// The weights as shares; equal ones where there are none.
    fn shares(&self) -> Weights {
        let total: f64 = self.weights.iter().sum();
        let mut shares = [[0.0; CLASSES]; BINS];
        for (share, weight) in shares.iter_mut().zip(&self.weights).take(self.count) {
            // Boxes say nothing about slopes, so all are of the first class.
            share[0] = if total == 0.0 { 1.0 / self.count as f64 } else { weight / total };
        }
        shares
    }
}

/// Rays through a picture, from its near to its far rectangle, row by row.
struct Grid {
    rays: [Ray; MOST_RAYS],
    count: RayCount,
    picture: Picture,
    near: f64,
    depth: f64,
}

impl Grid {
    #[expect(clippy::large_stack_arrays, reason = "56 KiB, for the time that it takes to look around")]
    fn new(view: &View, count: RayCount) -> Self {
        let whole = view.slice(view.near, view.far);
        let corners = |i: usize| [whole.corners[i], whole.corners[i + 1], whole.corners[i + 2], whole.corners[i + 3]];
        let (start, end) = (corners(0), corners(4));
        let mut rays = [Ray::new(DVec3::ZERO, DVec3::ZERO); MOST_RAYS];
        for (row, rays) in rays.chunks_exact_mut(count.columns).enumerate().take(count.rows) {
            let [first, last] = ends_of_row(&start, &end, row, count);
            let step = 1.0 / (count.columns - 1) as f64;
            let (start_step, end_step) = ((last.0 - first.0) * step, (last.1 - first.1) * step);
            for (column, ray) in rays.iter_mut().enumerate() {
                let x = column as f64;
                *ray = Ray::new(first.0 + start_step * x, first.1 + end_step * x);
            }
        }
        Self { rays, count, picture: view.picture(), near: view.near, depth: view.far - view.near }
    }

    /// Intersects all rays with a box that begins at a view depth.
    fn meet(&mut self, view: &View, bins: &Bins, nearest: f64, min: DVec3, max: DVec3) {
        let Some((columns, rows)) = covered(view, &self.picture, self.count, min, max) else { return };
        let bin = |t: f64| bins.of(self.near + self.depth * t) as u8;
        // Shares of a ray are those of the view depth.
        let nearest = (nearest - self.near) / self.depth - ROUNDING;
        for row in rows {
            for ray in &mut self.rays[row * self.count.columns..][columns.clone()] {
                if nearest < ray.enters[LAYERS - 1]
                    && let Some(crossing) = crossing(ray.start, ray.along, min, max)
                {
                    ray.add(crossing, bin);
                }
            }
        }
    }
}

/// The first and the last ray of a row, each from its start to its end.
fn ends_of_row(start: &[DVec3; 4], end: &[DVec3; 4], row: usize, count: RayCount) -> [(DVec3, DVec3); 2] {
    let y = (row as f64 + 0.5) / count.rows as f64;
    // Left-top, right-top, right-bottom, left-bottom.
    let at = |top: usize, bottom: usize| {
        let lerp = |c: &[DVec3; 4]| c[top] * (1.0 - y) + c[bottom] * y;
        (lerp(start), lerp(end))
    };
    let (left, right) = (at(0, 3), at(1, 2));
    let half = 0.5 / count.columns as f64;
    let between = |x: f64| (left.0 * (1.0 - x) + right.0 * x, left.1 * (1.0 - x) + right.1 * x);
    [between(half), between(1.0 - half)]
}

/// Columns and rows of rays that may meet a box; all of them where it reaches before the near
/// plane.
pub(crate) fn covered(
    view: &View,
    picture: &Picture,
    count: RayCount,
    min: DVec3,
    max: DVec3,
) -> Option<(core::ops::Range<usize>, core::ops::Range<usize>)> {
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
