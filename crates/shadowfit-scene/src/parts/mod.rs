//! Building blocks of generated scenes: solids and sheets, materials and pictures, plants, a figure, loops,
//! and the [`Builder`] that collects them.
//!
//! The built-in scenes consist of these alone, and other scenes can use them, too. Everything is generated
//! from fixed numbers, so a scene is the same every time. Right-handed, y up, metres and radians.

mod build;
mod dice;
mod figure;
mod finish;
mod flora;
mod motion;
mod numbered;
mod pixels;
mod shapes;
mod sheet;
mod solid;
mod sweep;

pub use build::*;
pub use dice::*;
pub use figure::figure_at_ease;
pub(crate) use figure::{Wear, wanderer};
pub use finish::*;
pub use flora::*;
pub use motion::*;
pub use numbered::numbered;
pub use pixels::*;
pub use shapes::*;
pub use sheet::*;
pub use solid::*;
pub use sweep::*;
