//! The classic techniques as named samples: each with the scene, camera, light and numbers of its source, the flaws that it
//! is known for as variants, and what modern maps make of the same view.
//!
//! [`SAMPLES`] lists them; a [`SampleDrawer`] draws one by its [`SampleValues`], and [`SampleFigures`] judge it
//! against rays. Lengths are in the units of each source. `docs/samples` has a page for each.
//!
//! Each sample has a module with its card and options, its scene, its WGSL and the same formulas in Rust. [`mapped`] draws
//! scenes lit by one map, [`lamp`] has what those with a lamp share, [`occlusion`] finds ambient occlusion.

pub mod comparison;
pub mod headlight;
pub mod lamp;
pub mod mapped;
pub mod occlusion;
pub mod sky_box;
pub mod terrain;
pub mod xna;

mod ambient_occlusion;
mod drawer;
mod figures;
mod list;
mod options;
mod parallel_split;
mod sample;
#[cfg(test)]
mod tests;

pub use drawer::{SampleDrawer, SampleOutcome};
pub use figures::SampleFigures;
pub use list::SAMPLES;
pub use options::{OptionError, OptionKind, SampleOption, SampleValues};
pub use sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};
