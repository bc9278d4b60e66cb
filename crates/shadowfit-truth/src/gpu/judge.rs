//! The pass that judges a picture in three steps and sums it in a fourth, and the texture that it fills.

use shadowfit_rays::make_at_once;

use super::error::GpuTruthError;
use super::input::GpuJudgeInput;
use super::pipeline::{STORAGE, TEXTURE, UNIFORM, group, group_layout, pipeline};
use super::pixel::GpuPixel;
use super::shader;
use super::tally::GpuTally;
use super::tally_pass::{TallyInput, TallyPass};
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
/// A texture's rows begin at multiples of this in a buffer, in bytes; wgpu requires it.
const ROW_ALIGNMENT: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

/// The texture of classes, to be written.
const CLASSES: wgpu::BindingType = wgpu::BindingType::StorageTexture {
    access: wgpu::StorageTextureAccess::WriteOnly,
    format: wgpu::TextureFormat::R32Uint,
    view_dimension: wgpu::TextureViewDimension::D2,
};

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
        let layout = group_layout(device, "judged picture", [UNIFORM, TEXTURE, STORAGE, CLASSES]);
        let (scene, slots) = (shadowfit_rays::rays_layout(device), slots_layout(device));
        let passes = [("trace", shader::truth()), ("rows", shader::rows()), ("classify", shader::classes())];
        let layouts = [Some(&scene), Some(&layout), Some(&slots)];
        let make = |(entry, wgsl): &(&str, String)| pipeline(device, &layouts, (entry, wgsl.clone()));
        let pipelines = make_at_once(device, &passes, make);
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("judge"),
            size: size_of::<JudgeUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
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
        let [here, before] = [seen, seen_before].map(|view| [view.texture().width(), view.texture().height()]);
        if here != size {
            return Err(GpuTruthError::Size { seen: here, camera: size });
        }
        if before != size {
            return Err(GpuTruthError::BeforeSize { before, camera: size });
        }
        let uniform = input.uniform(tracer.origin(), tracer.triangles())?;
        let target = match self.target.take() {
            Some(target) if target.size == size => target,
            _ => Target::new(device, size)?,
        };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let resources = [
            self.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(seen),
            target.pixels.as_entire_binding(),
            wgpu::BindingResource::TextureView(&target.view),
        ];
        let group = group(device, "judged picture", &self.layout, resources);
        let squares = size.map(|side| side.div_ceil(SQUARE));
        self.pictures += 1;
        let is_summed = self.tally.has_room();
        self.tally.clear(encoder);
        let timestamp_writes = input.timestamp_writes.clone();
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("judge"), timestamp_writes });
        let [scene, slots] = tracer.groups();
        for (number, group) in (0..).zip([scene, &group, slots]) {
            pass.set_bind_group(number, group, &[]);
        }
        for (pipeline, [x, y]) in self.pipelines.iter().zip([squares, [size[1], 1], squares]) {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups(x, y, 1);
        }
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
        let [width, height] = target.size;
        let row = (width * 4).next_multiple_of(ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("classes"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            target.classes.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            target.classes.size(),
        );
        queue.submit([encoder.finish()]);
        // Whether it was mapped is checked below.
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|_| GpuTruthError::Read)?;
        let mapped = buffer.slice(..).get_mapped_range().map_err(|_| GpuTruthError::Read)?;
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&mapped);
        let rows = words.chunks_exact(row as usize / 4);
        Ok(rows.flat_map(|row| &row[..width as usize]).map(|bits| GpuPixel::from_bits(*bits)).collect())
    }
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
        let classes = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("classes"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R32Uint,
            usage: wgpu::TextureUsages::STORAGE_BINDING
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = classes.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { size, pixels, classes, view })
    }
}
