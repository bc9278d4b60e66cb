//! Sums over the pixels of judged pictures, and the figures that follow from them.
//!
//! Sums of pictures can be merged. Where no pixel was judged there are no figures, so that an empty
//! picture is never taken for a perfect one.

use crate::area::AreaTally;
use crate::class::Class;
use crate::histogram::Histogram;

/// Sums over the pixels that count: those that face the light, within the shadow distance and the
/// light's image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureTally {
    /// Number of pictures.
    pub frames: u64,
    /// Classes of all pixels that count, grazing ones included.
    pub all: ClassTally,
    /// Classes of those whose cosine toward the light is below 0.05.
    pub grazing: ClassTally,
    /// Pixels in the edge zone, right or wrong.
    pub edge_zone: u64,
    /// Sum of |factor − truth|, where truth is the share of light that arrives.
    pub error: f64,
    /// Pixels that no map covers.
    pub uncovered: u64,
    /// Pixels per texel along the worse axis, of pixels that a map covers and that are not grazing.
    pub pixels_per_texel: Histogram,
    /// Those of them with more than one pixel per texel.
    pub undersampled: u64,
    /// Sum over true shadow edges, border by border between two pixels, of the distance to the
    /// map's nearest edge of the same sign, in pixels, each at most
    /// [`MAX_DISPLACEMENT`](crate::MAX_DISPLACEMENT).
    pub displacement: f64,
    /// Borders between two pixels that are true shadow edges.
    pub transitions: u64,
    /// Pixels in the edge zone that [`crawl()`](crate::crawl()) compared with the frame before.
    pub crawl_compared: u64,
    /// Those of them whose verdict differs.
    pub crawl_different: u64,
    /// Sum over the pixels that [`crawl()`](crate::crawl()) may compare, in the edge zone or not, of how much their factor
    /// differs from that of the maps of the frame before, and their number.
    pub change: f64,
    /// Number of those pixels.
    pub change_compared: u64,
    /// The errors against the areas of pixels, where these were traced.
    pub area: AreaTally,
    /// Facing pixels of pictures whose edges were traced, as the renderer counted them.
    pub traced_of: u64,
    /// Those of them that took rays.
    pub traced: u64,
}

/// Sums over the points that the maps of two frames are compared at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crawl {
    /// Compared pixels of the edge zone that have another verdict in the frame before.
    pub different: u64,
    /// Compared pixels of the edge zone. Where it is 0 nothing was measured.
    pub compared: u64,
    /// Sum of the differences of factors, of all pixels that count and that the maps of both frames cover.
    pub change: f64,
    /// Number of pixels in that sum.
    pub change_compared: u64,
}

/// Numbers of pixels by class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassTally {
    /// All pixels; each of them faces the light.
    pub facing: u64,
    /// Those whose verdict differs from the truth, edges included.
    pub wrong: u64,
    /// [`Class::FalseShadow`].
    pub false_shadow: u64,
    /// [`Class::FalseLight`].
    pub false_light: u64,
    /// [`Class::Hole`].
    pub hole: u64,
    /// [`Class::Edge`].
    pub edge: u64,
}

/// The figures of judged pictures. Shares are in per cent of the pixels that count, 0..=100, unless a field says
/// otherwise; a figure for which nothing could be measured is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureFigures {
    /// Pixels whose verdict differs from the truth, edges included.
    pub wrong: f64,
    /// [`Class::FalseShadow`].
    pub false_shadow: f64,
    /// [`Class::FalseLight`].
    pub false_light: f64,
    /// [`Class::Hole`].
    pub hole: f64,
    /// [`Class::Edge`].
    pub edge: f64,
    /// Pixels in the edge zone, right or wrong.
    pub edge_zone: f64,
    /// Pixels that no map covers.
    pub uncovered: f64,
    /// Mean of |factor − truth|, in per cent of full light.
    pub mean_error: f64,
    /// Pixels whose cosine toward the light is below 0.05.
    pub grazing: f64,
    /// Wrong ones of those, in per cent of all pixels that count.
    pub grazing_wrong: f64,
    /// Quantiles 50%, 95% and 99% of pixels per texel along the worse axis. `None` where every pixel
    /// is grazing or uncovered.
    pub pixels_per_texel: Option<[f64; 3]>,
    /// Pixels with more than one pixel per texel, in per cent of those that have a value in
    /// `pixels_per_texel`. `None` where none has.
    pub undersampled: Option<f64>,
    /// Mean distance of true shadow edges to the map's nearest edge of the same sign, in pixels.
    /// `None` without a true edge.
    pub edge_distance: Option<f64>,
    /// Pixels of the edge zone whose verdict differs in the maps of the frame before, in per cent of
    /// those compared. `None` where none was compared.
    pub crawl: Option<f64>,
    /// Mean of how much the factor of a point differs from that of the maps of the frame before, in per cent of full light.
    /// `None` where none was compared.
    pub change: Option<f64>,
    /// Mean of |factor − share of the pixel's area that is lit|, in per cent of full light: of pixels that show one
    /// surface, and of those that show several. `None` where areas were not traced.
    pub area_errors: [Option<f64>; 2],
    /// Pixels that took rays, in per cent of the facing pixels of pictures whose edges were traced. `None` where none were.
    pub traced: Option<f64>,
}

