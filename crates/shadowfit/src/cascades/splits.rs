//! The splits: view depths where one map ends and the next begins.
//!
//! Each map gets a separate range of view depths. Fixed schemes place the splits by depth alone.
//! Content-aware schemes place them where they improve the most visible pixels.

use core::cell::OnceCell;

use crate::base::checks::ROUNDING;
use crate::base::{FitError, checks};
use crate::fits::{Covers, Frame};
use crate::technique::Cascades;
use crate::technique::settings::{MAX_MAPS, SplitScheme, Stabilise};
use crate::view::{Depths, Range, RayCount};

use super::bins::{BINS, Bins, Splits, Weights, even, weights_of_boxes, weights_of_histogram};
use super::extents::{Maps, Sizes, slice_bin};
use super::optimise;

/// Computes the splits of a fixed scheme for `count` maps over a range of view depths.
///
/// The practical scheme of parallel-split shadow maps lies between uniform and logarithmic splits (F. Zhang,
/// H. Sun, L. Xu, L. K. Lun, "Parallel-split shadow maps for large-scale virtual environments", 2006):
/// `λ log + (1 - λ) uniform`.
fn practical(near: f64, far: f64, count: usize, lambda: f64) -> Splits {
    let mut splits = [far as f32; MAX_MAPS + 1];
    for (i, split) in splits.iter_mut().enumerate().take(count) {
        let share = i as f64 / count as f64;
        let uniform = near + (far - near) * share;
        let logarithmic = near * libm::exp2(libm::log2(far / near) * share);
        *split = (lambda * logarithmic + (1.0 - lambda) * uniform) as f32;
    }
    splits
}

/// Splits of an earlier frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct HeldSplits {
    pub(super) splits: Splits,
    /// View depths over which the splits were distributed, in metres.
    spread: (f64, f64),
    /// View depth at which shadows ended when the splits were chosen, in metres.
    far: f32,
    /// Frames since the last comparison with the best splits.
    age: u32,
}

/// Frames between two comparisons of held splits with the best ones, which take most of the time of a fit.
/// Every frame checks whether held splits reach far enough.
const COMPARE_EVERY: u32 = 8;

/// Chooses the splits of a frame.
pub(super) struct Chooser<'a, 'b> {
    frame: &'a Frame<'a, 'b>,
    settings: &'a Cascades,
    /// Computed once, to compare held splits with the best ones, to choose new ones, or both.
    estimate: OnceCell<Estimate>,
}

/// Input of the search for the best splits.
struct Estimate {
    bins: Bins,
    /// Visible share of each bin.
    weights: Weights,
    /// Map size of any run of bins.
    sizes: Sizes,
}

impl<'a, 'b> Chooser<'a, 'b> {
    pub(super) fn new(frame: &'a Frame<'a, 'b>, settings: &'a Cascades) -> Self {
        Self { frame, settings, estimate: OnceCell::new() }
    }

    /// Returns this frame's splits. Held splits are used while they are good enough.
    pub(super) fn held_or_chosen(&self, held: Option<HeldSplits>) -> Result<HeldSplits, FitError> {
        let is_held = self.settings.stabilise != Stabilise::Off;
        let spread = self.spread();
        if let Some(held) = held.filter(|_| is_held)
            && let Some(splits) = self.kept(&held.splits, held.far, spread)
        {
            let age = held.age.saturating_add(1);
            let is_young = age < COMPARE_EVERY;
            let (near, far) = held.spread;
            if is_young || self.serves(&splits, Depths { near, far }, spread) {
                return Ok(HeldSplits { splits, age: if is_young { age } else { 0 }, ..held });
            }
        }
        let splits = self.choose(spread)?;
        let Depths { near, far } = self.bounded(spread);
        Ok(HeldSplits { splits, spread: (near, far), far: self.frame.range.far, age: 0 })
    }

