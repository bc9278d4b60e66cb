//! Depth buffers of a few planes and boxes, and the compute pass over them.

use shadowfit::DepthConvention;
use shadowfit::Seen;
use shadowfit::glam::{Mat4, Vec3};
use shadowfit_render::Gpu;
use shadowfit_wgpu::demand::{DemandPass, DemandView};
use wgpu::util::DeviceExt;

use super::demand_reference::{Counts, Depths};
use super::read_back::texels;

/// Positions are in clip space already.
const SHADER: &str = "
@vertex fn vs(@location(0) position: vec4<f32>) -> @builtin(position) vec4<f32> {
    return position;
}
";

/// How a depth buffer is made.
#[derive(Clone, Copy)]
pub(super) struct Drawing {
    /// Width and height of the texture, in pixels.
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    /// Which samples are drawn.
    pub(super) mask: u64,
}

impl Drawing {
    /// A texture of one sample a pixel.
    pub(super) fn new(size: [u32; 2]) -> Self {
        Self { size, samples: 1, mask: !0 }
    }
}

/// Corners of the triangles of a quad, around.
pub(super) fn quad(corners: [Vec3; 4]) -> [Vec3; 6] {
    let [a, b, c, d] = corners;
    [a, b, c, a, c, d]
}

/// Triangles of a box.
pub(super) fn cuboid(low: Vec3, high: Vec3) -> Vec<Vec3> {
    let at = |bits: usize| {
        Vec3::from_array([0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { high[axis] } else { low[axis] }))
    };
    let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    faces.iter().flat_map(|face| quad(face.map(at))).collect()
}

/// Draws triangles, relative to the eye, into the view's part of a depth texture.
pub(super) fn draw(gpu: &Gpu, view: &DemandView, triangles: &[Vec3], drawing: &Drawing) -> wgpu::Texture {
    let texture = texture(gpu, drawing);
    let pipeline = pipeline(gpu, view.depth, drawing);
    let clip = view.clip_from_world.as_dmat4();
    let positions: Vec<[f32; 4]> =
        triangles.iter().map(|p| (clip * p.as_dvec3().extend(1.0)).as_vec4().to_array()).collect();
    let vertices = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&positions),
        usage: wgpu::BufferUsages::VERTEX,
    });
    let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &target,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(view.depth.far()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        if positions.is_empty() {
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
            return texture;
        }
        let [left, top, width, height] = view.rectangle.map(|pixels| pixels as f32);
        pass.set_viewport(left, top, width, height, 0.0, 1.0);
        pass.set_pipeline(&pipeline);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..positions.len() as u32, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
    texture
}

fn texture(gpu: &Gpu, drawing: &Drawing) -> wgpu::Texture {
    let copies = if drawing.samples == 1 { wgpu::TextureUsages::COPY_SRC } else { wgpu::TextureUsages::empty() };
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: drawing.size[0], height: drawing.size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: drawing.samples,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | copies,
        view_formats: &[],
    })
}

fn pipeline(gpu: &Gpu, depth: DepthConvention, drawing: &Drawing) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let is_reversed = depth == DepthConvention::Reversed;
    let closer = if is_reversed { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 16,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x4],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(closer),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: drawing.samples, mask: drawing.mask, ..Default::default() },
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

/// Reads a texture of one sample a pixel back.
pub(super) fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Depths {
    Depths { width: texture.width(), values: texels(&gpu.device, &gpu.queue, texture) }
}

/// Runs the pass over a texture, and waits for it.
pub(super) fn seen(gpu: &Gpu, view: &DemandView, texture: &wgpu::Texture) -> Seen {
    let mut pass = DemandPass::new(&gpu.device, &gpu.queue, texture.sample_count()).expect("a device that computes");
    record(gpu, &mut pass, view, texture);
    pass.wait().expect("the device answers").expect("a picture was recorded")
}

/// Records a picture and submits it.
pub(super) fn record(gpu: &Gpu, pass: &mut DemandPass, view: &DemandView, texture: &wgpu::Texture) {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let depth = texture.create_view(&wgpu::TextureViewDescriptor::default());
    assert_eq!(pass.record(&mut encoder, &depth, view, None), Ok(true));
    gpu.queue.submit([encoder.finish()]);
}

impl From<&Seen> for Counts {
    fn from(seen: &Seen) -> Self {
        Self { cells: seen.demand().counts.to_vec(), bins: seen.histogram().bins.to_vec() }
    }
}

/// A perspective with an infinite far plane and reversed depth.
pub(super) fn infinite(clip_from_view: Mat4, near: f32) -> Mat4 {
    let mut matrix = clip_from_view;
    matrix.z_axis.z = 0.0;
    matrix.w_axis.z = near;
    matrix
}
