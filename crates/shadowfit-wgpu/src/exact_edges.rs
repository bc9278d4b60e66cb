//! Exact edges: shadow rays where the texels of the maps disagree. For each pixel of the depth buffer, a
//! compute pass checks whether all texels that the filter reads agree. Where they do not, rays decide. The
//! engine's main pass then reads a texture of shadow factors.
//!
//! ```text
//!   depth pre-pass ──▶ classify: which pixels are the maps sure of? ──▶ factors ──▶ the engine's picture
//!                          └─▶ list of the others ──▶ rays ────────────────┘
//! ```
//!
//! A pixel is *surely lit* if none of the 4×4 texels around it (6×6 in the coarsest map) is nearer to the
//! light than the pixel's own plane by more than rounding. The texels are read from the finest map that
//! covers the pixel. A pixel is *surely in shadow* if all of these texels shadow it by the technique's bias.
//! Points outside all maps, or closer to a map's border than the filter's radius, are traced. Surfaces that
//! face away from the light get 0 without a ray.
//!
//! Depths are rounded, and GPUs move the corners of triangles by up to 1/256 pixel. Each traced pixel
//! therefore finds its triangle again with a short ray from the eye, so that its shadow ray starts from the
//! exact point with the exact normal.
//!
//! A few rays cannot sample the whole area of a pixel, or the whole disc of a sun with a radius. With several
//! rays per pixel, or a sun with a radius, the map therefore gives an estimate for the whole area or disc,
//! and the rays correct its error. A single ray to a sun without a radius decides its pixel alone.
//!
//! ```no_run
//! # fn demo(device: &wgpu::Device, queue: &wgpu::Queue, sun: &mut shadowfit_wgpu::SunShadows,
//! #         rays: &shadowfit_rays::RayScene, depth: &wgpu::TextureView, clip_from_eye: shadowfit::glam::Mat4,
//! #         eye: shadowfit::glam::DVec3, encoder: &mut wgpu::CommandEncoder) -> Result<(), Box<dyn std::error::Error>> {
//! use shadowfit::DepthConvention;
//! use shadowfit_wgpu::exact_edges::{EdgePass, EdgeView};
//!
//! let mut exact = EdgePass::new(device, queue)?; // once per view
//! // In each frame, between the depth pre-pass and the main pass:
//! let view = EdgeView::new(depth, clip_from_eye, DepthConvention::Reversed, eye);
//! let edges = exact.record(encoder, sun, Some(rays), &view)?; // contains the reason if edges are filtered
//! // The shader of the main pass calls `shadowfit_exact_factor` of `exact_factor_wgsl`, with `exact.group()` bound.
//! # Ok(()) }
//! ```
//!
//! The lowest bit of a factor is set if rays were traced for its pixel, and clear if the map decided alone.
//! It changes the factor by at most 6e-8. `shadowfit_is_traced` reads it.
//!
//! Surfaces that are not in the depth buffer, such as blended surfaces, particles and fog, call the filter's
//! `shadowfit_factor_at` as before.

mod any_hit;
mod error;
mod group;
mod noise;
mod outcome;
mod pass;
mod pyramid;
mod shader;
mod source;
mod uniform;
mod verdict;
mod view;

pub use crate::pixels::DepthBufferError;
pub use any_hit::AnyHit;
pub use error::EdgeError;
pub use outcome::{EdgeCounts, EdgeOutcome, FallbackReason};
pub use pass::EdgePass;
pub use shader::{edges_wgsl, exact_factor_wgsl};
pub use uniform::{EdgeUniform, UnknownUniform};
pub use view::{EdgeView, NormalEncoding, Normals};
