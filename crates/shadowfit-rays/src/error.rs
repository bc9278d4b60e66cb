//! Errors of meshes and scenes, each with its remedy.

use glam::Vec3;
use thiserror::Error;

/// The reason why a mesh or a scene of rays cannot be created or changed. On an error the scene is unchanged,
/// unless the method states otherwise.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RayError {
    /// The device cannot trace rays at all.
    #[error(
        "this device has {buffers} storage buffers per shader stage and {threads} threads per workgroup, but rays need \
         {needed_buffers} and {needed_threads}: use shadow maps alone here"
    )]
    Unsupported {
        /// Storage buffers per shader stage of the device.
        buffers: u32,
        /// Threads per workgroup of the device.
        threads: u32,
        /// Required storage buffers.
        needed_buffers: u32,
        /// Required threads.
        needed_threads: u32,
    },
    /// An index of a vertex that does not exist.
    #[error("index {place} of the mesh is vertex {index}, but the mesh has {vertices} vertices: use smaller indices")]
    Index {
        /// Position in the list of indices.
        place: usize,
        /// The index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The number of indices is not a multiple of 3.
    #[error("the number of indices, {0}, is not a multiple of 3: pass a triangle list instead of strips or fans")]
    Indices(usize),
    /// More triangles than 32 bits can count.
    #[error("{0} triangles are more than the limit of a mesh, 2^32 / 3: split the mesh")]
    Triangles(usize),
    /// The number of texture coordinates differs from the number of vertices.
    #[error("{uvs} texture coordinates were given for {vertices} vertices: pass one for each vertex, in their order")]
    Uvs {
        /// Number of given texture coordinates.
        uvs: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A cut-out of a triangle that does not exist.
    #[error("a cut-out is for triangle {triangle}, but the mesh has {triangles}: use the triangle's index in the mesh")]
    CutOut {
        /// The triangle's index.
        triangle: u32,
        /// Number of triangles of the mesh.
        triangles: usize,
    },
    /// An image whose alpha does not match its size.
    #[error(
        "an image of {width} × {height} texels was given {bytes} bytes of alpha: pass one per texel, at least one, and \
         at most 2^24 texels per side"
    )]
    Image {
        /// Width, in texels.
        width: u32,
        /// Height, in texels.
        height: u32,
        /// Number of given bytes.
        bytes: usize,
    },
    /// A buffer would be larger than the device allows.
    #[error(
        "the {what} need {bytes} bytes in one buffer, but the device allows {limit}: use fewer of them, or request a \
         device with higher `max_storage_buffer_binding_size` and `max_buffer_size` from the adapter"
    )]
    TooLarge {
        /// Content of the buffer.
        what: &'static str,
        /// Required bytes.
        bytes: u64,
        /// Greatest size of a buffer, in bytes.
        limit: u64,
    },
    /// The hierarchies need a longer stack than the shaders' stack.
    #[error(
        "the stack of a ray would hold {top} nodes of instances and {mesh} of a mesh, but the shaders' stack holds \
         {limit} in total: use fewer instances or smaller meshes"
    )]
    TooDeep {
        /// Nodes for the hierarchy of instances.
        top: usize,
        /// Nodes for the mesh with the longest stack.
        mesh: usize,
        /// Nodes on the shaders' stack.
        limit: usize,
    },
    /// A mesh that is not in the scene.
    #[error("this mesh is not in the scene, or was removed: pass the identifier that `add_mesh` returned")]
    NoMesh,
    /// An instance of a mesh that is not in the scene.
    #[error("the mesh of instance {0} is not in the scene, or was removed: omit the instance, or add its mesh first")]
    NoMeshOfInstance(usize),
    /// An image that is not in the scene.
    #[error("this image is not in the scene, or was removed: pass the identifier that `add_image` returned")]
    NoImage,
    /// A mesh that was not added as deforming.
    #[error("the mesh was added as a rigid one: add it with `add_deforming_mesh`")]
    NotDeforming,
    /// Bounds of a deforming mesh that are not a box.
    #[error("bounds of a deforming mesh from {least} to {most} are not a finite box: pass a box that holds all poses")]
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
    /// The device failed to create a resource, for example because it is out of memory. Contains the device's
    /// message.
    #[error("the device refused a buffer of the rays' scene: {0}")]
    Device(String),
    /// A prefix that is not allowed at the start of WGSL names.
    #[error("`{0}` cannot be the prefix of WGSL names: use ASCII letters, digits and underscores, with a letter first")]
    Prefix(String),
}

/// The reason why a vertex buffer cannot be read.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum VertexBufferLack {
    /// The buffer was created without the usage `STORAGE`.
    #[error("it has the usage {0:?}: create it with `STORAGE` as well")]
    Usage(wgpu::BufferUsages),
    /// Offset or stride is not a multiple of 4 bytes, or vertices overlap.
    #[error("offset {offset} and stride {stride} bytes: both must be multiples of 4, and the stride at least 12")]
    Alignment {
        /// Start of the first position, in bytes.
        offset: u64,
        /// Distance from one position to the next, in bytes.
        stride: u32,
    },
    /// The buffer ends before the last vertex.
    #[error("it has {size} bytes, but the last vertex ends at {needed}: pass a buffer with all vertices")]
    Size {
        /// Size of the buffer, in bytes.
        size: u64,
        /// Required bytes.
        needed: u64,
    },
}
