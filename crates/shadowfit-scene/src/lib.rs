//! CPU scenes for the shadowfit samples: glTF import, the built-in scene, animation and bounds.
//!
//! Renderers draw [`Scene`] and [`Pose`]; ray tracers take [`Pose::triangles`]. Nothing here
//! touches a GPU.

mod bounds;
mod deform;
mod pose;
mod sample;
mod scene;

pub use bounds::Aabb;
pub use deform::Deformed;
pub use pose::{Instance, Pose, Triangle};
pub use scene::*;
