//! Screen-space ambient occlusion: buffers of view-space positions and normals, the occlusion of each pixel
//! by its neighbours, an optional blur, and a picture with a darkened ambient term. [`formula`] has the
//! formulas.
//!
//! Occlusion is a texture of half floats, 0 (open) to 1 (closed), of the picture's size with one sample per
//! pixel, and 0 in the sky. The blur is a box of four pixels that only uses neighbours in the pixel's plane.
//! Random vectors repeat every four pixels, so it averages all of them. With two radii, the greater occlusion
//! counts, so that creases which only the smaller radius finds remain.

pub mod formula;
pub mod shaders;

mod formats;
mod frame;
mod passes;
mod pipelines;
mod targets;
mod traced;

pub(crate) use formats::missing_format;
pub use frame::{OcclusionFrame, OcclusionLight, OcclusionMethod, OcclusionSettings, OcclusionUniform, OcclusionView};
pub use passes::OcclusionPasses;
pub(crate) use traced::{Traced, truth};
