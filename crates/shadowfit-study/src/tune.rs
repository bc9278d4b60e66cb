//! The search for the technique with the least error in a scene, within a budget of maps and texels.
//!
//! One thing is changed at a time, in a fixed order, and kept when it helps: the same scene, path and GPU always give
//! the same result, and the gain of each change is known.

use anyhow::{Context, Result, ensure};
use shadowfit::Technique;
use shadowfit::settings::{
    BiasSettings, FilterKind, FitKind, HoldSettings, ReceiverSource, RectangleKind, SplitScheme, Stabilise,
};
use shadowfit_truth::PictureTally;

use crate::{Comparison, NamedTechnique, SharedTruth, View, ensure_judged};

/// How much each error of a technique counts: weights of shares in per cent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Of all wrong pixels.
    pub wrong: f64,
    /// Of false shadow, again: acne is seen at once.
    pub false_shadow: f64,
    /// Of false light, again.
    pub false_light: f64,
    /// Of holes, again.
    pub hole: f64,
    /// Of the mean difference between the filtered factor and the truth.
    pub mean_error: f64,
    /// Of edge pixels that change from frame to frame.
    pub crawl: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { wrong: 1.0, false_shadow: 10.0, false_light: 2.0, hole: 10.0, mean_error: 0.0, crawl: 0.01 }
    }
}

impl Weights {
    /// The weighted error of a tally; infinite where nothing was judged.
    pub fn error(&self, tally: &PictureTally) -> f64 {
        let Some(figures) = tally.figures() else { return f64::INFINITY };
        self.wrong * figures.wrong
            + self.false_shadow * figures.false_shadow
            + self.false_light * figures.false_light
            + self.hole * figures.hole
            + self.mean_error * figures.mean_error
            + self.crawl * figures.crawl.unwrap_or(0.0)
    }
}

/// What may be spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Most maps.
    pub maps: u32,
    /// Width and height of each, in texels.
    pub resolution: u32,
}

/// A change that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What was changed.
    pub what: String,
    /// Weighted error with it.
    pub error: f64,
    /// Sums over all frames with it.
    pub tally: PictureTally,
    /// Whether it was kept.
    pub is_kept: bool,
}

/// The outcome of a search.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The best technique found.
    pub technique: NamedTechnique,
    /// Its sums over all frames.
    pub tally: PictureTally,
    /// All that was tried, in order; the first is the start.
    pub steps: Vec<Step>,
    /// Whether the search was stopped before its end.
    pub stopped_early: bool,
}

/// A change that may help.
struct Change {
    what: String,
    apply: Box<dyn Fn(&mut Technique)>,
}

impl Change {
    fn new(what: impl Into<String>, apply: impl Fn(&mut Technique) + 'static) -> Self {
        Self { what: what.into(), apply: Box::new(apply) }
    }
}

/// Searches. `progress(tried, at most)` is called after each candidate, and stops the search when it answers `false`.
///
/// # Errors
///
/// When there are no views, one cannot be drawn, or none shows a surface that faces the light.
pub fn tune(
    comparison: &mut Comparison,
    views: &[View],
    budget: Budget,
    weights: &Weights,
    progress: &mut dyn FnMut(usize, usize) -> bool,
) -> Result<Tuned> {
    ensure!(!views.is_empty(), "there is no frame to tune for");
    let mut truths: Vec<SharedTruth> = views.iter().map(|_| SharedTruth::default()).collect();
    let rounds = rounds(budget);
    let most = 1 + rounds.iter().map(Vec::len).sum::<usize>();
    let mut best = start(budget);
    let mut tally = measure(comparison, views, &mut truths, &best)?;
    let mut error = weights.error(&tally);
    let mut tried = vec![in_effect(&best)];
    let mut steps = vec![Step { what: "the start".to_owned(), error, tally: tally.clone(), is_kept: true }];
    let mut goes_on = progress(1, most);
    for changes in rounds {
        // The best of each round is kept.
        let from = best;
        let mut kept = None;
        for change in changes {
            let mut candidate = from;
            (change.apply)(&mut candidate);
            if !goes_on || tried.contains(&in_effect(&candidate)) {
                continue;
            }
            tried.push(in_effect(&candidate));
            let found = measure(comparison, views, &mut truths, &candidate).with_context(|| change.what.clone())?;
            let new_error = weights.error(&found);
            steps.push(Step { what: change.what, error: new_error, tally: found.clone(), is_kept: false });
            if new_error < error {
                (error, tally, best, kept) = (new_error, found, candidate, Some(steps.len() - 1));
            }
            goes_on = progress(steps.len(), most);
        }
        if let Some(kept) = kept {
            steps[kept].is_kept = true;
        }
    }
    let summary = format!("the least error found with {} maps of {} texels", budget.maps, budget.resolution);
    let technique = NamedTechnique { name: "tuned".to_owned(), summary, technique: best };
    Ok(Tuned { technique, tally, steps, stopped_early: !goes_on })
}

