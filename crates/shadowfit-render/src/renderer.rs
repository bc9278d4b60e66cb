//! One frame: shadow passes, shaded pass, and the elements over the picture.

mod edges;
mod known;
mod maps;
mod over;
mod picture;
mod pixel;
mod plan;

use shadowfit::Technique;
use shadowfit_wgpu::{MAX_MAPS, ShadowMap, ShadowMapDescriptor, ShadowMapError, SunShadows, SunShadowsDescriptor};

use crate::frame::Frame;
use crate::judged::JudgedInput;
use crate::maker::Maker;
use crate::marks::MarkPasses;
use crate::pipelines::{Drawn, Layouts, MapPipelines, Pipelines};
use crate::probe::{Probe, ProbeError, ProbeTargets};
use crate::scene::GpuScene;
use crate::statistics::{MapStatistics, Statistics};
use crate::target::RenderTarget;
use crate::timer::{PassTimer, PassTimes};
use crate::uniform::{FrameUniform, InsetVertex, LineVertex, QuadVertex};
use crate::vertex_buffer::VertexBuffer;
use crate::{Gpu, Inset, Line, Quad, bindings};

use edges::{Edges, Extent};
use known::KnownMaps;
use plan::Plan;

/// Draws scenes with the shadows of a sun, and owns every pipeline.
#[derive(Debug)]
pub struct Renderer {
    layouts: Layouts,
    pipelines: Pipelines,
    sun: SunShadows,
    samples: u32,
    frame_uniform: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    /// Bind group of the frame with the factors of its picture.
    lit_group: wgpu::BindGroup,
    /// The factors in that bind group.
    bound_factors: wgpu::TextureView,
    edges: Edges,
    judged: JudgedInput,
    lines: VertexBuffer,
    insets: VertexBuffer,
    quads: VertexBuffer,
    /// Created for the first marks.
    marks: Option<MarkPasses>,
    /// Target for resolving parts of multisampled pictures.
    part: Option<wgpu::Texture>,
    /// Targets for probing single pixels.
    pixel_targets: Option<ProbeTargets>,
    /// Statistics of the maps drawn since the last picture.
    drawn: [MapStatistics; MAX_MAPS],
    /// Content of the maps, if known.
    known: Option<KnownMaps>,
    timer: PassTimer,
}

/// Returns the descriptor of a sun whose maps may have another size and format than its technique's.
fn sun_descriptor(technique: Technique, maps: &ShadowMapDescriptor) -> SunShadowsDescriptor {
    SunShadowsDescriptor { technique, first_binding: maps.first_binding, texture: None, maps: Some(*maps) }
}

