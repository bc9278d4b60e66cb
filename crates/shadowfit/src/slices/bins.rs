//! Bins of view depth, and what is visible in each.

use crate::technique::settings::MAX_MAPS;

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
