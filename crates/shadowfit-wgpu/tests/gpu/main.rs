//! Tests of shadowfit-wgpu: its WGSL and its uniforms, which need no GPU, and maps, look-ups and passes on the
//! adapter of the tests. `engine` is the renderer of all tests that draw.
//!
//! Tests that need a graphics device have `gpu` in their path, and `cargo xtask test` leaves them out on machines without
//! one.

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
