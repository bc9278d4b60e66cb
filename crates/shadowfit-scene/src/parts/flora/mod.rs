//! Plants: limbs of wood, cards of cut-out leaves, the images that these are cut from, and plants that several scenes
//! have.

mod bark;
mod cards;
mod leaves;
mod limbs;
mod plants;

pub use bark::bark;
pub use cards::{Card, Cards};
pub use leaves::{fern, grass, twig};
pub use limbs::Limbs;
pub use plants::{Tuft, cypress, egg};
