//! The formats of the textures of ambient occlusion.

/// Positions in view space, 1 in w where there is a surface. Half floats would be too coarse: 1/64 m at 20 m.
pub(super) const POSITION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Unit normals in view space.
pub(super) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Occlusion; can be blended, which takes the greater of two radii.
pub(super) const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;
