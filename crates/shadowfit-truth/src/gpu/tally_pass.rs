//! The pass that sums a judged picture, and the read-back of the sums.

use shadowfit_gpu::bindings::{UNIFORM, group, layout, storage, texture};
use shadowfit_gpu::{ReadBackRing, compute_pipeline, wgsl_module};

use super::error::GpuTruthError;
use super::shader;
use super::tally::GpuTally;
use super::uniform::TallyRecord;

/// Binding of a texture of unsigned integers.
pub(super) const TEXTURE: wgpu::BindingType = texture(wgpu::TextureSampleType::Uint, false);
/// Number of buffers that take turns: one in use by the GPU, one waiting in the queue, and one being read by
/// the CPU.
const BUFFERS: usize = 3;
/// Side of the square that a workgroup sums, in pixels.
const SQUARE: u32 = 32;

/// Sums pictures on the GPU.
#[derive(Debug)]
pub(super) struct TallyPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    sums: wgpu::Buffer,
    /// Read-backs, each with the number of its picture.
    read_backs: ReadBackRing<u64>,
}

/// Input of the sums.
pub(super) struct TallyInput<'a> {
    pub(super) size: [u32; 2],
    pub(super) uniform: &'a wgpu::Buffer,
    pub(super) seen: &'a wgpu::TextureView,
    pub(super) pixels: &'a wgpu::Buffer,
    pub(super) classes: &'a wgpu::TextureView,
    /// Any texture of the picture's size if no previous frame is compared.
    pub(super) seen_before: &'a wgpu::TextureView,
}

impl TallyPass {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let bindings = [UNIFORM, TEXTURE, storage(false), TEXTURE, storage(false), TEXTURE];
        let layout = layout(device, "summed picture", wgpu::ShaderStages::COMPUTE, &bindings);
        let module = wgsl_module(device, "sum", shader::tally());
        let pipeline = compute_pipeline(device, "sum", &[None, Some(&layout)], &module, "sum");
        let sums = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("tally"),
            size: size_of::<TallyRecord>() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let read_backs = ReadBackRing::new(device, "tally read-back", sums.size(), BUFFERS);
        Self { layout, pipeline, sums, read_backs }
    }

    /// Returns whether a buffer is free for the sums of another picture.
    pub(super) fn has_room(&mut self) -> bool {
        self.read_backs.free_overtaken();
        self.read_backs.free().is_some()
    }

    /// Clears the sums. Call it before the pass.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.sums, 0, None);
    }

    /// Sums a picture in a pass.
    pub(super) fn sum(&self, device: &wgpu::Device, pass: &mut wgpu::ComputePass<'_>, input: &TallyInput<'_>) {
        let resources = [
            input.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(input.seen),
            input.pixels.as_entire_binding(),
            wgpu::BindingResource::TextureView(input.classes),
            self.sums.as_entire_binding(),
            wgpu::BindingResource::TextureView(input.seen_before),
        ];
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &group(device, "summed picture", &self.layout, &resources), &[]);
        let [x, y] = input.size.map(|side| side.div_ceil(SQUARE));
        pass.dispatch_workgroups(x, y, 1);
    }

    /// Records the read-back of a picture's sums. Call it after the pass.
    pub(super) fn read_back(&mut self, encoder: &mut wgpu::CommandEncoder, picture: u64) {
        self.read_backs.record(encoder, &self.sums, picture);
    }

    /// Returns the sums of the newest finished picture, once.
    pub(super) fn take(&mut self, device: &wgpu::Device) -> Result<Option<GpuTally>, GpuTruthError> {
        // Does not wait. The buffers show whether a read-back has finished.
        let _ = device.poll(wgpu::PollType::Poll);
        let taken = self.read_backs.take(bytemuck::pod_read_unaligned).map_err(|_| GpuTruthError::Read)?;
        Ok(taken.map(|(picture, record)| GpuTally::new(picture, &record)))
    }
}
