//! Techniques compared on the same frames: each is fitted, drawn by the samples' renderer, and judged against rays.
//!
//! A [`Subject`] is the scene, a [`Shot`] a camera and a light. A [`Technique`] is all that decides how shadows come
//! out; its [`Fitter`] makes the maps of a shot, and a [`Contender`] draws and judges them. A [`Comparison`] does so
//! for several, and [`tune()`] searches the best.

mod comparison;
mod contender;
mod histogram;
mod live;
mod rust_code;
mod subject;
mod technique;
mod tune;

pub use comparison::{Comparison, Outcome};
pub use contender::{Contender, Fitter, Judging, SharedTruth, Shot, fit_map};
pub(crate) use contender::{factors, maps_seen, measured, triangles};
pub use histogram::SeenDepths;
pub use live::{Agreement, LiveTruth};
pub use subject::Subject;
pub use technique::{DEFAULT_TECHNIQUE, Knowledge, Technique};
pub use tune::{Budget, Step, Tuned, Weights, tune};
