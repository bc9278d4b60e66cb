//! Search for the technique with the smallest error in a scene, within a budget of maps and texels.
//!
//! The search changes one thing at a time, in a fixed order, and keeps changes that help. The same scene,
//! path and GPU always give the same result, and the gain of each change is known.

mod changes;

use anyhow::{Context, Error, Result, ensure};
use shadowfit::{FitError, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::ProbeError;
use shadowfit_truth::PictureTally;
use shadowfit_wgpu::ShadowMapError;

use self::changes::{Change, maps, rounds};
use crate::{Comparison, NamedTechnique, SharedTruth, View, ensure_judged};

/// Weights of a technique's errors, for shares in per cent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Weight of all wrong pixels.
    pub wrong: f64,
    /// Additional weight of false shadow, because acne is conspicuous.
    pub false_shadow: f64,
    /// Additional weight of false light.
    pub false_light: f64,
    /// Additional weight of holes.
    pub hole: f64,
    /// Weight of the error of the sunlight ([`light_error`](shadowfit_truth::PictureFigures::light_error)). It shows
    /// surfaces that a bias darkens by less than half, which are not wrong.
    pub light_error: f64,
    /// Weight of edge pixels that change from frame to frame.
    pub crawl: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { wrong: 1.0, false_shadow: 10.0, false_light: 2.0, hole: 10.0, light_error: 0.25, crawl: 0.01 }
    }
}

impl Weights {
    /// Returns the weighted error of a tally. Infinite if no pixel was judged.
    pub fn error(&self, tally: &PictureTally) -> f64 {
        let Some(figures) = tally.figures() else { return f64::INFINITY };
        self.wrong * figures.wrong
            + self.false_shadow * figures.false_shadow
            + self.false_light * figures.false_light
            + self.hole * figures.hole
            + self.light_error * figures.light_error
            + self.crawl * figures.crawl.unwrap_or(0.0)
    }
}

/// The budget of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Greatest number of maps.
    pub maps: u32,
    /// Width and height of each map, in texels.
    pub resolution: u32,
}

/// Parts of a technique that a search may change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TuneScope {
    /// Everything except the size of the maps. The number of maps may only fall.
    #[default]
    Everything,
    /// Only bias and filter: the maps and their fit stay the same. A
    /// [soft](shadowfit::settings::FilterKind::is_soft) filter also stays, because the truth has a hard sun.
    BiasAndFilter,
}

/// Start, scope and weights of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TuneSettings {
    /// Technique to start with. Its number and size of maps are the budget. Default: the recommended
    /// technique.
    pub start: Technique,
    /// Inputs of its fits. Default: [`Inputs::default`].
    pub inputs: Inputs,
    /// Parts that may change. Default: everything.
    pub scope: TuneScope,
    /// Weights of the errors. Default: [`Weights::default`].
    pub weights: Weights,
}

impl TuneSettings {
    /// Returns a search for the best technique within a budget, starting with the recommended technique.
    pub fn within(budget: Budget) -> Self {
        let start = Technique::default().with_count(budget.maps);
        Self { start: start.with_resolution(budget.resolution, budget.resolution), ..Self::default() }
    }
}

/// Progress of a search, reported after each technique.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Number of techniques tried, including the first one.
    pub tried: usize,
    /// Greatest number of techniques that will be tried.
    pub at_most: usize,
    /// Smallest weighted error so far.
    pub best_error: f64,
    /// Weighted error of the technique that the search started with.
    pub start_error: f64,
    /// Description of the last change.
    pub what: String,
}

/// A change that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Description of the change.
    pub what: String,
    /// Weighted error with the change.
    pub error: f64,
    /// Sums over all frames with the change.
    pub tally: PictureTally,
    /// Whether the change was kept.
    pub is_kept: bool,
}

/// The outcome of a search.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// The best technique found.
    pub technique: NamedTechnique,
    /// Its sums over all frames.
    pub tally: PictureTally,
    /// All changes that were tried, in order. The first step is the start.
    pub steps: Vec<Step>,
    /// Whether the search was stopped before its end.
    pub stopped_early: bool,
}

