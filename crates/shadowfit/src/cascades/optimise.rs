//! The splits with the least 95% quantile of pixels per texel.
//!
//! A point at view depth z in a map of width S has S / (resolution · z · pixel angle) pixels per texel. For a
//! bound T on S / z, the points of a run of bins that are nearer than S / T exceed the bound. Dynamic
//! programming over the bins finds exactly the splits with the fewest such points (R. Bellman, "On the
//! approximation of curves by line segments using dynamic programming", 1961). Bisection finds the least T
//! that at most 5% of the points exceed.

use super::bins::{BINS, Bins, CLASSES, Weights};
use super::extents::Sizes;
use crate::technique::settings::MAX_MAPS;

/// Share of the points that may exceed the bound.
const OVER: f64 = 0.05;

/// Octaves below the bound of logarithmic splits that are searched for a better one. No case was found to
/// gain that much.
const OCTAVES: f64 = 4.0;

/// Bisection steps, each of which halves the interval.
const STEPS: usize = 9;

/// Weight of a point's log2 error relative to whether it exceeds the bound. It is enough to choose between
/// splits with equally many points over the bound.
const MEAN: f64 = 0.01;

/// Octaves that each class shifts the needed texel size: half of the octaves that its surfaces need. They are
/// usually foreshortened along one direction only, and the longer side of a map, which is its size here, lies
/// along another one about half of the time. Chosen on ten scenes, where 0, 0.7 and 1 are all worse.
const PER_CLASS: f64 = 0.5;

/// Returns the bins at which the best splits into `count` maps begin, then the end of the last map.
pub(super) fn best(bins: &Bins, weights: &Weights, sizes: &Sizes, count: usize) -> [usize; MAX_MAPS + 1] {
    let search = Search::new(bins, weights, sizes);
    search.best(count, search.least_bound(count, None))
}

/// Returns whether the bound of given splits is at most `max_oversize` times the bound of the best ones.
pub(super) fn is_near_best(bins: &Bins, weights: &Weights, sizes: &Sizes, splits: &[usize], max_oversize: f64) -> bool {
    let search = Search::new(bins, weights, sizes);
    let least = search.quantile(splits) - libm::log2(max_oversize);
    search.least_bound(splits.len() - 1, Some(least)) >= least
}

/// Returns the smallest number of maps whose best splits reach a bound `max_oversize` times the bound of
/// `count` maps.
pub(super) fn fewest(bins: &Bins, weights: &Weights, sizes: &Sizes, count: usize, max_oversize: f64) -> usize {
    let search = Search::new(bins, weights, sizes);
    let bound = search.least_bound(count, None) + libm::log2(max_oversize);
    (1..count).find(|fewer| search.is_feasible(*fewer, bound)).unwrap_or(count)
}

