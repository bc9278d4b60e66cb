//! Fits a directional light's orthographic view-projection to a camera frustum.
#![no_std]
#![forbid(unsafe_code)]

pub mod figures;
pub mod settings;

pub use glam;

/// Depth range of a clip space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthConvention {
    /// Near is 0, far is 1 (wgpu, Direct3D, Vulkan, Metal).
    #[default]
    ZeroToOne,
    /// Near is 1, far is 0: the same range reversed, for float precision.
    Reversed,
    /// Near is -1, far is 1 (OpenGL).
    NegativeOneToOne,
}
