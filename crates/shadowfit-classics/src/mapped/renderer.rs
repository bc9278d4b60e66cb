//! Draws frames of the classic samples: map, picture, inset, and probes of the shading.

use core::fmt;

use shadowfit_render::attachment::{cleared, depth, drawn_over, part};
use shadowfit_render::passes::{Draw, PartKey};
use shadowfit_render::{
    Gpu, GpuScene, Probe, ProbeError, ProbeTargets, ReadError, RenderTarget, bindings, read_texture,
};

use super::map::SampleMap;
use super::pipelines::{SamplePipelines, Use};
use super::{CasterFaces, FrameExtras, MapRead, SampleFrame, SampleUniform};

/// Bind groups of the map and of the material.
const MAP_GROUP: u32 = 1;
const MATERIAL_GROUP: u32 = 2;

/// Error of drawing a sample's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleError {
    /// The map is larger than the device allows, or has no texels.
    MapSize {
        /// Requested width and height, in texels.
        size: [u32; 2],
        /// Greatest width and height that the device allows.
        limit: u32,
    },
    /// The test compares with a sampler, but the map is not a depth texture.
    Format,
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MapSize { size: [width, height], limit } => {
                write!(f, "a map of {width} × {height} texels cannot be created: use 1 to {limit} texels each way")
            }
            Self::Format => write!(f, "this shadow test cannot read a map of this format; choose another format"),
        }
    }
}

impl core::error::Error for SampleError {}

