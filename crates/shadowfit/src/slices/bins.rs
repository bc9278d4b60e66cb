//! Bins of view depth, and what is visible in each: by a histogram of an earlier frame, or estimated from the boxes.
//!
//! The estimate looks at the nearest few boxes along each ray of a coarse grid, each spread over the depths that the
//! ray is in it. A box is not its surface; where the estimate is wrong, maps are less sharp than they could be, and
//! nothing worse.

use glam::DVec3;

use crate::content::{Bounds, Content, Found, Query, Visit};
use crate::demand::histogram::DepthHistogram;
use crate::technique::settings::MAX_MAPS;
use crate::view::{Picture, RayCount, View, covered, crossing};

/// Splits of all maps, in metres of view depth: map i covers `splits[i]..splits[i + 1]`.
pub(crate) type Splits = [f32; MAX_MAPS + 1];

/// Most bins of log view depth that the content is sorted into.
pub(crate) const BINS: usize = 64;

/// Bins of equal size in log view depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    /// Their number, at most [`BINS`].
    pub(super) count: usize,
    pub(super) near: f64,
    pub(super) far: f64,
    pub(super) log_near: f64,
    pub(super) log_step: f64,
    /// Bins in an octave.
    per_log: f64,
}

impl Bins {
    pub(super) fn new(near: f64, far: f64, count: usize) -> Self {
        let (log_near, log_far) = (libm::log2(near), libm::log2(far));
        let log_step = (log_far - log_near) / count as f64;
        Self { count, near, far, log_near, log_step, per_log: 1.0 / log_step }
    }

    /// View depth at which a bin begins, in metres.
    pub(super) fn start(&self, bin: usize) -> f64 {
        match bin {
            0 => self.near,
            _ if bin >= self.count => self.far,
            _ => libm::exp2(self.log_near + self.log_step * bin as f64),
        }
    }

    /// The bin whose beginning is nearest to a view depth.
    pub(super) fn nearest(&self, depth: f64) -> usize {
        let bin = (libm::log2(depth.max(self.near)) - self.log_near) / self.log_step;
        (libm::round(bin) as usize).min(self.count)
    }

    /// The bin of a view depth; depths outside go to the first or the last.
    #[inline]
    pub(super) fn of(&self, depth: f64) -> usize {
        let depth = depth.max(self.near);
        // Away from the beginning of a bin an approximation tells as much.
        let bin = (approximate_log2(depth) - self.log_near) * self.per_log;
        let error = APPROXIMATE * self.per_log;
        let (low, high) = ((bin - error) as usize, (bin + error) as usize);
        let bin = if low == high { low } else { self.exactly(depth) };
        bin.min(self.count - 1)
    }

    #[cold]
    fn exactly(&self, depth: f64) -> usize {
        ((libm::log2(depth) - self.log_near) / self.log_step) as usize
    }
}

/// log2 of a positive normal number rounded to f32: that of libm, which is only asked where an approximation
/// does not tell how it rounds.
#[inline]
pub(super) fn log2(x: f64) -> f32 {
    let near = approximate_log2(x);
    let (low, high) = ((near - APPROXIMATE) as f32, (near + APPROXIMATE) as f32);
    if low == high { low } else { libm::log2(x) as f32 }
}

/// Greatest error of [`approximate_log2`], in octaves.
const APPROXIMATE: f64 = 1e-11;

/// log2 of a positive normal number: exponent, and the first terms of the series of artanh for the rest, which
/// lies within √½..√2.
#[inline]
fn approximate_log2(x: f64) -> f64 {
    const MANTISSA: u64 = (1 << 52) - 1;
    const TWO_BY_LN_2: f64 = 2.0 * core::f64::consts::LOG2_E;
    let bits = x.to_bits();
    let (exponent, mantissa) = ((bits >> 52) as i32 - 1023, f64::from_bits(bits & MANTISSA | 1.0_f64.to_bits()));
    let is_high = mantissa > core::f64::consts::SQRT_2;
    let (octave, rest) = if is_high { (exponent + 1, mantissa * 0.5) } else { (exponent, mantissa) };
    let s = (rest - 1.0) / (rest + 1.0);
    let q = s * s;
    let series = SERIES.iter().rev().fold(0.0, |sum, term| sum * q + term);
    f64::from(octave) + TWO_BY_LN_2 * s * series
}

/// Terms of artanh(s) / s by powers of s²; the next one is below the error that is allowed.
const SERIES: [f64; 7] = [1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0];

/// Classes of foreshortening, an octave each: the first holds surfaces that face both the eye and
/// the light, the others those that need texels half as wide, a quarter, and so on.
pub(crate) const CLASSES: usize = 6;

