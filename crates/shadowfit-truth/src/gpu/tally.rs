//! Sums of a picture that was judged on the GPU, and the figures computed from them.

use super::uniform::TallyRecord;
use crate::class::Class;
use crate::tally::{ClassTally, PictureFigures, PictureTally};

/// Bins per octave of pixels per texel.
const BINS_PER_OCTAVE: f64 = 32.0;
/// Bin that begins at one pixel per texel.
const ONE: f64 = TallyRecord::BINS as f64 / 2.0;
/// Steps per octave in the texture of classes. Each step encodes the values that round to it, and bins
/// consist of whole steps. Bins therefore begin half a step early.
const STEPS_PER_OCTAVE: f64 = 256.0;

/// Sums over the counted pixels of a picture, like [`PictureTally`]: pixels that face the light within the
/// shadow distance. The GPU counts the pixels of all triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuTally {
    /// Number of the picture: the value of [`GpuJudge::pictures`](super::GpuJudge::pictures) right after it
    /// was recorded.
    pub picture: u64,
    /// Classes of all counted pixels, including grazing ones.
    pub all: ClassTally,
    /// Classes of the pixels whose cosine toward the light is below 0.05.
    pub grazing: ClassTally,
    /// Pixels that the light reaches in truth.
    pub lit: u64,
    /// Pixels in the edge zone, right or wrong.
    pub edge_zone: u64,
    /// Sum of |factor − truth|, where truth is 0 or 1. Each pixel's error is rounded to 2^-20.
    pub error: f64,
    /// Sum of the cosines between the surface normal and the direction toward the light. Each pixel's is rounded to 2^-20.
    pub light: f64,
    /// Sum of |factor − truth| times that cosine. Each pixel's is rounded to 2^-20.
    pub light_error: f64,
    /// Pixels that no map covers.
    pub uncovered: u64,
    /// Histogram of pixels per texel along the worse axis, over the covered pixels that are not grazing. Bin
    /// k of 1024 begins at 2^((k − 512) / 32 − 1/512). The first and the last bin also hold all values beyond
    /// them. An octave has 32 bins, a quarter as many as in [`Histogram`](crate::Histogram).
    pub pixels_per_texel: Vec<u64>,
    /// Pixels in the histogram with more than one pixel per texel.
    pub undersampled: u64,
    /// Pixels in the edge zone that were compared with the previous frame, as in [`crawl()`](crate::crawl()).
    pub crawl_compared: u64,
    /// Compared pixels whose verdict differs.
    pub crawl_different: u64,
}

impl GpuTally {
    pub(super) fn new(picture: u64, record: &TallyRecord) -> Self {
        Self {
            picture,
            all: class_tally(&record.all),
            grazing: class_tally(&record.grazing),
            lit: record.lit.into(),
            edge_zone: record.edge_zone.into(),
            error: sum(record.error_high, record.error_low),
            light: sum(record.light_high, record.light_low),
            light_error: sum(record.light_error_high, record.light_error_low),
            uncovered: record.uncovered.into(),
            pixels_per_texel: record.bins.map(u64::from).to_vec(),
            undersampled: record.undersampled.into(),
            crawl_compared: record.crawl_compared.into(),
            crawl_different: record.crawl_different.into(),
        }
    }

    /// Computes the figures, like [`PictureTally::figures`]. Returns `None` if no pixel was judged.
    ///
    /// Quantiles of pixels per texel are the middles of [bins](Self::pixels_per_texel), at most 1.1% off. A
    /// quantile in the last bin, from 2^16 on, is infinite. The GPU does not measure the distance of edges,
    /// which is `None`.
    pub fn figures(&self) -> Option<PictureFigures> {
        let covered: u64 = self.pixels_per_texel.iter().sum();
        let sums = PictureTally {
            frames: 1,
            all: self.all,
            grazing: self.grazing,
            edge_zone: self.edge_zone,
            error: self.error,
            light: self.light,
            light_error: self.light_error,
            uncovered: self.uncovered,
            crawl_compared: self.crawl_compared,
            crawl_different: self.crawl_different,
            ..PictureTally::default()
        };
        let [p50, p95, p99] = [0.5, 0.95, 0.99].map(|q| self.quantile(q));
        sums.figures().map(|figures| PictureFigures {
            pixels_per_texel: p50.zip(p95).zip(p99).map(|((p50, p95), p99)| [p50, p95, p99]),
            undersampled: (covered > 0).then(|| 100.0 * (self.undersampled as f64 / covered as f64)),
            ..figures
        })
    }

