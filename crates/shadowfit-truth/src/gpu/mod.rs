//! The same classes from compute passes, for pictures that are judged while they are looked at.
//!
//! [`GpuTracer`] holds a tracer's triangles and hierarchy, and [`GpuJudge`] fills a texture with the
//! class of each pixel, without reading anything back. It uses only what every WebGPU device has. The
//! CPU's [`crate::judge()`] is the reference; the GPU follows the same rules in f32.

mod error;
mod input;
mod judge;
mod pixel;
pub mod shader;
mod tracer;
mod uniform;

pub use error::GpuTruthError;
pub use input::GpuJudgeInput;
pub use judge::GpuJudge;
pub use pixel::GpuPixel;
pub use tracer::GpuTracer;
pub use uniform::{CutOutRecord, ImageRecord, JudgeUniform, MAX_MAPS, MapUniform, NodeRecord, TriangleRecord};
