//! The pass that sums a judged picture, and the way of its sums back to the CPU.

use super::error::GpuTruthError;
use super::pipeline::{STORAGE, TEXTURE, UNIFORM, group, group_layout, pipeline};
use super::read_back::ReadBacks;
use super::shader;
use super::stopwatch::{Stopwatch, milliseconds};
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
    /// Nanoseconds of a tick.
    period: f32,
}

/// What the pass reads.
pub(super) struct TallyInput<'a> {
    /// Number of the picture.
    pub(super) picture: u64,
    pub(super) size: [u32; 2],
    pub(super) uniform: &'a wgpu::Buffer,
    pub(super) seen: &'a wgpu::TextureView,
    pub(super) pixels: &'a wgpu::Buffer,
    pub(super) classes: &'a wgpu::TextureView,
    /// Any texture of the size where no frame before is compared.
    pub(super) seen_before: &'a wgpu::TextureView,
    /// Times the passes up to this one.
    pub(super) stopwatch: Option<&'a Stopwatch>,
    /// Nanoseconds of its ticks.
    pub(super) period: f32,
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
        Self { layout, pipeline, sums, read_backs: ReadBacks::new(device), period: 1.0 }
    }

    /// Records the sums of a picture and their way back; nothing where all buffers are on their way.
    pub(super) fn record(&mut self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, input: &TallyInput<'_>) {
        let Some(read_back) = self.read_backs.free() else { return };
        let resources = [
            input.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(input.seen),
            input.pixels.as_entire_binding(),
            wgpu::BindingResource::TextureView(input.classes),
            self.sums.as_entire_binding(),
            wgpu::BindingResource::TextureView(input.seen_before),
        ];
        let group = group(device, "summed picture", &self.layout, resources);
        encoder.clear_buffer(&self.sums, 0, None);
        {
            let timestamp_writes = input.stopwatch.map(Stopwatch::end);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(1, &group, &[]);
            let [x, y] = input.size.map(|side| side.div_ceil(SQUARE));
            pass.dispatch_workgroups(x, y, 1);
        }
        let ticks = input.stopwatch.map(|stopwatch| stopwatch.ticks(encoder));
        read_back.record(encoder, (&self.sums, ticks), input.picture);
        self.period = input.period;
    }

    /// The newest finished picture's sums, once.
    pub(super) fn take(&mut self, device: &wgpu::Device) -> Result<Option<GpuTally>, GpuTruthError> {
        // Only looks; whether anything is finished shows in the buffers.
        let _ = device.poll(wgpu::PollType::Poll);
        let newest = self.read_backs.take()?;
        Ok(newest.map(|(picture, record, ticks)| GpuTally {
            milliseconds: milliseconds(ticks, self.period),
            ..GpuTally::new(picture, &record)
        }))
    }
}