/// Bisects for the least number above which a condition holds, between a number where it may not hold and one
/// where it does. Stops once it is clear on which side of `enough` the result lies.
fn bisect(low: f64, high: f64, enough: Option<f64>, mut holds: impl FnMut(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    for _ in 0..STEPS {
        if enough.is_some_and(|enough| low >= enough || high < enough) {
            break;
        }
        let middle = (low + high) * 0.5;
        if holds(middle) { high = middle } else { low = middle }
    }
    high
}

struct Search<'a> {
    bins: &'a Bins,
    sizes: &'a Sizes,
    /// Weight of all bins before each one, by class.
    before: [[f64; CLASSES]; BINS + 1],
    /// Weight of all bins before each one, and weight times log2 of the depth that needs the texels of its
    /// class.
    log_before: [[f64; 2]; BINS + 1],
    /// Number of classes that are not empty.
    classes: usize,
    /// Bins that each class shifts the needed texel size.
    shifts: [f64; CLASSES],
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
                log_before[i + 1][1] += weight * (log_depth - PER_CLASS * class as f64);
            }
        }
        let classes = (0..CLASSES).rev().find(|class| before[BINS][*class] > 0.0).map_or(0, |last| last + 1);
        let shifts = core::array::from_fn(|class| PER_CLASS * class as f64 / bins.log_step);
        Self { bins, sizes, before, log_before, classes, shifts }
    }

    /// Computes the bound that given splits reach.
    fn quantile(&self, splits: &[usize]) -> f64 {
        let runs = || splits.windows(2).filter(|run| run[0] < run[1]).map(|run| (run[0], run[1]));
        // At this bound no point is over it, even in the largest map, at the nearest depth and in the last
        // class.
        let largest = runs().map(|(first, end)| self.sizes.log_extent(first, end)).fold(f32::MIN, f32::max);
        let high = f64::from(largest) - self.bins.log_near + PER_CLASS * CLASSES as f64;
        let over = |bound: f64| runs().map(|(first, end)| self.over(first, end, bound)).sum::<f64>();
        // The second bisection refines the last interval, to be at least as precise as the search.
        let coarse = bisect(high - WIDEST, high, None, |bound| over(bound) <= OVER);
        bisect(coarse - WIDEST / f64::from(1_u32 << STEPS), coarse, None, |bound| over(bound) <= OVER)
    }

    /// Returns the least bound that splits into `count` maps reach, [only as precisely](bisect) as `enough`
    /// needs.
    fn least_bound(&self, count: usize, enough: Option<f64>) -> f64 {
        let even: [usize; MAX_MAPS + 1] = core::array::from_fn(|i| self.bins.count * i.min(count) / count);
        let known = self.quantile(&even[..=count]);
        bisect(known - OCTAVES, known, enough, |bound| self.is_feasible(count, bound))
    }

    /// Returns the weight of a run's points over the bound. It grows with the run.
    fn over(&self, first: usize, end: usize, bound: f64) -> f64 {
        let log_size = f64::from(self.sizes.log_extent(first, end));
        // Points nearer than this, in bins, are over the bound. For later classes the limit is farther out.
        let over = (log_size - bound - self.bins.log_near) / self.bins.log_step;
        let mut weight = 0.0;
        for class in 0..self.classes {
            let over = (over + self.shifts[class]).max(first as f64).min(end as f64);
            let whole = over as i32 as usize;
            let (at, next) = (self.before[whole][class], self.before[(whole + 1).min(BINS)][class]);
            weight += at + (next - at) * (over - whole as f64) - self.before[first][class];
        }
        weight
    }

    /// Sums the weight of a run's points times their log2 of pixels per texel, up to a constant.
    fn error(&self, first: usize, end: usize) -> f64 {
        let [[w0, d0], [w1, d1]] = [self.log_before[first], self.log_before[end]];
        f64::from(self.sizes.log_extent(first, end)) * (w1 - w0) - (d1 - d0)
    }

    /// Returns whether any splits leave at most the allowed share over a bound.
    fn is_feasible(&self, count: usize, bound: f64) -> bool {
        let bins = self.bins.count;
        // Indexed by the number of maps and the bin at which they end.
        let mut least = [[f64::MAX; BINS + 1]; MAX_MAPS + 1];
        least[0][0] = 0.0;
        for first in 0..bins {
            // Weights of the runs from here, each computed at first use.
            let (mut over, mut known) = ([0.0; BINS + 1], first);
            for map in 0..count {
                let before = least[map][first];
                if before > OVER {
                    continue;
                }
                for (end, least) in least[map + 1].iter_mut().enumerate().take(bins + 1).skip(first + 1) {
                    if end > known {
                        (over[end], known) = (self.over(first, end, bound), end);
                    }
                    let total = before + over[end];
                    if total > OVER {
                        break;
                    }
                    *least = least.min(total);
                }
            }
        }
        least[count][bins] <= OVER
    }

    /// Returns the splits with the least weight over the bound and, among those, the least error.
    fn best(&self, count: usize, bound: f64) -> [usize; MAX_MAPS + 1] {
        let bins = self.bins.count;
        // Indexed by the number of maps and the bin at which they end, with the bin at which the last one
        // begins.
        let mut least = [[(f64::MAX, 0); BINS + 1]; MAX_MAPS + 1];
        least[0][0].0 = 0.0;
        for first in 0..bins {
            for end in first + 1..=bins {
                let (over, error) = (self.over(first, end, bound), MEAN * self.error(first, end));
                for map in 0..count {
                    let total = least[map][first].0 + over + error;
                    if total < least[map + 1][end].0 {
                        least[map + 1][end] = (total, first);
                    }
                }
            }
        }
        let mut splits = [bins; MAX_MAPS + 1];
        let mut end = bins;
        for map in (0..count).rev() {
            end = least[map + 1][end].1;
            splits[map] = end;
        }
        splits
    }
}

/// Octaves in which the bound of given splits is searched.
const WIDEST: f64 = 64.0;
