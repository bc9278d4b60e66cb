//! What is summed up over the pixels of judged pictures; sums of pictures can be merged.

use crate::displacement::displacement;
use crate::judge::seems_lit;
use crate::peers::Histogram;
use crate::peers::choice::LEAST_FACING;
use crate::{Class, Judged, Truth};

/// Sums over the facing pixels that count: those that face the light, within the shadow distance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureTally {
    /// Pictures.
    pub frames: u64,
    /// Classes of all facing pixels, grazing ones included.
    pub all: ClassTally,
    /// Classes of those whose cosine toward the light is below 0.05.
    pub grazing: ClassTally,
    /// Pixels in the edge zone, right or wrong.
    pub edge_zone: u64,
    /// Sum of |factor − truth|, the truth's share of light.
    pub error: f64,
    /// Pixels that no map holds.
    pub uncovered: u64,
    /// Pixels per texel along the worse axis, of pixels that a map holds and that are not grazing.
    pub texels: Histogram,
    /// Those of them with more than one pixel per texel.
    pub under: u64,
    /// Sum over true transitions of the distance to the nearest one of the same sign in the map, in
    /// pixels, each at most 32.
    pub displacement: f64,
    /// True transitions.
    pub transitions: u64,
    /// Pixels in the edge zone whose verdict was compared with that of the frame before.
    pub crawl_compared: u64,
    /// Those of them whose verdict differs.
    pub crawl_different: u64,
}

/// Numbers of pixels by class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassTally {
    /// Pixels.
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
        self.texels.merge(&other.texels);
        self.under += other.under;
        self.displacement += other.displacement;
        self.transitions += other.transitions;
        self.crawl_compared += other.crawl_compared;
        self.crawl_different += other.crawl_different;
    }

    /// Adds what [`crate::crawl()`] counted: pixels that differ, and pixels compared.
    pub fn add_crawl(&mut self, (different, compared): (u64, u64)) {
        self.crawl_different += different;
        self.crawl_compared += compared;
    }

    /// A count's share of the facing pixels, 0..=1; 0 without any.
    pub fn share(&self, count: u64) -> f64 {
        ratio(count as f64, self.all.facing)
    }

    /// Names and values of a report's columns: per cent of the facing pixels (of those with a texel
    /// for `ppt > 1 %`, of the pixels compared for `crawl %`), pixels per texel, and pixels. 0 where
    /// nothing was counted.
    pub fn columns(&self) -> Vec<(&'static str, f64)> {
        let percent = |count: u64| 100.0 * self.share(count);
        let quantile = |q: f64| self.texels.log2_quantile(q).map_or(0.0, f64::exp2);
        vec![
            ("wrong %", percent(self.all.wrong)),
            ("false shadow %", percent(self.all.false_shadow)),
            ("false light %", percent(self.all.false_light)),
            ("hole %", percent(self.all.hole)),
            ("edge %", percent(self.all.edge)),
            ("edge zone %", percent(self.edge_zone)),
            ("uncov %", percent(self.uncovered)),
            ("mean error %", 100.0 * ratio(self.error, self.all.facing)),
            ("grazing %", percent(self.grazing.facing)),
            ("grazing wrong %", percent(self.grazing.wrong)),
            ("ppt p50", quantile(0.5)),
            ("ppt p95", quantile(0.95)),
            ("ppt p99", quantile(0.99)),
            ("ppt > 1 %", 100.0 * ratio(self.under as f64, self.texels.total())),
            ("edge px", ratio(self.displacement, self.transitions)),
            ("crawl %", 100.0 * ratio(self.crawl_different as f64, self.crawl_compared)),
        ]
    }

    /// Sums over a judged picture, its tally aside.
    pub(crate) fn of(truth: &Truth, judged: &Judged, factors: &[f32]) -> Self {
        let mut tally = Self { frames: 1, ..Self::default() };
        for pixel in (0..factors.len()).filter(|pixel| judged.counted[*pixel]) {
            tally.add(truth, judged, factors[pixel], pixel);
        }
        let size = truth.camera.size.map(|side| side as usize);
        let seen = |pixel: usize| truth.verdict(pixel).map(|_| seems_lit(factors[pixel]));
        let edges = displacement(size, &|pixel| truth.verdict(pixel), &seen, |pixel| judged.counted[pixel]);
        Self { displacement: edges.sum, transitions: edges.transitions, ..tally }
    }

    fn add(&mut self, truth: &Truth, judged: &Judged, factor: f32, pixel: usize) {
        let Some(point) = &truth.points[pixel] else { return };
        let class = judged.classes[pixel];
        self.all.add(class);
        self.edge_zone += u64::from(judged.edge_zone[pixel]);
        // A factor that is not a number is a shadow to the verdict, and so it is here.
        let factor = if factor.is_nan() { 0.0 } else { factor.clamp(0.0, 1.0) };
        self.error += f64::from((factor - point.lit).abs());
        let is_covered = judged.choice[pixel].is_some();
        self.uncovered += u64::from(!is_covered);
        if point.facing < LEAST_FACING {
            self.grazing.add(class);
        } else if is_covered {
            let texels = f64::from(judged.pixels_per_texel[pixel]);
            self.texels.add(texels);
            self.under += u64::from(texels > 1.0);
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

/// A sum over a count, 0 where nothing was counted.
fn ratio(sum: f64, count: u64) -> f64 {
    if count == 0 { 0.0 } else { sum / count as f64 }
}
