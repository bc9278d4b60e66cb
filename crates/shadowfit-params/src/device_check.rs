//! The report of a check of the graphics device: rows with results and tolerances, a summary sentence, and a
//! text for an issue thread. Plain data, filled in by the checking code and shown by panels and command
//! lines.

use alloc::string::String;
use alloc::vec::Vec;
use alloc::{borrow::ToOwned, format};
use core::fmt::Write as _;

/// State of one check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum CheckState {
    /// Not started yet.
    #[default]
    Waiting,
    /// In progress.
    Running,
    /// Result within the tolerance.
    Passed,
    /// Result beyond the tolerance, or check not completed.
    Failed,
    /// Not supported by the device, for this reason. Such a check does not fail.
    Unavailable(String),
    /// Left out, for this reason, such as a device that was lost before.
    NotRun(String),
}

impl CheckState {
    /// Returns a word or two for tables.
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Running => "running",
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Unavailable(_) => "not available",
            Self::NotRun(_) => "not run",
        }
    }
}

/// One check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CheckRow {
    /// Name.
    pub name: &'static str,
    /// The two things that the check compares, in a sentence.
    pub about: &'static str,
    /// State.
    pub state: CheckState,
    /// Result, or the reason of an early failure. Empty until the check has ended.
    pub found: String,
    /// Greatest difference that passes, and the guarantee or number format that justifies it.
    pub tolerance: &'static str,
    /// Duration, in seconds.
    pub seconds: f64,
}

impl CheckRow {
    /// Returns the result, or the reason why there is none.
    pub fn result(&self) -> String {
        match &self.state {
            CheckState::Unavailable(reason) => format!("not available: {reason}"),
            CheckState::NotRun(reason) => format!("not run: {reason}"),
            CheckState::Waiting | CheckState::Running | CheckState::Passed | CheckState::Failed => self.found.clone(),
        }
    }
}

/// The report of a check, also while it runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CheckReport {
    /// Facts about the program and the device: names and values.
    pub facts: Vec<(&'static str, String)>,
    /// The checks, in the order in which they run.
    pub rows: Vec<CheckRow>,
}

/// Width of a line of [`CheckReport::text`], in characters.
const WIDTH: usize = 100;

impl CheckReport {
    /// Returns whether every check has ended or was left out.
    pub fn has_ended(&self) -> bool {
        !self.rows.iter().any(|row| matches!(row.state, CheckState::Waiting | CheckState::Running))
    }

    /// Returns whether all checks that the device supports have passed, at least one of them.
    pub fn has_passed(&self) -> bool {
        let is_good = |row: &CheckRow| matches!(row.state, CheckState::Passed | CheckState::Unavailable(_));
        self.count(&CheckState::Passed) > 0 && self.rows.iter().all(is_good)
    }

    /// Ends the report early: the running check fails for this reason, and waiting checks are not run.
    pub fn end(&mut self, reason: &str) {
        for row in &mut self.rows {
            match row.state {
                CheckState::Waiting => row.state = CheckState::NotRun(reason.to_owned()),
                CheckState::Running => (row.state, row.found) = (CheckState::Failed, reason.to_owned()),
                CheckState::Passed | CheckState::Failed | CheckState::Unavailable(_) | CheckState::NotRun(_) => {}
            }
        }
    }

    /// Returns the number of checks that have ended or were left out.
    pub fn ended(&self) -> usize {
        self.rows.len() - self.count(&CheckState::Waiting) - self.count(&CheckState::Running)
    }

    fn count(&self, state: &CheckState) -> usize {
        self.rows.iter().filter(|row| row.state == *state).count()
    }

    /// Returns a sentence that tells whether shadows can be trusted on the device.
    pub fn sentence(&self) -> String {
        let names = |is_it: fn(&CheckState) -> bool| {
            let names: Vec<&str> = self.rows.iter().filter(|row| is_it(&row.state)).map(|row| row.name).collect();
            names.join(", ").to_lowercase()
        };
        let [ended, all, passed] = [self.ended(), self.rows.len(), self.count(&CheckState::Passed)];
        if !self.has_ended() {
            return format!("Checking: {ended} of {all} checks have ended.");
        }
        let failed = names(|state| *state == CheckState::Failed);
        if !failed.is_empty() {
            return format!(
                "Do not trust shadows on this device: {failed} failed. Please attach this report to an issue."
            );
        }
        let left_out = names(|state| matches!(state, CheckState::NotRun(_)));
        if !left_out.is_empty() {
            return format!("The check was stopped early and says nothing about this device: {left_out} not run.");
        }
        let missing = names(|state| matches!(state, CheckState::Unavailable(_)));
        if passed == 0 {
            return format!("This device supports none of the {all} checks, so nothing is known about its shadows.");
        }
        if missing.is_empty() {
            return format!("Shadows can be trusted on this device: all {all} checks passed.");
        }
        format!(
            "Shadows can be trusted on this device: {passed} of {all} checks passed, and it cannot do the rest \
                 ({missing})."
        )
    }