    /// Returns the depths over which the maps are distributed: the depths of the receivers in view, if known.
    fn spread(&self) -> Depths {
        let (near, far) = (f64::from(self.frame.range.near), f64::from(self.frame.range.far));
        let (near, far) = match self.frame.content.depth_range() {
            Some(seen) => (seen.near.max(near), seen.far.min(far)),
            None => (near, far),
        };
        // Logarithms need a positive near end. No practical view has a greater depth ratio than this.
        let near = near.max(far * NEAREST);
        Depths { near: if near < far { near } else { far * 0.5 }, far }
    }

    /// Limits the depths to the visible depth bounds, if they are known and the scheme is not content-aware
    /// itself.
    fn bounded(&self, spread: Depths) -> Depths {
        let is_fixed = !matches!(self.settings.splits, SplitScheme::FromBoxes | SplitScheme::FromHistogram);
        let Some(bounds) = self.frame.input.depth_bounds.filter(|_| is_fixed) else { return spread };
        let within = |bound: f32| f64::from(bound).max(spread.near).min(spread.far);
        Depths { near: within(bounds.near), far: within(bounds.far) }
    }

    /// Returns the view depth to which the last map reaches. Fits that clip receivers to their slice reach to
    /// the end of shadows, other fits to the farthest receiver. Held splits leave room for some movement, and
    /// no turn of the camera exceeds them.
    fn end(&self, spread: Depths) -> f64 {
        let far = f64::from(self.frame.range.far);
        if self.frame.rule.form.whole_distance {
            return far;
        }
        let is_held = self.settings.stabilise != Stabilise::Off;
        let end = if is_held { self.frame.content.farthest().map(|far| far * (1.0 + FAR_ROOM)) } else { None };
        end.unwrap_or(spread.far).min(far)
    }

    /// Chooses splits by the technique's scheme over the given depths.
    fn choose(&self, spread: Depths) -> Result<Splits, FitError> {
        let count = self.settings.count as usize;
        let Depths { near, far } = self.bounded(spread);
        let splits = match self.settings.splits {
            SplitScheme::Uniform => practical(near, far, count, 0.0),
            SplitScheme::Logarithmic => practical(near, far, count, 1.0),
            SplitScheme::Practical(lambda) => {
                let lambda = checks::within("the splits' lambda", f64::from(lambda), 0.0, 1.0)?;
                practical(near, far, count, lambda)
            }
            SplitScheme::Manual(splits) => manual(&splits, count, self.frame.range)?,
            SplitScheme::FromBoxes | SplitScheme::FromHistogram => return Ok(self.by_content(spread)),
        };
        Ok(self.whole(splits, spread))
    }

    /// Makes splits ascend from the near end of the shadowed range to [`Self::end`].
    fn whole(&self, mut splits: Splits, spread: Depths) -> Splits {
        let count = self.settings.count as usize;
        let end = self.end(spread) as f32;
        splits[0] = self.frame.range.near;
        for i in 1..=MAX_MAPS {
            splits[i] = if i >= count { end } else { splits[i].max(splits[i - 1]).min(end) };
        }
        splits
    }

    /// Computes the best splits for the visible surfaces.
    fn by_content(&self, spread: Depths) -> Splits {
        let Estimate { bins, weights, sizes } = self.estimate(spread);
        let chosen = optimise::best(bins, weights, sizes, self.settings.count as usize);
        let mut splits = [0.0; MAX_MAPS + 1];
        let (beyond, mut next) = (self.read_beyond(bins), 0);
        for (split, bin) in splits.iter_mut().zip(chosen) {
            let bin = slice_bin(bins, bin, beyond).max(next);
            *split = bins.start(bin) as f32;
            // Each map gets at least one bin.
            next = bin + 1;
        }
        self.whole(splits, spread)
    }

