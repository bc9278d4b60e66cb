//! The renderer's WGSL and its pictures. Tests that need a graphics device have `gpu` in their path, and `cargo xtask test`
//! leaves them out on machines without one.

mod alpha_gpu;
mod clamp_gpu;
mod devices;
mod frames_gpu;
mod heat_map_gpu;
mod judged_gpu;
mod kept_scene_gpu;
mod layout;
mod limits_gpu;
mod pictures;
mod pixel_gpu;
mod probe_gpu;
mod sheets;
mod sweep_gpu;
mod tint_gpu;
#[cfg(feature = "gles")]
mod webgl2_gpu;
mod wgsl;
