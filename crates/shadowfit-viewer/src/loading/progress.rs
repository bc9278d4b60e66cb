//! How far the loading of a scene is: the time that has passed, as a share of the time that it will take.
//!
//! The time of each phase follows from the scene's size by what it took in measured scenes. How fast this machine is
//! follows from the phases before; within one, the clock moves the bar, up to where the next one begins.

use std::time::Instant;

use shadowfit_scene::SceneSize;

/// Reading the file, parsing it, decoding what it has, making the scene ready.
pub(super) const PHASES: usize = 4;
/// The last phase; the others are the steps of loading a file.
pub(super) const READY: usize = PHASES - 1;

/// Bytes of JSON for each node in files of many nodes, and of buffers for each triangle: what is taken for the size of
/// a file until its JSON has been parsed.
const JSON_A_NODE: u64 = 68;
const BYTES_A_TRIANGLE: u64 = 18;

/// Time that each phase will take on one of the cores that the weights were measured on, in seconds.
pub(super) fn weights(size: &SceneSize) -> [f64; PHASES] {
    let guessed = guessed(size);
    let [file, json, nodes, triangles, drawn, images] =
        [guessed.file, guessed.json, guessed.nodes, guessed.triangles, guessed.drawn, guessed.images]
            .map(|amount| amount as f64 * 1e-9);
    [
        0.4 * file + 1e-4,
        12.0 * json + 1e-4,
        300.0 * nodes + 190.0 * triangles + 40.0 * images + 1e-4,
        600.0 * nodes + 330.0 * triangles + 300.0 * drawn + 20.0 * images + 5e-3,
    ]
}

/// The size of a scene with what is not known of it yet.
fn guessed(size: &SceneSize) -> SceneSize {
    if size.nodes > 0 {
        return *size;
    }
    let json = if size.json > 0 { size.json } else { size.file / 2 };
    let triangles = size.file.saturating_sub(json) / BYTES_A_TRIANGLE;
    SceneSize { json, nodes: json / JSON_A_NODE, triangles, drawn: triangles, ..*size }
}

/// How far a scene is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    weights: [f64; PHASES],
    phase: usize,
    /// When the first phase and this one began.
    start: Instant,
    since: Instant,
    /// The share at which this phase began: it never falls.
    least: f32,
}

impl Progress {
    pub(super) fn new(now: Instant) -> Self {
        Self { weights: weights(&SceneSize::default()), phase: 0, start: now, since: now, least: 0.0 }
    }

    /// A phase begins, with what is known of the scene's size by now.
    pub(super) fn begin(&mut self, phase: usize, size: Option<&SceneSize>, now: Instant) {
        self.least = self.share(now);
        self.weights = size.map_or(self.weights, weights);
        (self.phase, self.since) = (phase.min(READY), now);
    }

    /// Share of the time that has passed, 0..=1.
    pub(super) fn share(&self, now: Instant) -> f32 {
        let [before, after] = [self.end_of(self.phase.checked_sub(1)), self.end_of(Some(self.phase))];
        // Times as long as on the machine that the weights are of.
        let measured = (self.since - self.start).as_secs_f64() / (before * self.sum());
        let slowness = if self.phase > 0 && measured.is_finite() { measured } else { 1.0 };
        let expected = self.weights[self.phase] * slowness;
        let passed = ((now - self.since).as_secs_f64() / expected).clamp(0.0, 1.0);
        ((before + (after - before) * passed) as f32).max(self.least)
    }

    /// Share at which a phase ends; 0 before the first.
    pub(super) fn end_of(&self, phase: Option<usize>) -> f64 {
        let done: f64 = phase.map_or(0.0, |phase| self.weights[..=phase].iter().sum());
        done / self.sum()
    }

    fn sum(&self) -> f64 {
        self.weights.iter().sum()
    }
}
