//! The same classes, computed on the GPU for pictures that are judged in real time.
//!
//! [`GpuTracer`] holds a tracer's triangles and hierarchy. [`GpuJudge`] fills a texture with the class of
//! each pixel and sums the picture. No read-back by the caller is needed: the sums, [`GpuTally`], arrive some
//! frames later. Every WebGPU device can run it. [`crate::judge()`] and [`crate::PictureTally`] on the CPU
//! are the reference; the GPU follows the same rules in f32.

mod error;
mod input;
mod judge;
mod pixel;
pub mod shader;
mod tally;
mod tally_pass;
mod tracer;
mod uniform;

pub use error::GpuTruthError;
pub use input::{GpuBefore, GpuJudgeInput};
pub use judge::GpuJudge;
pub use pixel::GpuPixel;
pub use tally::GpuTally;
pub use tracer::GpuTracer;
pub use uniform::{BeforeUniform, JudgeUniform, MAX_MAPS, MapUniform, TallyRecord};
