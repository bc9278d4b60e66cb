//! Tests of facts that need several crates.
//!
//! Tests that need a graphics device have `gpu` or `golden` in their path. `cargo xtask test` skips them if
//! there is no device, and otherwise runs them in one process. Tests with `own_process` in their path get
//! their own process.

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
