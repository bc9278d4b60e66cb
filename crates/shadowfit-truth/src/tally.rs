//! Sums over the pixels of judged pictures, and the figures computed from them.
//!
//! Sums of pictures can be merged. If no pixel was judged there are no figures, so that an empty picture is
//! not mistaken for a perfect one.

use crate::area::AreaTally;
use crate::class::Class;
use crate::histogram::Histogram;

/// Sums over the counted pixels: pixels that face the light, within the shadow distance and the light's
/// image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureTally {
    /// Number of pictures.
    pub frames: u64,
    /// Classes of all counted pixels, including grazing ones.
    pub all: ClassTally,
    /// Classes of the pixels whose cosine toward the light is below 0.05.
    pub grazing: ClassTally,
    /// Pixels in the edge zone, right or wrong.
    pub edge_zone: u64,
    /// Sum of |factor − truth|, where truth is the share of light that arrives.
    pub error: f64,
    /// Sum of the cosines between the surface normal and the direction toward the light.
    pub light: f64,
    /// Sum of |factor − truth| times that cosine.
    pub light_error: f64,
    /// Pixels that no map covers.
    pub uncovered: u64,
    /// Pixels per texel along the worse axis, over covered pixels that are not grazing.
    pub pixels_per_texel: Histogram,
    /// Pixels in `pixels_per_texel` with more than one pixel per texel.
    pub undersampled: u64,
    /// Sum over true shadow edges of the distance to the map's nearest edge of the same sign, in pixels. Each
    /// border between two pixels is one edge. Each distance is at most
    /// [`MAX_DISPLACEMENT`](crate::MAX_DISPLACEMENT).
    pub displacement: f64,
    /// Borders between two pixels that are true shadow edges.
    pub transitions: u64,
    /// Pixels in the edge zone that [`crawl()`](crate::crawl()) compared with the previous frame.
    pub crawl_compared: u64,
    /// Compared pixels whose verdict differs.
    pub crawl_different: u64,
    /// Sum of the differences between the factors of two frames' maps, over all pixels that
    /// [`crawl()`](crate::crawl()) can compare, in the edge zone or not.
    pub change: f64,
    /// Number of pixels in `change`.
    pub change_compared: u64,
    /// Errors against the areas of pixels, if these were traced.
    pub area: AreaTally,
    /// Sum over pictures of their mean [ꟻLIP](crate::FlipReference) error against the same picture with true shadows.
    pub flip: f64,
    /// Number of pictures in that sum.
    pub flip_pictures: u64,
    /// Facing pixels of the pictures with traced edges, as counted by the renderer.
    pub traced_of: u64,
    /// Facing pixels that took rays.
    pub traced: u64,
}

/// Sums over the points at which the maps of two frames are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crawl {
    /// Compared pixels of the edge zone whose verdict differs in the previous frame.
    pub different: u64,
    /// Compared pixels of the edge zone. If 0, crawl was not measured.
    pub compared: u64,
    /// Sum of the differences of factors, over all counted pixels that the maps of both frames cover.
    pub change: f64,
    /// Number of pixels in `change`.
    pub change_compared: u64,
}

/// Numbers of pixels by class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassTally {
    /// All pixels. Each of them faces the light.
    pub facing: u64,
    /// Pixels whose verdict differs from the truth, edges included.
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

/// The figures of judged pictures. Shares are in per cent of the counted pixels, 0..=100, unless a field says
/// otherwise. A figure that could not be measured is `None`.
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
    /// Mean of |factor − truth| · N·L divided by the mean of N·L: the error in per cent of the light that arrives without
    /// shadows. Errors at grazing incidence count as little as they show.
    pub light_error: f64,
    /// Pixels whose cosine toward the light is below 0.05.
    pub grazing: f64,
    /// Wrong grazing pixels, in per cent of all counted pixels.
    pub grazing_wrong: f64,
    /// Quantiles 50%, 95% and 99% of pixels per texel along the worse axis. `None` if every pixel is grazing
    /// or uncovered.
    pub pixels_per_texel: Option<[f64; 3]>,
    /// Pixels with more than one pixel per texel, in per cent of the pixels in `pixels_per_texel`. `None`
    /// without any.
    pub undersampled: Option<f64>,
    /// Mean distance of true shadow edges to the map's nearest edge of the same sign, in pixels. `None`
    /// without a true edge.
    pub edge_distance: Option<f64>,
    /// Pixels of the edge zone whose verdict differs in the previous frame's maps, in per cent of the
    /// compared pixels. `None` if no pixel was compared.
    pub crawl: Option<f64>,
    /// Mean difference between the factors of this frame's and the previous frame's maps at a point, in per
    /// cent of full light. `None` if no pixel was compared.
    pub change: Option<f64>,
    /// Mean of |factor − share of the pixel's area that is lit|, in per cent of full light, for pixels that
    /// show one surface and for pixels that show several. `None` if areas were not traced.
    pub area_errors: [Option<f64>; 2],
    /// Mean [ꟻLIP](crate::FlipReference) error, 0..=1, of the shaded pictures against the same pictures with true shadows.
    /// `None` if it was not measured.
    pub flip: Option<f64>,
    /// Pixels that took rays, in per cent of the facing pixels of pictures with traced edges. `None` without
    /// such pictures.
    pub traced: Option<f64>,
}

