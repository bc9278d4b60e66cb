//! Plants: wooden limbs, cards of cut-out leaves with their images, and plants that several scenes share.

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
