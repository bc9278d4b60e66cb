//! Images: one triangle over the whole image, or triangles with their depths.

use shadowfit::DepthConvention;
use shadowfit::glam::Vec4;

use super::{ClearedDepth, Engine, Pipeline, cleared, vertices};

/// The vertex shader `vs` of a triangle over the whole image.
pub(crate) const WHOLE: &str = "
@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.5, 1.0);
}
";

/// Usage of images that are read back.
pub(crate) const READ_BACK: wgpu::TextureUsages =
    wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::COPY_SRC);

/// Shaders for triangles whose positions are in clip space.
const SURFACE: &str = "
struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) normal: vec4<f32>,
}
@vertex fn vs(@location(0) clip: vec4<f32>, @location(1) normal: vec4<f32>) -> Surface {
    return Surface(clip, normal);
}
@fragment fn fs(in: Surface) -> @location(0) vec4<f32> {
    return in.normal;
}
";

/// A corner of a visible triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct SeenCorner {
    /// Position in clip space.
    pub(crate) clip: Vec4,
    /// Value in the texture of normals.
    pub(crate) normal: Vec4,
}

/// A depth buffer: its texture, and the part that is drawn.
#[derive(Clone, Copy)]
pub(crate) struct DepthPicture<'a> {
    /// Width and height of the texture, in pixels.
    pub(crate) size: [u32; 2],
    /// Left, top, width and height of the part, in pixels.
    pub(crate) part: [u32; 4],
    pub(crate) samples: u32,
    /// Mask of the drawn samples.
    pub(crate) mask: u64,
    pub(crate) format: wgpu::TextureFormat,
    pub(crate) convention: DepthConvention,
    /// Texture of normals, which is drawn in the same pass.
    pub(crate) normals: Option<&'a wgpu::TextureView>,
}

impl DepthPicture<'_> {
    /// Returns a depth buffer of 32-bit floats with one sample per pixel, which fills its texture.
    pub(crate) fn new(size: [u32; 2], convention: DepthConvention) -> Self {
        let format = wgpu::TextureFormat::Depth32Float;
        Self { size, part: [0, 0, size[0], size[1]], samples: 1, mask: !0, format, convention, normals: None }
    }
}

/// Draws one triangle over a whole image.
pub(crate) fn draw_whole(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    groups: &[&wgpu::BindGroup],
    picture: &wgpu::TextureView,
) {
    let mut pass = cleared(encoder, &[picture], None);
    pass.set_pipeline(pipeline);
    for (index, group) in (0..).zip(groups) {
        pass.set_bind_group(index, *group, &[]);
    }
    pass.draw(0..3, 0..1);
}

impl Engine {
    /// Draws the depths of triangles.
    pub(crate) fn draw_depths(&self, picture: &DepthPicture<'_>, corners: &[SeenCorner]) -> wgpu::TextureView {
        let DepthPicture { size, part, samples, mask, format, convention, normals } = *picture;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        // Multisampled textures cannot be copied.
        let copied = if samples == 1 { wgpu::TextureUsages::COPY_SRC } else { wgpu::TextureUsages::empty() };
        let view = self.texture(size, samples, format, usage | copied);
        let is_reversed = convention == DepthConvention::Reversed;
        let closer = if is_reversed { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less };
        let targets = [Some(wgpu::TextureFormat::Rgba32Float.into())];
        let pipeline = Pipeline {
            buffers: &[vertices(
                &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4],
                wgpu::VertexStepMode::Vertex,
            )],
            fragment: normals.map(|_| "fs"),
            targets: &targets,
            depth: Some(wgpu::DepthStencilState {
                format,
                depth_write_enabled: Some(true),
                depth_compare: Some(closer),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: samples, mask, ..Default::default() },
            ..Pipeline::new(SURFACE)
        }
        .make(self);
        let buffer = self.buffer(corners, wgpu::BufferUsages::VERTEX);
        let mut encoder = self.encoder();
        let depth = ClearedDepth { view: &view, value: convention.far() };
        let mut pass = cleared(&mut encoder, normals.as_slice(), Some(depth));
        pass.set_pipeline(&pipeline);
        let [left, top, width, height] = part.map(|pixels| pixels as f32);
        pass.set_viewport(left, top, width, height, 0.0, 1.0);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..corners.len() as u32, 0..1);
        drop(pass);
        self.submit(encoder);
        view
    }
}