/// A technique without what has no effect on its maps: of windows that of splits, stabilisation and rectangle.
fn in_effect(technique: &Technique) -> Technique {
    if technique.fit.kind != FitKind::Windows {
        return *technique;
    }
    let Technique { splits, overlap, stabilise, hold, fit, .. } = Technique::default();
    let fit = technique.fit.with_rectangle(fit.rectangle);
    let hold = hold.with_waste(technique.hold.waste);
    Technique { splits, overlap, stabilise, hold, fit, choice: technique.map_choice(), ..*technique }
}

/// The recommended technique, within the budget.
fn start(budget: Budget) -> Technique {
    Technique::default().with_count(budget.maps).with_resolution(budget.resolution, budget.resolution)
}

/// The changes that are tried, round by round: what matters most comes first.
fn rounds(budget: Budget) -> Vec<Vec<Change>> {
    let mut rounds = vec![fits(), biases(), filters()];
    if budget.maps > 1 {
        rounds.push(splits());
        rounds.push(counts(budget.maps));
    }
    rounds.extend([stillness(), rectangles(), fine_biases(), filters()]);
    rounds
}

fn fits() -> Vec<Change> {
    let kinds = [
        ("boxes of the frustum's slices", FitKind::FrustumAabb, ReceiverSource::Clusters),
        ("least rectangles of the frustum", FitKind::Oriented, ReceiverSource::Clusters),
        ("spheres around the frustum's slices", FitKind::Sphere, ReceiverSource::Clusters),
        ("least rectangles around the objects in view", FitKind::Focused, ReceiverSource::Objects),
        ("least rectangles around the clusters in view", FitKind::Focused, ReceiverSource::Clusters),
    ];
    let change = |(what, kind, receivers)| {
        Change::new(what, move |technique: &mut Technique| {
            technique.fit.kind = kind;
            technique.receivers = receivers;
        })
    };
    kinds.into_iter().map(change).collect()
}

fn biases() -> Vec<Change> {
    vec![
        Change::new("an offset along the normal", |technique| {
            technique.bias = BiasSettings::automatic_normal_offset(technique.filter, &technique.softness);
        }),
        Change::new("no bias", |technique| {
            technique.bias =
                BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
        }),
    ]
}

/// Filters whose widths are numbers of texels, each with the bias of the present kind that it needs. Truth has a hard
/// sun, to which soft ones only add noise.
fn filters() -> Vec<Change> {
    let filters = [
        ("one comparison", FilterKind::Point),
        ("2×2 comparison", FilterKind::Hardware2x2),
        ("a tent of 3×3", FilterKind::Pcf3x3),
        ("a tent of 5×5", FilterKind::Pcf5x5),
        ("a tent of 7×7", FilterKind::Pcf7x7),
    ];
    let change = |(what, filter): (&str, FilterKind)| {
        Change::new(what, move |technique: &mut Technique| {
            let softness = technique.softness;
            let offset = |filter| BiasSettings::automatic_normal_offset(filter, &softness);
            if technique.bias == BiasSettings::automatic(technique.filter) {
                technique.bias = BiasSettings::automatic(filter);
            } else if technique.bias == offset(technique.filter) {
                technique.bias = offset(filter);
            }
            technique.filter = filter;
        })
    };
    filters.into_iter().map(change).collect()
}

fn splits() -> Vec<Change> {
    let schemes = [
        ("uniform splits", SplitScheme::Uniform),
        ("practical splits, 0.8", SplitScheme::Practical(0.8)),
        ("logarithmic splits", SplitScheme::Logarithmic),
        ("splits from the boxes", SplitScheme::FromBoxes),
    ];
    let change = |(what, splits)| Change::new(what, move |technique: &mut Technique| technique.splits = splits);
    schemes.into_iter().map(change).collect()
}

fn counts(maps: u32) -> Vec<Change> {
    let fewer = (1..maps).rev().take(2);
    let change =
        |count| Change::new(format!("{count} maps only"), move |technique: &mut Technique| technique.count = count);
    fewer.map(change).collect()
}

fn stillness() -> Vec<Change> {
    vec![
        Change::new("maps fitted anew in each frame", |technique| technique.stabilise = Stabilise::Off),
        Change::new("maps on a grid of whole texels", |technique| technique.stabilise = Stabilise::Snap),
        Change::new("maps held longer", |technique| technique.hold = HoldSettings::default().with_waste(3.0)),
        Change::new("maps held for a shorter time", |technique| {
            technique.hold = HoldSettings::default().with_waste(1.3).with_growth(1.2);
        }),
    ]
}

