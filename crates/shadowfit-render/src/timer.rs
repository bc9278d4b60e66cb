//! Times of the passes on the GPU, a few frames late, through the `wgpu-profiler` crate.

use std::fmt;

use shadowfit_wgpu::MAX_MAPS;
use wgpu_profiler::{GpuProfiler, GpuProfilerQuery, GpuProfilerSettings, GpuTimerQueryResult};

use crate::Gpu;

/// A timed pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Into a map, by its number.
    Shadow(usize),
    Probe,
    Scene,
    /// The shaded pass of a further picture of maps that a frame before it drew.
    Again,
}

/// Times of the last frame that the GPU has finished, in milliseconds; `None` for passes that it had none of, and where the
/// adapter has no timestamps.
///
/// A frame ends with its picture. A probe that is drawn before it belongs to it where the maps
/// [stay](crate::Frame::maps_stay); of any other probe only its own pass is timed. Further pictures of the same maps are
/// not timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassTimes {
    /// All shadow passes together.
    pub shadow_ms: Option<f32>,
    /// The shadow passes of each map.
    pub maps_ms: [Option<f32>; MAX_MAPS],
    /// The probe pass.
    pub probe_ms: Option<f32>,
    /// The shaded pass.
    pub scene_ms: Option<f32>,
}

/// Times passes; does nothing on adapters without timestamps.
pub(crate) struct PassTimer {
    profiler: Option<GpuProfiler>,
    pub(crate) times: PassTimes,
    /// Whether the frame that is open has a probe, and whether maps were drawn for it.
    has_probe: bool,
    has_maps: bool,
}

impl fmt::Debug for PassTimer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PassTimer").field("times", &self.times).finish_non_exhaustive()
    }
}

/// Frames that wait for the GPU at most: each picture may have one or two probes that are frames of their own.
const PENDING: usize = 9;

/// Labels of the passes into the maps.
const SHADOW_LABELS: [&str; MAX_MAPS] =
    ["shadow 0", "shadow 1", "shadow 2", "shadow 3", "shadow 4", "shadow 5", "shadow 6", "shadow 7"];

impl Pass {
    fn label(self) -> &'static str {
        match self {
            Self::Shadow(map) => SHADOW_LABELS[map % MAX_MAPS],
            Self::Probe => "probe",
            Self::Scene => "scene",
            Self::Again => "scene again",
        }
    }
}

impl PassTimes {
    /// Times of a frame. What it lacks is left as it was where it has no picture, or only a further one of the same maps.
    fn of(results: &[GpuTimerQueryResult], before: Self) -> Self {
        let milliseconds = |pass: Pass| {
            let ranges = results.iter().filter(|result| result.label == pass.label());
            let seconds: f64 = ranges.filter_map(|result| result.time.as_ref()).map(|t| t.end - t.start).sum();
            (seconds > 0.0).then_some((seconds * 1e3) as f32)
        };
        let maps_ms = core::array::from_fn(|map| milliseconds(Pass::Shadow(map)));
        let times = Self {
            shadow_ms: maps_ms.into_iter().flatten().reduce(|sum, map| sum + map),
            maps_ms,
            probe_ms: milliseconds(Pass::Probe),
            scene_ms: milliseconds(Pass::Scene),
        };
        let is_whole = results.iter().any(|result| result.label == Pass::Scene.label());
        if is_whole { times } else { Self { probe_ms: times.probe_ms.or(before.probe_ms), ..before } }
    }
}

impl PassTimer {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let has_timestamps = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let settings = GpuProfilerSettings { max_num_pending_frames: PENDING, ..GpuProfilerSettings::default() };
        let profiler = has_timestamps.then(|| GpuProfiler::new(device, settings).ok()).flatten();
        Self { profiler, times: PassTimes::default(), has_probe: false, has_maps: false }
    }

    /// A probe comes next. One without a picture after it is a frame of its own.
    pub(crate) fn begin_probe(&mut self, gpu: &Gpu, maps_stay: bool) {
        if self.has_probe {
            self.end_frame(gpu);
        }
        (self.has_probe, self.has_maps) = (true, !maps_stay);
    }

    /// A picture comes next. One whose maps are drawn for it is a frame of its own.
    pub(crate) fn begin_picture(&mut self, gpu: &Gpu, maps_stay: bool) {
        if self.has_probe && !maps_stay {
            self.end_frame(gpu);
        }
    }

    /// What the shaded pass of a frame is timed as.
    pub(crate) fn scene(&self, maps_stay: bool) -> Pass {
        if maps_stay && !self.has_maps { Pass::Again } else { Pass::Scene }
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

    /// Records the read-back of the timestamps: the last thing before an encoder is submitted.
    pub(crate) fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(profiler) = &mut self.profiler {
            profiler.resolve_queries(encoder);
        }
    }

    /// Closes a submitted frame and takes the times of those that are finished.
    pub(crate) fn end_frame(&mut self, gpu: &Gpu) {
        (self.has_probe, self.has_maps) = (false, false);
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
            self.times = PassTimes::of(&results, self.times);
        }
    }
}
