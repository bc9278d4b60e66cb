//! The classes on the GPU: the same pictures judged where they are drawn.

use std::time::Instant;

use anyhow::{Context, Result};
use glam::DVec3;
use shadowfit_render::Gpu;
use shadowfit_truth::gpu::{GpuJudge, GpuJudgeInput, GpuPixel, GpuTracer};
use shadowfit_truth::{Class, Judged, MapsSeen, PixelCamera};

use crate::study::Subject;

/// A scene's rays on the GPU, and the passes that judge with them.
#[derive(Debug)]
pub struct LiveTruth {
    tracer: GpuTracer,
    judge: GpuJudge,
}

/// What is judged live, beside what the contender knows.
pub(crate) struct LiveInput<'a> {
    pub(crate) camera: PixelCamera,
    pub(crate) settings: shadowfit_truth::TruthSettings,
    pub(crate) maps: MapsSeen<'a>,
    pub(crate) seen: &'a wgpu::TextureView,
}

impl LiveTruth {
    /// Uploads the rays of a scene.
    ///
    /// # Errors
    ///
    /// When the scene is too large for the GPU.
    pub fn new(gpu: &Gpu, subject: &Subject) -> Result<Self> {
        let tracer = GpuTracer::new(&gpu.device, &gpu.queue, &subject.rays.tracer, DVec3::ZERO)
            .with_context(|| subject.scene.name.clone())?;
        Ok(Self { tracer, judge: GpuJudge::new(&gpu.device) })
    }

    /// Takes over a new pose of the scene.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn set_pose(&mut self, gpu: &Gpu, subject: &Subject) -> Result<()> {
        Ok(self.tracer.update(&gpu.device, &gpu.queue, &subject.rays.tracer)?)
    }

    /// Bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        self.tracer.bytes()
    }

    pub(crate) fn judge(&mut self, gpu: &Gpu, input: &LiveInput<'_>) -> Result<Vec<GpuPixel>> {
        self.submit(gpu, input)?;
        Ok(self.judge.read(&gpu.device, &gpu.queue)?)
    }

    /// Mean time of one picture over `repeats`, in milliseconds: from the first submission to the end of the last.
    pub(crate) fn time(&mut self, gpu: &Gpu, input: &LiveInput<'_>, repeats: u32) -> Result<f64> {
        // Clocks and caches warm up first.
        for _ in 0..repeats {
            self.submit(gpu, input)?;
        }
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        let start = Instant::now();
        for _ in 0..repeats {
            self.submit(gpu, input)?;
        }
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok(start.elapsed().as_secs_f64() * 1e3 / f64::from(repeats.max(1)))
    }

    fn submit(&mut self, gpu: &Gpu, input: &LiveInput<'_>) -> Result<()> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let judged = GpuJudgeInput { camera: &input.camera, settings: &input.settings, maps: &input.maps };
        self.judge.judge(&gpu.device, &gpu.queue, &mut encoder, &self.tracer, input.seen, &judged)?;
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}

/// How far the classes of the GPU and of the processor agree, over any number of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    judged: u64,
    same: u64,
    judged_off_edges: u64,
    same_off_edges: u64,
    same_edge_zone: u64,
}

impl Agreement {
    /// Adds a picture that both judged.
    pub fn add(&mut self, judged: &Judged, pixels: &[GpuPixel]) {
        for (pixel, found) in pixels.iter().enumerate() {
            let class = judged.classes[pixel];
            if class == Class::NotJudged && found.class == Class::NotJudged {
                continue;
            }
            let same = u64::from(class == found.class);
            self.judged += 1;
            self.same += same;
            self.same_edge_zone += u64::from(judged.edge_zone[pixel] == found.is_in_edge_zone);
            if !judged.edge_zone[pixel] {
                self.judged_off_edges += 1;
                self.same_off_edges += same;
            }
        }
    }

    /// Number of pixels that either judged.
    pub fn pixels(&self) -> u64 {
        self.judged
    }

    /// Share of all judged pixels that have the same class, 0..=1; 1 without any.
    pub fn all(&self) -> f64 {
        share(self.same, self.judged)
    }

    /// The same of those outside the processor's edge zone.
    pub fn off_edges(&self) -> f64 {
        share(self.same_off_edges, self.judged_off_edges)
    }

    /// Share of all judged pixels that both put into the edge zone, or both do not.
    pub fn edge_zone(&self) -> f64 {
        share(self.same_edge_zone, self.judged)
    }
}

fn share(same: u64, judged: u64) -> f64 {
    if judged == 0 { 1.0 } else { same as f64 / judged as f64 }
}