    /// Returns the splits of an earlier frame, in which shadows ended at `last_far`, if they hold all depths
    /// of this frame and not far more. Rounding of the camera's matrix changes only their far end.
    fn kept(&self, splits: &Splits, last_far: f32, now: Depths) -> Option<Splits> {
        let count = self.settings.count as usize;
        let (end, far) = (f64::from(splits[count]), f64::from(self.frame.range.far));
        let is_wasteful = end > self.end(now) * f64::from(self.settings.stabilise.max_oversize());
        let needed = now.far.min(far);
        let is_same_far = (far - f64::from(last_far)).abs() <= far.abs() * FAR_ROUNDING;
        let reaches = end >= needed || (is_same_far && end >= f64::from(last_far));
        if is_wasteful || !reaches || !self.is_same_near(splits[0]) {
            return None;
        }
        let mut kept = *splits;
        for end in &mut kept[count..] {
            *end = end.max(needed as f32);
        }
        Some(kept)
    }

    /// Returns whether the near end of the shadowed range differs from an earlier frame's only by rounding.
    fn is_same_near(&self, held: f32) -> bool {
        let Range { near, far } = self.frame.range;
        let distances = checks::length(self.frame.content.origin) + f64::from(far.abs());
        let rounding = f64::from(held.abs()) * NEAR_ROUNDING + distances * ROUNDING;
        (f64::from(near) - f64::from(held)).abs() <= rounding
    }

    /// Returns whether splits of an earlier frame are still good enough for this one, compared with the best
    /// ones.
    fn serves(&self, splits: &Splits, held: Depths, now: Depths) -> bool {
        let count = self.settings.count as usize;
        let max_oversize = f64::from(self.settings.stabilise.max_oversize());
        if !matches!(self.settings.splits, SplitScheme::FromBoxes | SplitScheme::FromHistogram) {
            let is_near = |now: f64, held: f64| now >= held / max_oversize && now <= held * max_oversize;
            let bounded = self.bounded(now);
            // Without bounds, the splits must reach the far end anyway.
            return is_near(bounded.near, held.near) && (bounded == now || is_near(bounded.far, held.far));
        }
        let Estimate { bins, weights, sizes } = self.estimate(now);
        let mut chosen = [bins.count; MAX_MAPS + 1];
        for (bin, split) in chosen.iter_mut().zip(splits).take(count) {
            *bin = bins.nearest(f64::from(*split));
            *bin = if *bin == 0 { 0 } else { (*bin + self.read_beyond(bins)).min(bins.count) };
        }
        optimise::is_near_best(bins, weights, sizes, &chosen[..=count], max_oversize)
    }

    /// Returns the smallest number of maps whose best splits reach `max_oversize` times the bound of the full
    /// count.
    pub(super) fn fewest(&self, max_oversize: f64) -> u32 {
        let Estimate { bins, weights, sizes } = self.estimate(self.spread());
        optimise::fewest(bins, weights, sizes, self.settings.count as usize, max_oversize) as u32
    }

    /// Returns the input of the search for the best splits over the given depths.
    fn estimate(&self, spread: Depths) -> &Estimate {
        self.estimate.get_or_init(|| {
            let bins = self.bins(spread);
            Estimate { bins, weights: self.weights(&bins), sizes: self.sizes(&bins) }
        })
    }

    /// Estimates the map size of any run of bins.
    fn sizes(&self, bins: &Bins) -> Sizes {
        let maps = Maps {
            content: self.frame.content,
            axes: self.frame.light.axes(self.frame.rule.form.roll),
            rule: self.frame.rule,
            is_snapped: matches!(self.settings.stabilise, Stabilise::Snap { .. }),
            near: f64::from(self.frame.range.near),
            end: self.end(Depths { near: bins.near, far: bins.far }),
        };
        let sizes = maps.sizes(bins);
        match self.read_beyond(bins) {
            0 => sizes,
            beyond => sizes.by_reading(bins, beyond),
        }
    }

    /// Returns the bins of a range of view depths.
    fn bins(&self, spread: Depths) -> Bins {
        Bins::new(spread.near, spread.far, if self.frame.rule.serves_all { SHARED_BINS } else { BINS })
    }