/// A counted pixel, as input of the sums.
pub(crate) struct CountedPixel {
    pub(crate) class: Class,
    pub(crate) is_in_edge_zone: bool,
    /// |factor − truth|.
    pub(crate) error: f32,
    /// Cosine between the surface normal and the direction toward the light.
    pub(crate) facing: f64,
    pub(crate) is_covered: bool,
    pub(crate) is_grazing: bool,
    pub(crate) pixels_per_texel: f32,
}

impl PictureTally {
    /// Adds the sums of `other`. For bit-identical sums of many pictures, merge them in the same order.
    pub fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.all.merge(&other.all);
        self.edge_zone += other.edge_zone;
        self.error += other.error;
        self.light += other.light;
        self.light_error += other.light_error;
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
        self.flip += other.flip;
        self.flip_pictures += other.flip_pictures;
        self.traced_of += other.traced_of;
        self.traced += other.traced;
    }

    /// Adds the counts of [`crawl()`](crate::crawl()).
    pub fn add_crawl(&mut self, crawl: &Crawl) {
        self.crawl_different += crawl.different;
        self.crawl_compared += crawl.compared;
        self.change += crawl.change;
        self.change_compared += crawl.change_compared;
    }

    /// Adds the mean [ꟻLIP](crate::FlipReference) error of a picture against the same picture with true shadows.
    pub fn add_flip(&mut self, mean: f64) {
        self.flip += mean;
        self.flip_pictures += 1;
    }

    /// Adds the counts of a renderer: pixels that took rays, and pixels that face the light.
    pub fn add_traced(&mut self, traced: u64, facing: u64) {
        self.traced += traced;
        self.traced_of += facing;
    }

    /// Returns whether no pixel was judged: the picture shows only sky, surfaces that face away from the
    /// light, or surfaces beyond the shadow distance. There are then no figures, and a wrong share of 0 is
    /// meaningless.
    pub fn is_empty(&self) -> bool {
        self.all.facing == 0
    }

    /// Returns a count's share of the counted pixels, 0..=1. It is 0 if [`Self::is_empty`], which callers
    /// must check first.
    pub fn share(&self, count: u64) -> f64 {
        if self.is_empty() { 0.0 } else { count as f64 / self.all.facing as f64 }
    }

    /// Computes the figures. `None` if [`Self::is_empty`].
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
            light_error: if self.light > 0.0 { 100.0 * (self.light_error / self.light) } else { 0.0 },
            grazing: percent(self.grazing.facing),
            grazing_wrong: percent(self.grazing.wrong),
            pixels_per_texel: p50.zip(p95).zip(p99).map(|((p50, p95), p99)| [p50, p95, p99]),
            undersampled: ratio(self.undersampled as f64, self.pixels_per_texel.total()).map(|share| 100.0 * share),
            edge_distance: ratio(self.displacement, self.transitions),
            crawl: ratio(self.crawl_different as f64, self.crawl_compared).map(|share| 100.0 * share),
            change: ratio(self.change, self.change_compared).map(|share| 100.0 * share),
            area_errors: self.area.errors(),
            flip: ratio(self.flip, self.flip_pictures),
            traced: ratio(self.traced as f64, self.traced_of).map(|share| 100.0 * share),
        })
    }

    /// Returns the titles and values of a report's columns, from [`Self::figures`]. NaN if a figure could not
    /// be measured.
    pub fn columns(&self) -> Vec<(&'static str, f64)> {
        let figures = self.figures();
        let of = |value: fn(&PictureFigures) -> Option<f64>| figures.as_ref().and_then(value).unwrap_or(f64::NAN);
        vec![
            ("wrong %", of(|figures| Some(figures.wrong))),
            ("light error %", of(|figures| Some(figures.light_error))),
            ("flip", of(|figures| figures.flip)),
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
        self.light += pixel.facing;
        self.light_error += f64::from(pixel.error) * pixel.facing;
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

/// Returns a sum over a count; `None` if the count is 0.
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
            facing: if class == Class::Right { 1.0 } else { 0.25 },
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
            light_error: 25.0,
            grazing: 100.0,
            grazing_wrong: 80.0,
            pixels_per_texel: None,
            undersampled: None,
            edge_distance: None,
            crawl: None,
            change: None,
            area_errors: [None; 2],
            flip: None,
            traced: None,
        };
        assert_eq!(figures, wanted);
        tally.add(&CountedPixel { is_grazing: false, ..pixel(Class::Right, true) });
        tally.add_crawl(&Crawl { different: 1, compared: 4, ..Crawl::default() });
        tally.add_flip(0.25);
        tally.add_flip(0.75);
        let figures = tally.figures().expect("six pixels");
        assert_eq!((figures.undersampled, figures.crawl, figures.flip), (Some(100.0), Some(25.0), Some(0.5)));
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
