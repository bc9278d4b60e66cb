//! Screen-space ambient occlusion: buffers of view-space positions and normals, the occlusion of each pixel by its
//! neighbours, an optional blur, and a picture whose ambient term it darkens. [`formula`] has the formulas.
//!
//! Occlusion is a texture of half floats, 0 (open) to 1 (closed), of the picture's size with one sample per pixel, 0
//! where there is sky. The blur is a box of four pixels that takes only neighbours in the pixel's plane; since random
//! vectors repeat every four pixels, it averages all of them. Of two radii the greater occlusion counts, so that creases
//! which only the smaller radius finds stay.

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
