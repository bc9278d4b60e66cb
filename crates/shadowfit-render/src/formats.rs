//! Formats of textures and the layout of vertices.

/// Colour format of render targets, as the renderer writes it.
pub(crate) const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// The same bytes without the sRGB decoding, for user interfaces that blend encoded colours.
pub const ENCODED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Depth format of the camera.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of the normals that edges are traced with: world axes, unit length.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Bytes of an element of each stream of vertices: positions, normals, tangents, and texture coordinates with colours.
pub(crate) const STRIDES: [usize; 4] = [12, 12, 16, 24];
