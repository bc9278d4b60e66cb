//! The records that the shaders read, with the same fields as in WGSL. Tests compare sizes and offsets with
//! naga's reflection.

/// Marks the absence of a node.
pub const NO_ROOT: u32 = u32::MAX;

/// Packs a node into a word, as shaders do. A buffer of 4 GiB holds fewer than 2^27 nodes, triangles or
/// instances.
#[cfg(feature = "gpu")]
pub(crate) fn packed(count: u32, first: u32) -> u32 {
    (count << 27) | first
}

/// A node of a hierarchy: of a mesh, in the mesh's space, or of the instances.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct NodeRecord {
    /// Least corner of its box, in metres.
    pub least: [f32; 3],
    /// Number of triangles of a leaf, or 1 for a leaf with an instance. 0 for an inner node.
    pub count: u32,
    /// Greatest corner of its box, in metres.
    pub most: [f32; 3],
    /// First triangle or instance of a leaf, or first child of an inner node. [`NO_ROOT`] for no node.
    pub first: u32,
}

/// A triangle, in leaf order.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TriangleRecord {
    /// First corner, in the space of the mesh, in metres.
    pub a: [f32; 3],
    /// Index of its cut-out plus 1. 0 for none.
    pub cut_out: u32,
    /// Second corner.
    pub b: [f32; 3],
    /// Index of the triangle in its mesh.
    pub index: u32,
    /// Third corner.
    pub c: [f32; 3],
    /// Unused.
    pub padding: u32,
}

/// A [`RayInstance`](crate::RayInstance).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct InstanceRecord {
    /// First row of the transform from world to mesh.
    pub row_x: [f32; 4],
    /// Second row.
    pub row_y: [f32; 4],
    /// Third row.
    pub row_z: [f32; 4],
    /// Root of its mesh, packed as in shaders: `count << 27 | first`. [`NO_ROOT`] if rays skip the instance.
    pub root: u32,
    /// [`Sides`](crate::Sides) as a number.
    pub sides: u32,
    /// Number that the engine assigned.
    pub custom: u32,
    /// Unused.
    pub padding: u32,
}

/// A [`CutOut`](crate::CutOut).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CutOutRecord {
    /// Texture coordinates of the first corner.
    pub uv_a: [f32; 2],
    /// Texture coordinates of the second corner.
    pub uv_b: [f32; 2],
    /// Texture coordinates of the third corner.
    pub uv_c: [f32; 2],
    /// Alpha of the material.
    pub base_alpha: f32,
    /// Least alpha that counts as opaque.
    pub cutoff: f32,
    /// Alpha of the corners.
    pub alphas: [f32; 3],
    /// Index of the image's first word in the words of all images, plus 1. 0 for none.
    pub image: u32,
    /// [`Wrap`](crate::Wrap) across and down.
    pub wrap: [u32; 2],
    /// 1 to sample the nearest texel.
    pub nearest: u32,
    /// Unused.
    pub padding: u32,
}

/// Parameters of one dispatch of a refit.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct RefitUniform {
    /// First node of the level, or first triangle.
    pub first: u32,
    /// Number of nodes of the level, or of triangles.
    pub count: u32,
    /// Start of the first position in the bound vertices, in words.
    pub offset: u32,
    /// Distance from one position to the next, in words.
    pub stride: u32,
}
