//! The table of `--timings`: the time of each start step without a window, and of each line of the script.

use std::time::{Duration, Instant};

use shadowfit_render::Spent;

/// Times of consecutive steps without gaps.
pub(crate) struct Timings {
    last: Instant,
    steps: Vec<Step>,
}

/// A step of the start, or a line of the script.
struct Step {
    name: String,
    total: Duration,
    /// Time of this thread without sleep and waits for the GPU.
    own: Duration,
    frames: u32,
    slowest: Duration,
}

impl Timings {
    pub(crate) fn start() -> Self {
        Self { last: Instant::now(), steps: Vec::new() }
    }

    /// Adds a step that started at the end of the last one, and ends now.
    pub(crate) fn step(&mut self, name: &str) {
        let total = self.since_last();
        let (name, own) = (name.to_owned(), total);
        self.steps.push(Step { name, total, own, frames: 0, slowest: Duration::ZERO });
    }

    /// Adds a frame, with the time since the last one, to the step of this name.
    pub(crate) fn frame(&mut self, name: &str, frame: Spent) {
        let total = self.since_last();
        if self.steps.last().is_none_or(|step| step.name != name) {
            let [total, own, slowest] = [Duration::ZERO; 3];
            self.steps.push(Step { name: name.to_owned(), total, own, frames: 0, slowest });
        }
        let Some(step) = self.steps.last_mut() else { return };
        step.total += total;
        step.own += frame.wall;
        step.frames += 1;
        step.slowest = step.slowest.max(total);
    }

    /// Returns the table: a row for each step, and one for all steps.
    pub(crate) fn table(&self) -> String {
        let heading = format!("{:>9} {:>9} {:>7} {:>9}  step\n", "total ms", "own ms", "frames", "slowest");
        let sum = |part: fn(&Step) -> Duration| self.steps.iter().map(part).sum();
        let all = Step {
            name: "all".to_owned(),
            total: sum(|step| step.total),
            own: sum(|step| step.own),
            frames: self.steps.iter().map(|step| step.frames).sum(),
            slowest: self.steps.iter().map(|step| step.slowest).max().unwrap_or_default(),
        };
        heading + &self.steps.iter().chain([&all]).map(Step::row).collect::<String>()
    }

    fn since_last(&mut self) -> Duration {
        let now = Instant::now();
        now.duration_since(std::mem::replace(&mut self.last, now))
    }
}

impl Step {
    fn row(&self) -> String {
        let [total, own, slowest] = [self.total, self.own, self.slowest].map(|time| time.as_secs_f64() * 1e3);
        format!("{total:>9.1} {own:>9.1} {:>7} {slowest:>9.1}  {}\n", self.frames, self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_of_a_line_are_one_row_and_the_last_row_has_them_all() {
        let mut timings = Timings::start();
        timings.step("device");
        let frame = Spent { wall: Duration::from_millis(2), cpu: Duration::ZERO, is_making: false };
        for line in ["a.txt:1: wait 1", "a.txt:1: wait 1", "a.txt:2: quit"] {
            timings.frame(line, frame);
        }
        let table = timings.table();
        let rows: Vec<Vec<&str>> = table.lines().map(|row| row.split_whitespace().collect()).collect();
        let frames: Vec<&str> = rows.iter().map(|row| row[2]).collect();
        assert_eq!(frames, ["own", "0", "2", "1", "3"], "{table}");
        assert_eq!([rows[2][1], rows[3][1]], ["4.0", "2.0"], "{table}");
        assert!(rows[4].ends_with(&["all"]), "{table}");
    }
}
