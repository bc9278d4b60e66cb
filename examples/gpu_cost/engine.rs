//! A small engine: one buffer of triangles, a matrix, and the shadows of one sun.

use core::ops::Range;

use anyhow::Result;
use glam::Vec3;
use shadowfit::{Aabb, Boxes, DepthConvention, FittedMap, PerspectiveCamera, Technique};
use shadowfit_render::{Gpu, GpuProfilerQuery, GpuTimer};
use shadowfit_wgpu::{Casters, MapView, ShadowMap, SunFrame, SunShadows, WgslOptions, caster_wgsl};
use wgpu::util::DeviceExt;

use crate::scene::BenchScene;

/// Size of the picture, in pixels.
pub(crate) const SIZE: [u32; 2] = [1920, 1080];

/// Of the camera's depth buffer.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

const CASTER: &str = "
@vertex fn vs(@location(0) position: vec3<f32>, @location(1) offset: vec3<f32>) -> @builtin(position) vec4<f32> {
    return shadowfit_caster_position(position + offset);
}
";

const COLOR: &str = "
@fragment fn fs(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return shadowfit_caster_color(at.z);
}
";

const SEEN: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4<f32>;
@vertex fn vs(@location(0) position: vec3<f32>, @location(1) offset: vec3<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_world * vec4<f32>(position + offset, 1.0);
}
";

/// The engine.
pub(crate) struct Engine<'a> {
    gpu: &'a Gpu,
    scene: &'a BenchScene,
    pub(crate) sun: SunShadows,
    vertices: wgpu::Buffer,
    offsets: wgpu::Buffer,
    caster_pipeline: wgpu::RenderPipeline,
    seen_pipeline: wgpu::RenderPipeline,
    camera_uniform: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    pub(crate) depth: wgpu::TextureView,
    boxes: Vec<Aabb>,
    moves: Vec<bool>,
}

