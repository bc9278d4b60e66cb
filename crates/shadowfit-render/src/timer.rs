//! Times of the renderer's passes, and which of them make up a frame.

use shadowfit_wgpu::MAX_MAPS;
use wgpu_profiler::{GpuProfilerQuery, GpuTimerQueryResult};

use crate::Gpu;
use crate::gpu_timer::GpuTimer;

/// A timed pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// Into a map, by its number.
    Shadow(usize),
    Probe,
    /// Depths and normals that edges are traced from.
    Surfaces,
    /// The edge passes.
    Edges,
    Scene,
    /// The shaded pass of a further picture of maps that a frame before it drew.
    Again,
}

/// Times of the last frame that the GPU has finished, in milliseconds; `None` for passes that it did not have, and where the
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
    /// The passes that edges are traced by: depths and normals, and rays.
    pub edges_ms: Option<f32>,
    /// The shaded pass.
    pub scene_ms: Option<f32>,
}

/// Times the passes of the renderer.
#[derive(Debug)]
pub(crate) struct PassTimer {
    timer: GpuTimer,
    pub(crate) times: PassTimes,
    /// Whether the frame that is open has a probe, and whether maps were drawn for it.
    has_probe: bool,
    has_maps: bool,
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
            Self::Surfaces => "surfaces",
            Self::Edges => "edges",
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
            edges_ms: match (milliseconds(Pass::Surfaces), milliseconds(Pass::Edges)) {
                (Some(surfaces), Some(edges)) => Some(surfaces + edges),
                _ => None,
            },
            scene_ms: milliseconds(Pass::Scene),
        };
        let is_whole = results.iter().any(|result| result.label == Pass::Scene.label());
        if is_whole { times } else { Self { probe_ms: times.probe_ms.or(before.probe_ms), ..before } }
    }
}

impl PassTimer {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let timer = GpuTimer::new(device, PENDING);
        Self { timer, times: PassTimes::default(), has_probe: false, has_maps: false }
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
        self.timer.begin(pass.label(), encoder)
    }

    /// Ends what [`Self::begin`] began.
    pub(crate) fn end(&self, query: Option<GpuProfilerQuery>, encoder: &mut wgpu::CommandEncoder) {
        self.timer.end(query, encoder);
    }

    /// Records the way of the timestamps back: the last thing before an encoder is submitted.
    pub(crate) fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.timer.resolve(encoder);
    }

    /// Closes a submitted frame and takes the times of those that are finished.
    pub(crate) fn end_frame(&mut self, gpu: &Gpu) {
        (self.has_probe, self.has_maps) = (false, false);
        self.timer.end_frame(gpu);
        while let Some(results) = self.timer.take(gpu) {
            self.times = PassTimes::of(&results, self.times);
        }
    }
}
