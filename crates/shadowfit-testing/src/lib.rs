//! Code that the tests of several crates share.
//!
//! Opening a device takes longer than many tests that draw. Therefore [`test_gpu`] shares one device among
//! successive tests, and `cargo xtask test` runs the tests that draw in one process per test binary.

pub mod commands;
mod folder;
mod gpu;
mod lacking;
#[cfg(feature = "wgsl")]
pub mod layout;
pub mod pairs;
mod program;
pub mod read_back;
pub mod scene_notes;
#[cfg(feature = "wgsl")]
pub mod wgsl;

pub use folder::{package_folder, package_program};
pub use gpu::{Lent, TestGpu, adapter_choice, adapter_name, filter_step, open_test_gpu, subpixel_step, test_gpu};
#[cfg(feature = "render")]
pub use gpu::{golden_gpu, open_renderer_gpu, renderer_gpu};
pub use lacking::{lacking, require_fine_steps, require_large_triangles};
pub use program::refuses_missing_adapter;