impl Renderer {
    /// Creates a renderer for pictures of `samples` per pixel (1 or 4). Its maps are not cached at first, so
    /// that pictures do not depend on earlier ones.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the shadow map cannot be created.
    pub fn new(gpu: &Gpu, shadow_map: &ShadowMapDescriptor, samples: u32) -> Result<Self, ShadowMapError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let mut sun = SunShadows::new(device, &gpu.queue, &sun_descriptor(Technique::default(), shadow_map))?;
        sun.set_caching(false);
        let pipelines = Pipelines::new(device, &layouts, sun.map(), samples);
        let frame_uniform = bindings::uniform_buffer::<FrameUniform>(device, "frame");
        let edges = Edges::new(gpu)?;
        let resources = [frame_uniform.as_entire_binding()];
        let frame_group = bindings::group(device, "frame", &layouts.uniform, &resources);
        let lit_group = lit_group(device, &layouts, &frame_uniform, edges.factors());
        Ok(Self {
            layouts,
            pipelines,
            sun,
            samples,
            frame_uniform,
            frame_group,
            lit_group,
            bound_factors: edges.factors().clone(),
            edges,
            judged: JudgedInput::new(device),
            lines: VertexBuffer::new(device, "lines"),
            insets: VertexBuffer::new(device, "insets"),
            quads: VertexBuffer::new(device, "quads"),
            marks: None,
            part: None,
            pixel_targets: None,
            drawn: Default::default(),
            known: None,
            timer: PassTimer::new(device),
        })
    }

    /// Returns the layout of the scene's materials, for [`GpuScene::new`].
    pub fn material_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layouts.material
    }

    /// Returns the current shadow map.
    pub fn shadow_map(&self) -> &ShadowMap {
        self.sun.map()
    }

    /// Returns the sun's shadows: the fitted maps, and the parts of them that were drawn in the last frame
    /// whose maps did not [stay](Frame::maps_stay).
    pub fn sun(&self) -> &SunShadows {
        &self.sun
    }

    /// Returns the sun's shadows, to fit them and to set how they are drawn. Use [`Self::set_shadow_map`] to
    /// set another shadow map, because pipelines depend on it.
    pub fn sun_mut(&mut self) -> &mut SunShadows {
        &mut self.sun
    }

    /// Rebuilds the shadow map if its descriptor differs. On an error the old one stays.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the new one cannot be created.
    pub fn set_shadow_map(&mut self, gpu: &Gpu, descriptor: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        let old = *self.shadow_map().descriptor();
        if !self.sun.set_descriptor(&sun_descriptor(*self.sun.technique(), descriptor))? {
            return Ok(());
        }
        // Values that shaders read from uniforms may differ. The greatest radius of a filter is a constant in
        // the shaders.
        let ShadowMapDescriptor { resolution, fade, softness, edges, .. } = *descriptor;
        let softness = softness.with_ceiling(old.softness.ceiling);
        let same_shaders = ShadowMapDescriptor { resolution, fade, softness, edges, ..old } == *descriptor;
        if !same_shaders {
            let maker = Maker { device: &gpu.device, samples: self.samples };
            self.pipelines.of_map = MapPipelines::new(&maker, &self.layouts, self.sun.map());
        }
        Ok(())
    }

    /// Returns the times of the passes, a few frames late.
    pub fn pass_times(&self) -> PassTimes {
        self.timer.times
    }

    /// Creates a target of the given width and height, in pixels, for this renderer.
    pub fn target(&self, gpu: &Gpu, size: [u32; 2]) -> RenderTarget {
        RenderTarget::new(&gpu.device, size, self.samples)
    }

    /// Draws a frame into a target and submits it. If the maps [stay](Frame::maps_stay), the statistics
    /// contain the map draws since the last picture, for example for a probe of the same frame.
    ///
    /// # Errors
    ///
    /// As for [`ShadowMap::prepare`], if a map does not match this renderer's shadow map. Nothing is drawn
    /// then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        target: &RenderTarget,
    ) -> Result<Statistics, ShadowMapError> {
        let frame = &self.with_known_maps(scene, frame);
        self.timer.begin_picture(gpu, frame.maps_stay);
        let plan = self.prepare(gpu, scene, frame, Drawn::Shaded(frame.overlay), target.size)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.shadow_passes(&mut encoder, scene, &plan);
        self.trace_edges(gpu, &mut encoder, scene, frame, &plan, Extent { size: target.size, samples: self.samples });
        self.scene_pass(gpu, &mut encoder, scene, &plan, target);
        self.over_pass(gpu, &mut encoder, frame, &plan, target);
        if let (Some(encoding), Some(encoded)) = (&self.pipelines.encoding, &target.encoded) {
            encoding.record(&gpu.device, &mut encoder, &target.color_view, encoded);
        }
        self.timer.resolve(&mut encoder);
        gpu.submit([encoder.finish()]);
        self.timer.end_frame(gpu);
        Ok(plan.statistics(core::mem::take(&mut self.drawn)))
    }

    /// Draws a frame's probe and reads it back.
    ///
    /// # Errors
    ///
    /// [`ProbeError`] if a map does not match the shadow map or the device was lost.
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

    /// Draws a frame's probe, to be read on the GPU. A picture of the same frame may follow, with maps that
    /// [stay](Frame::maps_stay).
    ///
    /// # Errors
    ///
    /// As for [`Self::probe`].
    pub fn draw_probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        targets: &ProbeTargets,
    ) -> Result<(), ProbeError> {
        // A probe shows no overlay.
        let frame = Frame { overlay: crate::Overlay::None, ..self.with_known_maps(scene, frame) };
        let plan = self.prepare(gpu, scene, &frame, Drawn::Probe, targets.size)?;
        self.timer.begin_probe(gpu, frame.maps_stay);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.shadow_passes(&mut encoder, scene, &plan);
        self.trace_edges(gpu, &mut encoder, scene, &frame, &plan, Extent { size: targets.size, samples: 1 });
        self.probe_pass(&mut encoder, scene, &plan, targets, true);
        self.timer.resolve(&mut encoder);
        gpu.submit([encoder.finish()]);
        Ok(())
    }

    /// Culls the scene, and writes every buffer of the frame.
    fn prepare(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        drawn: Drawn,
        size: [u32; 2],
    ) -> Result<Plan, ShadowMapError> {
        let eye = frame.camera.eye;
        if !frame.maps_stay {
            self.known = None;
        }
        self.prepare_maps(gpu, scene, frame)?;
        self.prepare_parts(gpu, scene, drawn);
        let uniform = FrameUniform::new(frame.camera, -frame.direction, frame.shadows, frame.atmosphere, size);
        gpu.queue.write_buffer(&self.frame_uniform, 0, bytemuck::bytes_of(&uniform));
        let lines: Vec<[LineVertex; 2]> = frame.lines.iter().map(|line: &Line| line.vertices(eye)).collect();
        self.lines.write(gpu, &lines);
        // Without maps there is nothing to show.
        let insets = if self.sun.maps().is_empty() { &[] } else { frame.insets };
        self.insets.write(gpu, &insets.iter().map(Inset::vertex).collect::<Vec<InsetVertex>>());
        self.quads.write(gpu, &frame.quads.iter().map(Quad::vertex).collect::<Vec<QuadVertex>>());
        Ok(self.plan(gpu, scene, frame, &uniform, size))
    }
}

fn lit_group(
    device: &wgpu::Device,
    layouts: &Layouts,
    uniform: &wgpu::Buffer,
    factors: &wgpu::TextureView,
) -> wgpu::BindGroup {
    let resources = [uniform.as_entire_binding(), wgpu::BindingResource::TextureView(factors)];
    bindings::group(device, "frame", &layouts.frame, &resources)
}
