//! The look-up alone: a triangle over the picture that takes positions from the depth buffer.

use glam::Mat4;
use shadowfit::{DepthConvention, PerspectiveCamera};
use shadowfit_render::{Gpu, GpuProfilerQuery, GpuTimer};
use shadowfit_wgpu::{ShadowMap, WgslOptions, receiver_wgsl};
use wgpu::util::DeviceExt;

use crate::engine::{SIZE, texture, uniform_layout};

const SHADER: &str = "
@group(0) @binding(0) var<uniform> world_from_pixel: mat4x4<f32>;
@group(1) @binding(0) var depths: texture_depth_2d;

@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

fn position(pixel: vec2<f32>) -> vec3<f32> {
    let depth = textureLoad(depths, vec2<i32>(pixel), 0);
    let homogeneous = world_from_pixel * vec4<f32>(pixel, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

@fragment fn fs(@builtin(position) at: vec4<f32>) -> @location(0) f32 {
    let p = position(at.xy);
    let normal = normalize(cross(dpdy(p), dpdx(p)));
    return LOOK_UP;
}
";

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// The pass for one shadow map.
pub(crate) struct Fullscreen {
    pipeline: wgpu::RenderPipeline,
    groups: [wgpu::BindGroup; 2],
    color: wgpu::TextureView,
}

impl Fullscreen {
    /// The pass that looks up a map at the positions of a depth buffer, its discs turned from pixel to pixel or not; without
    /// a map it takes positions alone.
    pub(crate) fn new(
        gpu: &Gpu,
        map: Option<(&ShadowMap, bool)>,
        camera: &PerspectiveCamera,
        depth: &wgpu::TextureView,
    ) -> Self {
        let device = &gpu.device;
        let pixels = Mat4::from_cols_array_2d(&[
            [2.0 / SIZE[0] as f32, 0.0, 0.0, 0.0],
            [0.0, -2.0 / SIZE[1] as f32, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0, 1.0],
        ]);
        let world_from_pixel = camera.clip_from_world(DepthConvention::Reversed).inverse() * pixels;
        let uniform = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&world_from_pixel.to_cols_array()),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let layouts = [uniform_layout(device, wgpu::ShaderStages::FRAGMENT), depth_layout(device)];
        let resources = [uniform.as_entire_binding(), wgpu::BindingResource::TextureView(depth)];
        let group = |(layout, resource): (&wgpu::BindGroupLayout, wgpu::BindingResource<'_>)| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
            })
        };
        let [first, second] = resources;
        let groups = [group((&layouts[0], first)), group((&layouts[1], second))];
        let color = texture(device, COLOR).create_view(&wgpu::TextureViewDescriptor::default());
        Self { pipeline: pipeline(device, map, &layouts), groups, color }
    }

    /// Records the pass, timed.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, map: Option<&ShadowMap>, timer: &GpuTimer) {
        let query = timer.begin("fullscreen", encoder);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        for (index, group) in (0..).zip(&self.groups) {
            pass.set_bind_group(index, group, &[]);
        }
        if let Some(map) = map {
            pass.set_bind_group(2, map.receiver_group(), &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        timer.end(query, encoder);
    }
}

fn depth_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Depth,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        }],
    })
}

fn pipeline(
    device: &wgpu::Device,
    map: Option<(&ShadowMap, bool)>,
    layouts: &[wgpu::BindGroupLayout; 2],
) -> wgpu::RenderPipeline {
    let (receiver, look_up) = match map {
        Some((map, is_turned)) => (
            receiver_wgsl(map.descriptor(), &WgslOptions::group(2)),
            if is_turned { "shadowfit_factor_at(p, normal, at.xy)" } else { "shadowfit_factor(p, normal)" },
        ),
        None => (String::new(), "normal.x + p.x"),
    };
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl((receiver + &SHADER.replace("LOOK_UP", look_up)).into()),
    });
    let mut groups = vec![Some(&layouts[0]), Some(&layouts[1])];
    groups.extend(map.map(|(map, _)| Some(map.receiver_layout())));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