/// A running search.
struct Search<'a> {
    comparison: &'a mut Comparison,
    views: &'a [View],
    truths: Vec<SharedTruth>,
    weights: &'a Weights,
    at_most: usize,
    /// All techniques that were tried.
    tried: Vec<Technique>,
    steps: Vec<Step>,
    best: Technique,
    /// Inputs of all fits.
    inputs: Inputs,
    /// Index of the best technique in the steps.
    best_step: usize,
}

/// Searches for the best technique. Calls `progress` after each technique, and stops if it returns `false`.
///
/// It can run on another thread, with a comparison that has another [`Gpu`](shadowfit_render::Gpu):
///
/// ```no_run
/// # use std::sync::mpsc::{Receiver, channel};
/// # use shadowfit::Technique;
/// # use shadowfit_study::{Comparison, Progress, Tuned, TuneScope, TuneSettings, View, tune};
/// # fn begin(mut comparison: Comparison, views: Vec<View>, present: Technique) -> Receiver<Progress> {
/// let settings = TuneSettings { start: present, scope: TuneScope::BiasAndFilter, ..TuneSettings::default() };
/// let (sender, progress) = channel();
/// std::thread::spawn(move || {
///     // If the receiver was dropped, the search stops.
///     let tuned = tune(&mut comparison, &views, &settings, &mut |progress| sender.send(progress.clone()).is_ok());
///     // ...
/// #   drop(tuned);
/// });
/// # progress
/// # }
/// ```
///
/// Changes that the fit or the shadow map refuses are skipped.
///
/// # Errors
///
/// If there are no views, one cannot be drawn, or none shows a surface that faces the light.
pub fn tune(
    comparison: &mut Comparison,
    views: &[View],
    settings: &TuneSettings,
    progress: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Tuned> {
    pollster::block_on(tune_async(comparison, views, settings, progress))
}

/// Searches like [`tune`]. A browser can do other work while the GPU draws.
///
/// # Errors
///
/// As for [`tune`].
pub async fn tune_async(
    comparison: &mut Comparison,
    views: &[View],
    settings: &TuneSettings,
    progress: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Tuned> {
    ensure!(!views.is_empty(), "there is no frame to tune for");
    let rounds = rounds(&settings.start, settings.scope);
    let mut search = Search {
        comparison,
        views,
        truths: views.iter().map(|_| SharedTruth::default()).collect(),
        weights: &settings.weights,
        at_most: 1 + rounds.iter().map(Vec::len).sum::<usize>(),
        tried: Vec::new(),
        steps: Vec::new(),
        best: settings.start,
        inputs: settings.inputs,
        best_step: 0,
    };
    search.measure(&settings.start, "the start").await?;
    search.steps[0].is_kept = true;
    let mut goes_on = progress(&search.progress("the start"));
    for changes in rounds {
        // Keeps the best change of each round.
        let from = search.best;
        for change in changes {
            if goes_on && search.try_change(&from, &change).await? {
                goes_on = progress(&search.progress(&change.what));
            }
        }
        let best = search.best_step;
        search.steps[best].is_kept = true;
    }
    Ok(search.end(!goes_on))
}

impl Search<'_> {
    /// Tries a change, and returns whether it changed the technique.
    async fn try_change(&mut self, from: &Technique, change: &Change) -> Result<bool> {
        let mut candidate = *from;
        (change.apply)(&mut candidate);
        if self.tried.contains(&candidate) {
            return Ok(false);
        }
        match self.measure(&candidate, &change.what).await {
            Err(error) if is_refusal(&error) => {}
            result => result.with_context(|| change.what.clone())?,
        }
        Ok(true)
    }

    /// Measures a technique, which becomes the best one if its error is smaller.
    async fn measure(&mut self, technique: &Technique, what: &str) -> Result<()> {
        self.tried.push(*technique);
        let tally = self.sums(technique).await?;
        let error = self.weights.error(&tally);
        let is_first = self.steps.is_empty();
        if is_first || error < self.steps[self.best_step].error {
            (self.best, self.best_step) = (*technique, self.steps.len());
        }
        self.steps.push(Step { what: what.to_owned(), error, tally, is_kept: false });
        Ok(())
    }

    /// Returns the sums over all frames.
    async fn sums(&mut self, technique: &Technique) -> Result<PictureTally> {
        self.comparison.clear();
        self.comparison.add(NamedTechnique { inputs: self.inputs, ..(*technique).into() })?;
        let mut tally = PictureTally::default();
        for (view, truth) in self.views.iter().zip(&mut self.truths) {
            for outcome in self.comparison.frame_async(view, truth).await? {
                tally.merge(&outcome.judged.tally);
            }
        }
        self.comparison.clear();
        ensure_judged(&tally)?;
        Ok(tally)
    }

    fn progress(&self, what: &str) -> Progress {
        Progress {
            tried: self.tried.len(),
            at_most: self.at_most,
            best_error: self.steps[self.best_step].error,
            start_error: self.steps[0].error,
            what: what.to_owned(),
        }
    }

    fn end(self, stopped_early: bool) -> Tuned {
        let [width, height] = self.best.fit.resolution.to_array();
        let size = if width == height { width.to_string() } else { format!("{width} × {height}") };
        let summary = format!("the least error found with {} of {size} texels", maps(self.best.maps.count()));
        let technique = NamedTechnique { name: "tuned".to_owned(), summary, technique: self.best, inputs: self.inputs };
        Tuned { technique, tally: self.steps[self.best_step].tally.clone(), steps: self.steps, stopped_early }
    }
}

/// Returns whether the technique was refused, as opposed to a failure of the machine.
fn is_refusal(error: &Error) -> bool {
    error.is::<FitError>()
        || error.is::<ShadowMapError>()
        || matches!(error.downcast_ref(), Some(ProbeError::ShadowMap(_)))
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;
    use std::thread;

    use glam::{DVec3, Vec3};
    use shadowfit::PerspectiveCamera;
    use shadowfit::settings::{BiasSettings, CasterPolicy, FilterKind};
    use shadowfit_scene::Scene;
    use shadowfit_testing::renderer_gpu;
    use shadowfit_truth::ClassTally;

    use super::*;
    use crate::Judging;

    #[test]
    fn the_search_within_a_budget_starts_with_the_recommended_technique() {
        let settings = TuneSettings::within(Budget { maps: 4, resolution: 1024 });
        assert_eq!(settings.start, Technique::default().with_resolution(1024, 1024));
        assert_eq!(settings.scope, TuneScope::Everything);
    }

    #[test]
    fn the_error_is_the_sum_of_the_weighted_shares_in_per_cent() {
        let all = ClassTally { facing: 200, wrong: 30, false_shadow: 10, false_light: 4, hole: 6, edge: 10 };
        let tally = PictureTally {
            frames: 1,
            all,
            light: 50.0,
            light_error: 5.0,
            crawl_compared: 50,
            crawl_different: 4,
            ..PictureTally::default()
        };
        let none = Weights { wrong: 0.0, false_shadow: 0.0, false_light: 0.0, hole: 0.0, light_error: 0.0, crawl: 0.0 };
        for (weights, error) in [
            (Weights { wrong: 1.0, ..none }, 15.0),
            (Weights { false_shadow: 2.0, ..none }, 10.0),
            (Weights { false_light: 3.0, ..none }, 6.0),
            (Weights { hole: 1.0, ..none }, 3.0),
            (Weights { light_error: 2.0, ..none }, 20.0),
            (Weights { crawl: 0.5, ..none }, 4.0),
            (Weights { wrong: 1.0, hole: 2.0, crawl: 1.0, ..none }, 29.0),
        ] {
            assert!((weights.error(&tally) - error).abs() < 1e-9, "{weights:?}: {}", weights.error(&tally));
        }
    }

    /// Returns a floor and a slanted board over it.
    fn scene() -> Scene {
        let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        let quad = |[a, b, c, d]: [Vec3; 4]| vec![[a, b, c], [a, c, d]];
        let floor = quad([at(-9.0, 0.0, -9.0), at(-9.0, 0.0, 9.7), at(9.0, 0.0, 9.7), at(9.0, 0.0, -9.0)]);
        let board = quad([at(-1.0, 0.2, -1.0), at(-1.0, 0.2, 1.0), at(1.0, 1.9, 1.0), at(1.0, 1.9, -1.0)]);
        Scene::from_objects("board", &[floor, board])
    }

    fn views() -> Vec<View> {
        let view = |x: f64, is_first| View {
            camera: PerspectiveCamera {
                eye: DVec3::new(x, 3.0, 6.0),
                forward: Vec3::new(0.0, -0.4, -0.9).normalize(),
                up: Vec3::Y,
                fov_y: 0.8,
                aspect: 16.0 / 9.0,
                near: 0.1,
                far: 40.0,
            }
            .into(),
            direction: Vec3::new(0.5, -0.7, -0.2).normalize(),
            is_first,
        };
        vec![view(0.0, true), view(0.05, false)]
    }

    fn comparison() -> Comparison {
        let judging = Judging { size: [96, 54], ..Judging::default() };
        Comparison::new(renderer_gpu(), scene(), judging).expect("a scene")
    }

    /// Returns coarse maps without a bias, which have acne.
    fn bad() -> Technique {
        let none =
            BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
        let technique = Technique::preset("focused-4").expect("a preset").with_count(2).with_resolution(512, 256);
        technique.with_look_up(FilterKind::Point, none)
    }

    #[test]
    fn gpu_a_search_on_a_thread_tells_how_far_it_is_and_keeps_the_maps_that_it_began_with() {
        let settings = TuneSettings { start: bad(), scope: TuneScope::BiasAndFilter, ..TuneSettings::default() };
        let (sender, receiver) = channel();
        let mut comparison = comparison();
        let search = thread::spawn(move || {
            tune(&mut comparison, &views(), &settings, &mut |progress| sender.send(progress.clone()).is_ok())
        });
        let progress: Vec<Progress> = receiver.iter().collect();
        let tuned = search.join().expect("no panic").expect("tuned");
        let found = tuned.technique.technique;
        assert_eq!(found.with_look_up(bad().filter, bad().bias), bad());
        assert_eq!(tuned.technique.summary, "the least error found with 2 maps of 512 × 256 texels");
        assert!(!tuned.stopped_early && progress.len() == tuned.steps.len());
        for (index, (told, step)) in progress.iter().zip(&tuned.steps).enumerate() {
            assert_eq!((told.tried, &told.what, told.start_error), (index + 1, &step.what, tuned.steps[0].error));
            assert!(told.tried <= told.at_most && told.best_error <= told.start_error);
        }
        let last = progress.last().expect("some");
        assert_eq!(last.best_error, settings.weights.error(&tuned.tally));
        assert!(last.best_error < 0.5 * last.start_error, "{last:?}");
        assert!(tuned.steps.iter().any(|step| step.is_kept && step.error == last.best_error));
    }

    #[test]
    fn gpu_a_search_that_is_stopped_has_the_best_so_far_and_goes_no_farther() {
        let settings = TuneSettings { start: bad(), ..TuneSettings::default() };
        let mut told = 0;
        let mut stop_at_two = |progress: &Progress| {
            told = progress.tried;
            progress.tried < 2
        };
        let tuned = tune(&mut comparison(), &views(), &settings, &mut stop_at_two).expect("stopped, not failed");
        assert!(tuned.stopped_early && tuned.steps.len() == 2 && told == 2);
        let least = tuned.steps.iter().map(|step| step.error).fold(f64::INFINITY, f64::min);
        assert_eq!(settings.weights.error(&tuned.tally), least);
    }

    #[test]
    fn gpu_changes_that_are_refused_are_passed_over_and_a_start_that_is_refused_is_an_error() {
        let mut comparison = comparison();
        let mut search = Search {
            comparison: &mut comparison,
            views: &views(),
            truths: views().iter().map(|_| SharedTruth::default()).collect(),
            weights: &Weights::default(),
            at_most: 9,
            tried: Vec::new(),
            steps: Vec::new(),
            best: bad(),
            inputs: Inputs::default(),
            best_step: 0,
        };
        pollster::block_on(search.measure(&bad(), "the start")).expect("measured");
        let impossible = Change::new("blockers in clamped maps", |technique: &mut Technique| {
            (technique.filter, technique.fit.casters) = (FilterKind::Pcss, CasterPolicy::DepthClamp);
        });
        let no_maps =
            Change::new("no resolution", |technique: &mut Technique| technique.fit.resolution = glam::UVec2::ZERO);
        for change in [impossible, no_maps] {
            assert!(pollster::block_on(search.try_change(&bad(), &change)).expect("passed over"), "{}", change.what);
            assert_eq!((search.steps.len(), search.best), (1, bad()));
        }
        let settings = TuneSettings { start: bad().with_resolution(1, 1), ..TuneSettings::default() };
        assert!(tune(&mut comparison, &views(), &settings, &mut |_| true).is_err());
    }
}
