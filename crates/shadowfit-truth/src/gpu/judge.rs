//! The compute pass that judges a picture in three steps and sums it in a fourth, and its output texture.

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

/// Bytes per pixel of the buffer between the steps: flags, pixels per texel, distance along the row, cosine.
const PIXEL_BYTES: u64 = 16;
/// Storage buffers that the pass binds: five for the rays, one for the triangles' slots, one for the pixels.
const STORAGE_BUFFERS: u32 = 7;
/// Threads in the largest workgroup.
const WORKGROUP_THREADS: u32 = 256;
/// Side of the square that a workgroup handles, in pixels.
const SQUARE: u32 = 8;
/// Binding of the texture of classes, write-only.
const CLASSES: wgpu::BindingType = written_texture(wgpu::TextureFormat::R32Uint);

/// Judges pictures on the GPU.
#[derive(Debug)]
pub struct GpuJudge {
    layout: wgpu::BindGroupLayout,
    /// Pipelines of the three steps, in order.
    pipelines: Vec<wgpu::ComputePipeline>,
    uniform: wgpu::Buffer,
    target: Option<Target>,
    tally: TallyPass,
    /// Number of pictures recorded so far.
    pictures: u64,
}

/// The buffer and the texture whose size is the picture's.
#[derive(Debug)]
struct Target {
    size: [u32; 2],
    pixels: wgpu::Buffer,
    classes: wgpu::Texture,
    view: wgpu::TextureView,
}

impl GpuJudge {
    /// Returns whether a device with these limits has enough storage buffers and threads to judge pictures.
    pub const fn runs_with(limits: &wgpu::Limits) -> bool {
        limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS
            && limits.max_compute_invocations_per_workgroup >= WORKGROUP_THREADS
    }

    /// Creates the pipelines. The device must have the limits of [`Self::runs_with`].
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

    /// Records the pass that judges a picture, and returns its output texture (see [`GpuPixel`]). The texture
    /// is reused until the size changes.
    ///
    /// `seen` is an `Rg32Uint` texture of the camera's size. Its channels are the index of the tracer's
    /// triangle plus 1 (0 for the sky), and the bits of the filtered factor, an f32.
    ///
    /// The sums of the picture are recorded as well, for [`Self::take`]. If the sums of three earlier
    /// pictures are still on their way back, this picture is judged but not summed.
    ///
    /// Submit the encoder before you record the next picture, which overwrites this one.
    ///
    /// # Errors
    ///
    /// If the size of `seen` or [`GpuBefore::seen`](super::GpuBefore::seen) differs from the camera's, the
    /// picture is too large for the device, there are more than [`MAX_MAPS`](super::MAX_MAPS) maps, or the
    /// light is not a sun with hard shadows.
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

    /// Records the three steps that judge a picture.
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

    /// Returns the number of pictures recorded so far, which is also the number of the last one.
    pub fn pictures(&self) -> u64 {
        self.pictures
    }

    /// Returns the sums of the newest picture that the GPU has finished, once. Returns `None` if there are
    /// none. Never waits: called each frame, it returns the sums of a picture from a few frames ago, named by
    /// [`GpuTally::picture`].
    ///
    /// # Errors
    ///
    /// [`GpuTruthError::Read`] if the device is lost or out of memory.
    pub fn take(&mut self, device: &wgpu::Device) -> Result<Option<GpuTally>, GpuTruthError> {
        self.tally.take(device)
    }

    /// Returns the texture of the last picture's classes; `None` before the first picture.
    pub fn classes(&self) -> Option<&wgpu::Texture> {
        self.target.as_ref().map(|target| &target.classes)
    }

    /// Reads the last picture's classes back, rows from the top. Waits for the device.
    ///
    /// # Errors
    ///
    /// If no picture was judged yet, or the device is lost or out of memory.
    pub fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<GpuPixel>, GpuTruthError> {
        let target = self.target.as_ref().ok_or(GpuTruthError::NotJudged)?;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let copy = TexelCopy::record(device, &mut encoder, &target.classes, target.classes.size(), 4);
        queue.submit([encoder.finish()]);
        // A failed mapping is reported by `texels` below.
        copy.buffer().slice(..).map_async(wgpu::MapMode::Read, |_| ());
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| GpuTruthError::Read)?;
        let words = bytemuck::pod_collect_to_vec(&copy.texels().map_err(|_| GpuTruthError::Read)?);
        Ok(words.into_iter().map(GpuPixel::from_bits).collect())
    }
}

/// Returns an error if a texture's size differs from the camera's.
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
