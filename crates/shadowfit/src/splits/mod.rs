//! Where one map ends and the next begins.
//!
//! FittedMaps give each range of view depths a map of its own. Fixed schemes place the cuts by depth
//! alone; the ones that look at the content place them where the most visible pixels gain.

mod extents;
mod histogram;
mod optimise;
mod visible;

use crate::checks;
use crate::fits::{Content, Light, Range};
use crate::settings::{FitKind, SplitScheme, Stabilise};
use crate::{FitError, FitInput, MAX_MAPS, Technique};

use extents::Sizes;
pub use histogram::{DepthHistogram, needed_texel};
use optimise::{Cuts as BinCuts, least_quantile, quantile};

/// Cuts of all maps, in metres of view depth: map i covers `cuts[i]..cuts[i + 1]`.
pub(crate) type Cuts = [f32; MAX_MAPS + 1];

/// Bins of log view depth that the content is sorted into.
pub(crate) const BINS: usize = 64;

/// Bins at even steps of log view depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bins {
    near: f64,
    far: f64,
    log_near: f64,
    log_step: f64,
}

impl Bins {
    fn new(near: f64, far: f64) -> Self {
        let (log_near, log_far) = (libm::log2(near), libm::log2(far));
        Self { near, far, log_near, log_step: (log_far - log_near) / BINS as f64 }
    }

    /// View depth at which a bin begins, in metres.
    fn start(&self, bin: usize) -> f64 {
        match bin {
            0 => self.near,
            BINS => self.far,
            _ => libm::exp2(self.log_near + self.log_step * bin as f64),
        }
    }

    /// The bin whose beginning is nearest to a view depth.
    fn nearest(&self, depth: f64) -> usize {
        let place = (libm::log2(depth.max(self.near)) - self.log_near) / self.log_step;
        (libm::round(place) as usize).min(BINS)
    }

    /// The bin of a view depth; depths outside go to the first or the last.
    fn of(&self, depth: f64) -> usize {
        let bin = (libm::log2(depth.max(self.near)) - self.log_near) / self.log_step;
        (bin as usize).min(BINS - 1)
    }
}

/// Classes of foreshortening, an octave each: the first holds surfaces that face both the eye and
/// the light, the others those that need texels half as wide, a quarter, and so on.
pub(crate) const CLASSES: usize = 6;

/// Shares of the visible points in each bin and class.
pub(crate) type Weights = [[f64; CLASSES]; BINS];

/// The cuts of a fixed scheme over a range of view depths: `count` maps.
///
/// Uniform and logarithmic cuts are the two ends between which the practical scheme of parallel-split shadow
/// maps lies (F. Zhang, H. Sun, L. Xu, L. K. Lun, "Parallel-split shadow maps for large-scale
/// virtual environments", 2006): `λ log + (1 - λ) uniform`.
pub(crate) fn practical(near: f64, far: f64, count: usize, lambda: f64) -> Cuts {
    let mut cuts = [far as f32; MAX_MAPS + 1];
    for (i, cut) in cuts.iter_mut().enumerate().take(count) {
        let share = i as f64 / count as f64;
        let uniform = near + (far - near) * share;
        let logarithmic = near * libm::exp2(libm::log2(far / near) * share);
        *cut = (lambda * logarithmic + (1.0 - lambda) * uniform) as f32;
    }
    cuts
}

/// Everything a choice of cuts depends on.
pub(crate) struct Chooser<'a, 'b> {
    pub(crate) content: &'a Content<'b>,
    pub(crate) light: Light,
    pub(crate) settings: &'a Technique,
    pub(crate) input: &'a FitInput<'b>,
    /// What is shadowed at all.
    pub(crate) range: Range,
}

impl Chooser<'_, '_> {
    /// The depths between which the maps are spread: those of the receivers in view, if known.
    pub(crate) fn spread(&self) -> (f64, f64) {
        let (near, far) = (f64::from(self.range.near), f64::from(self.range.far));
        let (near, far) = match self.content.depth_range() {
            Some((first, last)) => (first.max(near), last.min(far)),
            None => (near, far),
        };
        // Logarithms need a positive near end; no view of a scene has more octaves than this.
        let near = near.max(far * NEAREST);
        if near < far { (near, far) } else { (far * 0.5, far) }
    }

    /// The same within the bounds of what is visible, if they are known and the scheme does not
    /// look at the content by itself.
    pub(crate) fn bounded(&self, (near, far): (f64, f64)) -> (f64, f64) {
        let is_fixed = !matches!(self.settings.splits, SplitScheme::FromBoxes | SplitScheme::FromHistogram);
        let Some(bounds) = self.input.depth_bounds.filter(|_| is_fixed) else { return (near, far) };
        let within = |bound: f32| f64::from(bound).max(near).min(far);
        (within(bounds.near), within(bounds.far))
    }

    /// View depth to which the last map reaches: that of what is shadowed where fits clip the
    /// receivers to their slice, else that of the receivers. If it is to be held, no turn of the
    /// camera may exceed it, and there is room for some movement.
    fn end(&self, spread: (f64, f64)) -> f64 {
        let far = f64::from(self.range.far);
        if matches!(self.settings.fit.kind, FitKind::Focused | FitKind::XnaSample) {
            return far;
        }
        let is_held = self.settings.stabilise != Stabilise::Off;
        let end = if is_held { self.content.farthest().map(|far| far * (1.0 + FAR_SLACK)) } else { None };
        end.unwrap_or(spread.1).min(far)
    }

