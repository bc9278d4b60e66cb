//! Which casters a shadow pass has to draw.
//!
//! A [`CasterVolume`] is a convex volume as planes: either all that a map can store, or the part of
//! it that can cast a shadow into view. Tests against it are conservative: they may keep a caster
//! whose shadow is not visible, but never cull one whose shadow is.

mod batch;
mod coverage;
mod planes;
mod readers;
mod shapes;
mod sweep;
mod volume;

pub use batch::cull;
pub use coverage::Reader;
pub use planes::CasterPlanes;
pub use readers::caster_volumes;
pub use shapes::{Bounds, OrientedBox, Sphere};
pub use sweep::Sweep;
pub use volume::CasterVolume;
