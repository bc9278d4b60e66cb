//! What the shaders read, field by field as in WGSL; tests compare sizes and offsets with naga's reflection.

use glam::DVec3;

use super::{GpuJudgeInput, GpuTruthError};
use crate::peers::ShadowMap;

/// Most shadow maps of a picture.
pub const MAX_MAPS: usize = 8;

/// A node of the hierarchy.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct NodeRecord {
    /// Least corner of its box, relative to the origin, in metres.
    pub least: [f32; 3],
    /// Triangles of a leaf, 0 for an inner node.
    pub count: u32,
    /// Greatest corner of its box, relative to the origin, in metres.
    pub most: [f32; 3],
    /// First triangle of a leaf, first of the two children of an inner node.
    pub first: u32,
}

/// A triangle, in leaf order.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TriangleRecord {
    /// First corner, relative to the origin, in metres.
    pub a: [f32; 3],
    /// Place of its cut-out plus 1, 0 for none.
    pub cut_out: u32,
    /// Second corner.
    pub b: [f32; 3],
    /// Unused.
    pub padding_0: u32,
    /// Third corner.
    pub c: [f32; 3],
    /// Unused.
    pub padding_1: u32,
}

/// A [`crate::CutOut`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CutOutRecord {
    /// Texture coordinates of the first corner.
    pub uv_a: [f32; 2],
    /// Texture coordinates of the second corner.
    pub uv_b: [f32; 2],
    /// Texture coordinates of the third corner.
    pub uv_c: [f32; 2],
    /// Alpha of the material.
    pub base_alpha: f32,
    /// Least alpha that is there.
    pub cutoff: f32,
    /// Alpha of the corners.
    pub alphas: [f32; 3],
    /// Place of its image plus 1, 0 for none.
    pub image: u32,
    /// [`crate::Wrap`] to the right and down.
    pub wrap: [u32; 2],
    /// 1 where the nearest texel is taken.
    pub nearest: u32,
    /// Unused.
    pub padding: u32,
}

/// Where an image's alpha begins.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ImageRecord {
    /// Its first byte among those of all images.
    pub first: u32,
    /// Width, in texels.
    pub width: i32,
    /// Height, in texels.
    pub height: i32,
    /// Unused.
    pub padding: u32,
}

/// A shadow map.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct SeenMapUniform {
    /// First row of clip from positions relative to the eye.
    pub row_x: [f32; 4],
    /// Second row.
    pub row_y: [f32; 4],
    /// Third row.
    pub row_z: [f32; 4],
    /// Fourth row.
    pub row_w: [f32; 4],
    /// Texels across and down.
    pub size: [f32; 2],
    /// View depth below which the map is the first choice, in metres.
    pub split_far: f32,
    /// 1 where depth 1 is nearest to the light.
    pub is_reversed: u32,
}

/// A picture's camera, light and maps.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct JudgeUniform {
    /// Eye, relative to the origin of the triangles, in metres.
    pub eye: [f32; 3],
    /// View depth of the near plane, in metres.
    pub near: f32,
    /// Unit direction to the right.
    pub right: [f32; 3],
    /// View depth of the far plane, in metres.
    pub far: f32,
    /// Unit direction upward.
    pub up: [f32; 3],
    /// Start of the shadow rays above the surface, in metres.
    pub ray_offset: f32,
    /// Unit direction of view.
    pub forward: [f32; 3],
    /// Greatest view depth that is judged, in metres.
    pub max_distance: f32,
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// Width of the edge zone, in pixels or texels' footprints.
    pub edge_width: f32,
    /// Tangents of half of the fields of view.
    pub tan_half_fov: [f32; 2],
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Number of maps.
    pub map_count: u32,
    /// 1 where the maps were drawn with depth clamp.
    pub depth_clamp: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// Unused.
    pub padding: u32,
    /// The maps.
    pub maps: [SeenMapUniform; MAX_MAPS],
}

impl JudgeUniform {
    /// A picture's uniform, for triangles that are stored relative to `origin`.
    pub(crate) fn new(input: &GpuJudgeInput, origin: DVec3, triangles: u32) -> Result<Self, GpuTruthError> {
        let GpuJudgeInput { camera, settings, maps } = input;
        if maps.maps.len() > MAX_MAPS {
            return Err(GpuTruthError::TooManyMaps(maps.maps.len()));
        }
        if settings.sun_radius > 0.0 {
            return Err(GpuTruthError::SoftSun);
        }
        let mut uniforms = [SeenMapUniform::default(); MAX_MAPS];
        for (uniform, map) in uniforms.iter_mut().zip(maps.maps) {
            *uniform = seen_map(map, camera.eye);
        }
        Ok(Self {
            eye: (camera.eye - origin).as_vec3().into(),
            near: finite(camera.near),
            right: camera.right.as_vec3().into(),
            far: finite(camera.far),
            up: camera.up.as_vec3().into(),
            ray_offset: finite(settings.ray_offset),
            forward: camera.forward.as_vec3().into(),
            max_distance: finite(settings.max_distance),
            to_light: settings.to_light.as_vec3().into(),
            edge_width: maps.edge_width(),
            tan_half_fov: camera.tan_half_fov.as_vec2().into(),
            size: camera.size,
            map_count: maps.maps.len() as u32,
            depth_clamp: maps.depth_clamp.into(),
            triangles,
            padding: 0,
            maps: uniforms,
        })
    }
}

fn seen_map(map: &ShadowMap, eye: DVec3) -> SeenMapUniform {
    let [row_x, row_y, row_z, row_w] = map.rows_from(eye).map(|row| row.as_vec4().into());
    SeenMapUniform {
        row_x,
        row_y,
        row_z,
        row_w,
        size: map.size.as_vec2().into(),
        split_far: finite(map.split_far),
        is_reversed: map.is_reversed.into(),
    }
}

/// A length that shaders can compare: WGSL has no infinity.
fn finite(value: f64) -> f32 {
    (value as f32).clamp(f32::MIN, f32::MAX)
}
