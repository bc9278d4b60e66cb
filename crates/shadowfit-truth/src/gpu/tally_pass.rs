//! The sums of a judged picture, and their way back to the CPU.

use super::error::GpuTruthError;
use super::pipeline::{STORAGE, TEXTURE, UNIFORM, group, group_layout, pipeline};
use super::read_back::ReadBacks;
use super::shader;
use super::tally::GpuTally;
use super::uniform::TallyRecord;

/// Pixels a side of a workgroup's square.
const SQUARE: u32 = 32;

/// Sums pictures on the GPU.
#[derive(Debug)]
pub(super) struct TallyPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    sums: wgpu::Buffer,
    read_backs: ReadBacks,
}

/// What is read for the sums.
pub(super) struct TallyInput<'a> {
    pub(super) size: [u32; 2],
    pub(super) uniform: &'a wgpu::Buffer,
    pub(super) seen: &'a wgpu::TextureView,
    pub(super) pixels: &'a wgpu::Buffer,
    pub(super) classes: &'a wgpu::TextureView,
    /// Any texture of the size where no frame before is compared.
    pub(super) seen_before: &'a wgpu::TextureView,
}

impl TallyPass {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        let bindings = [UNIFORM, TEXTURE, STORAGE, TEXTURE, STORAGE, TEXTURE];
        let layout = group_layout(device, "summed picture", bindings);
        let pipeline = pipeline(device, &[None, Some(&layout)], ("sum", shader::tally()));
        let sums = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("tally"),
            size: size_of::<TallyRecord>() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Self { layout, pipeline, sums, read_backs: ReadBacks::new(device) }
    }

    /// Whether a buffer is free for the sums of a further picture.
    pub(super) fn has_room(&mut self) -> bool {
        self.read_backs.free().is_some()
    }

    /// Sets the sums to zero, before the pass.
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
        pass.set_bind_group(1, &group(device, "summed picture", &self.layout, resources), &[]);
        let [x, y] = input.size.map(|side| side.div_ceil(SQUARE));
        pass.dispatch_workgroups(x, y, 1);
    }

    /// Records the way back of the sums of a picture, after the pass.
    pub(super) fn read_back(&mut self, encoder: &mut wgpu::CommandEncoder, picture: u64) {
        if let Some(read_back) = self.read_backs.free() {
            read_back.record(encoder, &self.sums, picture);
        }
    }

    /// The newest finished picture's sums, once.
    pub(super) fn take(&mut self, device: &wgpu::Device) -> Result<Option<GpuTally>, GpuTruthError> {
        // Only looks; whether anything is finished shows in the buffers.
        let _ = device.poll(wgpu::PollType::Poll);
        Ok(self.read_backs.take()?.map(|(picture, record)| GpuTally::new(picture, &record)))
    }
}