/// Draws frames of samples. Owns their map and every pipeline.
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
    /// Creates a renderer for pictures with `samples` samples per pixel (1 or 4).
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let pipelines = SamplePipelines::new(gpu, samples);
        let uniform = bindings::uniform_buffer::<SampleUniform>(&gpu.device, "sample");
        let group = bindings::group(&gpu.device, "sample", &pipelines.uniform, &[uniform.as_entire_binding()]);
        Self { pipelines, map: None, uniform, group }
    }

    /// Draws a frame into a target with this renderer's number of samples per pixel, and submits it.
    ///
    /// # Errors
    ///
    /// [`SampleError`] if the map cannot be created, or the test cannot read it. The frame is not drawn then.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &SampleFrame,
        extras: FrameExtras<'_>,
        target: &RenderTarget,
    ) -> Result<(), SampleError> {
        let plan = self.prepare(gpu, scene, frame, extras)?;
        let shaded = |key: PartKey| Use::Shaded(seen_faces(frame, key), key.streams);
        self.add(gpu, frame, &plan.seen, shaded);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.map_pass(gpu, &mut encoder, scene, frame, &plan.casters);
        let background = frame.background.map(|value| f64::from(value) / 255.0);
        let mut pass = target.begin_encoded(&mut encoder, "sample", background);
        self.draw_scene(&mut pass, scene, frame, &plan.seen, shaded);
        if let Some(behind) = extras.behind {
            behind(&mut pass);
        }
        drop(pass);
        if let Some(inset) = extras.inset {
            self.inset_pass(gpu, &mut encoder, frame, target, inset);
        }
        gpu.submit([encoder.finish()]);
        Ok(())
    }

    /// Draws the shading's data of each pixel of a frame, and reads it back.
    ///
    /// # Errors
    ///
    /// The outer error as [`Self::draw`]. The inner error if the device was lost.
    pub async fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &SampleFrame,
        extras: FrameExtras<'_>,
        targets: &ProbeTargets,
    ) -> Result<Result<Probe, ProbeError>, SampleError> {
        let plan = self.prepare(gpu, scene, frame, extras)?;
        let probed = |key: PartKey| Use::Probe(seen_faces(frame, key), key.streams);
        self.add(gpu, frame, &plan.seen, probed);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.map_pass(gpu, &mut encoder, scene, frame, &plan.casters);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample's probe"),
            color_attachments: &[Some(cleared(&targets.view, None, wgpu::Color::TRANSPARENT))],
            depth_stencil_attachment: Some(depth(targets.depth_view())),
            ..Default::default()
        });
        self.draw_scene(&mut pass, scene, frame, &plan.seen, probed);
        drop(pass);
        gpu.submit([encoder.finish()]);
        Ok(targets.arrive(gpu).await.map_err(ProbeError::from))
    }

    /// Returns the bytes of the map that was drawn last, rows from the top, or `None` before the first frame.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    pub fn read_map(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>, ReadError> {
        let Some(map) = &self.map else { return Ok(None) };
        let bytes = map.settings.format.texture().block_copy_size(None).unwrap_or(4);
        read_texture(gpu, &map.texture, map.settings.size, bytes).map(Some)
    }

    /// Rebuilds the map if its settings changed, uploads the uniform, and lists the draws.
    fn prepare(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &SampleFrame,
        extras: FrameExtras<'_>,
    ) -> Result<Plan, SampleError> {
        check(gpu, frame)?;
        let (settings, image) = (frame.map, frame.light.image);
        if self.map.as_ref().is_none_or(|map| !map.is_of(&settings, image)) {
            // Drops the old map first: both may be large.
            self.map = None;
            self.map = Some(SampleMap::new(gpu, self.pipelines.map(settings.format), settings, image));
        }
        let uniform = SampleUniform::new(frame);
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        scene.begin_frame(frame.camera.eye);
        let is_read = frame.test.reads != MapRead::Nothing || frame.shading.reads_map || extras.inset.is_some();
        let casters = if is_read {
            scene.drawn_of(|node| extras.casts.is_none_or(|casts| casts.get(node) == Some(&true)))
        } else {
            Vec::new()
        };
        let [seen, _] = scene.seen(glam::Mat4::from_cols_array_2d(&uniform.clip_from_world));
        scene.end_frame(gpu);
        Ok(Plan { casters, seen })
    }

    /// Creates the missing pipelines of draws.
    fn add(&mut self, gpu: &Gpu, frame: &SampleFrame, draws: &[Draw], purpose: impl Fn(PartKey) -> Use) {
        for draw in draws {
            self.pipelines.add(gpu, purpose(draw.key), frame);
        }
    }

    fn map_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &SampleFrame,
        casters: &[Draw],
    ) {
        let purpose = |key: PartKey| {
            let left_out = match frame.map.faces {
                CasterFaces::All => None,
                CasterFaces::Front => Some(key.back()),
                CasterFaces::Back => Some(key.front()),
            };
            Use::Caster(left_out, key.streams)
        };
        self.add(gpu, frame, casters, purpose);
        let Some(map) = &self.map else { return };
        let mut pass = map.begin(encoder);
        pass.set_bind_group(0, &self.group, &[]);
        for draw in casters {
            pass.set_pipeline(self.pipelines.get(purpose(draw.key), frame));
            scene.draw(&mut pass, draw, None);
        }
    }

    fn draw_scene(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        frame: &SampleFrame,
        draws: &[Draw],
        purpose: impl Fn(PartKey) -> Use,
    ) {
        pass.set_bind_group(0, &self.group, &[]);
        let Some(map) = &self.map else { return };
        pass.set_bind_group(MAP_GROUP, &map.group, &[]);
        for draw in draws {
            let purpose = purpose(draw.key);
            pass.set_pipeline(self.pipelines.get(purpose, frame));
            match purpose {
                Use::Probe(..) => scene.draw_probed(pass, draw, MATERIAL_GROUP),
                _ => scene.draw(pass, draw, Some(MATERIAL_GROUP)),
            }
        }
    }

    fn inset_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        frame: &SampleFrame,
        target: &RenderTarget,
        inset: [u32; 4],
    ) {
        let [x, y, width, height] = part(inset, target.size);
        self.pipelines.add(gpu, Use::Inset, frame);
        let Some(map) = self.map.as_ref().filter(|_| width > 0 && height > 0) else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample's inset"),
            color_attachments: &[Some(drawn_over(&target.encoded_view()))],
            ..Default::default()
        });
        let [left, top, across, down] = [x, y, width, height].map(|side| side as f32);
        pass.set_viewport(left, top, across, down, 0.0, 1.0);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(self.pipelines.get(Use::Inset, frame));
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_bind_group(MAP_GROUP, &map.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Returns the faces of a part that the picture culls.
fn seen_faces(frame: &SampleFrame, key: PartKey) -> Option<wgpu::Face> {
    if frame.double_sided { None } else { key.cull_mode() }
}

fn check(gpu: &Gpu, frame: &SampleFrame) -> Result<(), SampleError> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if frame.map.size.iter().any(|side| !(1..=limit).contains(side)) {
        return Err(SampleError::MapSize { size: frame.map.size, limit });
    }
    let is_readable = frame.test.reads != MapRead::Compared || frame.map.format.is_depth();
    if is_readable { Ok(()) } else { Err(SampleError::Format) }
}