/// A pixel that counts, as the sums take it.
pub(crate) struct CountedPixel {
    pub(crate) class: Class,
    pub(crate) is_in_edge_zone: bool,
    /// |factor − truth|.
    pub(crate) error: f32,
    pub(crate) is_covered: bool,
    pub(crate) is_grazing: bool,
    pub(crate) pixels_per_texel: f32,
}

impl PictureTally {
    /// Adds the sums of `other`. Where sums of many pictures must be the same to the last bit, merge
    /// them in the same order.
    pub fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.all.merge(&other.all);
        self.edge_zone += other.edge_zone;
        self.error += other.error;
        self.uncovered += other.uncovered;
        self.grazing.merge(&other.grazing);
        self.pixels_per_texel.merge(&other.pixels_per_texel);
        self.undersampled += other.undersampled;
        self.displacement += other.displacement;
        self.transitions += other.transitions;
        self.crawl_compared += other.crawl_compared;
        self.crawl_different += other.crawl_different;
        self.change += other.change;
        self.change_compared += other.change_compared;
        self.area.merge(&other.area);
        self.traced_of += other.traced_of;
        self.traced += other.traced;
    }

    /// Adds what [`crawl()`](crate::crawl()) counted.
    pub fn add_crawl(&mut self, crawl: &Crawl) {
        self.crawl_different += crawl.different;
        self.crawl_compared += crawl.compared;
        self.change += crawl.change;
        self.change_compared += crawl.change_compared;
    }

    /// Adds the counts of a renderer: pixels that took rays, and pixels that face the light.
    pub fn add_traced(&mut self, traced: u64, facing: u64) {
        self.traced += traced;
        self.traced_of += facing;
    }

    /// Whether no pixel was judged: the sky alone, or only surfaces that face away from the light or
    /// lie beyond the shadow distance. There are no figures then, and a wrong share of 0 means
    /// nothing.
    pub fn is_empty(&self) -> bool {
        self.all.facing == 0
    }

    /// A count's share of the pixels that count, 0..=1. It is 0 when [`Self::is_empty`], which callers
    /// have to ask first.
    pub fn share(&self, count: u64) -> f64 {
        if self.is_empty() { 0.0 } else { count as f64 / self.all.facing as f64 }
    }

    /// The figures; `None` when [`Self::is_empty`].
    pub fn figures(&self) -> Option<PictureFigures> {
        let percent = |count: u64| 100.0 * self.share(count);
        let [p50, p95, p99] = [0.5, 0.95, 0.99].map(|q| self.pixels_per_texel.log2_quantile(q).map(f64::exp2));
        (!self.is_empty()).then(|| PictureFigures {
            wrong: percent(self.all.wrong),
            false_shadow: percent(self.all.false_shadow),
            false_light: percent(self.all.false_light),
            hole: percent(self.all.hole),
            edge: percent(self.all.edge),
            edge_zone: percent(self.edge_zone),
            uncovered: percent(self.uncovered),
            mean_error: 100.0 * (self.error / self.all.facing as f64),
            grazing: percent(self.grazing.facing),
            grazing_wrong: percent(self.grazing.wrong),
            pixels_per_texel: p50.zip(p95).zip(p99).map(|((p50, p95), p99)| [p50, p95, p99]),
            undersampled: ratio(self.undersampled as f64, self.pixels_per_texel.total()).map(|share| 100.0 * share),
            edge_distance: ratio(self.displacement, self.transitions),
            crawl: ratio(self.crawl_different as f64, self.crawl_compared).map(|share| 100.0 * share),
            change: ratio(self.change, self.change_compared).map(|share| 100.0 * share),
            area_errors: self.area.errors(),
            traced: ratio(self.traced as f64, self.traced_of).map(|share| 100.0 * share),
        })
    }

    /// Titles and values of a report's columns, made from [`Self::figures`]. Not a number where
    /// nothing could be measured.
    pub fn columns(&self) -> Vec<(&'static str, f64)> {
        let figures = self.figures();
        let of = |value: fn(&PictureFigures) -> Option<f64>| figures.as_ref().and_then(value).unwrap_or(f64::NAN);
        vec![
            ("wrong %", of(|figures| Some(figures.wrong))),
            ("false shadow %", of(|figures| Some(figures.false_shadow))),
            ("false light %", of(|figures| Some(figures.false_light))),
            ("hole %", of(|figures| Some(figures.hole))),
            ("edge %", of(|figures| Some(figures.edge))),
            ("edge zone %", of(|figures| Some(figures.edge_zone))),
            ("uncov %", of(|figures| Some(figures.uncovered))),
            ("mean error %", of(|figures| Some(figures.mean_error))),
            ("grazing %", of(|figures| Some(figures.grazing))),
            ("grazing wrong %", of(|figures| Some(figures.grazing_wrong))),
            ("ppt p50", of(|figures| figures.pixels_per_texel.map(|[p50, ..]| p50))),
            ("ppt p95", of(|figures| figures.pixels_per_texel.map(|[_, p95, _]| p95))),
            ("ppt p99", of(|figures| figures.pixels_per_texel.map(|[.., p99]| p99))),
            ("ppt > 1 %", of(|figures| figures.undersampled)),
            ("edge px", of(|figures| figures.edge_distance)),
            ("crawl %", of(|figures| figures.crawl)),
            ("change %", of(|figures| figures.change)),
            ("area error %", of(|figures| figures.area_errors[0])),
            ("area error several %", of(|figures| figures.area_errors[1])),
            ("traced %", of(|figures| figures.traced)),
        ]
    }

    /// Adds a pixel.
    pub(crate) fn add(&mut self, pixel: &CountedPixel) {
        self.all.add(pixel.class);
        self.edge_zone += u64::from(pixel.is_in_edge_zone);
        self.error += f64::from(pixel.error);
        self.uncovered += u64::from(!pixel.is_covered);
        if pixel.is_grazing {
            self.grazing.add(pixel.class);
        } else if pixel.is_covered {
            let pixels_per_texel = f64::from(pixel.pixels_per_texel);
            self.pixels_per_texel.add(pixels_per_texel);
            self.undersampled += u64::from(pixels_per_texel > 1.0);
        }
    }
}

