//! Times of the renderer's passes, assigned to frames.

use shadowfit_wgpu::MAX_MAPS;
use wgpu_profiler::{GpuProfilerQuery, GpuTimerQueryResult};

use crate::Gpu;
use crate::gpu_timer::GpuTimer;

/// A timed pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pass {
    /// The pass into a map, by the map's number.
    Shadow(usize),
    Probe,
    /// Depths and normals for tracing edges.
    Surfaces,
    /// The edge passes.
    Edges,
    Scene,
    /// The shaded pass of a further picture, with maps that an earlier frame drew.
    Again,
}

/// Times of the last frame that the GPU has finished, in milliseconds. `None` for passes that the frame
/// lacks, and if the adapter has no timestamps.
///
/// A frame ends with its picture. A probe before the picture belongs to the same frame if the picture's maps
/// [stay](crate::Frame::maps_stay). Of any other probe, only the probe pass is timed. Further pictures of the
/// same maps are not timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassTimes {
    /// All shadow passes together.
    pub shadow_ms: Option<f32>,
    /// The shadow passes of each map.
    pub maps_ms: [Option<f32>; MAX_MAPS],
    /// The probe pass.
    pub probe_ms: Option<f32>,
    /// The passes for tracing edges: depths and normals, and rays.
    pub edges_ms: Option<f32>,
    /// The shaded pass.
    pub scene_ms: Option<f32>,
}

/// Times the passes of the renderer.
#[derive(Debug)]
pub(crate) struct PassTimer {
    timer: GpuTimer,
    pub(crate) times: PassTimes,
    /// Whether the current frame has a probe, and whether maps were drawn for it.
    has_probe: bool,
    has_maps: bool,
}

/// Greatest number of frames that wait for the GPU. Each picture may have one or two probes that count as
/// separate frames.
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
    /// Returns the times of a frame. If it has no picture, or only a further picture of the same maps,
    /// missing times are taken from `before`.
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

    /// Begins a probe. A probe without a picture after it is a separate frame.
    pub(crate) fn begin_probe(&mut self, gpu: &Gpu, maps_stay: bool) {
        if self.has_probe {
            self.end_frame(gpu);
        }
        (self.has_probe, self.has_maps) = (true, !maps_stay);
    }

    /// Begins a picture. If its maps are drawn for it, it is a separate frame.
    pub(crate) fn begin_picture(&mut self, gpu: &Gpu, maps_stay: bool) {
        if self.has_probe && !maps_stay {
            self.end_frame(gpu);
        }
    }

    /// Returns the timed pass for the shaded pass of a frame.
    pub(crate) fn scene(&self, maps_stay: bool) -> Pass {
        if maps_stay && !self.has_maps { Pass::Again } else { Pass::Scene }
    }

    /// Reserves the timestamps of a pass.
    pub(crate) fn begin(&self, pass: Pass, encoder: &mut wgpu::CommandEncoder) -> Option<GpuProfilerQuery> {
        self.timer.begin(pass.label(), encoder)
    }

    /// Ends a query of [`Self::begin`].
    pub(crate) fn end(&self, query: Option<GpuProfilerQuery>, encoder: &mut wgpu::CommandEncoder) {
        self.timer.end(query, encoder);
    }

    /// Records the read-back of the timestamps. Call it last before the encoder is submitted.
    pub(crate) fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.timer.resolve(encoder);
    }

    /// Ends a submitted frame and takes the times of finished frames.
    pub(crate) fn end_frame(&mut self, gpu: &Gpu) {
        (self.has_probe, self.has_maps) = (false, false);
        self.timer.end_frame(gpu);
        while let Some(results) = self.timer.take(gpu) {
            self.times = PassTimes::of(&results, self.times);
        }
    }
}
