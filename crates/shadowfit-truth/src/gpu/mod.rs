//! The same classes from compute passes, for pictures that are judged while they are looked at.
//!
//! [`GpuTracer`] holds a tracer's triangles and hierarchy, and [`GpuJudge`] fills a texture with the
//! class of each pixel and sums the picture. Nothing has to be read back; the sums, [`GpuTally`], come
//! back by themselves some frames later. It uses only what every WebGPU device has. The CPU's
//! [`crate::judge()`] and [`crate::PictureTally`] are the reference; the GPU follows the same rules in
//! f32.

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
