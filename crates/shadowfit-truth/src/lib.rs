//! Ray-traced reference shadows, and the errors of a shadow map judged against them.
//!
//! It takes plain triangle slices (world space, right-handed, metres) and cut-outs, so that any
//! engine can be judged: [`Tracer`] answers rays, [`Truth`] says what the light does at each pixel,
//! [`judge()`] sorts the pixels of a picture into right ones and the named kinds of wrong ones, and
//! [`peers`] ranks fits by what their maps give to many frames. With the feature `gpu`, compute
//! passes fill a texture with the same classes.

mod camera;
mod crawl;
mod cut_out;
mod displacement;
mod edges;
#[cfg(feature = "gpu")]
pub mod gpu;
mod judge;
mod memory;
pub mod peers;
mod sun;
mod tally;
mod tracer;
mod truth;

pub use camera::PixelCamera;
pub use crawl::{MapsBefore, crawl};
pub use cut_out::{AlphaImage, CutOut, CutOuts, Wrap};
pub use displacement::GREATEST_DISPLACEMENT;
pub use judge::{Class, Judged, MapsSeen, judge};
pub use memory::TracerMemory;
pub use tally::{ClassTally, PictureTally};
pub use tracer::{Hit, Tracer, TriangleCountError};
pub use truth::{Truth, TruthPoint, TruthSettings};
