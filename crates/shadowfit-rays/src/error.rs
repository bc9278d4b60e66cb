//! Why a mesh or a scene cannot be made or changed, with what to do about it.

use glam::Vec3;
use thiserror::Error;

/// Why a mesh or a scene of rays cannot be made or changed. Nothing is changed then, unless it says so.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RayError {
    /// The device cannot trace rays at all.
    #[error(
        "this device has {buffers} storage buffers a shader stage and {threads} threads a workgroup, and rays need \
         {needed_buffers} and {needed_threads}: use shadow maps alone here"
    )]
    Unsupported {
        /// Storage buffers that a shader stage may have.
        buffers: u32,
        /// Threads that a workgroup may have.
        threads: u32,
        /// Storage buffers that are needed.
        needed_buffers: u32,
        /// Threads that are needed.
        needed_threads: u32,
    },
    /// An index of a vertex that does not exist.
    #[error("index {place} of the mesh is vertex {index}, and it has {vertices} vertices: give indices below that")]
    Index {
        /// Where it stands among the indices.
        place: usize,
        /// The index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// Indices that are not those of whole triangles.
    #[error("{0} indices are not three for each triangle: give a triangle list, strips and fans taken apart")]
    Indices(usize),
    /// More triangles than 32 bits can count.
    #[error("{0} triangles are more than a mesh can have, 2^32 / 3: split it")]
    Triangles(usize),
    /// Texture coordinates that are not one for each vertex.
    #[error("{uvs} texture coordinates were given for {vertices} vertices: give one for each vertex, in their order")]
    Uvs {
        /// Texture coordinates that were given.
        uvs: usize,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// A cut-out of a triangle that does not exist.
    #[error("a cut-out is for triangle {triangle}, and the mesh has {triangles}: give the triangle's own index")]
    CutOut {
        /// The triangle's index.
        triangle: u32,
        /// Triangles of the mesh.
        triangles: usize,
    },
    /// An image whose alpha does not have its size.
    #[error(
        "an image of {width} × {height} texels was given {bytes} bytes of alpha: give one for each texel, at least one, \
         and at most 2^24 a side"
    )]
    Image {
        /// Width, in texels.
        width: u32,
        /// Height, in texels.
        height: u32,
        /// Bytes that were given.
        bytes: usize,
    },
    /// A buffer would be larger than the device allows.
    #[error(
        "the {what} demand {bytes} bytes in one buffer, and the device allows {limit}: use fewer of them, or ask the \
         adapter for a device with higher `max_storage_buffer_binding_size` and `max_buffer_size`"
    )]
    TooLarge {
        /// What would be in the buffer.
        what: &'static str,
        /// Bytes that it needs.
        bytes: u64,
        /// Bytes that one buffer may have.
        limit: u64,
    },
    /// The hierarchies need a longer stack than the shaders have.
    #[error(
        "a ray would keep {top} nodes of instances and {mesh} of a mesh, and the shaders can keep {limit} together: use \
         fewer instances or smaller meshes"
    )]
    TooDeep {
        /// Nodes of the hierarchy of instances.
        top: usize,
        /// Nodes of the mesh that needs most.
        mesh: usize,
        /// Nodes that the shaders can keep.
        limit: usize,
    },
    /// A mesh that is not in the scene.
    #[error("this mesh is not in the scene, or no longer: give the number that `add_mesh` returned")]
    NoMesh,
    /// An instance of a mesh that is not in the scene.
    #[error("instance {0} is of a mesh that is not in the scene, or no longer: leave it out, or add its mesh first")]
    NoMeshOfInstance(usize),
    /// An image that is not in the scene.
    #[error("this image is not in the scene, or no longer: give the number that `add_image` returned")]
    NoImage,
    /// A mesh whose vertices cannot be read again.
    #[error("the mesh was added as one that keeps its shape: add it with `add_deforming_mesh`")]
    NotDeforming,
    /// Bounds of a deforming mesh that are not a box.
    #[error("bounds of a deforming mesh from {least} to {most} are not a finite box: give one that holds all poses")]
    Bounds {
        /// Least corner, in the space of the mesh.
        least: Vec3,
        /// Greatest corner.
        most: Vec3,
    },
    /// A vertex buffer that cannot be read.
    #[cfg(feature = "gpu")]
    #[error("the vertex buffer of a deforming mesh cannot be read: {0}")]
    Vertices(VertexBufferLack),
    /// The device refused to make a resource, for example because it is out of memory; with its own words.
    #[error("the device refused a buffer of the rays' scene: {0}")]
    Device(String),
    /// A prefix that no name in WGSL can begin with.
    #[error("`{0}` cannot begin names in WGSL: use ASCII letters, digits and underscores, with a letter first")]
    Prefix(String),
}

/// Why a vertex buffer cannot be read.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum VertexBufferLack {
    /// It was made without the usage `STORAGE`.
    #[error("it has the usage {0:?}: make it with `STORAGE` as well")]
    Usage(wgpu::BufferUsages),
    /// Offset or stride is not a whole number of words, or vertices overlap.
    #[error("offset {offset} and stride {stride} bytes: both must be multiples of 4, and the stride at least 12")]
    Alignment {
        /// Where the first position begins, in bytes.
        offset: u64,
        /// From one position to the next one, in bytes.
        stride: u32,
    },
    /// It ends before the last vertex.
    #[error("it has {size} bytes, and the last vertex ends at {needed}: give the buffer of all vertices")]
    Size {
        /// Its bytes.
        size: u64,
        /// Bytes that are needed.
        needed: u64,
    },
}
