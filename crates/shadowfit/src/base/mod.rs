//! What everything else stands on: errors, checks of numbers, boxes, depth conventions, hulls and spheres.

mod bounds;
pub(crate) mod checks;
mod depth;
mod error;
pub(crate) mod hull;
mod number;
pub(crate) mod numbers;
pub(crate) mod sphere;

pub use bounds::{Aabb, Boxes};
pub(crate) use bounds::{box_corners, moved};
pub use depth::DepthConvention;
pub use error::FitError;
