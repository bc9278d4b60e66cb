//! Culling: the casters that a shadow pass has to draw.
//!
//! A [`CasterVolume`] is a convex volume, given by planes. It contains either all casters that a map can
//! store, or only the casters that can cast a shadow into view. Tests are conservative: they may keep a
//! caster without a visible shadow, but never cull one with a visible shadow.

mod batch;
mod readers;
mod shapes;
mod sweep;
#[cfg(feature = "cache")]
mod tree;
mod volume;

pub use batch::cull;
pub use readers::{Reader, caster_volumes};
pub use shapes::{Bounds, OrientedBox, Sphere};
pub use sweep::Sweep;
pub use volume::{CasterPlanes, CasterVolume};