fn rectangles() -> Vec<Change> {
    let kinds = [
        ("rectangles along the light's axes", RectangleKind::AxisAligned),
        ("least squares instead of rectangles", RectangleKind::MinimumSquare),
    ];
    let change = |(what, kind)| Change::new(what, move |technique: &mut Technique| technique.fit.rectangle = kind);
    kinds.into_iter().map(change).collect()
}

/// Small moves away from the bias that is provably enough.
fn fine_biases() -> Vec<Change> {
    let scaled = |what: &str, scale: f32| {
        Change::new(what, move |technique: &mut Technique| {
            technique.bias.receiver_plane *= scale;
            technique.bias.normal_offset *= scale;
        })
    };
    vec![
        scaled("half the bias", 0.5),
        scaled("three quarters of the bias", 0.75),
        scaled("one and a half times the bias", 1.5),
        Change::new("a constant bias of half a texel", |technique| technique.bias.constant = 0.5),
    ]
}

/// Sums over all frames.
fn measure(
    comparison: &mut Comparison,
    views: &[View],
    truths: &mut [SharedTruth],
    technique: &Technique,
) -> Result<PictureTally> {
    comparison.clear();
    comparison.add(*technique)?;
    let mut tally = PictureTally::default();
    for (view, truth) in views.iter().zip(truths) {
        for outcome in comparison.frame(view, truth)? {
            tally.merge(&outcome.judged.tally);
        }
    }
    comparison.clear();
    ensure_judged(&tally)?;
    Ok(tally)
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit_truth::ClassTally;

    #[test]
    fn every_change_but_those_to_what_is_already_so_makes_another_technique() {
        let start = start(Budget { maps: 4, resolution: 1024 });
        let changes: Vec<Change> = rounds(Budget { maps: 4, resolution: 1024 }).into_iter().flatten().collect();
        assert!(changes.len() > 20, "{}", changes.len());
        for change in changes {
            let mut changed = start;
            (change.apply)(&mut changed);
            assert!(changed != start || change.what == "a tent of 5×5", "{}", change.what);
        }
    }

    #[test]
    fn splits_and_stillness_of_windows_are_not_tried() {
        let with = |kind| Technique::default().with_fit(Technique::default().fit.with_kind(kind));
        let changed = |kind| with(kind).with_splits(SplitScheme::Uniform).with_stabilise(Stabilise::Off);
        assert_eq!(in_effect(&changed(FitKind::Windows)), in_effect(&with(FitKind::Windows)));
        assert_ne!(in_effect(&changed(FitKind::Focused)), in_effect(&with(FitKind::Focused)));
        let fewer = with(FitKind::Windows).with_count(3);
        assert_eq!(in_effect(&fewer), fewer);
    }

    #[test]
    fn the_search_starts_with_the_recommended_technique() {
        let start = start(Budget { maps: 4, resolution: 1024 });
        assert_eq!(start, Technique::default().with_resolution(1024, 1024));
    }

    #[test]
    fn a_change_of_the_filter_takes_the_bias_along() {
        let mut technique = Technique {
            bias: BiasSettings::automatic(FilterKind::Pcf3x3),
            ..start(Budget { maps: 1, resolution: 512 })
        };
        (filters()[0].apply)(&mut technique);
        assert_eq!((technique.filter, technique.bias), (FilterKind::Point, BiasSettings::automatic(FilterKind::Point)));
    }

    #[test]
    fn the_error_is_the_sum_of_the_weighted_shares_in_per_cent() {
        let all = ClassTally { facing: 200, wrong: 30, false_shadow: 10, false_light: 4, hole: 6, edge: 10 };
        let tally = PictureTally {
            frames: 1,
            all,
            error: 5.0,
            crawl_compared: 50,
            crawl_different: 4,
            ..PictureTally::default()
        };
        let none = Weights { wrong: 0.0, false_shadow: 0.0, false_light: 0.0, hole: 0.0, mean_error: 0.0, crawl: 0.0 };
        for (weights, error) in [
            (Weights { wrong: 1.0, ..none }, 15.0),
            (Weights { false_shadow: 2.0, ..none }, 10.0),
            (Weights { false_light: 3.0, ..none }, 6.0),
            (Weights { hole: 1.0, ..none }, 3.0),
            (Weights { mean_error: 4.0, ..none }, 10.0),
            (Weights { crawl: 0.5, ..none }, 4.0),
            (Weights { wrong: 1.0, hole: 2.0, crawl: 1.0, ..none }, 29.0),
        ] {
            assert!((weights.error(&tally) - error).abs() < 1e-9, "{weights:?}: {}", weights.error(&tally));
        }
    }
}
