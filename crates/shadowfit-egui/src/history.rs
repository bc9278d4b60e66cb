//! The figures over time, and as comma-separated values.

use std::collections::VecDeque;
use std::fmt::Write as _;

use shadowfit_params::figures::Figures;

/// Greatest number of stored samples.
pub(crate) const CAPACITY: usize = 600;

/// Least time between two samples, in seconds. With [`CAPACITY`] samples, the last minute is stored.
const INTERVAL: f64 = 0.1;

/// A figure over time.
pub(crate) struct Series {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    read: fn(&Figures) -> Option<f32>,
}

/// All figures, in the order of the columns.
pub(crate) const SERIES: [Series; 19] = [
    Series { name: "wrong", unit: "%", read: |f| Some(f.judged?.wrong) },
    Series { name: "false shadow", unit: "%", read: |f| Some(f.judged?.false_shadow) },
    Series { name: "false light", unit: "%", read: |f| Some(f.judged?.false_light) },
    Series { name: "hole", unit: "%", read: |f| Some(f.judged?.hole) },
    Series { name: "edge", unit: "%", read: |f| Some(f.judged?.edge) },
    Series { name: "light error", unit: "%", read: |f| Some(f.judged?.light_error) },
    Series { name: "flip", unit: "0 to 1", read: |f| f.judged?.flip },
    Series { name: "crawl", unit: "%", read: |f| f.judged?.crawl },
    Series { name: "pixels per texel 95%", unit: "px", read: |f| Some(f.judged?.pixels_per_texel?[1]) },
    Series { name: "traced", unit: "%", read: |f| f.traced },
    Series { name: "wrong of B", unit: "%", read: |f| Some(f.judged_other?.wrong) },
    Series { name: "light error of B", unit: "%", read: |f| Some(f.judged_other?.light_error) },
    Series { name: "flip of B", unit: "0 to 1", read: |f| f.judged_other?.flip },
    Series { name: "shadow passes", unit: "ms", read: |f| f.shadow_pass_ms },
    Series { name: "scene pass", unit: "ms", read: |f| f.scene_pass_ms },
    Series { name: "edge passes", unit: "ms", read: |f| f.edges_ms },
    Series { name: "judging", unit: "ms", read: |f| f.judge_ms },
    Series { name: "frame", unit: "ms", read: |f| f.frame_ms },
    Series { name: "texels drawn", unit: "texels", read: |f| f.shadow_texels.map(|texels| texels as f32) },
];

/// The figures at one time; `None` if not measured.
#[derive(Clone, Debug, PartialEq)]
struct Sample {
    /// Time, in seconds.
    time: f64,
    values: [Option<f32>; SERIES.len()],
}

/// The figures of the last minute.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    samples: VecDeque<Sample>,
    /// Whether new figures are ignored.
    pub(crate) is_paused: bool,
}

impl History {
    /// Adds the figures of a frame at a time in seconds. All frames within a tenth of a second share a sample
    /// with the greatest value of each figure, so that a single slow frame stays visible.
    pub(crate) fn push(&mut self, time: f64, figures: &Figures) {
        if self.is_paused {
            return;
        }
        let values = SERIES.map(|series| (series.read)(figures).filter(|value| value.is_finite()));
        match self.samples.back_mut() {
            Some(last) if (0.0..INTERVAL).contains(&(time - last.time)) => {
                for (kept, value) in last.values.iter_mut().zip(values) {
                    *kept = match (*kept, value) {
                        (Some(a), Some(b)) => Some(a.max(b)),
                        (a, b) => a.or(b),
                    };
                }
            }
            _ => {
                if self.samples.len() == CAPACITY {
                    self.samples.pop_front();
                }
                self.samples.push_back(Sample { time, values });
            }
        }
    }

