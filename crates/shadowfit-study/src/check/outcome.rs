//! Results of a check.

use core::fmt;

/// Result of a check, with a sentence about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Passed(String),
    Failed(String),
    /// The device cannot run the check, for this reason.
    Unavailable(String),
}

impl Outcome {
    /// Returns passed or failed, with a sentence.
    pub(super) fn of(is_within: bool, found: String) -> Self {
        if is_within { Self::Passed(found) } else { Self::Failed(found) }
    }
}

/// Error: the check was cancelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("it was cancelled")
    }
}

impl core::error::Error for Cancelled {}
