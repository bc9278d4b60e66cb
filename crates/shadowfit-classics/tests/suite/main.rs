//! The samples' WGSL, and the classic techniques on the software adapter. Tests that need a graphics device
//! have `gpu` in their path. `cargo xtask test` skips them on machines without one.

mod formulas_gpu;
mod layout;
mod occlusion_gpu;
mod probe_gpu;
mod scenes;
mod shading_gpu;
mod sky_box_gpu;
mod sky_box_seams;
mod wgsl;
