//! Times of passes by the GPU's clock.

use anyhow::Result;
use shadowfit_render::Gpu;

/// Passes of a frame that can be timed.
const MAX_PASSES: u32 = 64;

/// Timestamps of the passes of a frame.
pub(crate) struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
}

/// Timestamps of a frame that is being recorded.
pub(crate) struct Recording<'a> {
    queries: &'a wgpu::QuerySet,
    passes: u32,
}

impl Recording<'_> {
    /// The next two timestamps; `None` once there are no more.
    fn next(&mut self) -> Option<(&wgpu::QuerySet, u32)> {
        let first = 2 * self.passes;
        self.passes += 1;
        (self.passes <= MAX_PASSES).then_some((self.queries, first))
    }

    /// Those of a render pass.
    pub(crate) fn pass(&mut self) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let (query_set, first) = self.next()?;
        Some(wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Those of a compute pass.
    pub(crate) fn compute(&mut self) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let (query_set, first) = self.next()?;
        Some(wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }
}

impl Timer {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let count = 2 * MAX_PASSES;
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::from(count) * 8,
                usage,
                mapped_at_creation: false,
            })
        };
        Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            read: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
        }
    }

    /// Records and submits a frame; the time from the begin of its first timed pass to the end of the last one, in
    /// milliseconds. 0 where none was timed.
    pub(crate) fn frame(
        &self,
        gpu: &Gpu,
        record: impl FnOnce(&mut wgpu::CommandEncoder, &mut Recording<'_>) -> Result<()>,
    ) -> Result<f64> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut recording = Recording { queries: &self.queries, passes: 0 };
        record(&mut encoder, &mut recording)?;
        let count = 2 * recording.passes.min(MAX_PASSES);
        if count > 0 {
            encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, None);
            encoder.map_buffer_on_submit(&self.read, wgpu::MapMode::Read, .., |_| {});
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        if count == 0 {
            return Ok(0.0);
        }
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&self.read.get_mapped_range(..)?);
        self.read.unmap();
        let ticks = &ticks[..count as usize];
        let first = ticks.iter().step_by(2).min().copied().unwrap_or(0);
        let last = ticks.iter().skip(1).step_by(2).max().copied().unwrap_or(first);
        Ok(f64::from(gpu.queue.get_timestamp_period()) * last.saturating_sub(first) as f64 * 1e-6)
    }
}

/// The middle one of some times.
pub(crate) fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}
