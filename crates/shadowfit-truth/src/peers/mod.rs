//! Ranks shadow-map fits: how their maps serve what cameras see, on the same frames for all.
//!
//! [`Scenarios`] says the scenes, cameras and lights, a [`FitFile`] the maps that a fit made for
//! them. [`VisiblePoints`] is what a frame's camera sees, [`measure()`] judges maps on it, and a
//! [`Study`] does so for many fits and all frames of a scene. Everything is in world space:
//! right-handed, y up, metres.

mod cells;
pub(crate) mod choice;
#[cfg(test)]
mod closed_form;
mod error;
mod fit_file;
mod measure;
mod quantiles;
mod scenarios;
mod shadow_map;
mod study;
mod table;
mod tally;
mod visible;

pub use error::PeersError;
pub use fit_file::{FitFile, FitFrame, FitMap};
pub use measure::{FrameMaps, measure};
pub use quantiles::Histogram;
pub use scenarios::{Frame, Ground, Scenarios, Scene};
pub use shadow_map::{Gradients, Place, ShadowMap};
pub use study::Study;
pub use table::{FitTable, GroupTally, Row, overall_markdown, readable, to_json, to_markdown};
pub use tally::{Shimmer, Tally};
pub use visible::{RAYS, VisiblePoint, VisiblePoints};
