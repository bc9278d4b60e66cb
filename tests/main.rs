//! Scratch-level tests: facts that no crate can prove alone.
//!
//! Tests that need a graphics device have `gpu` or `golden` in their path, by which `cargo xtask test` leaves them out
//! where there is none, and runs them in one process where there is one. Tests with `own_process` in their path get a
//! process of their own.

mod artefacts;
mod conventions;
mod fits;
mod fuzz_corpus;
mod golden;
mod integration;
mod recipes;
mod robustness;
mod samples;
mod support;
mod truth;
mod window;