    /// Returns the quantile `q`, 0..=1, of pixels per texel: the middle of the first bin at which the count
    /// reaches ceil(q n) of the n pixels. `None` without pixels, infinite in the last bin.
    fn quantile(&self, q: f64) -> Option<f64> {
        let covered: u64 = self.pixels_per_texel.iter().sum();
        let wanted = ((q * covered as f64).ceil() as u64).max(1);
        let mut count = 0;
        let bin = self.pixels_per_texel.iter().position(|pixels| {
            count += pixels;
            count >= wanted
        })?;
        let middle = (bin as f64 + 0.5 - ONE) / BINS_PER_OCTAVE - 0.5 / STEPS_PER_OCTAVE;
        Some(if bin + 1 >= self.pixels_per_texel.len() { f64::INFINITY } else { middle.exp2() })
    }
}

/// Returns a sum from its two words.
fn sum(high: u32, low: u32) -> f64 {
    (f64::from(high) * f64::exp2(32.0) + f64::from(low)) / f64::from(TallyRecord::ERROR_ONE)
}

/// Counts pixels by class. Pixels that are not judged do not count.
fn class_tally(pixels: &[u32; 6]) -> ClassTally {
    let of = |class: Class| u64::from(pixels[class as usize]);
    let wrong = [Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge];
    let wrong_pixels = wrong.map(of).iter().sum();
    let [false_shadow, false_light, hole, edge] = wrong.map(of);
    ClassTally { facing: of(Class::Right) + wrong_pixels, wrong: wrong_pixels, false_shadow, false_light, hole, edge }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    #[test]
    fn a_record_is_decoded_by_class_and_its_error_from_two_words() {
        let record = TallyRecord {
            all: [0, 10, 1, 2, 3, 4],
            grazing: [0, 1, 0, 0, 2, 0],
            lit: 7,
            error_low: TallyRecord::ERROR_ONE / 2,
            error_high: 1,
            light_low: TallyRecord::ERROR_ONE * 4,
            light_error_low: TallyRecord::ERROR_ONE,
            ..TallyRecord::zeroed()
        };
        let tally = GpuTally::new(5, &record);
        let wanted = ClassTally { facing: 20, wrong: 10, false_shadow: 1, false_light: 2, hole: 3, edge: 4 };
        assert_eq!((tally.picture, tally.all, tally.grazing.wrong, tally.lit), (5, wanted, 2, 7));
        assert_eq!(tally.error, 4096.5);
        let figures = tally.figures().expect("20 pixels");
        assert_eq!((figures.wrong, figures.grazing, figures.grazing_wrong), (50.0, 15.0, 10.0));
        assert_eq!(figures.light_error, 25.0);
        assert_eq!((figures.pixels_per_texel, figures.undersampled, figures.crawl), (None, None, None));
    }

    #[test]
    fn the_largest_pictures_errors_fit_the_words() {
        let pixels = 8192.0 * 8192.0;
        let most = pixels * f64::from(TallyRecord::ERROR_ONE);
        assert!(most < f64::exp2(64.0));
        let record = TallyRecord { error_high: (most / f64::exp2(32.0)) as u32, ..TallyRecord::zeroed() };
        assert_eq!(GpuTally::new(1, &record).error, pixels);
    }

    #[test]
    fn quantiles_are_the_middles_of_bins_and_infinite_in_the_last_one() {
        let mut record = TallyRecord::zeroed();
        record.all[Class::Right as usize] = 100;
        record.bins[512] = 60;
        record.bins[512 + 64] = 38;
        record.bins[1023] = 2;
        record.undersampled = 50;
        let figures = GpuTally::new(1, &record).figures().expect("100 pixels");
        let [p50, p95, p99] = figures.pixels_per_texel.expect("100 pixels");
        let middle = 3.5 / 256.0;
        assert!((p50.log2() - middle).abs() < 1e-12 && (p95.log2() - middle - 2.0).abs() < 1e-12, "{p50} {p95}");
        assert_eq!(p99, f64::INFINITY);
        assert_eq!(figures.undersampled, Some(50.0));
    }

    #[test]
    fn a_picture_without_a_judged_pixel_has_no_figures() {
        assert_eq!(GpuTally::new(1, &TallyRecord::zeroed()).figures(), None);
    }
}
