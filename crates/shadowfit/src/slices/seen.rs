//! Which depths are visible, by a histogram of the frame before.

use super::bins::{BINS, Bins, CLASSES, Weights};
use crate::demand::histogram::DepthHistogram;

/// The counts as shares, resampled to other bins.
pub(super) fn weights(histogram: &DepthHistogram, bins: &Bins) -> Weights {
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