/// Shares of the visible points in each bin and class.
pub(crate) type Weights = [[f64; CLASSES]; BINS];

/// Equal weights for all depths of surfaces that face the light.
pub(crate) fn even(bins: &Bins) -> Weights {
    let mut weights = [[0.0; CLASSES]; BINS];
    for classes in &mut weights[..bins.count] {
        classes[0] = 1.0 / bins.count as f64;
    }
    weights
}

/// The counts as shares, resampled to other bins.
pub(super) fn weights_of_histogram(histogram: &DepthHistogram, bins: &Bins) -> Weights {
    let mut weights = [[0.0; CLASSES]; BINS];
    let (near, far) = (f64::from(histogram.near), f64::from(histogram.far));
    let depths = histogram.bins.len() / histogram.classes;
    let step = libm::log2(far / near) / depths as f64;
    let total: f64 = histogram.bins.iter().map(|count| f64::from(*count)).sum();
    for (i, count) in histogram.bins.iter().enumerate().filter(|(_, count)| **count > 0) {
        let class = (i / depths).min(CLASSES - 1);
        for part in 0..PARTS {
            let middle = (i % depths) as f64 + (f64::from(part) + 0.5) / f64::from(PARTS);
            let depth = near * libm::exp2(step * middle);
            weights[bins.of(depth)][class] += f64::from(*count) / (total * f64::from(PARTS));
        }
    }
    weights
}

/// Parts that each bin is divided into, to be spread.
const PARTS: u32 = 4;

/// Most rays through a picture.
const MOST_RAYS: usize = RayCount::FINE.columns * RayCount::FINE.rows;

/// Boxes kept along each ray. A box is mostly air, so what is behind the first one may be seen.
const LAYERS: usize = 4;

/// Factor by which each further box counts less. Chosen together with the constants before and
/// after it on ten scenes: counting the first box alone gives bad splits where boxes are loose.
const FURTHER: f64 = 0.85;

/// Weight of the boxes that a ray begins in, which may hold a surface anywhere up to their ends.
const AROUND: f64 = 1.0 / 3.0;

/// Shares of the rays that first meet a box in each bin; equal shares where no box is known.
pub(super) fn weights_of_boxes(content: &Content, bins: &Bins, rays: RayCount) -> Weights {
    let mut spread = Spread::new(bins);
    for part in content.whole_views() {
        let mut grid = Grid::new(&part.view, bins, rays);
        content.visit(Query::Lit(&part), &mut grid);
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
const RAY_ROUNDING: f64 = 1e-9;

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
    fn add(&mut self, mut enter: f64, leave: f64, bin: impl Fn(f64) -> u8) {
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
struct Grid<'a> {
    rays: [Ray; MOST_RAYS],
    count: RayCount,
    view: &'a View,
    picture: Picture,
    bins: &'a Bins,
    near: f64,
    depth: f64,
}

impl<'a> Grid<'a> {
    #[expect(clippy::large_stack_arrays, reason = "56 KiB, for the time that it takes to look around")]
    fn new(view: &'a View, bins: &'a Bins, count: RayCount) -> Self {
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
        Self { rays, count, view, picture: view.picture(), bins, near: view.near, depth: view.far - view.near }
    }
}

impl Visit for Grid<'_> {
    /// Returns whether a box may be among the nearest ones along a ray.
    fn wants(&self, bounds: &Bounds) -> bool {
        let covered = covered(self.view, &self.picture, self.count, bounds.min, bounds.max);
        let Some((columns, rows)) = covered else { return false };
        let nearest = (bounds.depths.near - self.near) / self.depth - RAY_ROUNDING;
        let mut rays = rows.flat_map(|row| &self.rays[row * self.count.columns..][columns.clone()]);
        rays.any(|ray| nearest < ray.enters[LAYERS - 1])
    }

    /// Intersects all rays with a box.
    fn take(&mut self, Found { bounds: Bounds { min, max, depths }, .. }: &Found) {
        let covered = covered(self.view, &self.picture, self.count, *min, *max);
        let Some((columns, rows)) = covered else { return };
        let bin = |t: f64| self.bins.of(self.near + self.depth * t) as u8;
        // Shares of a ray are those of the view depth.
        let nearest = (depths.near - self.near) / self.depth - RAY_ROUNDING;
        for row in rows {
            for ray in &mut self.rays[row * self.count.columns..][columns.clone()] {
                if nearest < ray.enters[LAYERS - 1]
                    && let Some((enter, leave)) = crossing(ray.start, ray.along, *min, *max)
                {
                    ray.add(enter, leave, bin);
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
