//! Auto-tune: the search for a technique with less error, on a thread with a separate graphics device.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use anyhow::{Context, Result, anyhow};
use shadowfit::Technique;
use shadowfit_egui::Tune;
use shadowfit_params::figures::JudgedFigures;
use shadowfit_params::tool::Settings;
use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_scene::Scene;
use shadowfit_study::{
    Comparison, Judging, Progress, TuneScope, TuneSettings, Tuned, View, in_background_async, tune_async,
};

use crate::stage::{changes, judged_figures};

/// Size of the judged pictures, in pixels: enough for every artefact.
const SIZE: [u32; 2] = [480, 270];

/// Messages before the first figures.
const GETTING_READY: &str = "Preparing a separate device and the scene";
const ENDING: &str = "Ending the search for the previous scene";

/// Input of a search.
#[derive(Debug)]
pub(crate) struct Task {
    pub(crate) adapter: AdapterChoice,
    pub(crate) scene: Arc<Scene>,
    /// Animation and its time, in seconds.
    pub(crate) pose: (usize, f32),
    pub(crate) settings: Settings,
    /// Distance above the surface at which shadow rays start, in metres.
    pub(crate) ray_offset: f64,
    pub(crate) views: Vec<View>,
    /// Whether the technique belongs to side B.
    pub(crate) is_of_other: bool,
}

/// Messages of the thread.
#[derive(Debug)]
enum News {
    Progress(Progress),
    Done(Box<Result<Tuned>>),
}

/// A finished search.
#[derive(Debug)]
struct Outcome {
    technique: Technique,
    before: JudgedFigures,
    after: JudgedFigures,
    changes: Vec<String>,
    is_applied: bool,
}

/// State of the search.
#[derive(Debug, Default)]
enum State {
    #[default]
    Idle,
    Running {
        settings: Box<Settings>,
        progress: Option<Progress>,
        news: Receiver<News>,
        is_cancelled: Arc<AtomicBool>,
        /// Whether its result will be dropped.
        is_abandoned: bool,
    },
    Done(Box<Outcome>),
    Failed(String),
}

/// The search for a better technique.
#[derive(Debug, Default)]
pub(crate) struct Tuning {
    state: State,
    /// Whether the initial technique of the search is on side B now.
    pub(crate) is_of_other: bool,
}

impl Tuning {
    /// Starts a search, unless one is running.
    pub(crate) fn start(&mut self, task: Task) {
        if self.is_running() {
            return;
        }
        self.is_of_other = task.is_of_other;
        let (sender, news) = channel();
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let settings = Box::new(task.settings);
        let flag = Arc::clone(&is_cancelled);
        let work = move || async move {
            let mut tell = |progress: &Progress| {
                sender.send(News::Progress(progress.clone())).is_ok() && !flag.load(Ordering::Relaxed)
            };
            let tuned = task.run(&mut tell).await;
            // The receiver is gone once the viewer has ended.
            let _ = sender.send(News::Done(Box::new(tuned)));
        };
        self.state = match in_background_async("tuning", work) {
            Ok(()) => State::Running { settings, progress: None, news, is_cancelled, is_abandoned: false },
            Err(error) => State::Failed(format!("no thread could be started: {error}")),
        };
    }

    pub(crate) fn is_running(&self) -> bool {
        matches!(self.state, State::Running { .. })
    }

    /// Stops the search. The best technique so far is its result.
    pub(crate) fn cancel(&mut self) {
        if let State::Running { is_cancelled, .. } = &self.state {
            is_cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Discards the result, and ends a running search without one. Its thread and device may take a moment to
    /// end.
    pub(crate) fn abandon(&mut self) {
        self.cancel();
        self.discard();
        if let State::Running { is_abandoned, .. } = &mut self.state {
            *is_abandoned = true;
        }
    }

    /// Discards the result.
    pub(crate) fn discard(&mut self) {
        if !self.is_running() {
            self.state = State::Idle;
        }
    }

    /// Takes the result.
    pub(crate) fn apply(&mut self) -> Option<Technique> {
        let State::Done(outcome) = &mut self.state else { return None };
        outcome.is_applied = true;
        Some(outcome.technique)
    }

    /// Takes the thread's messages.
    pub(crate) fn take(&mut self) {
        let State::Running { settings, progress, news, is_abandoned, .. } = &mut self.state else { return };
        let ended = loop {
            match news.try_recv() {
                Ok(News::Progress(new)) => *progress = Some(new),
                Ok(News::Done(result)) => break *result,
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => break Err(anyhow!("the search ended unexpectedly")),
            }
        };
        if *is_abandoned {
            self.state = State::Idle;
            return;
        }
        self.state = match ended.and_then(|tuned| outcome(&tuned, settings)) {
            Ok(outcome) => State::Done(Box::new(outcome)),
            Err(error) => State::Failed(format!("{error:#}")),
        };
    }

    /// Returns the state of the search for the panel.
    pub(crate) fn shown(&self) -> Tune<'_> {
        match &self.state {
            State::Idle => Tune::Idle,
            State::Running { is_abandoned: true, .. } => without_figures(ENDING),
            State::Running { progress: None, .. } => without_figures(GETTING_READY),
            State::Running { progress: Some(progress), .. } => Tune::Running {
                tried: progress.tried as u32,
                at_most: progress.at_most as u32,
                start_error: progress.start_error as f32,
                best_error: progress.best_error as f32,
                what: &progress.what,
            },
            State::Done(outcome) => Tune::Done {
                before: outcome.before,
                after: outcome.after,
                changes: &outcome.changes,
                is_applied: outcome.is_applied,
            },
            State::Failed(reason) => Tune::Failed(reason),
        }
    }
}

fn without_figures(what: &str) -> Tune<'_> {
    Tune::Running { tried: 0, at_most: 1, start_error: f32::NAN, best_error: f32::NAN, what }
}

impl Task {
    async fn run(self, progress: &mut dyn FnMut(&Progress) -> bool) -> Result<Tuned> {
        let gpu = Gpu::headless(&self.adapter).await?;
        let scene = Scene::clone(&self.scene);
        let judging = Judging { size: SIZE, ray_offset: self.ray_offset, ..Judging::default() };
        let mut comparison = Comparison::new(gpu, scene, judging)?;
        comparison.set_time(self.pose.0, self.pose.1);
        let Settings { technique: start, inputs, .. } = self.settings;
        let settings = TuneSettings { start, inputs, scope: TuneScope::Everything, ..TuneSettings::default() };
        tune_async(&mut comparison, &self.views, &settings, progress).await
    }
}

fn outcome(tuned: &Tuned, settings: &Settings) -> Result<Outcome> {
    let figures = |tally: &shadowfit_truth::PictureTally| {
        let figures = tally.figures().context("no visible surface faces the light")?;
        Ok::<_, anyhow::Error>(judged_figures(&figures, SIZE, 0.0))
    };
    let before = tuned.steps.first().context("no technique was tried")?;
    let technique = tuned.technique.technique;
    Ok(Outcome {
        technique,
        before: figures(&before.tally)?,
        after: figures(&tuned.tally)?,
        changes: changes(settings, &settings.with_technique(technique)),
        is_applied: false,
    })
}
