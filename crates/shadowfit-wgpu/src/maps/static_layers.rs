//! Separate layers for static casters. Passes restore parts of the shown layers from them.
//!
//! WebGPU copies depth textures only as a whole. Parts are therefore cleared and restored by drawing a
//! triangle within a scissor rectangle, or the outlines of boxes.

use shadowfit::cache::{FramePlan, Layer, PassPlan};
use shadowfit::scroll::TexelRect;
use shadowfit::{Aabb, DepthConvention};
use shadowfit_gpu::bindings::{group, layout, texture};
use shadowfit_gpu::{catch_errors, wgsl_module};

use crate::{ShadowMap, ShadowMapDescriptor, WgslOptions, caster_wgsl};

/// Pipelines and layers that clear and restore parts of depth maps.
#[derive(Debug)]
pub(crate) struct Layers {
    clear: wgpu::RenderPipeline,
    fixed: Option<StaticLayers>,
}

/// Layers that contain only static casters, one per map.
#[derive(Debug)]
struct StaticLayers {
    /// View and bind group of each layer, for drawing and reading.
    layers: Vec<(wgpu::TextureView, wgpu::BindGroup)>,
    mend: wgpu::RenderPipeline,
    mend_boxes: wgpu::RenderPipeline,
    boxes: wgpu::Buffer,
}

/// Arguments for opening a pass of the plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Opening<'a> {
    pub(crate) map: &'a ShadowMap,
    pub(crate) plan: &'a FramePlan,
    /// Index of the bind group that contains the map's matrix for the engine's casters.
    pub(crate) group: u32,
}

/// Vertices per box.
const BOX_VERTICES: u32 = 36;

/// Label of the static casters' resources, for graphics debuggers.
const LABEL: &str = "shadowfit static casters";

/// Bindings of the depths of static casters.
const READ: [wgpu::BindingType; 2] = [
    texture(wgpu::TextureSampleType::Float { filterable: false }, false),
    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
];

impl Layers {
    pub(crate) fn new(device: &wgpu::Device, map: &ShadowMap) -> Self {
        let [clear, _] = layers_wgsl(map.descriptor());
        let module = wgsl_module(device, "shadowfit layers", clear);
        Self { clear: pipeline(device, map, &Shape::new("shadowfit clear", &module, "vs_clear")), fixed: None }
    }

    /// Creates the layers of static casters, unless they exist.
    pub(crate) fn split(&mut self, device: &wgpu::Device, map: &ShadowMap) -> Result<(), wgpu::Error> {
        if self.fixed.is_none() {
            self.fixed = Some(catch_errors(device, || StaticLayers::new(device, map))?);
        }
        Ok(())
    }

    /// Uploads the boxes of a frame's passes.
    pub(crate) fn prepare(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, plan: &FramePlan) {
        let Some(fixed) = &mut self.fixed else { return };
        let boxes: &[Aabb] = &plan.boxes;
        if boxes.is_empty() {
            return;
        }
        if size_of_val(boxes) as u64 > fixed.boxes.size() {
            fixed.boxes = box_buffer(device, boxes.len().next_power_of_two());
        }
        let floats: Vec<[f32; 6]> =
            boxes.iter().map(|b| [b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z]).collect();
        queue.write_buffer(&fixed.boxes, 0, bytemuck::cast_slice(&floats));
    }

    /// Opens a pass, then clears and restores its parts.
    pub(crate) fn begin<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        opening: Opening<'_>,
        pass: &PassPlan,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let Opening { map, plan, group } = opening;
        let fixed = self.fixed.as_ref().map(|fixed| &fixed.layers[pass.map]);
        if pass.layer == Layer::Shown && pass.clears {
            return map.begin_pass(encoder, pass.map, group, timestamps);
        }
        let view = match (pass.layer, fixed) {
            (Layer::Static, Some((view, _))) => view,
            _ => map.depth_attachment(pass.map),
        };
        let load = if pass.clears { wgpu::LoadOp::Clear(map.far_depth()) } else { wgpu::LoadOp::Load };
        let mut opened = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadowfit map"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: timestamps,
            ..Default::default()
        });
        if !pass.cleared.is_empty() {
            opened.set_pipeline(&self.clear);
            fill(&mut opened, &plan.rects[pass.cleared.clone()]);
        }
        if let Some(fixed) = &self.fixed {
            fixed.mend(&mut opened, map, plan, pass);
        }
        opened.set_bind_group(group, map.caster_group(pass.map), &[]);
        opened
    }
}

/// Draws a triangle over each rectangle.
fn fill(pass: &mut wgpu::RenderPass<'_>, rects: &[TexelRect]) {
    for rect in rects {
        pass.set_scissor_rect(rect.min.x, rect.min.y, rect.size.x, rect.size.y);
        pass.draw(0..3, 0..1);
    }
}

