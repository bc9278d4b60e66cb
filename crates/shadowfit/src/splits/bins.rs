//! Bins of view depth, and what is visible in each.

use crate::settings::MAX_MAPS;

/// Splits of all maps, in metres of view depth: map i covers `splits[i]..splits[i + 1]`.
pub(crate) type Splits = [f32; MAX_MAPS + 1];

/// Bins of log view depth that the content is sorted into.
pub(crate) const BINS: usize = 64;

/// Bins of equal size in log view depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    pub(super) near: f64,
    pub(super) far: f64,
    pub(super) log_near: f64,
    pub(super) log_step: f64,
}

impl Bins {
    pub(super) fn new(near: f64, far: f64) -> Self {
        let (log_near, log_far) = (libm::log2(near), libm::log2(far));
        Self { near, far, log_near, log_step: (log_far - log_near) / BINS as f64 }
    }

    /// View depth at which a bin begins, in metres.
    pub(super) fn start(&self, bin: usize) -> f64 {
        match bin {
            0 => self.near,
            BINS => self.far,
            _ => libm::exp2(self.log_near + self.log_step * bin as f64),
        }
    }

    /// The bin whose beginning is nearest to a view depth.
    pub(super) fn nearest(&self, depth: f64) -> usize {
        let bin = (libm::log2(depth.max(self.near)) - self.log_near) / self.log_step;
        (libm::round(bin) as usize).min(BINS)
    }

    /// The bin of a view depth; depths outside go to the first or the last.
    pub(super) fn of(&self, depth: f64) -> usize {
        let bin = (libm::log2(depth.max(self.near)) - self.log_near) / self.log_step;
        (bin as usize).min(BINS - 1)
    }
}

/// Classes of foreshortening, an octave each: the first holds surfaces that face both the eye and
/// the light, the others those that need texels half as wide, a quarter, and so on.
pub(crate) const CLASSES: usize = 6;

/// Shares of the visible points in each bin and class.
pub(crate) type Weights = [[f64; CLASSES]; BINS];
