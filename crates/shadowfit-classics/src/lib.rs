//! The classic techniques as named samples. Each sample has the scene, camera, light and numbers of its
//! source, variants that show its known flaws, and a comparison with modern maps on the same view.
//!
//! [`SAMPLES`] lists them. A [`SampleDrawer`] draws a sample with its [`SampleValues`]. [`SampleFigures`]
//! judges it against rays. Lengths are in the units of each source. `docs/samples` has a page for each.
//!
//! Each sample has a module with its card and options, its scene, its WGSL and the same formulas in Rust.
//! [`mapped`] draws scenes lit by one map, [`lamp`] holds the code that samples with a lamp share,
//! [`occlusion`] computes ambient occlusion.

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
