//! The pass that judges a picture in three steps and sums it in a fourth, and the texture that it fills.

use shadowfit_gpu::bindings::{UNIFORM, group, layout, plain_texture, storage, uniform_buffer, written_texture};
use shadowfit_gpu::{TexelCopy, compute_pipeline, make_at_once, wgsl_module};

use super::error::GpuTruthError;
use super::input::GpuJudgeInput;
use super::pixel::GpuPixel;
use super::shader;
use super::tally::GpuTally;
use super::tally_pass::{TEXTURE, TallyInput, TallyPass};
use super::tracer::{GpuTracer, slots_layout};
use super::uniform::JudgeUniform;

/// Bytes of a pixel between the steps: flags, pixels per texel, distance along the row.
const PIXEL_BYTES: u64 = 12;
/// Storage buffers that a pass binds: five of the rays, the slots of the triangles, and the pixels.
const STORAGE_BUFFERS: u32 = 7;
/// Threads of the largest workgroup.
const WORKGROUP_THREADS: u32 = 256;
/// Pixels a side of a workgroup's square.
const SQUARE: u32 = 8;
/// The texture of classes, to be written.
const CLASSES: wgpu::BindingType = written_texture(wgpu::TextureFormat::R32Uint);

/// Judges pictures on the GPU.
#[derive(Debug)]
pub struct GpuJudge {
    layout: wgpu::BindGroupLayout,
    /// Of the three steps, in their order.
    pipelines: Vec<wgpu::ComputePipeline>,
    uniform: wgpu::Buffer,
    target: Option<Target>,
    tally: TallyPass,
    /// Number of pictures that were recorded.
    pictures: u64,
}

/// The buffer and the texture that have the size of the picture.
#[derive(Debug)]
struct Target {
    size: [u32; 2],
    pixels: wgpu::Buffer,
    classes: wgpu::Texture,
    view: wgpu::TextureView,
}

impl GpuJudge {
    /// Whether a device with these limits has enough storage buffers and threads to judge pictures.
    pub const fn runs_with(limits: &wgpu::Limits) -> bool {
        limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS
            && limits.max_compute_invocations_per_workgroup >= WORKGROUP_THREADS
    }

    /// Makes the pipelines. The device must have the limits of [`Self::runs_with`].
    pub fn new(device: &wgpu::Device) -> Self {
        let types = [UNIFORM, TEXTURE, storage(false), CLASSES];
        let layout = layout(device, "judged picture", wgpu::ShaderStages::COMPUTE, &types);
        let (scene, slots) = (shadowfit_rays::rays_layout(device), slots_layout(device));
        let passes = [("trace", shader::truth()), ("rows", shader::rows()), ("classify", shader::classes())];
        let layouts = [Some(&scene), Some(&layout), Some(&slots)];
        let make = |(entry, wgsl): &(&str, String)| {
            compute_pipeline(device, entry, &layouts, &wgsl_module(device, entry, wgsl.clone()), entry)
        };
        let pipelines = make_at_once(device, &passes, make);
        let uniform = uniform_buffer::<JudgeUniform>(device, "judge");
        Self { layout, pipelines, uniform, target: None, tally: TallyPass::new(device), pictures: 0 }
    }

