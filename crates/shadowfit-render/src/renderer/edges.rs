//! Exact edges: the surfaces of a picture are drawn first, and rays are traced where texels are not in
//! agreement.

use shadowfit::DepthConvention;
use shadowfit_wgpu::exact_edges::{
    EdgeCounts, EdgeError, EdgeOutcome, EdgePass, EdgeView, FallbackReason, NormalEncoding,
};
use shadowfit_wgpu::{ShadowMapDescriptor, ShadowMapError};
use wgpu_profiler::GpuProfilerQuery;

use super::{Plan, Renderer, lit_group};
use crate::Gpu;
use crate::attachment::{cleared, depth};
use crate::formats::{DEPTH_FORMAT, NORMAL_FORMAT};
use crate::frame::Frame;
use crate::pipelines::Drawn;
use crate::renderer::picture::set_part;
use crate::scene::GpuScene;
use crate::timer::Pass;

/// The edge pass, and the surfaces that it reads.
#[derive(Debug)]
pub(super) struct Edges {
    pass: EdgePass,
    surfaces: Option<Surfaces>,
    counts: Option<EdgeCounts>,
    result: EdgeOutcome,
}

/// Pixels and samples of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    /// Width and height, in pixels.
    pub(super) size: [u32; 2],
    /// Samples per pixel.
    pub(super) samples: u32,
}

/// The textures of a picture's surfaces.
#[derive(Debug)]
struct Surfaces {
    extent: Extent,
    depth: wgpu::TextureView,
    normals: wgpu::TextureView,
    /// Multisampled normals, resolved into `normals`.
    multisampled: Option<wgpu::TextureView>,
}

impl Edges {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, ShadowMapError> {
        let pass = EdgePass::new(&gpu.device, &gpu.queue);
        let pass = pass.map_err(|error| ShadowMapError::Device(error.to_string()))?;
        Ok(Self { pass, surfaces: None, counts: None, result: EdgeOutcome::Filtered(FallbackReason::Picture) })
    }

    pub(super) fn factors(&self) -> &wgpu::TextureView {
        self.pass.factors()
    }
}

impl Surfaces {
    fn new(device: &wgpu::Device, extent: Extent) -> Self {
        let Extent { size, samples } = extent;
        let texture = |format, sample_count| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("surfaces"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self {
            extent,
            depth: texture(DEPTH_FORMAT, samples),
            normals: texture(NORMAL_FORMAT, 1),
            multisampled: (samples > 1).then(|| texture(NORMAL_FORMAT, samples)),
        }
    }
}

impl Renderer {
    /// Returns how the edges of the last picture or probe were drawn.
    pub fn edge_result(&self) -> EdgeOutcome {
        self.edges.result
    }

    /// Returns how many pixels of a recent picture or probe were traced, a frame or two late; `None` before
    /// the first one.
    pub fn edge_counts(&self) -> Option<EdgeCounts> {
        self.edges.counts
    }

    /// Returns the counts of the newest picture or probe that the GPU has finished, once.
    pub fn take_edge_counts(&mut self) -> Option<EdgeCounts> {
        let counts = self.edges.pass.take_counts();
        self.edges.counts = counts.or(self.edges.counts);
        counts
    }

    /// Traces the edges of a picture of the given size, if the shadow map requests it and the scene has
    /// [rays](GpuScene::make_rays).
    pub(super) fn trace_edges(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &Frame<'_>,
        plan: &Plan,
        extent: Extent,
    ) {
        let untraced = EdgeOutcome::Filtered(FallbackReason::Picture);
        self.edges.result = match self.reason_to_filter(scene, frame) {
            Some(why) => EdgeOutcome::Filtered(why),
            None => self.record_edge_pass(gpu, encoder, scene, frame, plan, extent).unwrap_or(untraced),
        };
        if self.edges.result != self.edges.pass.result() {
            self.edges.pass.skip();
        }
        let factors = frame.factors.unwrap_or_else(|| self.edges.factors());
        if self.bound_factors != *factors {
            self.bound_factors = factors.clone();
            self.lit_group = lit_group(&gpu.device, &self.layouts, &self.frame_uniform, &self.bound_factors);
        }
    }

    /// Returns the reason why a picture's edges are filtered, if they are.
    fn reason_to_filter(&self, scene: &GpuScene, frame: &Frame<'_>) -> Option<FallbackReason> {
        let descriptor: &ShadowMapDescriptor = self.sun.map().descriptor();
        if !descriptor.edges.are_traced() {
            Some(FallbackReason::Technique)
        } else if let Some(lack) = self.edges.pass.unsupported() {
            Some(FallbackReason::Device(lack))
        } else if scene.rays().is_none() {
            Some(FallbackReason::Rays)
        } else {
            (!frame.shadows || frame.factors.is_some()).then_some(FallbackReason::Picture)
        }
    }

    fn record_edge_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &Frame<'_>,
        plan: &Plan,
        extent: Extent,
    ) -> Result<EdgeOutcome, EdgeError> {
        self.prepare_parts(gpu, scene, Drawn::Surfaces(extent.samples));
        let kept = self.edges.surfaces.take().filter(|surfaces| surfaces.extent == extent);
        let surfaces = kept.unwrap_or_else(|| Surfaces::new(&gpu.device, extent));
        self.surfaces_pass(encoder, scene, plan, &surfaces);
        let camera = frame.camera;
        let clip_from_eye = camera.clip_from_world(DepthConvention::Reversed);
        let view = EdgeView::new(&surfaces.depth, clip_from_eye, DepthConvention::Reversed, camera.eye)
            .with_normals(&surfaces.normals, NormalEncoding::Signed);
        let view = EdgeView { ray_offset: frame.ray_offset, ..view };
        let query = self.timer.begin(Pass::Edges, encoder);
        let timestamps = query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes);
        let outcome = self.edges.pass.record_timed(encoder, &self.sun, scene.rays(), &view, timestamps);
        self.timer.end(query, encoder);
        self.edges.surfaces = Some(surfaces);
        outcome
    }

    /// Draws depths and normals.
    fn surfaces_pass(&self, encoder: &mut wgpu::CommandEncoder, scene: &GpuScene, plan: &Plan, surfaces: &Surfaces) {
        let color = match &surfaces.multisampled {
            Some(view) => cleared(view, Some(&surfaces.normals), wgpu::Color::TRANSPARENT),
            None => cleared(&surfaces.normals, None, wgpu::Color::TRANSPARENT),
        };
        let query = self.timer.begin(Pass::Surfaces, encoder);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(depth(&surfaces.depth)),
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        set_part(&mut pass, plan);
        self.draw_scene(&mut pass, scene, &plan.opaque, Drawn::Surfaces(surfaces.extent.samples));
        drop(pass);
        self.timer.end(query, encoder);
    }
}