    /// Returns the number of bins that maps are read beyond their slices.
    fn read_beyond(&self, bins: &Bins) -> usize {
        let octaves = match self.frame.rule.form.covers {
            _ if !self.frame.rule.serves_all => return 0,
            Covers::Sphere => SPHERE_BEYOND,
            _ => RECTANGLE_BEYOND,
        };
        libm::round(octaves / bins.log_step) as usize
    }

    fn weights(&self, bins: &Bins) -> Weights {
        let rays = if self.frame.rule.serves_all { RayCount::COARSE } else { RayCount::FINE };
        let weights = match (self.settings.splits, &self.frame.input.histogram) {
            (SplitScheme::FromHistogram, Some(histogram)) if !histogram.is_empty() => {
                let (seen, guess) =
                    (weights_of_histogram(histogram, bins), weights_of_boxes(self.frame.content, bins, rays));
                let share = if self.frame.content.knows_receivers() { GUESS } else { BLIND_GUESS };
                mixed(&seen, &guess, share)
            }
            _ => weights_of_boxes(self.frame.content, bins, rays),
        };
        if self.frame.rule.serves_all && self.frame.rule.form.covers == Covers::Sphere {
            return mixed(&weights, &even(bins), UNSEEN);
        }
        weights
    }
}

/// Mixes two weights, with a share of the second.
fn mixed(one: &Weights, other: &Weights, share: f64) -> Weights {
    core::array::from_fn(|i| core::array::from_fn(|c| one[i][c] * (1.0 - share) + other[i][c] * share))
}

/// Octaves of view depth that maps are read beyond their slices by coverage, for spheres and for rectangles.
/// Points at these depths need no coarser map. Chosen on fifteen scenes. With 0 and 0.9 the texels of stable
/// maps are a tenth coarser on average.
const SPHERE_BEYOND: f64 = 0.35;
const RECTANGLE_BEYOND: f64 = 0.1;

/// Share of equal weights for all depths, for stable maps. Their splits are held for long, beyond the
/// surfaces visible at the start of a path. Chosen with the octaves above.
const UNSEEN: f64 = 0.1;

/// Bins for maps that are read by coverage. Their exact splits matter less, since they are read beyond their
/// splits.
const SHARED_BINS: usize = 32;

/// Weight of the estimate from boxes beside a histogram, for surfaces that have come into view since or that
/// the few samples missed. Chosen on real scenes, where 0 and 0.6 are both worse by 2%.
const GUESS: f64 = 0.3;

/// Weight of equal shares beside a histogram if no boxes are known. It is less than the share above the
/// quantile, so that it only decides where the histogram does not.
const BLIND_GUESS: f64 = 0.02;

/// Relative error of a far plane's view depth. For an f32 matrix of plain depth it is 4 · 2⁻²⁴ · far / near,
/// which reaches this value at 65,000 times the near depth.
const FAR_ROUNDING: f64 = 1.0 / 64.0;

/// Relative error of a near plane's view depth, in addition to the errors from the eye's distance to the
/// world's origin and from the view's extent.
const NEAR_ROUNDING: f64 = 1e-3;

/// Room that held splits leave beyond the farthest receiver, as a share of its distance.
const FAR_ROOM: f64 = 0.1;

/// Least view depth at which the distribution of maps starts, as a share of the farthest.
const NEAREST: f64 = 1.0 / 65_536.0;

/// Checks and returns manual splits.
fn manual(given: &[f32; MAX_MAPS - 1], count: usize, range: Range) -> Result<Splits, FitError> {
    let mut splits = [range.far; MAX_MAPS + 1];
    splits[0] = range.near;
    for i in 1..count {
        splits[i] = checks::finite("a manual split", f64::from(given[i - 1]))? as f32;
        if i > 1 && splits[i] <= splits[i - 1] {
            return Err(FitError::NearNotBelowFar { near: splits[i - 1], far: splits[i] });
        }
    }
    Ok(splits)
}
