//! Pictures judged on the GPU that draws them.

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

/// Greatest number of pictures whose times may wait for the GPU.
const PENDING: usize = 4;

/// Input of a picture that is judged live.
pub(crate) struct LiveInput<'a> {
    pub(crate) camera: PixelCamera,
    pub(crate) settings: TruthSettings,
    pub(crate) maps: PictureMaps<'a>,
    pub(crate) seen: &'a wgpu::TextureView,
    /// Shadow factors of the previous frame's maps at the same points.
    pub(crate) before: Option<GpuBefore<'a>>,
}

impl LiveTruth {
    /// Returns whether a device can judge pictures. Without enough storage buffers, as in WebGL2, threads
    /// judge instead.
    pub fn runs_on(gpu: &Gpu) -> bool {
        GpuJudge::runs_with(&gpu.device.limits())
    }

    /// Uploads the rays of a scene.
    ///
    /// # Errors
    ///
    /// If the scene is too large for the GPU.
    pub fn new(gpu: &Gpu, scene: &PreparedScene) -> Result<Self> {
        let tracer = GpuTracer::new(&gpu.device, &gpu.queue, &scene.rays().tracer, DVec3::ZERO)
            .with_context(|| scene.scene().name.clone())?;
        let (judge, timer) = (GpuJudge::new(&gpu.device), GpuTimer::new(&gpu.device, PENDING));
        Ok(Self { tracer, judge, timer, milliseconds: None })
    }

    /// Updates the rays to a new pose of the scene.
    ///
    /// # Errors
    ///
    /// As for [`Self::new`].
    pub fn set_pose(&mut self, gpu: &Gpu, scene: &PreparedScene) -> Result<()> {
        Ok(self.tracer.update(&gpu.device, &gpu.queue, &scene.rays().tracer)?)
    }

    /// Returns the size on the GPU, in bytes.
    pub fn bytes(&self) -> u64 {
        self.tracer.bytes()
    }

    /// Returns the classes of the last judged picture, an `R32Uint` texture of [`GpuPixel`]s; `None` before
    /// the first picture.
    pub fn classes(&self) -> Option<&wgpu::Texture> {
        self.judge.classes()
    }

    /// Returns the number of judged pictures.
    pub fn pictures(&self) -> u64 {
        self.judge.pictures()
    }

    /// Returns the sums of the newest picture that the GPU has finished, once and some frames late. `None` if
    /// there are none.
    ///
    /// # Errors
    ///
    /// If the device is lost.
    pub fn take(&mut self, gpu: &Gpu) -> Result<Option<GpuTally>> {
        let tally = self.judge.take(&gpu.device)?;
        while let Some(milliseconds) = self.timer.take_ms(gpu) {
            self.milliseconds = Some(milliseconds as f32);
        }
        Ok(tally)
    }

    /// Returns the latest known time in which the GPU judged and summed a picture, in milliseconds. `None`
    /// before the first time arrives, and on adapters without timestamps.
    pub fn milliseconds(&self) -> Option<f32> {
        self.milliseconds
    }

    pub(crate) fn judge(&mut self, gpu: &Gpu, input: &LiveInput<'_>) -> Result<Vec<GpuPixel>> {
        self.submit(gpu, input)?;
        Ok(self.judge.read(&gpu.device, &gpu.queue)?)
    }

    /// Measures the mean time of one picture over `repeats`, in milliseconds, from the first submission to
    /// the end of the last.
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