    pub(crate) fn clear(&mut self) {
        self.samples.clear();
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Returns the points of a series: seconds relative to the last sample, so 0 or less, and the value.
    pub(crate) fn points(&self, series: usize) -> impl Iterator<Item = [f64; 2]> {
        let end = self.samples.back().map_or(0.0, |last| last.time);
        let point = move |sample: &Sample| Some([sample.time - end, f64::from(sample.values[series]?)]);
        self.samples.iter().filter_map(point)
    }

    /// Returns the last value of a series.
    pub(crate) fn last(&self, series: usize) -> Option<f32> {
        self.samples.back()?.values[series]
    }

    /// Returns the length of the history, in seconds.
    pub(crate) fn seconds(&self) -> f64 {
        match (self.samples.front(), self.samples.back()) {
            (Some(first), Some(last)) => last.time - first.time,
            _ => 0.0,
        }
    }

    /// Returns all samples as comma-separated values: a line of names with units, and a line for each sample,
    /// oldest first. Figures that were not measured are empty.
    pub(crate) fn to_csv(&self) -> String {
        let mut text = String::from("time (s)");
        for series in &SERIES {
            // Writing to a string cannot fail.
            let _ = write!(text, ",{} ({})", series.name, series.unit);
        }
        text.push('\n');
        for sample in &self.samples {
            let _ = write!(text, "{:.3}", sample.time);
            for value in &sample.values {
                text.push(',');
                if let Some(value) = value {
                    let _ = write!(text, "{value}");
                }
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use shadowfit_params::figures::JudgedFigures;

    use super::*;

    fn frame(ms: f32) -> Figures {
        Figures { frame_ms: Some(ms), ..Figures::default() }
    }

    fn index(name: &str) -> usize {
        SERIES.iter().position(|series| series.name == name).expect("a series")
    }

    #[test]
    fn the_oldest_samples_are_forgotten() {
        let mut history = History::default();
        for step in 0..CAPACITY + 3 {
            history.push(step as f64, &frame(step as f32));
        }
        let points: Vec<_> = history.points(index("frame")).collect();
        assert_eq!(points.len(), CAPACITY);
        assert_eq!((points[0], points[CAPACITY - 1]), ([-599.0, 3.0], [0.0, 602.0]));
        assert_eq!(history.seconds(), 599.0);
    }

    #[test]
    fn frames_close_to_each_other_share_a_sample_with_the_greatest_values() {
        let mut history = History::default();
        for (time, ms) in [(0.0, 5.0), (0.02, 40.0), (0.04, 6.0), (0.2, 7.0)] {
            history.push(time, &frame(ms));
        }
        assert!(history.points(index("frame")).eq([[-0.2, 40.0], [0.0, 7.0]]));
    }

    #[test]
    fn what_is_no_number_or_comes_while_paused_is_left_out() {
        let mut history = History::default();
        history.push(0.0, &frame(f32::NAN));
        assert_eq!(history.last(index("frame")), None);
        history.is_paused = true;
        history.push(1.0, &frame(3.0));
        assert_eq!(history.samples.len(), 1);
        history.clear();
        assert!(history.is_empty());
    }

    #[test]
    fn the_csv_has_names_with_units_and_a_line_for_each_sample() {
        let mut history = History::default();
        let judged = JudgedFigures { wrong: 1.5, pixels_per_texel: Some([1.0, 2.5, 4.0]), ..JudgedFigures::default() };
        let figures = Figures { judged: Some(judged), shadow_texels: Some(4096), ..frame(16.5) };
        history.push(0.5, &frame(8.0));
        history.push(1.5, &figures);
        let csv = history.to_csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0].starts_with("time (s),wrong (%),false shadow (%),"), "{}", lines[0]);
        assert_eq!(lines[1], "0.500,,,,,,,,,,,,,,,,,,8,");
        assert_eq!(lines[2], "1.500,1.5,0,0,0,0,0,,,2.5,,,,,,,,,16.5,4096");
        let columns = |line: &str| line.split(',').count();
        assert!(lines.iter().all(|line| columns(line) == SERIES.len() + 1));
    }
}
