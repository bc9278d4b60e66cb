//! A small engine: one buffer of triangles, a matrix, and the shadows of one sun.

use core::ops::Range;

use anyhow::Result;
use glam::{Mat4, Vec3};
use shadowfit::{Aabb, Boxes, DepthConvention, FittedMap, PerspectiveCamera, Technique};
use shadowfit_render::passes::{DEPTH_FORMAT, Maker, Shape, depth};
use shadowfit_render::{Gpu, GpuProfilerQuery, GpuTimer, attachment, bindings};
use shadowfit_wgpu::{Casters, LightSteps, MapView, ShadowMap, SunFrame, SunShadows, WgslOptions, caster_wgsl};
use wgpu::util::DeviceExt;

use super::scene::BenchScene;

/// Size of the picture, in pixels.
pub(crate) const SIZE: [u32; 2] = [1920, 1080];

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
    /// Direction of travel of the light.
    pub(crate) direction: Vec3,
    /// Casters of the scene in the order in which they are passed on, their boxes, and whether they move.
    shown: Vec<u32>,
    boxes: Vec<Aabb>,
    moves: Vec<bool>,
}

impl<'a> Engine<'a> {
    pub(crate) fn new(gpu: &'a Gpu, scene: &'a BenchScene, technique: &Technique) -> Result<Self> {
        let device = &gpu.device;
        let sun = SunShadows::new(device, &gpu.queue, &(*technique).into())?;
        let camera_uniform = bindings::uniform_buffer::<Mat4>(device, "camera");
        let camera_layout = bindings::layout(device, "camera", wgpu::ShaderStages::VERTEX, &[bindings::UNIFORM]);
        let camera_group = bindings::group(device, "camera", &camera_layout, &[camera_uniform.as_entire_binding()]);
        let depth = target(device, SIZE, DEPTH_FORMAT);
        let maker = Maker { device, samples: 1 };
        Ok(Self {
            caster_pipeline: caster_pipeline(&maker, sun.map()),
            seen_pipeline: seen_pipeline(&maker, &camera_layout),
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
            shown: (0..scene.casters.len() as u32).collect(),
            boxes: Vec::new(),
            moves: scene.casters.iter().map(|caster| caster.moves).collect(),
            gpu,
            scene,
            sun,
            camera_uniform,
            camera_group,
            depth,
            direction: BenchScene::direction(),
        })
    }

    /// Sets the light steps of a moving sun.
    pub(crate) fn set_light_steps(&mut self, steps: Option<LightSteps>) -> Result<()> {
        if self.sun.set_light_steps(steps)? {
            self.caster_pipeline = caster_pipeline(&Maker { device: &self.gpu.device, samples: 1 }, self.sun.map());
        }
        Ok(())
    }

    /// Returns the device.
    pub(crate) fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// Stops all casters.
    pub(crate) fn stand_still(&mut self) {
        self.moves.fill(false);
    }

    /// Passes on only these casters of the scene, in this order.
    pub(crate) fn show(&mut self, numbers: &[u32]) {
        self.shown.clear();
        self.shown.extend(numbers);
        self.moves.clear();
        self.moves.extend(numbers.iter().map(|number| self.scene.casters[*number as usize].moves));
    }

    /// Returns the camera of a frame.
    pub(crate) fn camera(&self, frame: usize) -> PerspectiveCamera {
        self.scene.camera(frame, SIZE[0] as f32 / SIZE[1] as f32)
    }

    /// Moves the moving casters, and fits the maps.
    pub(crate) fn update(&mut self, frame: usize) -> Result<()> {
        self.move_casters(frame);
        self.fit(&self.camera(frame))
    }

    /// Moves the moving casters and the camera.
    pub(crate) fn move_casters(&mut self, frame: usize) {
        let camera = self.camera(frame);
        let (scene, queue) = (self.scene, &self.gpu.queue);
        let bob = |number: usize| if scene.casters[number].moves { BenchScene::bob(frame, number) } else { Vec3::ZERO };
        let eye = camera.eye.as_vec3();
        let offsets: Vec<Vec3> = (0..scene.casters.len()).map(|number| bob(number) - eye).collect();
        queue.write_buffer(&self.offsets, 0, bytemuck::cast_slice(&offsets));
        let moved = |number: usize| {
            let (aabb, by) = (scene.casters[number].bounds, bob(number));
            Aabb::new(aabb.min + by, aabb.max + by)
        };
        self.boxes.clear();
        self.boxes.extend(self.shown.iter().map(|number| moved(*number as usize)));
        let clip_from_world = camera.clip_from_world(DepthConvention::Reversed).to_cols_array();
        queue.write_buffer(&self.camera_uniform, 0, bytemuck::cast_slice(&clip_from_world));
    }

