//! Pictures judged on the GPU, where they are drawn.

use web_time::Instant;

use anyhow::{Context, Result};
use glam::DVec3;
use shadowfit_render::{Gpu, GpuProfilerQuery, GpuTimer};
use shadowfit_truth::gpu::{GpuBefore, GpuJudge, GpuJudgeInput, GpuPixel, GpuTally, GpuTracer};
use shadowfit_truth::{PictureMaps, PixelCamera, TruthSettings};

use crate::PreparedScene;

/// A scene's rays on the GPU, and the passes that judge with them.
#[derive(Debug)]
pub struct LiveTruth {
    tracer: GpuTracer,
    judge: GpuJudge,
    timer: GpuTimer,
    milliseconds: Option<f32>,
}

/// Most pictures whose times may wait for the GPU.
const PENDING: usize = 4;

/// A picture that is judged live.
pub(crate) struct LiveInput<'a> {
    pub(crate) camera: PixelCamera,
    pub(crate) settings: TruthSettings,
    pub(crate) maps: PictureMaps<'a>,
    pub(crate) seen: &'a wgpu::TextureView,
    /// The shadow factors that the maps of the frame before give at the same points.
    pub(crate) before: Option<GpuBefore<'a>>,
}

impl LiveTruth {
    /// Whether a device can judge pictures. Without enough storage buffers, as with WebGL2's limits, threads do it.
    pub fn runs_on(gpu: &Gpu) -> bool {
        GpuJudge::runs_with(&gpu.device.limits())
    }

    /// Uploads the rays of a scene.
    ///
    /// # Errors
    ///
    /// When the scene is too large for the GPU.
    pub fn new(gpu: &Gpu, scene: &PreparedScene) -> Result<Self> {
        let tracer = GpuTracer::new(&gpu.device, &gpu.queue, &scene.rays().tracer, DVec3::ZERO)
            .with_context(|| scene.scene().name.clone())?;
        let (judge, timer) = (GpuJudge::new(&gpu.device), GpuTimer::new(&gpu.device, PENDING));
        Ok(Self { tracer, judge, timer, milliseconds: None })
    }

    /// Takes over a new pose of the scene.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn set_pose(&mut self, gpu: &Gpu, scene: &PreparedScene) -> Result<()> {
        Ok(self.tracer.update(&gpu.device, &gpu.queue, &scene.rays().tracer)?)
    }

    /// Bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        self.tracer.bytes()
    }

    /// The classes of the last picture that was judged, an `R32Uint` texture of [`GpuPixel`]s; `None` before the first.
    pub fn classes(&self) -> Option<&wgpu::Texture> {
        self.judge.classes()
    }

    /// Number of pictures that were judged.
    pub fn pictures(&self) -> u64 {
        self.judge.pictures()
    }

    /// The sums of the newest picture that the GPU has finished, given once, some frames late; `None` until there are
    /// any.
    ///
    /// # Errors
    ///
    /// When the device is lost.
    pub fn take(&mut self, gpu: &Gpu) -> Result<Option<GpuTally>> {
        let tally = self.judge.take(&gpu.device)?;
        while let Some(milliseconds) = self.timer.take_ms(gpu) {
            self.milliseconds = Some(milliseconds as f32);
        }
        Ok(tally)
    }

    /// Time in which the GPU judged and summed a picture, in milliseconds: the last time that has come back. `None`
    /// before that, and on adapters without timestamps.
    pub fn milliseconds(&self) -> Option<f32> {
        self.milliseconds
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

    pub(crate) fn submit(&mut self, gpu: &Gpu, input: &LiveInput<'_>) -> Result<()> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let query = self.timer.begin("judge", &mut encoder);
        let judged = GpuJudgeInput {
            camera: &input.camera,
            settings: &input.settings,
            maps: &input.maps,
            before: input.before,
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes),
        };
        let recorded = self.judge.judge(&gpu.device, &gpu.queue, &mut encoder, &self.tracer, input.seen, &judged);
        let recorded = recorded.map(|_| ());
        self.timer.end(query, &mut encoder);
        recorded?;
        self.timer.resolve(&mut encoder);
        gpu.submit([encoder.finish()]);
        self.timer.end_frame(gpu);
        Ok(())
    }
}
