//! Code that the tests of several crates share.
//!
//! Opening a device takes longer than many tests that draw. [`software_gpu`] therefore lends a device to one test after
//! another, and `cargo xtask test` runs the tests that draw in one process per test binary.

mod gpu;
#[cfg(feature = "wgsl")]
pub mod layout;
pub mod pairs;
pub mod read_back;
#[cfg(feature = "wgsl")]
pub mod wgsl;

pub use gpu::{Lent, TestGpu, open_software_gpu, software_gpu};
#[cfg(feature = "render")]
pub use gpu::{open_renderer_gpu, renderer_gpu};
