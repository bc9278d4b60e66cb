//! Marks of wrong pixels over any view. The first pass finds the nearest wrong pixel in each row. The second
//! pass uses these to draw the pixels within a short distance of a wrong pixel.

use crate::formats::COLOR_FORMAT;
use crate::gpu::is_opengl;
use crate::judged::{DEPTHS, JudgedInput};
use crate::maker::{Maker, Shape};
use crate::target::RenderTarget;
use crate::uniform::MarksUniform;
use crate::{Gpu, bindings, shaders};

/// Style of the marks on wrong pixels of a [`JudgedPicture`](crate::JudgedPicture), in the [colours of their
/// classes](shadowfit_params::figures::ERROR_COLORS).
///
/// If the frame has the judged camera, its pixels equal those of the judged picture. Otherwise each pixel is
/// looked up by its depth, so that marks stick to the surfaces. In a [part](crate::Frame::scissor) of a
/// picture, pixels beyond its border show the earlier content. On OpenGL multisampled depths cannot be read,
/// so only pictures of one sample have marks while the camera differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marks {
    /// Whether areas of wrong pixels are outlined at a distance of three pixels, so that a single one has a
    /// ring around it. Otherwise they are filled, with a margin of one pixel.
    pub outline: bool,
    /// Opacity, 0..=1. Changes from frame to frame make marks blink.
    pub strength: f32,
    /// Marked classes: false shadow, false light, hole, edge.
    pub classes: [bool; 4],
}

impl Default for Marks {
    /// Returns outlines for all classes.
    fn default() -> Self {
        Self { outline: true, strength: 1.0, classes: [true; 4] }
    }
}

/// Nearest wrong pixel per row: bits 0 to 3 its distance, 4 to 7 its class; 0 for none.
const ROWS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Uint;

/// Pipelines and buffers of the two passes.
#[derive(Debug)]
pub(crate) struct MarkPasses {
    rows_layout: wgpu::BindGroupLayout,
    marks_layout: wgpu::BindGroupLayout,
    rows: wgpu::RenderPipeline,
    marks: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    nearest: Option<([u32; 2], wgpu::TextureView)>,
}

/// The second pass, ready to be drawn over the picture.
#[derive(Debug)]
pub(crate) struct PreparedMarks {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl MarkPasses {
    /// Creates the passes for targets of `samples` per pixel.
    pub(crate) fn new(device: &wgpu::Device, judged: &JudgedInput, samples: u32) -> Self {
        let layout = |sampled, multisampled| {
            let types = [bindings::UNIFORM, bindings::texture(sampled, multisampled)];
            bindings::layout(device, "marks", wgpu::ShaderStages::FRAGMENT, &types)
        };
        let is_multisampled = samples > 1 && !is_opengl(device);
        let depths = if is_multisampled { wgpu::TextureSampleType::Depth } else { DEPTHS };
        let rows_layout = layout(depths, is_multisampled);
        let marks_layout = layout(wgpu::TextureSampleType::Uint, false);
        let maker = Maker { device, samples: 1 };
        let rows_groups = maker.layout(&[&judged.layout, &rows_layout]);
        let rows_module = maker.module("mark rows", shaders::mark_rows(if is_multisampled { samples } else { 1 }));
        let rows = maker.pipeline(&Shape {
            targets: &[Some(ROWS_FORMAT.into())],
            ..Shape::new("mark rows", &rows_groups, &rows_module, ["vs_screen", "fs_mark_rows"])
        });
        let (marks_groups, marks_module) = (maker.layout(&[&marks_layout]), maker.module("marks", shaders::marks()));
        let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let marks = maker.pipeline(&Shape {
            targets: &[Some(wgpu::ColorTargetState { blend, ..COLOR_FORMAT.into() })],
            ..Shape::new("marks", &marks_groups, &marks_module, ["vs_screen", "fs_marks"])
        });
        let uniform = bindings::uniform_buffer::<MarksUniform>(device, "marks");
        Self { rows_layout, marks_layout, rows, marks, uniform, nearest: None }
    }

    /// Records the first pass, once the scene is drawn. `judged` is the frame's bind group, `no_depth` the
    /// depth of a picture without surfaces.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        marks: &Marks,
        judged: &wgpu::BindGroup,
        no_depth: &wgpu::TextureView,
        target: &RenderTarget,
    ) -> PreparedMarks {
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&MarksUniform::new(marks)));
        let nearest = self.nearest(gpu, target.size);
        let group = |layout, view| {
            let resources = [self.uniform.as_entire_binding(), wgpu::BindingResource::TextureView(view)];
            bindings::group(&gpu.device, "marks", layout, &resources)
        };
        let rows = group(&self.rows_layout, target.readable_depth().unwrap_or(no_depth));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("mark rows"),
            color_attachments: &[Some(crate::attachment::cleared(&nearest, None, wgpu::Color::TRANSPARENT))],
            ..Default::default()
        });
        pass.set_pipeline(&self.rows);
        pass.set_bind_group(0, judged, &[]);
        pass.set_bind_group(1, &rows, &[]);
        pass.draw(0..3, 0..1);
        PreparedMarks { pipeline: self.marks.clone(), group: group(&self.marks_layout, &nearest) }
    }

    /// Returns the texture between the passes, of the target's size.
    fn nearest(&mut self, gpu: &Gpu, size: [u32; 2]) -> wgpu::TextureView {
        let kept = self.nearest.take().filter(|(of, _)| *of == size);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        let make = || bindings::plain_texture(&gpu.device, "mark rows", size, ROWS_FORMAT, usage);
        let view = kept.map_or_else(|| make().create_view(&Default::default()), |(_, view)| view);
        self.nearest = Some((size, view.clone()));
        view
    }
}

impl PreparedMarks {
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl MarksUniform {
    /// Creates the uniform of marks.
    pub fn new(marks: &Marks) -> Self {
        let bit = |class: usize| if marks.classes[class] { 1 << (class + FIRST_WRONG) } else { 0 };
        Self {
            strength: marks.strength.clamp(0.0, 1.0),
            outline: marks.outline.into(),
            classes: (0..4).map(bit).sum(),
            padding: 0,
        }
    }
}

/// Number of the first class of wrong pixels, false shadow.
const FIRST_WRONG: usize = 2;
