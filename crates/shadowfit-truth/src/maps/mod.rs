//! Shadow maps as input of the measurements: the position of a point in a map, the selection of the map that
//! a point reads, and the map's pixels per texel at that point.
//!
//! Pictures and fits are measured by the same rules, so both use this module.

mod measured;
mod picture;
mod sampling;
mod selection;

pub use measured::{MapGradients, MapPosition, MeasuredMap};
pub use picture::{MapReading, PictureMaps};
pub use sampling::{MIN_FACING, pixels_per_texel};
pub use selection::{OccluderPlace, SelectedMap};