impl ClassTally {
    fn add(&mut self, class: Class) {
        self.facing += 1;
        self.wrong += u64::from(class != Class::Right);
        self.false_shadow += u64::from(class == Class::FalseShadow);
        self.false_light += u64::from(class == Class::FalseLight);
        self.hole += u64::from(class == Class::Hole);
        self.edge += u64::from(class == Class::Edge);
    }

    fn merge(&mut self, other: &Self) {
        self.facing += other.facing;
        self.wrong += other.wrong;
        self.false_shadow += other.false_shadow;
        self.false_light += other.false_light;
        self.hole += other.hole;
        self.edge += other.edge;
    }
}

/// A sum over a count; `None` where nothing was counted.
fn ratio(sum: f64, count: u64) -> Option<f64> {
    (count > 0).then(|| sum / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tally_without_a_judged_pixel_has_no_figures() {
        let mut tally = PictureTally { frames: 3, ..PictureTally::default() };
        tally.merge(&PictureTally { frames: 1, ..PictureTally::default() });
        assert!(tally.is_empty());
        assert_eq!(tally.figures(), None);
        assert!(tally.columns().iter().all(|(_, value)| value.is_nan()), "{:?}", tally.columns());
    }

    #[test]
    fn figures_are_shares_in_per_cent_and_what_was_not_measured_is_none() {
        let mut tally = PictureTally::default();
        let pixel = |class, is_covered| CountedPixel {
            class,
            is_in_edge_zone: class == Class::Edge,
            error: 0.25,
            is_covered,
            is_grazing: true,
            pixels_per_texel: 4.0,
        };
        for class in [Class::Right, Class::Edge, Class::FalseShadow, Class::FalseLight] {
            tally.add(&pixel(class, true));
        }
        tally.add(&pixel(Class::Hole, false));
        let figures = tally.figures().expect("five pixels");
        let wanted = PictureFigures {
            wrong: 80.0,
            false_shadow: 20.0,
            false_light: 20.0,
            hole: 20.0,
            edge: 20.0,
            edge_zone: 20.0,
            uncovered: 20.0,
            mean_error: 25.0,
            grazing: 100.0,
            grazing_wrong: 80.0,
            pixels_per_texel: None,
            undersampled: None,
            edge_distance: None,
            crawl: None,
            change: None,
            area_errors: [None; 2],
            traced: None,
        };
        assert_eq!(figures, wanted);
        tally.add(&CountedPixel { is_grazing: false, ..pixel(Class::Right, true) });
        tally.add_crawl(&Crawl { different: 1, compared: 4, ..Crawl::default() });
        let figures = tally.figures().expect("six pixels");
        assert_eq!((figures.undersampled, figures.crawl), (Some(100.0), Some(25.0)));
        let [median, ..] = figures.pixels_per_texel.expect("one pixel that is not grazing");
        assert!((median / 4.0 - 1.0).abs() < 0.003, "{median}");
    }

    #[test]
    fn columns_are_the_figures_by_title() {
        let all = ClassTally { facing: 8, wrong: 4, false_shadow: 1, false_light: 2, hole: 3, edge: 4 };
        let tally = PictureTally { all, transitions: 2, displacement: 3.0, ..PictureTally::default() };
        let columns = tally.columns();
        let column = |title| columns.iter().find(|(known, _)| *known == title).expect("a column").1;
        let titles = ["wrong %", "false shadow %", "false light %", "hole %", "edge %", "edge px"];
        assert_eq!(titles.map(column), [50.0, 12.5, 25.0, 37.5, 50.0, 1.5]);
        assert!(column("crawl %").is_nan() && column("ppt p50").is_nan());
    }
}
