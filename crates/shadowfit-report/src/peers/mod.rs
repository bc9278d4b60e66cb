//! Ranks shadow-map fits by what their maps give to the same frames: how well they cover and sample
//! what the cameras see.
//!
//! [`Scenarios`] has the scenes, cameras and lights, a [`FitFile`] the maps that a fit made for them.
//! [`VisiblePoints`] is what a frame's camera sees, [`measure()`] measures maps on these points, and a
//! [`Ranking`] does so for many fits and all frames of a scene. Everything is in world space:
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