    /// The cuts by the settings' scheme over the given depths.
    pub(crate) fn choose(&self, spread: (f64, f64)) -> Result<Cuts, FitError> {
        let count = self.settings.count as usize;
        let (near, far) = self.bounded(spread);
        let cuts = match self.settings.splits {
            SplitScheme::Uniform => practical(near, far, count, 0.0),
            SplitScheme::Logarithmic => practical(near, far, count, 1.0),
            SplitScheme::Practical(lambda) => {
                let lambda = checks::within("the splits' lambda", f64::from(lambda), 0.0, 1.0)?;
                practical(near, far, count, lambda)
            }
            SplitScheme::Manual(cuts) => manual(&cuts, count, self.range)?,
            SplitScheme::FromBoxes | SplitScheme::FromHistogram => return Ok(self.by_content(spread)),
        };
        Ok(self.whole(cuts, spread))
    }

    /// The same cuts, ascending, from the near end of what is shadowed to the far end of the
    /// receivers; where those are clipped to the view anyway, to the far end of what is shadowed.
    fn whole(&self, mut cuts: Cuts, spread: (f64, f64)) -> Cuts {
        let count = self.settings.count as usize;
        let end = self.end(spread) as f32;
        cuts[0] = self.range.near;
        for i in 1..=MAX_MAPS {
            cuts[i] = if i >= count { end } else { cuts[i].max(cuts[i - 1]).min(end) };
        }
        cuts
    }

    /// The cuts that suit what is visible.
    fn by_content(&self, spread: (f64, f64)) -> Cuts {
        let bins = Bins::new(spread.0, spread.1);
        let (weights, sizes) = (self.weights(&bins), Sizes::new(self, &bins));
        let BinCuts { bins: chosen, .. } = least_quantile(&bins, &weights, &sizes, self.settings.count as usize);
        let mut cuts = [0.0; MAX_MAPS + 1];
        for (cut, bin) in cuts.iter_mut().zip(chosen) {
            *cut = bins.start(bin) as f32;
        }
        self.whole(cuts, spread)
    }

    /// Whether cuts of an earlier frame hold all of this one's depths, and not far more.
    pub(crate) fn reaches(&self, cuts: &Cuts, now: (f64, f64)) -> bool {
        let end = f64::from(cuts[self.settings.count as usize]);
        let is_wasteful = end > self.end(now) * f64::from(self.settings.hold.waste);
        end >= now.1.min(f64::from(self.range.far)) && !is_wasteful && cuts[0] == self.range.near
    }

    /// Whether cuts of an earlier frame still do for this one, beside what would be best.
    pub(crate) fn serves(&self, cuts: &Cuts, held: (f64, f64), now: (f64, f64)) -> bool {
        let count = self.settings.count as usize;
        let waste = f64::from(self.settings.hold.waste);
        if !matches!(self.settings.splits, SplitScheme::FromBoxes | SplitScheme::FromHistogram) {
            let is_near = |now: f64, held: f64| now >= held / waste && now <= held * waste;
            let bounded = self.bounded(now);
            // Without bounds the far end is what the cuts have to reach.
            return is_near(bounded.0, held.0) && (bounded == now || is_near(bounded.1, held.1));
        }
        let bins = Bins::new(now.0, now.1);
        let (weights, sizes) = (self.weights(&bins), Sizes::new(self, &bins));
        let best = least_quantile(&bins, &weights, &sizes, count);
        let mut chosen = [BINS; MAX_MAPS + 1];
        for (bin, cut) in chosen.iter_mut().zip(cuts).take(count) {
            *bin = bins.nearest(f64::from(*cut));
        }
        quantile(&bins, &weights, &sizes, &chosen[..=count]) <= best.quality + libm::log2(waste)
    }

    /// The fewest maps whose best cuts reach a bound that is so many times that of all.
    pub(crate) fn fewest(&self, waste: f64) -> u32 {
        let (near, far) = self.spread();
        let bins = Bins::new(near, far);
        optimise::fewest(&bins, &self.weights(&bins), &Sizes::new(self, &bins), self.settings.count as usize, waste)
            as u32
    }

    fn weights(&self, bins: &Bins) -> Weights {
        match (self.settings.splits, &self.input.histogram) {
            (SplitScheme::FromHistogram, Some(histogram)) if !histogram.is_empty() => {
                let (seen, guess) = (histogram.weights(bins), visible::weights(self.content, bins));
                let share = if self.content.receivers.is_some() { GUESS } else { BLIND_GUESS };
                core::array::from_fn(|i| core::array::from_fn(|c| seen[i][c] * (1.0 - share) + guess[i][c] * share))
            }
            _ => visible::weights(self.content, bins),
        }
    }
}

/// Share of the boxes' guess beside a histogram: what came into view since, and what few samples
/// missed. Chosen on real scenes, where 0 and 0.6 are both worse by 2%.
const GUESS: f64 = 0.3;

/// The same where no boxes are known and all depths are guessed alike: less than what a quantile
/// leaves out, so that it only decides where the histogram does not.
const BLIND_GUESS: f64 = 0.02;

/// Room beyond the farthest receiver that held cuts leave, as a share of its distance.
const FAR_SLACK: f64 = 0.1;

/// Nearest view depth that maps are spread from, as a share of the farthest.
const NEAREST: f64 = 1.0 / 65_536.0;

/// Cuts given by hand.
fn manual(given: &[f32; MAX_MAPS - 1], count: usize, range: Range) -> Result<Cuts, FitError> {
    let mut cuts = [range.far; MAX_MAPS + 1];
    cuts[0] = range.near;
    let mut last = f32::MIN;
    for i in 1..count {
        let cut = checks::finite("a manual cut", f64::from(given[i - 1]))? as f32;
        if cut <= last {
            return Err(FitError::NearNotBelowFar { near: last, far: cut });
        }
        (cuts[i], last) = (cut, cut);
    }
    Ok(cuts)
}
