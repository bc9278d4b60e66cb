//! Plants: limbs of wood, twigs of cut-out leaves, and the images that these are cut from.

mod bark;
mod cards;
mod leaves;
mod limbs;

pub(super) use bark::bark;
pub(super) use cards::{Card, Cards};
pub(super) use leaves::{fern, grass, twig};
pub(super) use limbs::Limbs;

use super::pixels::hash;

/// Turn from one leaf or branch to the next that spreads any number of them evenly around: the golden angle, rounded, in
/// radians.
pub(super) const GOLDEN_ANGLE: f32 = 2.4;

/// Fixed pseudo-random numbers, one after the other.
pub(super) struct Dice {
    seed: u32,
    next: u32,
}

impl Dice {
    /// A sequence of its own for each seed.
    pub(super) fn new(seed: u32) -> Self {
        Self { seed, next: 0 }
    }

    /// The next number, in 0..1.
    pub(super) fn roll(&mut self) -> f32 {
        self.next += 1;
        hash(self.next, self.seed)
    }

    /// The next number, in `low`..`high`.
    pub(super) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.roll()
    }
}
