//! Shadow maps as the measures take them: where a point lies in a map, which map it reads, and how
//! finely that map samples it.
//!
//! Pictures and fits are measured by the same rules, so these stand below both.

mod choice;
mod measured;
mod picture;
mod sampling;

pub(crate) use choice::{MapSelection, OccluderPlace, choose};
pub use measured::{MapGradients, MapPosition, MeasuredMap};
pub use picture::{MapReading, PictureMaps};
pub(crate) use sampling::{MIN_FACING, pixels_per_texel};
