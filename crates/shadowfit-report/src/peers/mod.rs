//! Ranks shadow-map fits by the maps that they compute for the same frames: how well the maps cover and
//! sample the visible surfaces.
//!
//! [`Scenarios`] has the scenes, cameras and lights, and a [`FitFile`] has the maps that a fit computed for
//! them. [`VisiblePoints`] are the visible points of a frame. [`measure()`] measures maps at these points,
//! and a [`Ranking`] does so for many fits and all frames of a scene. All coordinates are in world space:
//! right-handed, y up, metres.

mod cells;
#[cfg(test)]
mod closed_form;
mod error;
mod fit_file;
#[cfg(any(test, fuzzing))]
pub(crate) mod fuzzed;
mod measure;
mod ranking;
mod scenarios;
mod table;
mod tally;
mod visible;
mod whole;

pub use error::PeersError;
pub use fit_file::{FitFile, FitFrame, FitMap};
pub use measure::{FrameMaps, PreviousMaps, measure};
pub use ranking::Ranking;
pub use scenarios::{Frame, Ground, Scenarios, Scene};
pub use table::{FitTable, GroupTally, Row, overall_markdown, to_json, to_markdown};
pub use tally::{Kept, Shimmer, Tally};
pub use visible::{RAYS, VisiblePoint, VisiblePoints};
