//! Meshes and their instances in buffers on the GPU, and the WGSL that reads them.

mod deform;
mod device;
mod instance;
mod placed;
mod pool;
mod ranges;
mod scene;
mod top;
mod wgsl;

pub use deform::VertexBuffer;
pub use instance::{RayInstance, Sides};
pub use placed::MeshId;
pub use scene::{RayScene, rays_layout};
pub use wgsl::{RayWgslOptions, rays_wgsl, refit_wgsl};
