//! One frame: shadow pass, shaded pass, sky, lines and inset.

use glam::{DVec3, Mat4};
use shadowfit::ViewFrustum;
use shadowfit_wgpu::{
    Casters, Culling, KeptMaps, MAX_MAPS, ShadowMap, ShadowMapDescriptor, ShadowMapError, ShadowPiece, SunFrame,
};

use crate::casters::CasterDraw;
use crate::frame::{Frame, MapStatistics, Statistics};
use crate::pipelines::{Layouts, Pipelines};
use crate::probe::{Probe, ProbeError, ProbeTargets};
use crate::scene::{Draw, GpuScene, Part, in_frustum};
use crate::shaders::CASTER_GROUP;
use crate::target::RenderTarget;
use crate::timer::{Pass, PassTimer, PassTimes};
use crate::uniform::{FrameUniform, InsetUniform, LineVertex};
use crate::{Gpu, Line};

/// Draws scenes; owns the shadow map and every pipeline.
#[derive(Debug)]
pub struct Renderer {
    layouts: Layouts,
    pipelines: Pipelines,
    maps: KeptMaps,
    samples: u32,
    frame_uniform: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    inset_uniform: wgpu::Buffer,
    inset_group: wgpu::BindGroup,
    line_buffer: wgpu::Buffer,
    timer: PassTimer,
}

/// The draws of a frame's passes.
struct Plan {
    /// Of each piece of each shadow pass, in their order.
    shadow: Vec<Vec<CasterDraw>>,
    opaque: Vec<Draw>,
    blended: Vec<Draw>,
}