    /// Returns the whole report as text for a terminal or an issue thread: facts, a block of lines per check,
    /// and the summary sentence.
    pub fn text(&self) -> String {
        let mut text = String::from("shadowfit device check\n\n");
        let width = self.facts.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        for (name, value) in &self.facts {
            wrapped(&mut text, &format!("{name:width$}  "), value);
        }
        for row in &self.rows {
            // Writing to a String cannot fail.
            let _ = write!(text, "\n[{}] {}", row.state.word(), row.name);
            if row.seconds > 0.0 {
                let _ = write!(text, " ({:.1} s)", row.seconds);
            }
            text.push('\n');
            for (name, value) in
                [("compares  ", row.about), ("result    ", &row.result()), ("tolerance ", row.tolerance)]
            {
                if !value.is_empty() {
                    wrapped(&mut text, &format!("  {name} "), value);
                }
            }
        }
        text.push('\n');
        wrapped(&mut text, "", &self.sentence());
        text
    }
}

/// Appends a label and a text, wrapped and indented by the label's width.
fn wrapped(text: &mut String, label: &str, value: &str) {
    let indent = label.chars().count();
    text.push_str(label);
    let mut column = indent;
    for (index, word) in value.split_whitespace().enumerate() {
        let length = word.chars().count();
        if index > 0 && column + 1 + length > WIDTH {
            text.push('\n');
            text.extend(core::iter::repeat_n(' ', indent));
            column = indent;
        } else if index > 0 {
            text.push(' ');
            column += 1;
        }
        text.push_str(word);
        column += length;
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    fn report(states: &[CheckState]) -> CheckReport {
        let names = ["Look-up", "Kept maps", "Exact edges"];
        let row = |(state, name): (&CheckState, &'static str)| CheckRow {
            name,
            about: "a against b",
            state: state.clone(),
            found: "3 of 7".to_owned(),
            tolerance: "none may differ",
            seconds: 1.25,
        };
        let rows = states.iter().zip(names).map(row).collect();
        CheckReport { facts: vec![("adapter", "one".to_owned()), ("limits", "many words ".repeat(30))], rows }
    }

    #[test]
    fn the_sentence_and_the_verdict_follow_from_the_states() {
        use CheckState::{Failed, NotRun, Passed, Running, Unavailable, Waiting};
        let missing = || Unavailable("no compute shaders".to_owned());
        let lost = || NotRun("the device was lost".to_owned());
        for (states, is_passed, word) in [
            (vec![Passed, Passed, Passed], true, "can be trusted on this device: all 3"),
            (vec![Passed, Passed, missing()], true, "2 of 3 checks passed, and it cannot do the rest (exact edges)"),
            (vec![missing(), missing(), missing()], false, "none of the 3 checks"),
            (vec![Passed, Failed, Passed], false, "Do not trust shadows on this device: kept maps failed"),
            (vec![Passed, Failed, lost()], false, "kept maps failed"),
            (vec![Passed, lost(), lost()], false, "kept maps, exact edges not run"),
            (vec![Passed, Running, Waiting], false, "1 of 3 checks have ended"),
        ] {
            let report = report(&states);
            assert!(report.sentence().contains(word), "{}", report.sentence());
            assert_eq!(report.has_passed(), is_passed, "{states:?}");
            assert_eq!(report.has_ended(), !states.contains(&Running), "{states:?}");
        }
    }

    #[test]
    fn the_text_has_every_fact_and_row_in_lines_that_fit() {
        let text = report(&[CheckState::Passed, CheckState::NotRun("the device was lost".to_owned())]).text();
        for part in ["adapter", "many words", "[passed] Look-up (1.2 s)", "3 of 7", "not run: the device was lost"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
    }
}
