//! Times of the passes on the GPU, a few frames late, through the `wgpu-profiler` crate.

use std::fmt;

use wgpu_profiler::{GpuProfiler, GpuProfilerQuery, GpuProfilerSettings};

use crate::Gpu;

/// A timed pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    Shadow,
    Scene,
}

/// Times of the last frame that the GPU has finished, in milliseconds; `None` where the adapter
/// has no timestamps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassTimes {
    /// All shadow passes together.
    pub shadow_ms: Option<f32>,
    /// The shaded pass.
    pub scene_ms: Option<f32>,
}

/// Times passes; does nothing on adapters without timestamps.
pub(crate) struct PassTimer {
    profiler: Option<GpuProfiler>,
    pub(crate) times: PassTimes,
}

impl fmt::Debug for PassTimer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PassTimer").field("times", &self.times).finish_non_exhaustive()
    }
}

impl Pass {
    const fn label(self) -> &'static str {
        match self {
            Self::Shadow => "shadow",
            Self::Scene => "scene",
        }
    }
}

impl PassTimer {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let has_timestamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let profiler = has_timestamps.then(|| GpuProfiler::new(device, GpuProfilerSettings::default()).ok()).flatten();
        Self { profiler, times: PassTimes::default() }
    }

    /// Reserves the timestamps of a pass.
    pub(crate) fn begin(&self, pass: Pass, encoder: &mut wgpu::CommandEncoder) -> Option<GpuProfilerQuery> {
        Some(self.profiler.as_ref()?.begin_pass_query(pass.label(), encoder))
    }

    /// Ends what [`Self::begin`] began.
    pub(crate) fn end(&self, query: Option<GpuProfilerQuery>, encoder: &mut wgpu::CommandEncoder) {
        if let (Some(profiler), Some(query)) = (&self.profiler, query) {
            profiler.end_query(encoder, query);
        }
    }

    /// Records the read-back of the frame's timestamps: the last thing before it is submitted.
    pub(crate) fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(profiler) = &mut self.profiler {
            profiler.resolve_queries(encoder);
        }
    }

    /// Closes a submitted frame and takes the times of those that are finished.
    pub(crate) fn end_frame(&mut self, gpu: &Gpu) {
        let Some(profiler) = &mut self.profiler else { return };
        // On a lost device there are no times; reading the picture returns an error.
        let _unreported = gpu.without_reports();
        if profiler.end_frame().is_err() {
            // A query was left open: times would be wrong from here on, so there are none.
            (self.profiler, self.times) = (None, PassTimes::default());
            return;
        }
        let period = gpu.queue.get_timestamp_period();
        while let Some(results) = profiler.process_finished_frame(period) {
            let milliseconds = |pass: Pass| {
                let ranges = results.iter().filter(|result| result.label == pass.label());
                let seconds: f64 = ranges.filter_map(|result| result.time.as_ref()).map(|t| t.end - t.start).sum();
                (seconds > 0.0).then_some((seconds * 1e3) as f32)
            };
            self.times = PassTimes { shadow_ms: milliseconds(Pass::Shadow), scene_ms: milliseconds(Pass::Scene) };
        }
    }
}
