//! The classic samples: the effect that each technique exists to show, and its flaws, as numbers.

mod ambient_gpu;
mod bench;
mod comparison_gpu;
mod lamps_gpu;
mod sky_gpu;
mod splits_gpu;
mod terrain_gpu;
mod xna_gpu;
