//! The structs that the shaders of this crate read. Tests compare their layout with naga's reflection.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use shadowfit::{Camera, DepthConvention};
use shadowfit_params::figures::linear_map_tints;
use shadowfit_scene::{Material, Texture};
use shadowfit_wgpu::MAX_MAPS;

/// Colours of sun and sky, linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atmosphere {
    /// Sunlight that a surface facing the sun receives.
    pub sun: Vec3,
    /// Sky overhead.
    pub zenith: Vec3,
    /// Sky at the horizon, and the colour into which distant surfaces fade.
    pub horizon: Vec3,
    /// Light that the ground reflects.
    pub ground: Vec3,
    /// Increase of the haze per metre, as a share.
    pub haze_per_metre: f32,
}

impl Default for Atmosphere {
    fn default() -> Self {
        Self {
            sun: Vec3::new(2.1, 1.85, 1.5),
            zenith: Vec3::new(0.12, 0.27, 0.62),
            horizon: Vec3::new(0.55, 0.67, 0.80),
            ground: Vec3::new(0.28, 0.24, 0.19),
            haze_per_metre: 0.0035,
        }
    }
}

/// Input of every shader of a frame: `Frame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FrameUniform {
    /// Matrix clip (reversed depth) from world positions relative to the eye.
    pub clip_from_world: [[f32; 4]; 4],
    /// Offset of a line of sight from the middle of the picture, `ray_right * ndc.x + ray_up * ndc.y`, in
    /// metres: at a view depth of 1 m for a perspective, at any view depth for an orthographic lens.
    pub ray_right: [f32; 4],
    /// See `ray_right`.
    pub ray_up: [f32; 4],
    /// Unit view direction.
    pub ray_forward: [f32; 4],
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// 1 if shadows are drawn, 0 if everything is lit.
    pub shadows: f32,
    /// [`Atmosphere::sun`].
    pub sun: [f32; 3],
    /// [`Atmosphere::haze_per_metre`].
    pub haze_per_metre: f32,
    /// [`Atmosphere::zenith`].
    pub zenith: [f32; 4],
    /// [`Atmosphere::horizon`].
    pub horizon: [f32; 4],
    /// [`Atmosphere::ground`].
    pub ground: [f32; 4],
    /// Width and height of the picture, in pixels.
    pub viewport: [f32; 2],
    /// View depth of the near plane, in metres.
    pub near: f32,
    /// 1 if all lines of sight are parallel, 0 for a perspective.
    pub parallel: f32,
    /// Linear [`MAP_TINTS`](shadowfit_params::figures::MAP_TINTS), for overlays; alpha is 1.
    pub map_tints: [[f32; 4]; MAX_MAPS],
}

impl FrameUniform {
    /// Creates the uniform of a frame. `to_light` is a unit direction, `viewport` in pixels.
    pub fn new(camera: impl Into<Camera>, to_light: Vec3, shadows: bool, sky: &Atmosphere, viewport: [u32; 2]) -> Self {
        let camera: Camera = camera.into();
        let view = camera.view_from_world();
        let half = camera.half_size().as_vec2();
        Self {
            clip_from_world: camera.clip_from_world(DepthConvention::Reversed).to_cols_array_2d(),
            ray_right: (view.row(0) * half.x).to_array(),
            ray_up: (view.row(1) * half.y).to_array(),
            ray_forward: (-view.row(2)).to_array(),
            to_light: to_light.to_array(),
            shadows: if shadows { 1.0 } else { 0.0 },
            sun: sky.sun.to_array(),
            haze_per_metre: sky.haze_per_metre,
            zenith: sky.zenith.extend(0.0).to_array(),
            horizon: sky.horizon.extend(0.0).to_array(),
            ground: sky.ground.extend(0.0).to_array(),
            viewport: viewport.map(|side| side as f32),
            near: camera.near,
            parallel: if camera.lens.is_orthographic() { 1.0 } else { 0.0 },
            map_tints: linear_map_tints().map(|tint| tint.extend(1.0).to_array()),
        }
    }
}

