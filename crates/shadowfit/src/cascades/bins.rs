//! Bins of view depth, and the visible share of each. The shares come from the histogram of an earlier frame,
//! or from [rays through the boxes](crate::demand::from_boxes). A ray spreads the weight of a box over the
//! depths inside it.

use crate::content::{Content, Query};
use crate::demand::from_boxes::{AROUND, Rays};
use crate::demand::histogram::DepthHistogram;
use crate::technique::settings::MAX_MAPS;
use crate::view::RayCount;

/// Splits of all maps, in metres of view depth: map i covers `splits[i]..splits[i + 1]`.
pub(crate) type Splits = [f32; MAX_MAPS + 1];

/// Greatest number of bins of log view depth.
pub(crate) const BINS: usize = 64;

/// Bins of equal size in log view depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    /// Number of bins, at most [`BINS`].
    pub(super) count: usize,
    pub(super) near: f64,
    pub(super) far: f64,
    pub(super) log_near: f64,
    pub(super) log_step: f64,
    /// Bins per octave.
    per_log: f64,
}

impl Bins {
    pub(super) fn new(near: f64, far: f64, count: usize) -> Self {
        let (log_near, log_far) = (libm::log2(near), libm::log2(far));
        let log_step = (log_far - log_near) / count as f64;
        Self { count, near, far, log_near, log_step, per_log: 1.0 / log_step }
    }

    /// Returns the view depth at which a bin begins, in metres.
    pub(super) fn start(&self, bin: usize) -> f64 {
        match bin {
            0 => self.near,
            _ if bin >= self.count => self.far,
            _ => libm::exp2(self.log_near + self.log_step * bin as f64),
        }
    }

    /// Returns the bin whose beginning is nearest to a view depth.
    pub(super) fn nearest(&self, depth: f64) -> usize {
        let bin = (libm::log2(depth.max(self.near)) - self.log_near) / self.log_step;
        (libm::round(bin) as usize).min(self.count)
    }

    /// Returns the bin of a view depth. Depths outside go to the first or the last bin.
    #[inline]
    pub(super) fn of(&self, depth: f64) -> usize {
        let depth = depth.max(self.near);
        // Away from the beginning of a bin, an approximation is enough.
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

/// Computes log2 of a positive normal number, rounded to f32. It equals libm's log2, which is only called if
/// the approximation does not decide the rounding.
#[inline]
pub(super) fn log2(x: f64) -> f32 {
    let near = approximate_log2(x);
    let (low, high) = ((near - APPROXIMATE) as f32, (near + APPROXIMATE) as f32);
    if low == high { low } else { libm::log2(x) as f32 }
}

/// Greatest error of [`approximate_log2`], in octaves.
const APPROXIMATE: f64 = 1e-11;

/// Approximates log2 of a positive normal number: the exponent, plus the first terms of the artanh series for
/// the rest, which lies within √½..√2.
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

/// Terms of artanh(s) / s by powers of s². The next one is below the allowed error.
const SERIES: [f64; 7] = [1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0];

/// Classes of foreshortening, an octave each. The first holds surfaces that face both the eye and the light.
/// The others hold surfaces that need texels half as wide, a quarter as wide, and so on.
pub(crate) const CLASSES: usize = 6;

/// Shares of the visible points in each bin and class.
pub(crate) type Weights = [[f64; CLASSES]; BINS];

/// Returns equal weights for all depths, for surfaces that face the light.
pub(crate) fn even(bins: &Bins) -> Weights {
    let mut weights = [[0.0; CLASSES]; BINS];
    for classes in &mut weights[..bins.count] {
        classes[0] = 1.0 / bins.count as f64;
    }
    weights
}

/// Converts the counts to shares and resamples them to other bins.
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

/// Parts that each bin of a histogram is divided into for resampling.
const PARTS: u32 = 4;

/// Factor by which each further box on a ray counts less. Chosen together with the constants before and after
/// it on ten scenes. Counting only the first box gives bad splits if boxes are loose.
const FURTHER: f64 = 0.85;

/// Computes the share of the rays that meet boxes in each bin. If no box is known, all depths have equal
/// shares.
pub(super) fn weights_of_boxes(content: &Content, bins: &Bins, count: RayCount) -> Weights {
    let mut spread = Spread::new(bins);
    for part in content.whole_views() {
        let mut rays = Rays::new(&part, count);
        content.visit(Query::Lit(&part), &mut rays);
        let bin = |share: f32| bins.of(part.near + (part.far - part.near) * f64::from(share));
        for ray in rays.iter() {
            let mut weight = 1.0;
            for layer in ray.layers() {
                spread.add(bin(layer.enter), bin(layer.leave), weight);
                weight *= FURTHER;
            }
            if let Some(around) = ray.around {
                spread.add(0, bin(around.leave), weight * f64::from(AROUND));
            }
        }
    }
    spread.shares()
}

/// Weights spread over bins.
struct Spread {
    /// View depths at which the bins begin and at which the last one ends, in metres.
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
    fn add(&mut self, first: usize, last: usize, weight: f64) {
        let per_metre = weight / (self.starts[last + 1] - self.starts[first]);
        if per_metre.is_finite() {
            for (weight, length) in self.weights[first..=last].iter_mut().zip(&self.lengths[first..=last]) {
                *weight += per_metre * length;
            }
        } else {
            // The depths are too close to distinguish.
            self.weights[first] += weight;
        }
    }

    /// Returns the weights as shares, or equal shares if all weights are zero.
    fn shares(&self) -> Weights {
        let total: f64 = self.weights.iter().sum();
        let mut shares = [[0.0; CLASSES]; BINS];
        for (share, weight) in shares.iter_mut().zip(&self.weights).take(self.count) {
            // Slopes are unknown for boxes, so all weight goes to the first class.
            share[0] = if total == 0.0 { 1.0 / self.count as f64 } else { weight / total };
        }
        shares
    }
}
