//! An engine's triangles as a bounding volume hierarchy on the GPU. The engine's shaders trace it to find
//! whether a triangle lies between a point and the sun.
//!
//! [`RayMesh`] is the hierarchy of one mesh, built on the CPU. [`RayScene`] holds meshes and the frame's
//! instances of them, in five storage buffers. [`rays_wgsl`] returns the shader functions that trace rays.
//! The crate uses only features of every WebGPU device. Positions are in metres, in `f32` relative to an
//! origin that the engine chooses.
//!
//! Meshes and hierarchies need no wgpu. The feature `gpu`, which is on by default, adds everything else.

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

/// Number of nodes on the shaders' stack, for the hierarchy of instances and the hierarchy of a mesh
/// together. A hierarchy of any shape needs at most 1.5 times the binary logarithm of its leaf count.
pub const STACK: usize = 96;
