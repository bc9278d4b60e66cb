//! Formats of textures and the layout of vertices.

/// Colour format of render targets.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// The colour format without sRGB decoding, for user interfaces that blend encoded colours.
pub const ENCODED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Depth format of the camera.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of the normals for tracing edges: world axes, unit length.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Bytes per element of each vertex stream: positions, normals, tangents, and texture coordinates with
/// colours.
pub(crate) const STRIDES: [usize; 4] = [12, 12, 16, 24];