impl StaticLayers {
    fn new(device: &wgpu::Device, map: &ShadowMap) -> Self {
        let descriptor = map.descriptor();
        let format = map.depth_stencil_state().format;
        let layout = layout(device, LABEL, wgpu::ShaderStages::FRAGMENT, &READ);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor { label: Some(LABEL), ..Default::default() });
        // Each layer is a separate texture, because OpenGL's shaders can read only whole arrays.
        let layer = || {
            let view = super::shadow_map::texture(device, descriptor, format, 1).create_view(&Default::default());
            let resources = [wgpu::BindingResource::TextureView(&view), wgpu::BindingResource::Sampler(&sampler)];
            let group = group(device, LABEL, &layout, &resources);
            (view, group)
        };
        let [_, mend] = layers_wgsl(descriptor);
        let module = wgsl_module(device, "shadowfit layers", mend);
        let layouts = [&layout, map.caster_layout()];
        let mend =
            Shape { fragment: Some("fs_mend"), layouts: &layouts, ..Shape::new("shadowfit mend", &module, "vs_clear") };
        let boxes = Shape { entry: "vs_mend_box", is_boxes: true, ..mend };
        Self {
            layers: (0..descriptor.maps).map(|_| layer()).collect(),
            mend: pipeline(device, map, &mend),
            mend_boxes: pipeline(device, map, &boxes),
            boxes: box_buffer(device, 16),
        }
    }

    /// Restores rectangles and boxes of the shown layer from the static casters' layer.
    fn mend(&self, opened: &mut wgpu::RenderPass<'_>, map: &ShadowMap, plan: &FramePlan, pass: &PassPlan) {
        if pass.mended.is_empty() && pass.mended_boxes.is_empty() {
            return;
        }
        opened.set_bind_group(0, &self.layers[pass.map].1, &[]);
        opened.set_bind_group(1, map.caster_group(pass.map), &[]);
        if !pass.mended.is_empty() {
            opened.set_pipeline(&self.mend);
            fill(opened, &plan.rects[pass.mended.clone()]);
        }
        if !pass.mended_boxes.is_empty() {
            let [width, height] = map.descriptor().resolution;
            opened.set_scissor_rect(0, 0, width, height);
            opened.set_pipeline(&self.mend_boxes);
            opened.set_vertex_buffer(0, self.boxes.slice(..));
            let size = pass.size.as_vec2();
            for view in &plan.viewports[pass.viewports.clone()] {
                opened.set_viewport(view.x as f32, view.y as f32, size.x, size.y, 0.0, 1.0);
                opened.draw(0..BOX_VERTICES, pass.mended_boxes.start as u32..pass.mended_boxes.end as u32);
            }
        }
    }
}

/// Differences between the pipelines.
#[derive(Clone, Copy, Debug)]
struct Shape<'a> {
    label: &'a str,
    module: &'a wgpu::ShaderModule,
    entry: &'a str,
    fragment: Option<&'a str>,
    layouts: &'a [&'a wgpu::BindGroupLayout],
    is_boxes: bool,
}

impl<'a> Shape<'a> {
    fn new(label: &'a str, module: &'a wgpu::ShaderModule, entry: &'a str) -> Self {
        Self { label, module, entry, fragment: None, layouts: &[], is_boxes: false }
    }
}

/// Returns the WGSL that clears parts of depth maps, and the WGSL that restores parts from the static
/// casters' layers.
fn layers_wgsl(descriptor: &ShadowMapDescriptor) -> [String; 2] {
    let far = if descriptor.depth == DepthConvention::Reversed { "0.0" } else { "1.0" };
    let clear = include_str!("clear.wgsl").replace("FAR", far);
    let caster = caster_wgsl(descriptor, &WgslOptions::group(1));
    let mend = [&caster, &clear, include_str!("mend.wgsl")].concat();
    [clear, mend]
}

fn pipeline(device: &wgpu::Device, map: &ShadowMap, shape: &Shape<'_>) -> wgpu::RenderPipeline {
    let layouts: Vec<_> = shape.layouts.iter().map(|layout| Some(*layout)).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(shape.label),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let boxes = [Some(wgpu::VertexBufferLayout {
        array_stride: 24,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
    })];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(shape.label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: shape.module,
            entry_point: Some(shape.entry),
            compilation_options: Default::default(),
            buffers: if shape.is_boxes { &boxes } else { &[] },
        },
        // The front sides of a box cover its whole outline.
        primitive: wgpu::PrimitiveState { cull_mode: shape.is_boxes.then_some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            depth_compare: Some(wgpu::CompareFunction::Always),
            ..map.depth_stencil_state()
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: shape.fragment.map(|entry| wgpu::FragmentState {
            module: shape.module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn box_buffer(device: &wgpu::Device, boxes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shadowfit mended boxes"),
        size: (boxes * size_of::<[f32; 6]>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
