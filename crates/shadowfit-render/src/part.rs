//! A part of a scene on the GPU: the buffers of one primitive, and its pipeline key.

use std::borrow::Cow;
use std::sync::Arc;

use bytemuck::cast_slice;
use glam::{Vec2, Vec4};
use shadowfit::Aabb;
use shadowfit_scene::{AlphaMode, Casting, Geometry, Primitive, Scene};

use crate::casters::{Cluster, clustered};
use crate::gpu::is_opengl;
use crate::maker::Streams;
use crate::unrolled::{Numbering, Unrolled};
use crate::upload::Upload;

/// One primitive with all its instances. A deformed primitive has a separate part for each instance.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Positions, normals, tangents, and texture coordinates with colours.
    pub(crate) streams: [wgpu::Buffer; 4],
    /// Which of the last two streams have an element for each vertex.
    pub(crate) has: Streams,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) index_count: u32,
    /// Unrolled vertices, if probes number triangles by their vertices.
    pub(crate) unrolled: Option<Unrolled>,
    /// Its triangles in the order of their clusters, for the shadow passes.
    pub(crate) caster_indices: wgpu::Buffer,
    pub(crate) clusters: Vec<Cluster>,
    pub(crate) material: usize,
    pub(crate) alpha: AlphaMode,
    pub(crate) casting: Casting,
    pub(crate) double_sided: bool,
    pub(crate) mirrored: bool,
    /// Whether its vertices move.
    pub(crate) deforms: bool,
    pub(crate) local_bounds: Option<Aabb>,
    pub(crate) members: Vec<usize>,
}

/// Properties that determine the buffers of rigid parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct TwinKey {
    geometry: *const Geometry,
    is_blended: bool,
    casts: bool,
}

impl TwinKey {
    pub(crate) fn of(scene: &Scene, primitive: &Primitive) -> Self {
        Self {
            geometry: Arc::as_ptr(&primitive.geometry),
            is_blended: scene.materials[primitive.material].alpha == AlphaMode::Blend,
            casts: scene.casting(primitive) != Casting::Nothing,
        }
    }
}

/// Properties that select a part's pipeline, in every pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent property of the part")]
pub struct PartKey {
    /// Whether fragments below the cutoff are discarded.
    pub masked: bool,
    /// Whether it is blended over the surfaces behind it.
    pub blended: bool,
    double_sided: bool,
    mirrored: bool,
    /// Streams that have an element for each vertex.
    pub streams: Streams,
}

impl Part {
    pub(crate) fn new(
        upload: &Upload<'_>,
        scene: &Scene,
        primitive: &Primitive,
        mirrored: bool,
        deforms: bool,
    ) -> Self {
        let material = &scene.materials[primitive.material];
        let casting = scene.casting(primitive);
        let Geometry { positions, normals, indices, .. } = &*primitive.geometry;
        let device = &upload.gpu.device;
        let has = streams(device, primitive);
        let (tangents, surface) = (tangents(primitive, has), surface(primitive, has));
        let vertices: [&[u8]; 4] =
            [cast_slice(positions), cast_slice(normals), cast_slice(&tangents), cast_slice(&surface)];
        // Passes refit the rays' deforming meshes from this buffer.
        let read = if deforms { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::empty() };
        // Blended surfaces are not probed.
        let is_unrolled = material.alpha != AlphaMode::Blend && Numbering::of(device) == Numbering::Vertices;
        let is_each = [true, true, has.tangents, has.surface];
        let each = [0, 1, 2, 3].map(|stream| is_each[stream].then_some(vertices[stream]));
        // Parts that cast no shadow or deform are not divided into clusters.
        let is_whole = deforms || casting == Casting::Nothing;
        let (caster_indices, clusters) = clustered(positions, indices, is_whole);
        let index = |indices: &[u32]| upload.buffer(wgpu::BufferUsages::INDEX, cast_slice(indices));
        Self {
            streams: vertices.map(|bytes| upload.buffer(wgpu::BufferUsages::VERTEX | read, bytes)),
            unrolled: is_unrolled.then(|| Unrolled::new(upload, indices, each)),
            has,
            indices: index(indices),
            caster_indices: index(&caster_indices),
            index_count: primitive.indices.len() as u32,
            clusters,
            material: primitive.material,
            alpha: material.alpha,
            casting,
            double_sided: material.double_sided,
            mirrored,
            deforms,
            local_bounds: Aabb::from_points(primitive.positions.iter().copied()),
            members: Vec::new(),
        }
    }

