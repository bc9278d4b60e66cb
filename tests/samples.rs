//! The classic samples: the effect that each technique exists to show, and its flaws, as numbers.

mod bench;
mod xna_gpu;
