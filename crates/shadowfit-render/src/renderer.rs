//! One frame: shadow pass, shaded pass, sky, lines and inset.

use glam::{DVec3, Mat4};
use shadowfit::CasterVolume;
use shadowfit_wgpu::{MAX_MAPS, MapFit, MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError};

use crate::frame::{Culling, Frame, MapStatistics, Statistics};
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
    shadow_map: ShadowMap,
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
    shadow: Vec<Vec<Draw>>,
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
        let shadow_map = ShadowMap::new(device, shadow_map)?;
        let pipelines = Pipelines::new(device, &layouts, &shadow_map, samples);
        let (frame_uniform, frame_group) = uniform(device, &layouts.frame, size_of::<FrameUniform>());
        let (inset_uniform, inset_group) = uniform(device, &layouts.inset, size_of::<InsetUniform>());
        let line_buffer = line_buffer(device, 64);
        Ok(Self {
            layouts,
            pipelines,
            shadow_map,
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
        &self.shadow_map
    }

    /// Makes the shadow map anew if its descriptor differs. On an error the old one stays.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the new one cannot be made.
    pub fn set_shadow_map(&mut self, gpu: &Gpu, descriptor: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        let old = *self.shadow_map.descriptor();
        if old == *descriptor {
            return Ok(());
        }
        self.shadow_map = ShadowMap::new(&gpu.device, descriptor)?;
        // What the shaders read from uniforms may differ; the greatest radius of a filter is a constant in them.
        let ShadowMapDescriptor { resolution, fade, softness, .. } = *descriptor;
        let softness = softness.with_ceiling(old.softness.ceiling);
        let same_shaders = ShadowMapDescriptor { resolution, fade, softness, ..old } == *descriptor;
        if !same_shaders {
            self.pipelines = Pipelines::new(&gpu.device, &self.layouts, &self.shadow_map, self.samples);
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
        Ok(statistics(scene, &plan))
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
        let (eye, forward) = frame.choice.unwrap_or((origin, frame.camera.forward.normalize()));
        let view = MapView { origin, eye, forward, frame: 0 };
        self.shadow_map.prepare(&gpu.queue, &view, &self.culled(frame, &view))?;
        let uniform = FrameUniform::new(frame.camera, -frame.direction, frame.shadows, frame.atmosphere, size)
            .with_overlay(frame.overlay);
        gpu.queue.write_buffer(&self.frame_uniform, 0, bytemuck::bytes_of(&uniform));
        if let Some(inset) = frame.inset {
            let uniform =
                InsetUniform { rectangle: inset.rectangle, depth_range: inset.depth_range, map: inset.map, padding: 0 };
            gpu.queue.write_buffer(&self.inset_uniform, 0, bytemuck::bytes_of(&uniform));
        }
        self.write_lines(gpu, origin, frame.lines);
        Ok(plan(gpu, scene, frame, &uniform, self.shadow_map.volumes()))
    }

    /// The maps, each with the casters that the frame's culling keeps for it.
    fn culled(&self, frame: &Frame<'_>, view: &MapView) -> Vec<MapFit> {
        let mut maps = frame.maps.to_vec();
        if frame.culling == Culling::Swept {
            let descriptor = self.shadow_map.descriptor();
            let swept = frame.camera.frustum().and_then(|seen| MapFit::sweep(&mut maps, view, &[seen], descriptor));
            if swept.is_err() {
                // What an invalid camera sees is unknown: maps get all casters that they can store.
                for map in &mut maps {
                    map.volume = None;
                }
            }
        }
        maps
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
        for (map, draws) in plan.shadow.iter().enumerate() {
            let query = self.timer.begin(Pass::Shadow, encoder);
            let timestamps = query.as_ref().and_then(wgpu_profiler::GpuProfilerQuery::render_pass_timestamp_writes);
            let mut pass = self.shadow_map.begin_pass(encoder, map, CASTER_GROUP, timestamps);
            for draw in draws {
                let part = &scene.parts[draw.part];
                pass.set_pipeline(self.pipelines.caster(part));
                draw_part(&mut pass, scene, draw, 1);
            }
            drop(pass);
            self.timer.end(query, encoder);
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
        pass.set_bind_group(1, self.shadow_map.receiver_group(), &[]);
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
        pass.set_bind_group(1, self.shadow_map.receiver_group(), &[]);
        pass.set_bind_group(2, &self.inset_group, &[]);
        pass.draw(0..4, 0..1);
    }
}

/// Decides what each pass draws and uploads the instances.
fn plan(gpu: &Gpu, scene: &mut GpuScene, frame: &Frame<'_>, uniform: &FrameUniform, volumes: &[CasterVolume]) -> Plan {
    scene.begin_frame(frame.camera.eye);
    let masks = scene.cull(volumes);
    let of_map = |map: usize| scene.visible(|instance, _| masks[instance] >> map & 1 == 1, Part::casts);
    let shadow = (0..volumes.len()).map(of_map).collect();
    let seen = in_frustum(Mat4::from_cols_array_2d(&uniform.clip_from_world));
    let mut opaque = scene.visible(|_, bounds| seen(bounds), Part::casts);
    // Near things first, so that what they hide is never shaded.
    opaque.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mut blended = scene.visible(|_, bounds| seen(bounds), |part| !part.casts());
    blended.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    scene.end_frame(gpu);
    Plan { shadow, opaque, blended }
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

fn statistics(scene: &GpuScene, plan: &Plan) -> Statistics {
    let casters = |draws: &[Draw]| {
        draws.iter().fold(MapStatistics::default(), |sum, draw| {
            let instances = draw.instances.len() as u32;
            let triangles = u64::from(scene.parts[draw.part].index_count / 3) * u64::from(instances);
            MapStatistics {
                casters: sum.casters + instances,
                draws: sum.draws + 1,
                triangles: sum.triangles + triangles,
            }
        })
    };
    let mut maps = [MapStatistics::default(); MAX_MAPS];
    for (map, draws) in maps.iter_mut().zip(&plan.shadow) {
        *map = casters(draws);
    }
    Statistics {
        shadow_draws: maps.iter().map(|map| map.draws).sum(),
        shadow_triangles: maps.iter().map(|map| map.triangles).sum(),
        scene_draws: (plan.opaque.len() + plan.blended.len()) as u32,
        scene_triangles: casters(&plan.opaque).triangles + casters(&plan.blended).triangles,
        maps,
    }
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