    /// Returns the part of a rigid primitive with the same geometry and [`TwinKey`]. Both share their
    /// buffers.
    pub(crate) fn twin(&self, scene: &Scene, primitive: &Primitive, mirrored: bool) -> Self {
        let material = &scene.materials[primitive.material];
        Self {
            material: primitive.material,
            alpha: material.alpha,
            casting: scene.casting(primitive),
            double_sided: material.double_sided,
            mirrored,
            members: Vec::new(),
            ..self.clone()
        }
    }

    /// Returns whether any of the part casts shadows.
    pub(crate) fn casts(&self) -> bool {
        self.casting != Casting::Nothing
    }

    /// Returns whether it is blended over the surfaces behind it.
    pub(crate) fn is_blended(&self) -> bool {
        self.alpha == AlphaMode::Blend
    }
}

impl PartKey {
    pub(crate) fn of(part: &Part) -> Self {
        Self {
            masked: matches!(part.alpha, AlphaMode::Mask { .. }),
            blended: part.is_blended(),
            double_sided: part.double_sided,
            mirrored: part.mirrored,
            streams: part.has,
        }
    }

    /// Returns the constants of the WGSL of [materials](crate::shaders::material).
    pub fn constants(self) -> [(&'static str, f64); 1] {
        [("MASKED", f64::from(self.masked))]
    }

    /// Returns the culled faces: back faces of single-sided parts. A mirrored part's back is its front.
    pub fn cull_mode(self) -> Option<wgpu::Face> {
        (!self.double_sided).then(|| self.back())
    }

    /// Returns the front face in the rasteriser's terms.
    pub fn front(self) -> wgpu::Face {
        if self.mirrored { wgpu::Face::Back } else { wgpu::Face::Front }
    }

    /// Returns the back face in the rasteriser's terms.
    pub fn back(self) -> wgpu::Face {
        if self.mirrored { wgpu::Face::Front } else { wgpu::Face::Back }
    }
}

/// Returns the streams that get an element for each vertex: all on OpenGL, which lacks single elements in
/// browsers.
fn streams(device: &wgpu::Device, primitive: &Primitive) -> Streams {
    let has_all = is_opengl(device);
    Streams {
        tangents: has_all || !primitive.tangents.is_empty(),
        surface: has_all || !primitive.colors.is_empty() || !primitive.uvs.is_empty(),
    }
}

/// Returns the tangents of each vertex, or a single one for all.
fn tangents(primitive: &Primitive, has: Streams) -> Cow<'_, [Vec4]> {
    let count = if has.tangents { primitive.positions.len() } else { 1 };
    if primitive.tangents.is_empty() { vec![Vec4::ZERO; count].into() } else { (&primitive.tangents).into() }
}

/// Returns texture coordinates and colours of each vertex, or a single element for all.
fn surface(primitive: &Primitive, has: Streams) -> Vec<[f32; 6]> {
    let element = |index: usize| {
        let uv = primitive.uvs.get(index).copied().unwrap_or(Vec2::ZERO);
        let color = primitive.colors.get(index).copied().unwrap_or(Vec4::ONE);
        [uv.x, uv.y, color.x, color.y, color.z, color.w]
    };
    let count = if has.surface { primitive.positions.len() } else { 1 };
    (0..count).map(element).collect()
}