impl Renderer {
    /// A renderer for pictures of `samples` per pixel (1 or 4).
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the shadow map cannot be made.
    pub fn new(gpu: &Gpu, shadow_map: &ShadowMapDescriptor, samples: u32) -> Result<Self, ShadowMapError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let mut maps = KeptMaps::new(device, shadow_map)?;
        maps.keeps = false;
        let pipelines = Pipelines::new(device, &layouts, maps.map(), samples);
        let (frame_uniform, frame_group) = uniform(device, &layouts.frame, size_of::<FrameUniform>());
        let (inset_uniform, inset_group) = uniform(device, &layouts.inset, size_of::<InsetUniform>());
        let line_buffer = line_buffer(device, 64);
        Ok(Self {
            layouts,
            pipelines,
            maps,
            samples,
            frame_uniform,
            frame_group,
            inset_uniform,
            inset_group,
            line_buffer,
            timer: PassTimer::new(device),
        })
    }

    /// Layout of the scene's materials, for [`GpuScene::new`].
    pub fn material_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layouts.material
    }

    /// The current shadow map.
    pub fn shadow_map(&self) -> &ShadowMap {
        self.maps.map()
    }

    /// Whether static casters are kept in the maps from frame to frame; off at first, so that pictures do not depend on
    /// what was drawn before.
    pub fn set_keeps(&mut self, keeps: bool) {
        self.maps.keeps = keeps;
    }

    /// The maps, with what was drawn of them in the last frame.
    pub fn kept_maps(&self) -> &KeptMaps {
        &self.maps
    }

    /// Has all maps drawn anew in the next frame.
    pub fn invalidate_maps(&mut self) {
        self.maps.invalidate_all();
    }

    /// Makes the shadow map anew if its descriptor differs. On an error the old one stays.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the new one cannot be made.
    pub fn set_shadow_map(&mut self, gpu: &Gpu, descriptor: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        let old = *self.shadow_map().descriptor();
        if old == *descriptor {
            return Ok(());
        }
        let mut maps = KeptMaps::new(&gpu.device, descriptor)?;
        maps.keeps = self.maps.keeps;
        self.maps = maps;
        // What the shaders read from uniforms may differ; the greatest radius of a filter is a constant in them.
        let ShadowMapDescriptor { resolution, fade, softness, .. } = *descriptor;
        let softness = softness.with_ceiling(old.softness.ceiling);
        let same_shaders = ShadowMapDescriptor { resolution, fade, softness, ..old } == *descriptor;
        if !same_shaders {
            self.pipelines = Pipelines::new(&gpu.device, &self.layouts, self.maps.map(), self.samples);
        }
        Ok(())
    }

    /// Times of the passes, a few frames late.
    pub fn pass_times(&self) -> PassTimes {
        self.timer.times
    }

    /// A target of the given width and height, in pixels, that this renderer can draw into.
    pub fn target(&self, gpu: &Gpu, size: [u32; 2]) -> RenderTarget {
        RenderTarget::new(&gpu.device, size, self.samples)
    }

    /// Draws a frame into a target and submits it.
    ///
    /// # Errors
    ///
    /// Those of [`ShadowMap::prepare`], for maps that this renderer's shadow map cannot take; nothing is drawn then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        target: &RenderTarget,
    ) -> Result<Statistics, ShadowMapError> {
        let plan = self.prepare(gpu, scene, frame, target.size)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.shadow_passes(&mut encoder, scene, &plan);
        self.scene_pass(&mut encoder, scene, &plan, target, frame.lines.len() as u32);
        if frame.inset.is_some() && !frame.maps.is_empty() {
            self.inset_pass(&mut encoder, target);
        }
        self.timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        self.timer.end_frame(gpu);
        Ok(self.statistics(scene, &plan))
    }

    /// Draws a frame's shadow decisions and reads them back.
    ///
    /// # Errors
    ///
    /// [`ProbeError`] for maps that the shadow map cannot take, a device without the primitive index, and one that was
    /// lost.
    pub fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        targets: &ProbeTargets,
    ) -> Result<Probe, ProbeError> {
        self.draw_probe(gpu, scene, frame, targets)?;
        Ok(targets.read(gpu)?)
    }

    /// Draws a frame's shadow decisions, to be read on the GPU.
    ///
    /// # Errors
    ///
    /// As [`Self::probe`].
    pub fn draw_probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        targets: &ProbeTargets,
    ) -> Result<(), ProbeError> {
        if !self.pipelines.can_probe() {
            return Err(ProbeError::NoPrimitiveIndex);
        }
        let plan = self.prepare(gpu, scene, frame, targets.size)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.shadow_passes(&mut encoder, scene, &plan);
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("probe"),
                color_attachments: &[Some(color_attachment(&targets.view, None, wgpu::Color::TRANSPARENT))],
                depth_stencil_attachment: Some(depth_attachment(&targets.depth, wgpu::StoreOp::Discard)),
                ..Default::default()
            });
            self.draw_scene(&mut pass, scene, &plan.opaque, |part| self.pipelines.probe(part));
        }
        self.timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        self.timer.end_frame(gpu);
        Ok(())
    }

    /// Culls, and writes every buffer of the frame.
    fn prepare(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        size: [u32; 2],
    ) -> Result<Plan, ShadowMapError> {
        let origin = frame.camera.eye;
        self.update_maps(gpu, scene, frame)?;
        let uniform = FrameUniform::new(frame.camera, -frame.direction, frame.shadows, frame.atmosphere, size)
            .with_overlay(frame.overlay);
        gpu.queue.write_buffer(&self.frame_uniform, 0, bytemuck::bytes_of(&uniform));
        if let Some(inset) = frame.inset {
            let uniform =
                InsetUniform { rectangle: inset.rectangle, depth_range: inset.depth_range, map: inset.map, padding: 0 };
            gpu.queue.write_buffer(&self.inset_uniform, 0, bytemuck::bytes_of(&uniform));
        }
        self.write_lines(gpu, origin, frame.lines);
        Ok(self.plan(gpu, scene, frame, &uniform))
    }

    /// Finds what is to be drawn into the maps.
    fn update_maps(&mut self, gpu: &Gpu, scene: &GpuScene, frame: &Frame<'_>) -> Result<(), ShadowMapError> {
        let (eye, forward) = frame.choice.unwrap_or((frame.camera.eye, frame.camera.forward.normalize()));
        // What an invalid camera sees is unknown: maps get all casters that they can store.
        let seen: Option<ViewFrustum> = frame.camera.frustum().ok();
        self.maps.culling = if seen.is_some() { frame.culling } else { Culling::WholeMap };
        let casters: Casters<'_> = scene.casters();
        let sun = SunFrame {
            eye,
            forward,
            receivers: None,
            ..SunFrame::new(seen.as_slice(), frame.direction, casters.boxes, casters)
        };
        self.maps.update(&gpu.queue, &sun.with_origin(frame.camera.eye), frame.maps)
    }

    /// Decides what each pass draws and uploads the instances.
    fn plan(&self, gpu: &Gpu, scene: &mut GpuScene, frame: &Frame<'_>, uniform: &FrameUniform) -> Plan {
        scene.begin_frame(frame.camera.eye);
        let mut shadow = Vec::new();
        for piece in self.maps.passes().flat_map(|pass| pass.pieces()) {
            let mut draws = Vec::new();
            scene.caster_draws(piece.casters, &mut draws);
            shadow.push(draws);
        }
        let seen = in_frustum(Mat4::from_cols_array_2d(&uniform.clip_from_world));
        let mut opaque = scene.visible(|_, bounds| seen(bounds), Part::casts);
        // Near things first, so that what they hide is never shaded.
        opaque.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut blended = scene.visible(|_, bounds| seen(bounds), |part| !part.casts());
        blended.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        scene.end_frame(gpu);
        Plan { shadow, opaque, blended }
    }

    fn statistics(&self, scene: &GpuScene, plan: &Plan) -> Statistics {
        let mut maps = [MapStatistics::default(); MAX_MAPS];
        let pieces = self.maps.passes().flat_map(|pass| pass.pieces());
        for (piece, draws) in pieces.zip(&plan.shadow) {
            let map = &mut maps[piece.map];
            map.casters += piece.casters.len() as u32;
            map.draws += draws.len() as u32;
            map.triangles +=
                draws.iter().map(|draw| (draw.indices.len() / 3 * draw.instances.len()) as u64).sum::<u64>();
        }
        let triangles = |draws: &[Draw]| -> u64 {
            let of = |draw: &Draw| u64::from(scene.parts[draw.part].index_count / 3) * draw.instances.len() as u64;
            draws.iter().map(of).sum()
        };
        Statistics {
            shadow_draws: maps.iter().map(|map| map.draws).sum(),
            shadow_triangles: maps.iter().map(|map| map.triangles).sum(),
            scene_draws: (plan.opaque.len() + plan.blended.len()) as u32,
            scene_triangles: triangles(&plan.opaque) + triangles(&plan.blended),
            maps,
        }
    }

    fn write_lines(&mut self, gpu: &Gpu, eye: DVec3, lines: &[Line]) {
        let vertices: Vec<[LineVertex; 2]> = lines.iter().map(|line| line.vertices(eye)).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&vertices);
        if bytes.len() as u64 > self.line_buffer.size() {
            self.line_buffer = line_buffer(&gpu.device, lines.len().next_power_of_two());
        }
        gpu.queue.write_buffer(&self.line_buffer, 0, bytes);
    }

    fn shadow_passes(&self, encoder: &mut wgpu::CommandEncoder, scene: &GpuScene, plan: &Plan) {
        let mut pieces = plan.shadow.iter();
        for pass in self.maps.passes() {
            let query = self.timer.begin(Pass::Shadow, encoder);
            let timestamps = query.as_ref().and_then(wgpu_profiler::GpuProfilerQuery::render_pass_timestamp_writes);
            let mut opened = self.maps.begin_pass(encoder, &pass, CASTER_GROUP, timestamps);
            for (piece, draws) in pass.pieces().zip(&mut pieces) {
                self.draw_piece(&mut opened, scene, &piece, draws);
            }
            drop(opened);
            self.timer.end(query, encoder);
        }
    }

    fn draw_piece(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        piece: &ShadowPiece<'_>,
        draws: &[CasterDraw],
    ) {
        piece.set(pass);
        for draw in draws {
            let part = &scene.parts[draw.part];
            pass.set_pipeline(self.pipelines.caster(part));
            pass.set_bind_group(1, &scene.materials[part.material], &[]);
            pass.set_vertex_buffer(0, part.motion.slice(..));
            pass.set_vertex_buffer(1, part.surface.slice(..));
            pass.set_vertex_buffer(2, scene.instance_buffer.slice(..));
            pass.set_index_buffer(part.caster_indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(draw.indices.clone(), 0, draw.instances.start as u32..draw.instances.end as u32);
        }
    }

    fn scene_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        plan: &Plan,
        target: &RenderTarget,
        lines: u32,
    ) {
        let query = self.timer.begin(Pass::Scene, encoder);
        let color = match &target.multisampled {
            Some(view) => color_attachment(view, Some(&target.color_view), wgpu::Color::BLACK),
            None => color_attachment(&target.color_view, None, wgpu::Color::BLACK),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(depth_attachment(&target.depth_view, wgpu::StoreOp::Store)),
            timestamp_writes: query.as_ref().and_then(wgpu_profiler::GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        self.draw_scene(&mut pass, scene, &plan.opaque, |part| self.pipelines.scene(part));
        pass.set_pipeline(&self.pipelines.sky);
        pass.draw(0..3, 0..1);
        self.draw_scene(&mut pass, scene, &plan.blended, |part| self.pipelines.scene(part));
        if lines > 0 {
            pass.set_pipeline(&self.pipelines.lines);
            pass.set_vertex_buffer(0, self.line_buffer.slice(..));
            pass.draw(0..6, 0..lines);
        }
        drop(pass);
        self.timer.end(query, encoder);
    }

    fn draw_scene<'a>(
        &'a self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        draws: &[Draw],
        pipeline: impl Fn(&Part) -> &'a wgpu::RenderPipeline,
    ) {
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, self.shadow_map().receiver_group(), &[]);
        for draw in draws {
            pass.set_pipeline(pipeline(&scene.parts[draw.part]));
            draw_part(pass, scene, draw, 2);
        }
    }

    fn inset_pass(&self, encoder: &mut wgpu::CommandEncoder, target: &RenderTarget) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("inset"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &target.color_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipelines.inset);
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, self.shadow_map().receiver_group(), &[]);
        pass.set_bind_group(2, &self.inset_group, &[]);
        pass.draw(0..4, 0..1);
    }
}

