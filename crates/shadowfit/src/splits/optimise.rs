//! The cuts with the least 95% quantile of pixels per texel.
//!
//! A point at view depth z in a map of width S sees S / (resolution · z · pixel angle) pixels per
//! texel, so for a bound T on S / z each run of bins leaves those points over the bound that lie
//! nearer than S / T. Which cuts leave the fewest is found exactly by dynamic programming over
//! the bins (R. Bellman, "On the approximation of curves by line segments using dynamic
//! programming", 1961); the least T that leaves 5% at most by bisection.

use super::extents::Sizes;
use super::{BINS, Bins, CLASSES, Weights};
use crate::MAX_CASCADES;

/// Share of the points that may lie over the bound.
const OVER: f64 = 0.05;

/// Bisection steps, each halving the 24 octaves that are searched.
const STEPS: usize = 14;

/// How much a point's log2 error counts beside its being over the bound or not: enough to choose
/// between cuts that leave equally many over it.
const MEAN: f64 = 0.01;

/// Bins at which the maps begin; the last one's end follows.
pub(super) struct Cuts {
    pub(super) bins: [usize; MAX_CASCADES + 1],
    /// The bound that was reached: log2 of map width per view depth.
    pub(super) quality: f64,
}

/// The best cuts into `count` maps.
pub(super) fn least_quantile(bins: &Bins, weights: &Weights, sizes: &Sizes, count: usize) -> Cuts {
    let search = Search::new(bins, weights, sizes);
    let (mut low, mut high) = (-12.0, 12.0);
    for _ in 0..STEPS {
        let bound = (low + high) * 0.5;
        if search.best(count, bound, 0.0).1 <= OVER {
            high = bound;
        } else {
            low = bound;
        }
    }
    Cuts { bins: search.best(count, high, MEAN).0, quality: high }
}

/// The bound that given cuts reach.
pub(super) fn quantile(bins: &Bins, weights: &Weights, sizes: &Sizes, cuts: &[usize]) -> f64 {
    let search = Search::new(bins, weights, sizes);
    let over = |bound: f64| -> f64 {
        cuts.windows(2).filter(|run| run[0] < run[1]).map(|run| search.cost(run[0], run[1], bound, 0.0)).sum()
    };
    let (mut low, mut high) = (-12.0, 12.0);
    for _ in 0..STEPS {
        let bound = (low + high) * 0.5;
        if over(bound) <= OVER { high = bound } else { low = bound }
    }
    high
}

struct Search<'a> {
    bins: &'a Bins,
    sizes: &'a Sizes,
    /// Weight of all bins before each, by class.
    before: [[f64; CLASSES]; BINS + 1],
    /// Weight of all bins before each, and weight times log2 of the depth that needs such texels.
    log_before: [[f64; 2]; BINS + 1],
}

impl<'a> Search<'a> {
    fn new(bins: &'a Bins, weights: &Weights, sizes: &'a Sizes) -> Self {
        let (mut before, mut log_before) = ([[0.0; CLASSES]; BINS + 1], [[0.0; 2]; BINS + 1]);
        for (i, classes) in weights.iter().enumerate() {
            let log_depth = bins.log_near + bins.log_step * (i as f64 + 0.5);
            log_before[i + 1] = log_before[i];
            for (class, weight) in classes.iter().enumerate() {
                before[i + 1][class] = before[i][class] + weight;
                log_before[i + 1][0] += weight;
                log_before[i + 1][1] += weight * (log_depth - class as f64);
            }
        }
        Self { bins, sizes, before, log_before }
    }

    /// Weight of the points of a run that lie over the bound, and `mean` times their log2 error.
    fn cost(&self, first: usize, end: usize, bound: f64, mean: f64) -> f64 {
        let log_size = f64::from(self.sizes.log_extent(first, end));
        // Points nearer than this, in bins, are over the bound; those of later classes farther out.
        let over = (log_size - bound - self.bins.log_near) / self.bins.log_step;
        let mut weight = 0.0;
        for class in 0..CLASSES {
            let over = (over + class as f64 / self.bins.log_step).max(first as f64).min(end as f64);
            let whole = over as usize;
            let (at, next) = (self.before[whole][class], self.before[(whole + 1).min(BINS)][class]);
            weight += at + (next - at) * (over - whole as f64) - self.before[first][class];
        }
        let [[w0, d0], [w1, d1]] = [self.log_before[first], self.log_before[end]];
        weight + mean * (log_size * (w1 - w0) - (d1 - d0))
    }

    /// The cuts of least cost, and that cost.
    fn best(&self, count: usize, bound: f64, mean: f64) -> ([usize; MAX_CASCADES + 1], f64) {
        let mut cost = [f64::MAX; BINS + 1];
        cost[0] = 0.0;
        let mut from = [[0_u8; BINS + 1]; MAX_CASCADES];
        for (map, from) in from.iter_mut().enumerate().take(count) {
            let mut next = [f64::MAX; BINS + 1];
            for end in map + 1..=BINS {
                for first in map..end {
                    if cost[first] < f64::MAX {
                        let total = cost[first] + self.cost(first, end, bound, mean);
                        if total < next[end] {
                            (next[end], from[end]) = (total, first as u8);
                        }
                    }
                }
            }
            cost = next;
        }
        let mut cuts = [BINS; MAX_CASCADES + 1];
        let mut end = BINS;
        for map in (0..count).rev() {
            end = usize::from(from[map][end]);
            cuts[map] = end;
        }
        (cuts, cost[BINS])
    }
}
