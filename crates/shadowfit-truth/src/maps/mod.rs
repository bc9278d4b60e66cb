//! Shadow maps as the measures take them: where a point lies in a map, which map it reads, and how
//! finely that map samples it.
//!
//! Pictures and fits are measured by the same rules, so these stand below both.

mod measured;
mod picture;
mod sampling;
mod selection;

pub use measured::{MapGradients, MapPosition, MeasuredMap};
pub use picture::{MapReading, PictureMaps};
pub use sampling::{MIN_FACING, pixels_per_texel};
pub use selection::{OccluderPlace, SelectedMap};
