//! Which casters a shadow pass has to draw.
//!
//! A [`CasterVolume`] is a convex volume as planes: either all that a map can store, or the part of
//! it that can cast a shadow into view. Tests against it are conservative: they may keep a caster
//! whose shadow is not visible, but never cull one whose shadow is.

mod batch;
mod readers;
mod shapes;
mod sweep;
#[cfg(feature = "alloc")]
mod tree;
mod volume;

pub use batch::cull;
pub use readers::{Reader, caster_volumes};
pub use shapes::{Bounds, OrientedBox, Sphere};
pub use sweep::Sweep;
pub use volume::{CasterPlanes, CasterVolume};
