//! Ray-traced reference shadows, and the errors of a shadow map judged against them.
//!
//! The input is plain triangles (world space, right-handed, metres) and cut-outs, so that any engine can be
//! judged. [`Tracer`] casts rays. [`Truth`] holds how much light reaches each pixel. [`judge()`] classifies
//! the pixels of a picture as right or as one of the kinds of wrong. With the feature `gpu`, compute passes
//! fill a texture with the same classes. The light is a sun or, on the CPU only, a light with a position
//! ([`TruthLight`]). [`AmbientTruth`] is the reference for ambient occlusion. [`FlipReference`] measures how
//! different two pictures look.
//!
//! Each module uses only modules on lower lines:
//!
//! ```text
//! crawl
//! gpu  judge
//! pixel  tally
//! area
//! ambient  truth
//! displacement  light  seen
//! camera  class  distances  flip  histogram  maps  sun  tracer
//! cut_out  memory  spiral
//! ```

mod ambient;
mod area;
mod camera;
mod class;
mod crawl;
mod cut_out;
mod displacement;
mod distances;
mod flip;
#[cfg(feature = "gpu")]
pub mod gpu;
mod histogram;
mod judge;
mod light;
mod maps;
mod memory;
mod pixel;
mod seen;
mod spiral;
mod sun;
mod tally;
mod tracer;
mod truth;

pub use ambient::{AmbientSettings, AmbientTruth};
pub use area::{AreaTally, area};
pub use camera::{PixelCamera, PixelRay, slide};
pub use class::Class;
pub use crawl::{MapsBefore, crawl};
pub use cut_out::{AlphaImage, CutMaterial, CutOut, CutOuts, Wrap};
pub use displacement::MAX_DISPLACEMENT;
pub use flip::FlipReference;
pub use histogram::Histogram;
pub use judge::{Judged, judge, judge_while};
pub use light::{LightRay, TruthLight};
pub use maps::{
    MIN_FACING, MapGradients, MapPosition, MapReading, MeasuredMap, OccluderPlace, PictureMaps, SelectedMap,
    pixels_per_texel,
};
pub use memory::TracerMemory;
pub use pixel::{PixelFinding, PixelTruth};
pub use tally::{ClassTally, Crawl, PictureFigures, PictureTally};
pub use tracer::{Hit, Tracer, TriangleCountError};
pub use truth::{Occluder, Truth, TruthPoint, TruthSettings};