/// Properties of a material in shaders: `Material` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MaterialUniform {
    /// Linear base colour and alpha.
    pub base_color: [f32; 4],
    /// Rows of the base colour's texture transform.
    pub base_uv: [[f32; 4]; 2],
    /// Rows of the normal map's texture transform.
    pub normal_uv: [[f32; 4]; 2],
    /// Linear emitted radiance.
    pub emissive: [f32; 3],
    /// Alpha below which fragments are discarded, in pictures of masked materials and in maps of cut-outs; 0
    /// for opaque materials.
    pub alpha_cutoff: f32,
    /// Metalness, 0..=1.
    pub metallic: f32,
    /// Roughness, 0..=1.
    pub roughness: f32,
    /// Scale of the normal map's x and y; 0 without a map.
    pub normal_scale: f32,
    /// 1 if alpha is blended, 0 if the surface is opaque.
    pub blended: f32,
}

impl MaterialUniform {
    /// Creates the uniform of a material.
    pub fn new(material: &Material) -> Self {
        use shadowfit_scene::AlphaMode;
        let rows = |texture: Option<Texture>| {
            texture.map_or([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]], |texture| {
                texture.uv_from_texcoord.map(|row| row.extend(0.0).to_array())
            })
        };
        Self {
            base_color: material.base_color.to_array(),
            base_uv: rows(material.base_color_texture),
            normal_uv: rows(material.normal_texture),
            emissive: material.emissive.to_array(),
            alpha_cutoff: material.alpha.least_opaque().unwrap_or(0.0),
            metallic: material.metallic,
            roughness: material.roughness,
            normal_scale: if material.normal_texture.is_some() { material.normal_scale } else { 0.0 },
            blended: if material.alpha == AlphaMode::Blend { 1.0 } else { 0.0 },
        }
    }
}

/// One instance in a vertex buffer.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct InstanceData {
    /// Rows of the affine transform: eye-relative world from mesh.
    pub rows: [[f32; 4]; 3],
    /// Number of the instance's first triangle in the scene, for probes.
    pub first_triangle: u32,
    /// The map that holds it, for [`Overlay::Casters`](crate::Overlay::Casters): its index plus 2, 1 if no
    /// map does, 0 if the instance casts no shadow.
    pub first_map: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding: [u32; 2],
}

/// One end of a line, relative to the eye, with linear colour.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LineVertex {
    /// Position relative to the eye, in metres.
    pub position: [f32; 3],
    /// Linear colour and alpha.
    pub color: [f32; 4],
}

/// An inset in a vertex buffer, as an instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct InsetVertex {
    /// Left, top, width and height of the inset in the picture, in pixels.
    pub rectangle: [f32; 4],
    /// Stored depths that are shown as black and as white.
    pub depth_range: [f32; 2],
    /// Index of the shown map.
    pub map: u32,
    /// Linear colour of its border.
    pub border: [f32; 3],
}

/// A quadrilateral in a vertex buffer, as an instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct QuadVertex {
    /// The first two corners, in pixels.
    pub first: [f32; 4],
    /// The other two corners, in pixels.
    pub second: [f32; 4],
    /// Linear colour and alpha.
    pub color: [f32; 4],
}

/// Transforms for finding surfaces and pixels in a judged picture: `Judged` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct JudgedUniform {
    /// Matrix clip of the judged camera from world positions relative to the frame's eye.
    pub clip_from_world: [[f32; 4]; 4],
    /// Homogeneous world positions relative to the frame's eye from its normalised device coordinates, with
    /// its reversed depth.
    pub world_from_ndc: [[f32; 4]; 4],
    /// Width and height of the judged picture, in pixels.
    pub size: [f32; 2],
    /// Judged pixels per pixel of the frame if both have the same camera; otherwise 0.
    pub scale: [f32; 2],
    /// View depth of the judged camera's near plane, in metres; 0 if its depth buffer is not used.
    pub near: f32,
    /// View depth of its far plane, in metres.
    pub far: f32,
    /// Width and height of the frame's picture, in pixels.
    pub viewport: [f32; 2],
}

/// Style of the marks on wrong pixels: `Marks` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MarksUniform {
    /// Opacity, 0..=1.
    pub strength: f32,
    /// 1 for outlines, 0 for filled marks.
    pub outline: u32,
    /// Marked classes: bit i for class i.
    pub classes: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding: u32,
}

/// Texels of a map that are read back: `Block` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BlockUniform {
    /// Left top texel of the block.
    pub first: [i32; 2],
    /// Last texel of the map, at its right bottom.
    pub last: [i32; 2],
    /// Index of the map.
    pub map: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}