    /// Executes the CPU work of a frame's shadows before the passes.
    pub(crate) fn fit(&mut self, camera: &PerspectiveCamera) -> Result<()> {
        let boxes = Boxes { boxes: &self.boxes, ..Boxes::default() };
        let casters = Casters { moves: &self.moves, ..Casters::fixed(boxes) };
        let views = [camera.frustum()?];
        self.sun.update(&self.gpu.queue, &SunFrame::new(&views, self.direction, boxes, casters))?;
        Ok(())
    }

    /// Records the shadow passes, with or without timing.
    pub(crate) fn shadow_passes(&self, encoder: &mut wgpu::CommandEncoder, timer: Option<&GpuTimer>) {
        for shadow in self.sun.passes() {
            let query = timer.and_then(|timer| timer.begin("shadow", encoder));
            let times = query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes);
            let mut pass = self.sun.begin_pass(encoder, &shadow, 0, times);
            for region in shadow.regions() {
                region.set(&mut pass);
                self.draw(&mut pass, region.casters);
            }
            drop(pass);
            if let Some(timer) = timer {
                timer.end(query, encoder);
            }
        }
    }

    /// Records the depth pass of the camera, and the visible demand for the next frames.
    pub(crate) fn seen_pass(&mut self, encoder: &mut wgpu::CommandEncoder, camera: &PerspectiveCamera) -> Result<()> {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(attachment::depth(&self.depth)),
            ..Default::default()
        });
        pass.set_pipeline(&self.seen_pipeline);
        pass.set_bind_group(0, &self.camera_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.offsets.slice(..));
        self.draw_shown(&mut pass, self.shown.iter().copied());
        drop(pass);
        let convention = DepthConvention::Reversed;
        self.sun.record_demand(encoder, &self.depth, camera.clip_from_world(convention), convention)?;
        Ok(())
    }

    /// Draws casters by their numbers.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, casters: &[u32]) {
        pass.set_pipeline(&self.caster_pipeline);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.offsets.slice(..));
        self.draw_shown(pass, casters.iter().map(|number| self.shown[*number as usize]));
    }

    fn draw_shown(&self, pass: &mut wgpu::RenderPass<'_>, numbers: impl Iterator<Item = u32>) {
        for number in numbers {
            let vertices: Range<u32> = self.scene.casters[number as usize].vertices.clone();
            pass.draw(vertices, number..number + 1);
        }
    }

    /// Returns the maps of this frame, for drawing into other layers.
    pub(crate) fn maps(&self) -> (Vec<FittedMap>, MapView) {
        let maps: Vec<FittedMap> = self.sun.fitted().to_vec();
        let origin = maps.first().map_or(glam::DVec3::ZERO, |map| map.projection.origin);
        (maps, MapView::from_eye(origin, Vec3::NEG_Z))
    }
}

/// Creates the texture of a picture.
pub(crate) fn target(device: &wgpu::Device, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::TextureView {
    let usage =
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
    bindings::plain_texture(device, "picture", size, format, usage).create_view(&Default::default())
}

fn caster_pipeline(maker: &Maker<'_>, map: &ShadowMap) -> wgpu::RenderPipeline {
    let color = [map.color_target()];
    let has_color = color[0].is_some();
    let source = caster_wgsl(map.descriptor(), &WgslOptions::group(0)) + CASTER + if has_color { COLOR } else { "" };
    let (layout, module) = (maker.layout(&[map.caster_layout()]), maker.module("casters", source));
    maker.pipeline(&Shape {
        entries: ("vs", has_color.then_some("fs")),
        buffers: &BUFFERS,
        targets: &color[..usize::from(has_color)],
        primitive: map.primitive_state(),
        depth: Some(map.depth_stencil_state()),
        ..Shape::new("casters", &layout, &module, ["vs", "fs"])
    })
}

fn seen_pipeline(maker: &Maker<'_>, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let (layout, module) = (maker.layout(&[layout]), maker.module("seen", SEEN.to_owned()));
    maker.pipeline(&Shape {
        entries: ("vs", None),
        buffers: &BUFFERS,
        targets: &[],
        depth: depth(true, wgpu::CompareFunction::GreaterEqual),
        ..Shape::new("seen", &layout, &module, ["vs", ""])
    })
}

/// Positions, and the offset of a caster.
const BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    Some(vec3s(wgpu::VertexStepMode::Vertex, &wgpu::vertex_attr_array![0 => Float32x3])),
    Some(vec3s(wgpu::VertexStepMode::Instance, &wgpu::vertex_attr_array![1 => Float32x3])),
];

const fn vec3s(
    step_mode: wgpu::VertexStepMode,
    attributes: &'static [wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout { array_stride: 12, step_mode, attributes }
}
