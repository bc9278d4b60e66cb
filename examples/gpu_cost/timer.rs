//! Times of the passes of a frame, waited for.

use anyhow::{Context, Result};
use shadowfit_render::{Gpu, GpuTimer};

/// Times frames, one after the other.
pub(crate) struct Timer(GpuTimer);

impl Timer {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        Self(GpuTimer::new(&gpu.device, 1))
    }

    /// Records and submits a frame; the time from the start of its first timed pass to the end of the last one, in
    /// milliseconds. 0 if none was timed.
    pub(crate) fn frame(
        &mut self,
        gpu: &Gpu,
        record: impl FnOnce(&mut wgpu::CommandEncoder, &GpuTimer) -> Result<()>,
    ) -> Result<f64> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(&mut encoder, &self.0)?;
        self.0.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        self.0.end_frame(gpu);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        self.0.take_ms(gpu).context("the times of the frame did not come back")
    }
}

/// The middle one of some times.
pub(crate) fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}
