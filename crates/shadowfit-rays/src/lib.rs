//! An engine's triangles as a bounding volume hierarchy on the GPU, traced by its own shaders: whether anything stands
//! between a point and the sun.
//!
//! [`RayMesh`] is the hierarchy of one mesh, built on the CPU; [`RayScene`] holds meshes, and their instances of the
//! frame, in five storage buffers; [`rays_wgsl`] is what a shader asks them with. It uses only what every WebGPU device
//! has. Positions are in metres, in `f32` relative to an origin that the engine chooses.

mod at_once;
mod cut_out;
mod deform;
mod device;
mod error;
mod hierarchy;
mod instance;
mod mesh;
mod placed;
mod pool;
pub mod records;
mod scene;
mod top;
mod wgsl;

pub use at_once::make_at_once;
pub use cut_out::{AlphaImage, CutMaterial, CutOut, Wrap};
pub use deform::VertexBuffer;
pub use error::{RayError, VertexBufferLack};
pub use glam;
pub use instance::{RayInstance, Sides};
pub use mesh::{RayMemory, RayMesh};
pub use placed::{ImageId, MeshId};
pub use scene::{RayScene, rays_layout};
pub use wgsl::{RayWgslOptions, rays_wgsl, refit_wgsl};

/// Nodes that the shaders' stack holds: those of the hierarchy of instances and of a mesh together. A hierarchy needs at most
/// 1.5 times the binary logarithm of its leaves, whatever its shape.
pub const STACK: usize = 96;
