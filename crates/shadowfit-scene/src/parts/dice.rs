//! Fixed pseudo-random numbers, for irregular placement.

use super::pixels::hash;

/// Turn from one leaf or branch to the next that distributes any number of them evenly around an axis: the
/// golden angle, rounded, in radians.
pub const GOLDEN_ANGLE: f32 = 2.4;

/// A sequence of fixed pseudo-random numbers.
#[derive(Clone, Debug)]
pub struct Dice {
    seed: u32,
    next: u32,
}

impl Dice {
    /// Creates the sequence of a seed.
    pub fn new(seed: u32) -> Self {
        Self { seed, next: 0 }
    }

    /// Returns the next number, in 0..1.
    pub fn roll(&mut self) -> f32 {
        self.next += 1;
        hash(self.next, self.seed)
    }

    /// Returns the next number, in `low`..`high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.roll()
    }
}