fn draw_part(pass: &mut wgpu::RenderPass<'_>, scene: &GpuScene, draw: &Draw, material_group: u32) {
    let part = &scene.parts[draw.part];
    pass.set_bind_group(material_group, &scene.materials[part.material], &[]);
    pass.set_vertex_buffer(0, part.motion.slice(..));
    pass.set_vertex_buffer(1, part.surface.slice(..));
    pass.set_vertex_buffer(2, scene.instance_buffer.slice(..));
    pass.set_index_buffer(part.indices.slice(..), wgpu::IndexFormat::Uint32);
    pass.draw_indexed(0..part.index_count, 0, draw.instances.clone());
}

fn color_attachment<'a>(
    view: &'a wgpu::TextureView,
    resolve_target: Option<&'a wgpu::TextureView>,
    clear: wgpu::Color,
) -> wgpu::RenderPassColorAttachment<'a> {
    let store = if resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store },
    }
}

/// The camera's depth, reversed: cleared to the far value 0.
fn depth_attachment(view: &wgpu::TextureView, store: wgpu::StoreOp) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
        stencil_ops: None,
    }
}

fn uniform(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, size: usize) -> (wgpu::Buffer, wgpu::BindGroup) {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    });
    (buffer, group)
}

fn line_buffer(device: &wgpu::Device, lines: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("lines"),
        size: (lines * 2 * size_of::<LineVertex>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