impl<'a> Engine<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &'a BenchScene, technique: &Technique) -> Result<Self> {
        let device = &gpu.device;
        let sun = SunShadows::new(device, &gpu.queue, technique)?;
        let camera_uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let camera_layout = uniform_layout(device, wgpu::ShaderStages::VERTEX);
        let camera_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &camera_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera_uniform.as_entire_binding() }],
        });
        let depth = texture(device, DEPTH).create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self {
            caster_pipeline: caster_pipeline(device, sun.map()),
            seen_pipeline: seen_pipeline(device, &camera_layout),
            vertices: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: bytemuck::cast_slice(&scene.vertices),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            offsets: device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: (scene.casters.len() * size_of::<Vec3>()) as u64,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            boxes: Vec::new(),
            moves: scene.casters.iter().map(|caster| caster.moves).collect(),
            gpu,
            scene,
            sun,
            camera_uniform,
            camera_group,
            depth,
        })
    }

    /// The camera of a frame.
    pub(crate) fn camera(&self, frame: usize) -> PerspectiveCamera {
        self.scene.camera(frame, SIZE[0] as f32 / SIZE[1] as f32)
    }

    /// Moves what moves, and fits the maps.
    pub(crate) fn update(&mut self, frame: usize) -> Result<()> {
        self.move_casters(frame);
        self.fit(&self.camera(frame))
    }

    /// Moves what moves, and the camera.
    pub(crate) fn move_casters(&mut self, frame: usize) {
        let camera = self.camera(frame);
        let (scene, queue) = (self.scene, &self.gpu.queue);
        let bob = |number: usize| if self.moves[number] { BenchScene::bob(frame, number) } else { Vec3::ZERO };
        let numbers = 0..scene.casters.len();
        let eye = camera.eye.as_vec3();
        let offsets: Vec<Vec3> = numbers.clone().map(|number| bob(number) - eye).collect();
        queue.write_buffer(&self.offsets, 0, bytemuck::cast_slice(&offsets));
        let moved = |number: usize| {
            let (aabb, by) = (scene.casters[number].bounds, bob(number));
            Aabb::new(aabb.min + by, aabb.max + by)
        };
        self.boxes.clear();
        self.boxes.extend(numbers.map(moved));
        let clip_from_world = camera.clip_from_world(DepthConvention::Reversed).to_cols_array();
        queue.write_buffer(&self.camera_uniform, 0, bytemuck::cast_slice(&clip_from_world));
    }

    /// The part of a frame that shadows take on the CPU before the passes.
    pub(crate) fn fit(&mut self, camera: &PerspectiveCamera) -> Result<()> {
        let boxes = Boxes { boxes: &self.boxes, ..Boxes::default() };
        let casters = Casters { boxes, moves: &self.moves };
        let views = [camera.frustum()?];
        self.sun.update(&self.gpu.queue, &SunFrame::new(&views, BenchScene::direction(), boxes, casters))?;
        Ok(())
    }

    /// The shadow passes, timed or not.
    pub(crate) fn shadow_passes(&self, encoder: &mut wgpu::CommandEncoder, timer: Option<&GpuTimer>) {
        for shadow in self.sun.passes() {
            let query = timer.and_then(|timer| timer.begin("shadow", encoder));
            let times = query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes);
            let mut pass = self.sun.begin_pass(encoder, &shadow, 0, times);
            for piece in shadow.pieces() {
                piece.set(&mut pass);
                self.draw(&mut pass, piece.casters);
            }
            drop(pass);
            if let Some(timer) = timer {
                timer.end(query, encoder);
            }
        }
    }

    /// The depth of what the camera sees, and what it shows for the next frames.
    pub(crate) fn seen_pass(&mut self, encoder: &mut wgpu::CommandEncoder, camera: &PerspectiveCamera) -> Result<()> {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(depth_attachment(&self.depth, 0.0)),
            ..Default::default()
        });
        pass.set_pipeline(&self.seen_pipeline);
        pass.set_bind_group(0, &self.camera_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.offsets.slice(..));
        for (number, caster) in (0..).zip(&self.scene.casters) {
            pass.draw(caster.vertices.clone(), number..number + 1);
        }
        drop(pass);
        let convention = DepthConvention::Reversed;
        self.sun.record_need(encoder, &self.depth, camera.clip_from_world(convention), convention)?;
        Ok(())
    }

    /// Draws casters by their numbers.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, casters: &[u32]) {
        pass.set_pipeline(&self.caster_pipeline);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.offsets.slice(..));
        for number in casters {
            let vertices: Range<u32> = self.scene.casters[*number as usize].vertices.clone();
            pass.draw(vertices, *number..number + 1);
        }
    }

    /// The maps of this frame, as they are drawn into other layers.
    pub(crate) fn maps(&self) -> (Vec<FittedMap>, MapView) {
        let maps: Vec<FittedMap> = self.sun.fitted().to_vec();
        let origin = maps.first().map_or(glam::DVec3::ZERO, |map| map.fit.origin);
        (maps, MapView::from_eye(origin, Vec3::NEG_Z))
    }
}

pub(crate) fn depth_attachment(view: &wgpu::TextureView, clear: f32) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

/// A texture of the picture's size.
pub(crate) fn texture(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// A uniform at binding 0.
pub(crate) fn uniform_layout(device: &wgpu::Device, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

fn caster_pipeline(device: &wgpu::Device, map: &ShadowMap) -> wgpu::RenderPipeline {
    let color = [map.color_target()];
    let has_color = color[0].is_some();
    let source = caster_wgsl(map.descriptor(), &WgslOptions::group(0)) + CASTER + if has_color { COLOR } else { "" };
    let states = (map.primitive_state(), map.depth_stencil_state(), &color[..usize::from(has_color)]);
    pipeline(device, source, map.caster_layout(), states)
}

fn seen_pipeline(device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let depth = wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    };
    pipeline(device, SEEN.to_owned(), layout, (wgpu::PrimitiveState::default(), depth, &[]))
}

fn pipeline(
    device: &wgpu::Device,
    source: String,
    layout: &wgpu::BindGroupLayout,
    (primitive, depth, targets): (wgpu::PrimitiveState, wgpu::DepthStencilState, &[Option<wgpu::ColorTargetState>]),
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let buffer = |step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride: 12, step_mode, attributes });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs"),
            compilation_options: Default::default(),
            buffers: &[
                buffer(wgpu::VertexStepMode::Vertex, &wgpu::vertex_attr_array![0 => Float32x3]),
                buffer(wgpu::VertexStepMode::Instance, &wgpu::vertex_attr_array![1 => Float32x3]),
            ],
        },
        primitive,
        depth_stencil: Some(depth),
        multisample: wgpu::MultisampleState::default(),
        fragment: (!targets.is_empty()).then(|| wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs"),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
