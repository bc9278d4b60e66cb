//! Shadow maps as the measures take them: where a point lies in a map, which map it reads, and how
//! finely that map samples it.
//!
//! Pictures and fits are measured by the same rules, so these stand below both.

mod choice;
mod measured;
mod picture;
mod sampling;

pub use choice::{OccluderPlace, SelectedMap};
pub use measured::{MapGradients, MapPosition, MeasuredMap};
pub use picture::{MapReading, PictureMaps};
pub use sampling::{MIN_FACING, pixels_per_texel};
