//! Times of passes on the GPU, through the `wgpu-profiler` crate.

use std::fmt;

pub use wgpu_profiler::GpuProfilerQuery;
use wgpu_profiler::{GpuProfiler, GpuProfilerSettings, GpuTimerQueryResult};

use crate::Gpu;

/// Times passes by the GPU's clock, frame by frame. Does nothing on adapters without timestamps.
///
/// In each frame, call [`begin`](Self::begin) and [`end`](Self::end) around each pass,
/// [`resolve`](Self::resolve) before the encoder is submitted, and [`end_frame`](Self::end_frame) afterwards.
/// [`take`](Self::take) returns the times some frames later.
pub struct GpuTimer(Option<GpuProfiler>);

impl fmt::Debug for GpuTimer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("GpuTimer").finish_non_exhaustive()
    }
}

impl GpuTimer {
    /// Creates a timer. At most `pending` frames wait for the GPU; beyond that it forgets the oldest one.
    pub fn new(device: &wgpu::Device, pending: usize) -> Self {
        let has_timestamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let settings = GpuProfilerSettings { max_num_pending_frames: pending, ..GpuProfilerSettings::default() };
        Self(has_timestamps.then(|| GpuProfiler::new(device, settings).ok()).flatten())
    }

    /// Reserves the timestamps of a pass. Its descriptor takes them from the result.
    pub fn begin(&self, label: &str, encoder: &mut wgpu::CommandEncoder) -> Option<GpuProfilerQuery> {
        Some(self.0.as_ref()?.begin_pass_query(label, encoder))
    }

    /// Ends a query of [`Self::begin`], after the pass.
    pub fn end(&self, query: Option<GpuProfilerQuery>, encoder: &mut wgpu::CommandEncoder) {
        if let (Some(profiler), Some(query)) = (&self.0, query) {
            profiler.end_query(encoder, query);
        }
    }

    /// Records the read-back of the timestamps. Call it last before the encoder is submitted.
    pub fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(profiler) = &mut self.0 {
            profiler.resolve_queries(encoder);
        }
    }

    /// Ends a frame that was submitted.
    pub fn end_frame(&mut self, gpu: &Gpu) {
        let Some(profiler) = &mut self.0 else { return };
        // A lost device has no times. Reading the picture returns an error.
        let _unreported = gpu.without_reports();
        if profiler.end_frame().is_err() {
            // A query was left open, so later times would be wrong. Timing is disabled.
            self.0 = None;
        }
    }

    /// Returns the times of the oldest frame that the GPU has finished, once, in seconds on the GPU's clock.
    pub fn take(&mut self, gpu: &Gpu) -> Option<Vec<GpuTimerQueryResult>> {
        let profiler = self.0.as_mut()?;
        // The profiler expects its mapped buffers to stay mapped, but a lost device's buffers are destroyed.
        if gpu.lost().is_some() {
            return None;
        }
        profiler.process_finished_frame(gpu.queue.get_timestamp_period())
    }

    /// Returns the time like [`Self::take`], from the start of the frame's first pass to the end of its last
    /// one, in milliseconds. `Some(0)` for a frame without timed passes.
    pub fn take_ms(&mut self, gpu: &Gpu) -> Option<f64> {
        let results = self.take(gpu)?;
        let times = results.iter().filter_map(|result| result.time.as_ref());
        let whole = times.cloned().reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
        Some(whole.map_or(0.0, |time| (time.end - time.start) * 1e3))
    }
}
