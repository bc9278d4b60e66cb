//! An engine's triangles as a bounding volume hierarchy on the GPU, traced by its own shaders: whether anything stands
//! between a point and the sun.
//!
//! [`RayMesh`] is the hierarchy of one mesh, built on the CPU; [`RayScene`] holds meshes, and their instances of the
//! frame, in five storage buffers; [`rays_wgsl`] is what a shader asks them with. It uses only what every WebGPU device
//! has. Positions are in metres, in `f32` relative to an origin that the engine chooses.
//!
//! Meshes and hierarchies need no wgpu: the feature `gpu`, which is on by default, adds everything else.

mod cut_out;
mod error;
#[cfg(feature = "gpu")]
mod gpu;
mod hierarchy;
mod mesh;
pub mod records;

pub use cut_out::{AlphaImage, CutMaterial, CutOut, ImageId, Wrap};
pub use error::RayError;
#[cfg(feature = "gpu")]
pub use error::VertexBufferLack;
pub use glam;
#[cfg(feature = "gpu")]
pub use gpu::{MeshId, RayInstance, RayScene, RayWgslOptions, Sides, VertexBuffer, rays_layout, rays_wgsl, refit_wgsl};
pub use hierarchy::build_bvh2;
pub use mesh::{RayMemory, RayMesh};

/// Nodes that the shaders' stack holds: those of the hierarchy of instances and of a mesh together. A hierarchy needs at most
/// 1.5 times the binary logarithm of its leaves, whatever its shape.
pub const STACK: usize = 96;
