//! CPU scenes for the shadowfit samples: glTF import, the built-in scene, animation and bounds.
//!
//! Renderers draw [`Scene`] and [`Pose`]; ray tracers take [`Pose::triangles`]. Nothing here
//! touches a GPU.

mod scene;

pub use scene::*;