    /// Records the pass that judges a picture, and returns the texture that it fills (see
    /// [`GpuPixel`]). The texture stays the same one as long as the size does. `seen` is an `Rg32Uint`
    /// of the camera's size: the index of the tracer's triangle plus 1 (0 for the sky), and the bits
    /// of the filtered factor, an f32.
    ///
    /// The sums of the picture are recorded as well, for [`Self::take`]. A picture that is recorded while the sums of
    /// three others are on their way is judged and not summed.
    ///
    /// Submit the encoder before the next picture is recorded, which overwrites this one.
    ///
    /// # Errors
    ///
    /// When the sizes of `seen` or [`GpuBefore::seen`](super::GpuBefore::seen) and the camera differ, the picture is
    /// too large for the device, there are more than [`MAX_MAPS`](super::MAX_MAPS) maps, or the light is not a sun with hard shadows.
    pub fn judge(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        tracer: &GpuTracer,
        seen: &wgpu::TextureView,
        input: &GpuJudgeInput,
    ) -> Result<&wgpu::Texture, GpuTruthError> {
        let size = input.camera.size;
        let seen_before = input.before.map_or(seen, |before| before.seen);
        check_sizes(seen, seen_before, size)?;
        let uniform = input.uniform(tracer.origin(), tracer.triangles())?;
        let target = match self.target.take() {
            Some(target) if target.size == size => target,
            _ => Target::new(device, size)?,
        };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let group = self.bind(device, seen, &target);
        self.pictures += 1;
        let is_summed = self.tally.has_room();
        self.tally.clear(encoder);
        let timestamp_writes = input.timestamp_writes.clone();
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("judge"), timestamp_writes });
        self.record_steps(&mut pass, tracer, &group, size);
        let (uniform, target) = (&self.uniform, &*self.target.insert(target));
        let (pixels, classes) = (&target.pixels, &target.view);
        if is_summed {
            let summed = TallyInput { size, uniform, seen, pixels, classes, seen_before };
            self.tally.sum(device, &mut pass, &summed);
        }
        drop(pass);
        if is_summed {
            self.tally.read_back(encoder, self.pictures);
        }
        Ok(&target.classes)
    }

    fn bind(&self, device: &wgpu::Device, seen: &wgpu::TextureView, target: &Target) -> wgpu::BindGroup {
        let resources = [
            self.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(seen),
            target.pixels.as_entire_binding(),
            wgpu::BindingResource::TextureView(&target.view),
        ];
        group(device, "judged picture", &self.layout, &resources)
    }

    /// Records the three steps that judge a picture of a size.
    fn record_steps(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        tracer: &GpuTracer,
        picture: &wgpu::BindGroup,
        size: [u32; 2],
    ) {
        let [scene, slots] = tracer.groups();
        for (number, group) in (0..).zip([scene, picture, slots]) {
            pass.set_bind_group(number, group, &[]);
        }
        let squares = size.map(|side| side.div_ceil(SQUARE));
        for (pipeline, [x, y]) in self.pipelines.iter().zip([squares, [size[1], 1], squares]) {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    /// Number of pictures that were recorded, which is also the number of the last one.
    pub fn pictures(&self) -> u64 {
        self.pictures
    }

    /// The sums of the newest picture that the GPU has finished, once; `None` while there is none. Never waits: called
    /// each frame, it gives the sums of a picture a few frames back, which [`GpuTally::picture`] names.
    ///
    /// # Errors
    ///
    /// [`GpuTruthError::Read`] if the device is lost or has no memory left.
    pub fn take(&mut self, device: &wgpu::Device) -> Result<Option<GpuTally>, GpuTruthError> {
        self.tally.take(device)
    }

    /// The texture of the last picture's classes; `None` before the first picture.
    pub fn classes(&self) -> Option<&wgpu::Texture> {
        self.target.as_ref().map(|target| &target.classes)
    }

    /// Reads the last picture's classes back, rows from the top, and waits for the device.
    ///
    /// # Errors
    ///
    /// When no picture was judged yet, or the device is lost or has no memory left.
    pub fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<GpuPixel>, GpuTruthError> {
        let target = self.target.as_ref().ok_or(GpuTruthError::NotJudged)?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let copy = TexelCopy::record(device, &mut encoder, &target.classes, target.classes.size(), 4);
        queue.submit([encoder.finish()]);
        // Whether it was mapped is checked below.
        copy.buffer().slice(..).map_async(wgpu::MapMode::Read, |_| ());
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| GpuTruthError::Read)?;
        let words = bytemuck::pod_collect_to_vec(&copy.texels().map_err(|_| GpuTruthError::Read)?);
        Ok(words.into_iter().map(GpuPixel::from_bits).collect())
    }
}

/// Refuses pictures of another size than the camera's.
fn check_sizes(seen: &wgpu::TextureView, before: &wgpu::TextureView, camera: [u32; 2]) -> Result<(), GpuTruthError> {
    let [seen, before] = [seen, before].map(|view| [view.texture().width(), view.texture().height()]);
    if seen != camera {
        return Err(GpuTruthError::Size { seen, camera });
    }
    if before != camera {
        return Err(GpuTruthError::BeforeSize { before, camera });
    }
    Ok(())
}

impl Target {
    fn new(device: &wgpu::Device, size: [u32; 2]) -> Result<Self, GpuTruthError> {
        let [width, height] = size;
        let bytes = u64::from(width) * u64::from(height) * PIXEL_BYTES;
        let limits = device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if bytes > limit {
            return Err(GpuTruthError::TooLarge { what: "pixels", bytes, limit });
        }
        let pixels = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("judged pixels"),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let usage =
            wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let classes = plain_texture(device, "classes", size, wgpu::TextureFormat::R32Uint, usage);
        let view = classes.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { size, pixels, classes, view })
    }
}
