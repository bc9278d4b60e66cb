//! The look-up alone: a full-screen triangle that computes positions from the depth buffer.

use glam::Mat4;
use shadowfit::{DepthConvention, PerspectiveCamera};
use shadowfit_render::passes::{Maker, Shape};
use shadowfit_render::{Gpu, GpuProfilerQuery, GpuTimer, attachment, bindings};
use shadowfit_wgpu::{ShadowMap, WgslOptions, receiver_wgsl};
use wgpu::util::DeviceExt;

use super::engine::{SIZE, target};

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
    pub(crate) color: wgpu::TextureView,
}

impl Fullscreen {
    /// Creates the pass that looks up a map at the positions of a depth buffer. The flag beside the map
    /// rotates discs from pixel to pixel. Without a map, the pass only computes positions.
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
        let types = [bindings::UNIFORM, bindings::texture(wgpu::TextureSampleType::Depth, false)];
        let layouts = types.map(|ty| bindings::layout(device, "fullscreen", wgpu::ShaderStages::FRAGMENT, &[ty]));
        let [first, second] = [uniform.as_entire_binding(), wgpu::BindingResource::TextureView(depth)];
        let group = |layout, resource| bindings::group(device, "fullscreen", layout, &[resource]);
        let groups = [group(&layouts[0], first), group(&layouts[1], second)];
        let color = target(device, SIZE, COLOR);
        Self { pipeline: pipeline(device, map, &layouts), groups, color }
    }

    /// Records the pass, timed.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, map: Option<&ShadowMap>, timer: &GpuTimer) {
        let query = timer.begin("fullscreen", encoder);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment::cleared(&self.color, None, wgpu::Color::BLACK))],
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
    let maker = Maker { device, samples: 1 };
    let module = maker.module("fullscreen", receiver + &SHADER.replace("LOOK_UP", look_up));
    let mut groups: Vec<_> = layouts.iter().collect();
    groups.extend(map.map(|(map, _)| map.receiver_layout()));
    let layout = maker.layout(&groups);
    maker
        .pipeline(&Shape { targets: &[Some(COLOR.into())], ..Shape::new("fullscreen", &layout, &module, ["vs", "fs"]) })
}
