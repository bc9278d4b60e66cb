//! Exact edges: rays where the maps are not sure. A compute pass over the depth buffer asks for each pixel whether all
//! texels that the filter reads agree; where they do not, rays decide. The picture then reads a texture of factors.
//!
//! ```text
//!   depth pre-pass ──▶ classify: which pixels are the maps sure of? ──▶ factors ──▶ the engine's picture
//!                          └─▶ list of the others ──▶ rays ────────────────┘
//! ```
//!
//! A pixel is *sure* to be lit where none of the 4×4 texels around it, in the finest map that holds it (6×6 in the coarsest
//! one), is nearer to the light than its own plane by more than rounding, and sure to be in shadow where all of them shadow
//! it by the technique's bias. Points outside all maps, or nearer to a map's border than the filter reaches, are traced;
//! surfaces that face away from the light get 0 without a ray.
//!
//! Depths are rounded, and GPUs move the corners of triangles by up to 1/256 pixel. Each traced pixel therefore finds its
//! triangle again with a short ray from the eye, and its shadow ray starts from the exact point with the exact normal.
//!
//! Several rays of a pixel, or those over the disc of a sun with a radius, are few: they correct what the map says of the
//! whole pixel or disc, instead of standing for it.
//!
//! ```no_run
//! # fn demo(device: &wgpu::Device, queue: &wgpu::Queue, sun: &mut shadowfit_wgpu::SunShadows,
//! #         rays: &shadowfit_rays::RayScene, depth: &wgpu::TextureView, clip_from_eye: shadowfit::glam::Mat4,
//! #         eye: shadowfit::glam::DVec3, encoder: &mut wgpu::CommandEncoder) -> Result<(), Box<dyn std::error::Error>> {
//! use shadowfit::DepthConvention;
//! use shadowfit_wgpu::exact_edges::{EdgePass, EdgeView};
//!
//! let mut exact = EdgePass::new(device, queue)?; // once, for each view
//! // In each frame, between the depth pre-pass and the picture:
//! let view = EdgeView::new(depth, clip_from_eye, DepthConvention::Reversed, eye);
//! let edges = exact.record(encoder, sun, Some(rays), &view)?; // says why where edges are filtered
//! // The picture's shader calls `shadowfit_exact_factor` of `exact_factor_wgsl`, with `exact.group()` bound.
//! # Ok(()) }
//! ```
//!
//! The lowest bit of a factor says whether rays were traced for its pixel: it is set for those, and clear for pixels that the
//! maps are sure of. Factors are off by that, 6e-8 at most, and `shadowfit_is_traced` reads it.
//!
//! What is no part of the depth buffer, such as blended surfaces, particles and fog, calls the filter's
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
