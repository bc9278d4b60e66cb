//! The comparison of a sample with modern maps, measured on a thread with a separate device.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use anyhow::Result;
use shadowfit::PerspectiveCamera;
use shadowfit_classics::{Sample, SampleFigures, SampleValues};
use shadowfit_egui::CardFigure;
use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_study::in_background_async;

/// Input of a measurement.
pub(crate) struct SampleView {
    pub(crate) sample: &'static Sample,
    pub(crate) values: SampleValues,
    pub(crate) camera: PerspectiveCamera,
    /// Time of the animation, in seconds.
    pub(crate) seconds: f32,
}

/// A running measurement, or the result of the last one.
#[derive(Debug, Default)]
pub(crate) struct Measuring {
    result: Option<Receiver<Result<SampleFigures>>>,
    lines: Vec<CardFigure>,
}

impl Measuring {
    /// Starts a measurement, and drops the result of a running one.
    pub(crate) fn start(&mut self, adapter: AdapterChoice, view: SampleView) {
        let (sender, result) = channel();
        let work = move || async move {
            let SampleView { sample, values, camera, seconds } = view;
            let measured = match Gpu::headless(&adapter).await {
                Ok(gpu) => SampleFigures::measure_async(gpu, sample, &values, &camera, seconds).await,
                Err(error) => Err(error.into()),
            };
            // The receiver is gone after another measurement was started.
            let _ = sender.send(measured);
        };
        self.lines = match in_background_async("measuring", work) {
            Ok(()) => vec![line("Measuring", "…")],
            Err(error) => vec![line("Not measured", &error.to_string())],
        };
        self.result = Some(result);
    }

    /// Returns whether a measurement is running.
    pub(crate) fn is_running(&self) -> bool {
        self.result.is_some()
    }

    /// Takes a result that has arrived.
    pub(crate) fn take(&mut self) {
        let Some(result) = self.result.as_ref().map(Receiver::try_recv) else { return };
        self.lines = match result {
            Err(TryRecvError::Empty) => return,
            Ok(Ok(figures)) => lines(&figures),
            Ok(Err(error)) => vec![line("Not measured", &format!("{error:#}"))],
            Err(TryRecvError::Disconnected) => vec![line("Not measured", "this is a bug of the viewer")],
        };
        self.result = None;
    }

    /// Returns the result, for the panel.
    pub(crate) fn lines(&self) -> &[CardFigure] {
        &self.lines
    }
}

/// Returns lines of figures, for the panel and for the headless mode.
pub(crate) fn lines(figures: &SampleFigures) -> Vec<CardFigure> {
    figures.lines().into_iter().map(|(name, value)| CardFigure { name, value }).collect()
}

fn line(name: &str, value: &str) -> CardFigure {
    CardFigure { name: name.to_owned(), value: value.to_owned() }
}
