//! How deep the picture is: a histogram that the engine takes from its last depth buffer.

use super::{BINS, Bins, Weights};

/// Counts of visible pixels in bins at even steps of log view depth.
///
/// Fill it from a depth buffer of the frame before, as coarsely as you like (64 × 36 samples
/// serve): `bin = floor(bins.len() · log(depth / near) / log(far / near))`, depth being the view
/// depth in metres; leave out the sky. It only chooses where the maps are cut: a late or wrong
/// histogram costs sharpness, never coverage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthHistogram<'a> {
    /// View depth at which the first bin begins, in metres; positive.
    pub near: f32,
    /// View depth at which the last bin ends, in metres.
    pub far: f32,
    /// Counts.
    pub bins: &'a [u32],
}

impl DepthHistogram<'_> {
    /// Whether nothing was counted, or the depths make no sense: cuts come from boxes then.
    pub fn is_empty(&self) -> bool {
        let is_valid = self.near > 0.0 && self.near < self.far && self.far.is_finite();
        !is_valid || self.bins.iter().all(|count| *count == 0)
    }

    /// The counts as shares, spread over other bins.
    pub(super) fn weights(&self, bins: &Bins) -> Weights {
        let mut weights = [0.0; BINS];
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let step = libm::log2(far / near) / self.bins.len() as f64;
        let total: f64 = self.bins.iter().map(|count| f64::from(*count)).sum();
        /// Parts that each bin is cut in, to be spread.
        const PARTS: usize = 4;
        for (i, count) in self.bins.iter().enumerate().filter(|(_, count)| **count > 0) {
            for part in 0..PARTS {
                let middle = i as f64 + (part as f64 + 0.5) / PARTS as f64;
                let depth = near * libm::exp2(step * middle);
                weights[bins.of(depth)] += f64::from(*count) / (total * PARTS as f64);
            }
        }
        weights
    }
}
