//! Measurement of a call, times of the frames of a walk, and medians.

use std::time::Instant;

use anyhow::Result;

/// Frames before the counted ones: the first one, and the one in which the visible demand first becomes
/// known.
pub(crate) const LEAD: usize = 2;

/// Each frame's shortest time of all rounds, in milliseconds.
#[derive(Clone, Default)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    /// Adds a round.
    pub(crate) fn add(&mut self, round: &[f64]) {
        if self.0.is_empty() {
            self.0 = round.to_vec();
        }
        for (least, time) in self.0.iter_mut().zip(round) {
            *least = least.min(*time);
        }
    }

    /// Returns the time of the first frame.
    pub(crate) fn first(&self) -> f64 {
        self.0.first().copied().unwrap_or(0.0)
    }

    /// Returns the median of the frames that count.
    pub(crate) fn median(&self) -> f64 {
        median(self.counting().to_vec())
    }

    /// Returns the time of the slowest frame that counts.
    pub(crate) fn worst(&self) -> f64 {
        self.counting().iter().copied().fold(0.0, f64::max)
    }

    fn counting(&self) -> &[f64] {
        self.0.get(LEAD..).unwrap_or_default()
    }
}

/// Returns the median of some times.
pub(crate) fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}

/// Returns the result of a call, and its time in milliseconds.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = Instant::now();
    let result = work();
    (result, begin.elapsed().as_secs_f64() * 1e3)
}

/// Returns the shortest time of some rounds, in milliseconds.
pub(crate) fn shortest(rounds: usize, mut work: impl FnMut() -> Result<()>) -> Result<f64> {
    let mut least = f64::INFINITY;
    for _ in 0..rounds {
        let (result, time) = timed(&mut work);
        result?;
        least = least.min(time);
    }
    Ok(least)
}
