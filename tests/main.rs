//! Scratch-level tests: what no crate can prove alone.
//!
//! Tests that need a graphics device have `gpu` or `golden` in their path, by which `cargo xtask test` leaves them out
//! where there is none.

mod artefacts;
mod conventions;
mod fits;
mod fuzz_corpus;
mod golden;
mod growth_gpu;
mod integration;
mod peers;
mod recipes;
mod reports_gpu;
mod robustness;
mod samples;
mod shaders;
mod support;
mod truth;
mod window;
