//! Draws frames of the classic samples: map, picture, inset, and probes of what the shading knew.

use core::fmt;

use shadowfit::Aabb;

use super::map::SampleMap;
use super::pipelines::{Kind, Read, SamplePipelines};
use super::{CasterFaces, SampleFrame, SampleUniform, Shading, ShadowTest, TestKind};
use crate::attachment::{cleared, depth, drawn_over};
use crate::probe::{ProbeError, can_probe};
use crate::scene::{Draw, GpuScene, Part, in_frustum};
use crate::target::{ENCODED_FORMAT, read_texture};
use crate::{Gpu, Probe, ProbeTargets, ReadError, RenderTarget, bindings};

/// Bind groups of the map and of the material.
const MAP_GROUP: u32 = 1;
const MATERIAL_GROUP: u32 = 2;

/// Why a frame of a sample cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleError {
    /// The map is larger than the device allows, or has no texels.
    MapSize {
        /// Width and height that were asked for, in texels.
        size: [u32; 2],
        /// The most that the device allows, each way.
        limit: u32,
    },
    /// The test compares with a sampler, and the map is no depth texture.
    Format,
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MapSize { size: [width, height], limit } => {
                write!(f, "a map of {width} × {height} texels cannot be made: give 1 to {limit} texels each way")
            }
            Self::Format => write!(f, "this shadow test cannot read a map of this format; choose another one of them"),
        }
    }
}

impl core::error::Error for SampleError {}

/// Draws frames of samples; owns their map and every pipeline.
#[derive(Debug)]
pub struct SampleRenderer {
    pipelines: SamplePipelines,
    map: Option<SampleMap>,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

/// The draws of a frame.
struct Plan {
    casters: Vec<Draw>,
    seen: Vec<Draw>,
}

impl SampleRenderer {
    /// A renderer for pictures of `samples` per pixel (1 or 4).
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let pipelines = SamplePipelines::new(gpu, samples);
        let uniform = bindings::uniform_buffer::<SampleUniform>(&gpu.device, "sample");
        let group = bindings::group(&gpu.device, "sample", &pipelines.uniform, &[uniform.as_entire_binding()]);
        Self { pipelines, map: None, uniform, group }
    }

