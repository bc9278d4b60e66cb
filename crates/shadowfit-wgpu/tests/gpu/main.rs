//! Tests of shadowfit-wgpu. Its WGSL and its uniforms need no GPU. Maps, look-ups and passes run on the test
//! adapter. `engine` is the renderer of all tests that draw.
//!
//! Tests that need a graphics device have `gpu` in their path, and `cargo xtask test` skips them on machines
//! without one.

mod acne_gpu;
mod cached_maps_gpu;
mod clamp_gpu;
mod culling_gpu;
mod demand_gpu;
mod demand_picture;
mod differences;
mod door_gpu;
mod engine;
mod exact_counts_gpu;
mod exact_edges_gpu;
mod fade_gpu;
mod formats_gpu;
mod gpu_casters_gpu;
mod harness;
mod layout;
mod parity_gpu;
mod penumbra_gpu;
mod prefixes;
mod refusals_gpu;
mod several_maps_gpu;
mod tents_gpu;
mod texel_offset_gpu;
mod wgsl;
