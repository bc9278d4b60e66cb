//! The same classes from compute passes, for pictures that are judged while they are looked at.
//!
//! [`GpuTracer`] holds a tracer's triangles and hierarchy, [`GpuJudge`] fills a texture with the
//! class of each pixel, and nothing is read back. Only what every WebGPU device has is used. The
//! processor's [`crate::judge()`] is the reference: the GPU has its rules in f32.

mod error;
mod judge;
mod pixel;
pub mod shader;
mod tracer;
mod uniform;

pub use error::GpuTruthError;
pub use judge::{GpuJudge, GpuJudgeInput};
pub use pixel::GpuPixel;
pub use tracer::GpuTracer;
pub use uniform::{CutOutRecord, ImageRecord, JudgeUniform, MAX_MAPS, NodeRecord, SeenMapUniform, TriangleRecord};
