//! How a check ends.

use core::fmt;

/// The end of a check, with its result in a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Passed(String),
    Failed(String),
    /// The device cannot do it, for this reason.
    Unavailable(String),
}

impl Outcome {
    /// Passed or failed, with a result.
    pub(super) fn of(is_within: bool, found: String) -> Self {
        if is_within { Self::Passed(found) } else { Self::Failed(found) }
    }
}

/// The error of a check that somebody stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cancelled;

impl fmt::Display for Cancelled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("it was cancelled")
    }
}

impl core::error::Error for Cancelled {}
