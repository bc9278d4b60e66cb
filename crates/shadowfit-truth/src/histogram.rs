//! Quantiles of values that span many octaves, in little memory and independent of the order of the values.

/// Bins per octave. A quantile is off by at most half a bin, 0.3%.
const BINS_PER_OCTAVE: f64 = 128.0;
/// Octaves on either side of 1 that have bins. Values beyond are counted in the last bin of that side.
const OCTAVES: f64 = 128.0;

/// Counts of values in bins of equal width in log2.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Histogram {
    /// Index of the first bin in `counts`. Bin k spans log2 from k / 128 to (k + 1) / 128.
    first: i32,
    counts: Vec<u64>,
    total: u64,
}

impl Histogram {
    /// Counts a value. NaN counts as infinite. A value of 0 or less counts in the first bin.
    pub fn add(&mut self, value: f64) {
        let log2 = if value.is_nan() { f64::INFINITY } else { value.max(0.0).log2() };
        let bin = (log2.clamp(-OCTAVES, OCTAVES) * BINS_PER_OCTAVE).floor() as i32;
        *self.count_mut(bin) += 1;
        self.total += 1;
    }

    /// Returns the number of counted values.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// Adds the counts of `other`.
    pub fn merge(&mut self, other: &Self) {
        for (bin, count) in (other.first..).zip(&other.counts) {
            if *count > 0 {
                *self.count_mut(bin) += count;
            }
        }
        self.total += other.total;
    }

    /// Returns log2 of the quantile `q`, 0..=1: the middle of the first bin at which the count reaches ceil(q
    /// n) of the n values. `None` without values; infinite if the quantile is 2^128 or more.
    pub fn log2_quantile(&self, q: f64) -> Option<f64> {
        let wanted = ((q * self.total as f64).ceil() as u64).max(1);
        let mut count = 0;
        let index = self.counts.iter().position(|bin| {
            count += bin;
            count >= wanted
        })?;
        let bin = f64::from(self.first) + index as f64;
        let last = OCTAVES * BINS_PER_OCTAVE;
        Some(if bin >= last { f64::INFINITY } else { (bin + 0.5) / BINS_PER_OCTAVE })
    }

    /// Returns the count of a bin. Adds the bin if it is missing.
    fn count_mut(&mut self, bin: i32) -> &mut u64 {
        if self.counts.is_empty() {
            self.first = bin;
        }
        if bin < self.first {
            let missing = (self.first - bin) as usize;
            self.counts.splice(0..0, std::iter::repeat_n(0, missing));
            self.first = bin;
        }
        let index = (bin - self.first) as usize;
        if index >= self.counts.len() {
            self.counts.resize(index + 1, 0);
        }
        &mut self.counts[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values in many octaves, in an order that adds bins at both ends.
    fn values() -> Vec<f64> {
        (0..2000u32).map(|i| (f64::from((i * 787) % 2000) - 900.5) / 100.0).map(f64::exp2).collect()
    }

    fn counted(values: &[f64]) -> Histogram {
        let mut histogram = Histogram::default();
        for value in values {
            histogram.add(*value);
        }
        histogram
    }

    #[test]
    fn quantiles_are_the_sorted_values_to_half_a_bin() {
        let values = values();
        let mut sorted: Vec<f64> = values.iter().map(|value| value.log2()).collect();
        sorted.sort_by(f64::total_cmp);
        let histogram = counted(&values);
        for q in [0.0, 0.001, 0.5, 0.95, 0.99, 1.0] {
            let wanted = sorted[((q * 2000.0) as usize).max(1) - 1];
            let found = histogram.log2_quantile(q).expect("values");
            assert!((found - wanted).abs() <= 0.5 / BINS_PER_OCTAVE + 1e-12, "{q}: {found}, not {wanted}");
        }
    }

    #[test]
    fn a_quantile_is_the_middle_of_its_bin() {
        assert_eq!(counted(&[1.0, 4.0]).log2_quantile(0.5), Some(0.5 / 128.0));
        assert_eq!(counted(&[1.0, 4.0]).log2_quantile(0.51), Some(2.0 + 0.5 / 128.0));
        assert_eq!(counted(&[0.999]).log2_quantile(0.5), Some(-0.5 / 128.0));
    }

    #[test]
    fn merged_counts_equal_counts_of_all() {
        let values = values();
        let mut merged = counted(&values[..700]);
        merged.merge(&counted(&values[700..]));
        merged.merge(&Histogram::default());
        let all = counted(&values);
        assert_eq!(merged.total(), all.total());
        for q in 0..=100 {
            assert_eq!(merged.log2_quantile(f64::from(q) / 100.0), all.log2_quantile(f64::from(q) / 100.0));
        }
    }

    #[test]
    fn values_without_a_logarithm_are_counted_at_the_ends() {
        let histogram = counted(&[f64::INFINITY, f64::NAN, 1.0, 0.0]);
        assert_eq!(histogram.log2_quantile(0.25), Some(-128.0 + 0.5 / 128.0));
        assert_eq!(histogram.log2_quantile(0.75), Some(f64::INFINITY));
        assert_eq!(Histogram::default().log2_quantile(0.5), None);
    }
}