    /// Draws a frame into a target of as many samples as this renderer, and submits it.
    ///
    /// # Errors
    ///
    /// [`SampleError`] for a map that cannot be made, or a test that cannot read it. Nothing is drawn then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &SampleFrame<'_>,
        target: &RenderTarget,
    ) -> Result<(), SampleError> {
        let plan = self.prepare(gpu, scene, frame)?;
        if let Some(sky) = frame.sky {
            sky.prepare(gpu, &frame.camera);
        }
        let (read, shading) = (Read::of(frame), frame.shading.into());
        let kind = |part: &Part| Kind::Shaded { read, shading, faces: faces(frame, part), mirrored: part.mirrored };
        for draw in &plan.seen {
            self.pipelines.add(gpu, kind(&scene.parts[draw.part]));
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.map_pass(gpu, &mut encoder, scene, frame, &plan);
        let view = target.encoded_view();
        let several = target.multisampled.as_ref().map(|view| {
            let format = Some(ENCODED_FORMAT);
            view.texture().create_view(&wgpu::TextureViewDescriptor { format, ..Default::default() })
        });
        let [r, g, b] = frame.background.map(|value| f64::from(value) / 255.0);
        let background = wgpu::Color { r, g, b, a: 1.0 };
        let color = match &several {
            Some(several) => cleared(several, Some(&view), background),
            None => cleared(&view, None, background),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample"),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(depth(&target.depth_view)),
            ..Default::default()
        });
        self.draw_scene(&mut pass, scene, &plan.seen, kind);
        if let Some(sky) = frame.sky {
            sky.draw(&mut pass);
        }
        drop(pass);
        self.inset_pass(gpu, &mut encoder, frame, &view, target.size);
        gpu.submit([encoder.finish()]);
        Ok(())
    }

    /// Draws what the shading of a frame knew about each pixel, and reads it back.
    ///
    /// # Errors
    ///
    /// The outer one as [`Self::draw`]; the inner one where the device has no primitive index, or was lost.
    pub fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &SampleFrame<'_>,
        targets: &ProbeTargets,
    ) -> Result<Result<Probe, ProbeError>, SampleError> {
        if !can_probe(&gpu.device) {
            return Ok(Err(ProbeError::NoPrimitiveIndex));
        }
        let plan = self.prepare(gpu, scene, frame)?;
        let read = Read::of(frame);
        let kind = |part: &Part| Kind::Probe { read, faces: faces(frame, part), mirrored: part.mirrored };
        for draw in &plan.seen {
            self.pipelines.add(gpu, kind(&scene.parts[draw.part]));
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.map_pass(gpu, &mut encoder, scene, frame, &plan);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample's probe"),
            color_attachments: &[Some(cleared(&targets.view, None, wgpu::Color::TRANSPARENT))],
            depth_stencil_attachment: Some(depth(&targets.depth)),
            ..Default::default()
        });
        self.draw_scene(&mut pass, scene, &plan.seen, kind);
        drop(pass);
        gpu.submit([encoder.finish()]);
        Ok(targets.read(gpu).map_err(ProbeError::from))
    }

    /// The bytes of the map that was drawn last, rows from the top; `None` before the first frame.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    pub fn read_map(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>, ReadError> {
        let Some(map) = &self.map else { return Ok(None) };
        let bytes = map.settings.format.texture().block_copy_size(None).unwrap_or(4);
        read_texture(gpu, &map.texture, map.settings.size, bytes).map(Some)
    }

    /// Makes the map where it is another one, uploads what the frame's shaders read, and says what is drawn.
    fn prepare(&mut self, gpu: &Gpu, scene: &mut GpuScene, frame: &SampleFrame<'_>) -> Result<Plan, SampleError> {
        check(gpu, frame)?;
        let (settings, image) = (frame.map, frame.light.image);
        if self.map.as_ref().is_none_or(|map| !map.is_of(&settings, image)) {
            // The old one goes first: both may be large.
            self.map = None;
            self.map = Some(SampleMap::new(gpu, self.pipelines.map(settings.format), settings, image));
        }
        let uniform = SampleUniform::new(frame);
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        scene.begin_frame(frame.camera.eye);
        let casters = match frame.test {
            ShadowTest::Off if frame.inset.is_none() && frame.shading != Shading::Projective => Vec::new(),
            _ => scene.drawn_of(|node| frame.casts.is_none_or(|casts| casts.get(node) == Some(&true))),
        };
        let seen = in_frustum(glam::Mat4::from_cols_array_2d(&uniform.clip_from_world));
        let mut seen: Vec<Draw> = scene.visible(|bounds: &Aabb| seen(bounds), Part::casts);
        seen.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        scene.end_frame(gpu);
        Ok(Plan { casters, seen })
    }

    fn map_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &SampleFrame<'_>,
        plan: &Plan,
    ) {
        let super::SampleMapSettings { format, depth, faces, .. } = frame.map;
        let kind = |part: &Part| Kind::Caster { format, depth, faces, mirrored: part.mirrored };
        for draw in &plan.casters {
            self.pipelines.add(gpu, kind(&scene.parts[draw.part]));
        }
        let Some(map) = &self.map else { return };
        let mut pass = map.begin(encoder);
        pass.set_bind_group(0, &self.group, &[]);
        for draw in &plan.casters {
            pass.set_pipeline(self.pipelines.get(kind(&scene.parts[draw.part])));
            scene.draw(&mut pass, draw, None);
        }
    }

    fn draw_scene(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        draws: &[Draw],
        kind: impl Fn(&Part) -> Kind,
    ) {
        pass.set_bind_group(0, &self.group, &[]);
        let Some(map) = &self.map else { return };
        pass.set_bind_group(MAP_GROUP, &map.group, &[]);
        for draw in draws {
            pass.set_pipeline(self.pipelines.get(kind(&scene.parts[draw.part])));
            scene.draw(pass, draw, Some(MATERIAL_GROUP));
        }
    }

    fn inset_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        frame: &SampleFrame<'_>,
        view: &wgpu::TextureView,
        size: [u32; 2],
    ) {
        let Some(inset) = frame.inset else { return };
        let [x, y, width, height] = crate::attachment::part(inset, size);
        let kind = Kind::Inset { format: frame.map.format };
        self.pipelines.add(gpu, kind);
        let Some(map) = self.map.as_ref().filter(|_| width > 0 && height > 0) else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample's inset"),
            color_attachments: &[Some(drawn_over(view))],
            ..Default::default()
        });
        let [left, top, across, down] = [x, y, width, height].map(|side| side as f32);
        pass.set_viewport(left, top, across, down, 0.0, 1.0);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(self.pipelines.get(kind));
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_bind_group(MAP_GROUP, &map.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Faces of a part that the picture shows.
fn faces(frame: &SampleFrame<'_>, part: &Part) -> CasterFaces {
    if frame.double_sided || part.double_sided { CasterFaces::All } else { CasterFaces::Front }
}

fn check(gpu: &Gpu, frame: &SampleFrame<'_>) -> Result<(), SampleError> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if frame.map.size.iter().any(|side| !(1..=limit).contains(side)) {
        return Err(SampleError::MapSize { size: frame.map.size, limit });
    }
    if TestKind::from(frame.test).can_read(frame.map.format) { Ok(()) } else { Err(SampleError::Format) }
}
