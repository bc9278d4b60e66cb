//! The figures of `--log-frames`: the time until the first scene, the times of frames, and the memory in use.

use std::time::{Duration, Instant};

use shadowfit_render::Spent;

use crate::platform::memory;
use crate::platform::output;

/// Number of frames between two lines, and greatest time between them.
const LOG_EVERY: (u64, Duration) = (60, Duration::from_secs(4));
/// Least frame time that is distinguished, in milliseconds.
const LEAST_MS: f64 = 0.01;
/// Ratio of the times of neighbouring bins.
const STEP: f64 = 1.02;
/// Number of classes: up to some minutes.
const CLASSES: usize = 900;

/// Statistics of the frames since the start. Its memory does not grow with their number.
pub(crate) struct FrameLog {
    start: Instant,
    last_line: Instant,
    frames: u64,
    is_ready: bool,
    /// Longest time that a frame has blocked the window since the last line, without waits for the GPU.
    longest: Duration,
    /// Greatest CPU time of a frame since the last line.
    most_cpu: Duration,
    /// Greatest value of `longest` since the start.
    longest_of_all: Duration,
    /// Numbers of frames by CPU time, without frames that loaded a scene or made pipelines.
    classes: Vec<u64>,
    /// Number of those frames, and their greatest CPU time.
    loads: (u64, Duration),
}

impl FrameLog {
    pub(crate) fn new(start: Instant) -> Self {
        let [longest, most_cpu, longest_of_all] = [Duration::ZERO; 3];
        Self {
            start,
            last_line: start,
            frames: 0,
            is_ready: false,
            longest,
            most_cpu,
            longest_of_all,
            classes: vec![0; CLASSES],
            loads: (0, Duration::ZERO),
        }
    }

    /// Records a frame. Its own time excludes waits for the GPU. `ready` is the window's title once there is
    /// a scene.
    pub(crate) fn frame(&mut self, own: Spent, frame_ms: f32, is_loading: bool, ready: Option<String>) {
        self.frames += 1;
        self.longest = self.longest.max(own.wall);
        self.most_cpu = self.most_cpu.max(own.cpu);
        self.longest_of_all = self.longest_of_all.max(own.wall);
        if is_loading || own.is_making {
            self.loads = (self.loads.0 + 1, self.loads.1.max(own.cpu));
        } else {
            self.classes[class(ms(own.cpu))] += 1;
        }
        if let Some(title) = ready.filter(|_| !self.is_ready) {
            self.is_ready = true;
            output::tell(format_args!("ready: {title} after {:.2} s", self.start.elapsed().as_secs_f32()));
        }
        if self.frames.is_multiple_of(LOG_EVERY.0) || self.last_line.elapsed() >= LOG_EVERY.1 {
            let seconds = self.start.elapsed().as_secs();
            let memory = memory().map_or_else(String::new, |bytes| format!(", {:.0} MB", bytes as f64 / 1e6));
            let [longest, most_cpu] = [self.longest, self.most_cpu].map(ms);
            output::tell(format_args!(
                "frame {} at {seconds} s: {frame_ms:.1} ms, longest block {longest:.1} ms, own CPU time up to {most_cpu:.1} \
                 ms{memory}",
                self.frames
            ));
            (self.longest, self.most_cpu, self.last_line) = (Duration::ZERO, Duration::ZERO, Instant::now());
        }
    }

    /// Prints the last lines.
    pub(crate) fn end(&self) {
        output::tell(format_args!("{} frames, longest block {:.1} ms", self.frames, ms(self.longest_of_all)));
        let [median, late] = [0.5, 0.999].map(|share| self.quantile(share));
        let (loads, longest) = (self.loads.0, ms(self.loads.1));
        output::tell(format_args!(
            "own CPU time of frames without loads: median {median:.2} ms, 99.9% below {late:.2} ms"
        ));
        output::tell(format_args!(
            "{loads} frames loaded a scene or made pipelines: own CPU time up to {longest:.2} ms"
        ));
    }

    /// Returns the upper limit of the time of a share of the frames, in milliseconds.
    fn quantile(&self, share: f64) -> f64 {
        let all: u64 = self.classes.iter().sum();
        let mut below = 0;
        let reached = self.classes.iter().position(|frames| {
            below += frames;
            below as f64 >= share * all as f64
        });
        LEAST_MS * STEP.powf(reached.unwrap_or(0) as f64 + 1.0)
    }
}

/// Returns the class of a time in milliseconds.
fn class(ms: f64) -> usize {
    let class = (ms / LEAST_MS).max(1.0).log(STEP);
    (class as usize).min(CLASSES - 1)
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_frames_without_loads() {
        let mut log = FrameLog::new(Instant::now());
        for frame in 1..=2000_u64 {
            let time = if frame > 1997 { Duration::from_millis(50) } else { Duration::from_micros(frame) };
            let own = Spent { wall: time, cpu: time, is_making: false };
            log.frame(own, 1.0, false, None);
            let long = Spent { wall: Duration::from_secs(1), cpu: Duration::from_secs(1), is_making: false };
            log.frame(long, 1.0, true, None);
            log.frame(Spent { is_making: true, ..long }, 1.0, false, None);
        }
        let near = |share, expected: f64| {
            let found = log.quantile(share);
            assert!((found / expected - 1.0).abs() < STEP - 0.99, "{share}: {found} ms for {expected}");
        };
        near(0.5, 1.0);
        near(0.9, 1.8);
        near(0.999, 50.0);
        assert_eq!((log.longest_of_all, log.loads), (Duration::from_secs(1), (4000, Duration::from_secs(1))));
    }
}
