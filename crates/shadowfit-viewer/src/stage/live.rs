//! Judging of pictures against rays while they are shown. A graphics card judges each picture. Without one, a
//! thread judges the next picture when the last one is done. Browsers have no threads, so the GPU judges
//! there, too; if it is a software driver, as rarely as a thread would.

use anyhow::{Result, anyhow};
use shadowfit::{Camera, FittedMap, Technique};
use shadowfit_params::figures::JudgedFigures;
use shadowfit_params::tool::ErrorMarks;
use shadowfit_render::{DeviceFault, Gpu, JudgedPicture, ProbeTargets, classes_texture};
use shadowfit_study::{BackgroundJudge, Evaluator, LiveTruth, View};
use shadowfit_truth::PictureFigures;

use super::flip::Flip;
use super::shot::Shot;
use crate::platform::IS_PAGE;

/// Width of a picture that a thread judges, in pixels: enough for every artefact, and judged in a fraction of
/// a second.
const BACKGROUND_WIDTH: u32 = 480;
/// Time for which a view must not change before a thread judges it, in seconds, unless the judged picture is
/// shown, and before its look is compared.
const STILL: f32 = 0.3;
/// Interval at which a thread judges a changing view, in seconds.
const MOVING: f32 = 2.0;
/// Greatest number of triangles that are moved to a new pose within a frame, so that frames do not stall.
const MOST_POSED: usize = 150_000;
/// Greatest number of frames that wait for their sums.
const FRAMES: usize = 8;

/// The content of a picture. If any field differs, it is another picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) camera: Camera,
    pub(super) technique: Technique,
    /// The light's direction of travel.
    pub(super) direction: glam::Vec3,
    /// Time of the scene's animation, in seconds.
    pub(super) seconds: f32,
    /// Distance above the surface at which shadow rays start, in metres.
    pub(super) ray_offset: f64,
    /// Maps can change while the view does not, once the visible demand arrives.
    pub(super) maps: Vec<FittedMap>,
}

/// A judged picture, with its classes as a texture.
#[derive(Debug)]
struct Judged {
    key: Key,
    view: wgpu::TextureView,
    size: [u32; 2],
    /// The probe of the judged picture, whose depth buffer identifies its surfaces; `None` if the next frame
    /// is judged again.
    seen: Option<ProbeTargets>,
}

/// A picture that waits for its sums.
#[derive(Debug)]
struct Drawn {
    key: Key,
    size: [u32; 2],
    /// Time when it was drawn, by the stage's clock in seconds.
    at: f32,
}

/// The sums of a picture.
#[derive(Debug)]
struct Sums {
    of: Drawn,
    /// `None` for a picture without counted pixels, such as a picture of the sky.
    figures: Option<PictureFigures>,
    /// GPU time of judging it, in milliseconds; `None` if the GPU does not judge, or is not timed.
    gpu_ms: Option<f32>,
}

/// A judged picture that was compared with the same picture with true shadows.
#[derive(Debug)]
struct Compared {
    key: Key,
    size: [u32; 2],
    flip: Flip,
}

/// The judge of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum JudgedBy {
    /// Threads, with rays of the CPU.
    #[default]
    Threads,
    /// A graphics card, for each picture.
    Gpu,
    /// A browser's software GPU, as rarely as a thread would.
    SlowGpu,
    /// None: a browser has no threads, and WebGL2 has no compute shaders.
    Nobody,
}

/// The judge of a side's pictures.
#[derive(Debug, Default)]
pub(super) struct Live {
    /// The judge.
    pub(super) by: JudgedBy,
    /// Reason why threads judge this scene instead of the GPU.
    no_gpu: Option<String>,
    gpu: Option<LiveTruth>,
    background: Option<BackgroundJudge>,
    /// The picture that the thread judges, and its probe.
    started: Option<(Drawn, ProbeTargets)>,
    /// Time when the thread last got a picture, by the stage's clock in seconds.
    begun: Option<f32>,
    judged: Option<Judged>,
    sums: Option<Sums>,
    /// The comparison of a judged picture with true shadows.
    compared: Option<Compared>,
    /// Whether the last view was compared. The renderer then drew other pictures in between.
    pub(super) has_compared: bool,
    /// The last pictures sent to the GPU, by their numbers.
    drawn: Vec<(u64, Drawn)>,
    /// The view of the previous frame, and the time since which it has not changed, by the stage's clock in
    /// seconds.
    last: Option<(Key, f32)>,
    /// Time of the scene's pose in the GPU's rays.
    posed: Option<f32>,
    /// Whether pictures are judged at once, for scripts and headless pictures.
    pub(super) waits: bool,
}

impl Live {
    pub(super) fn new(gpu: &Gpu) -> Self {
        let by = match (gpu.is_software(), IS_PAGE, LiveTruth::runs_on(gpu)) {
            (true, false, _) | (_, false, false) => JudgedBy::Threads,
            (false, _, true) => JudgedBy::Gpu,
            (true, true, true) => JudgedBy::SlowGpu,
            (_, true, false) => JudgedBy::Nobody,
        };
        Self { by, ..Self::default() }
    }

    /// Discards all pictures, for another scene.
    pub(super) fn forget(&mut self) {
        let waits = self.waits;
        let by = if self.no_gpu.is_some() { JudgedBy::Gpu } else { self.by };
        // This also stops the thread.
        *self = Self { by, waits, ..Self::default() };
    }

    /// Returns why pictures are judged in an unusual way, as a line.
    pub(super) fn notice(&self) -> Option<String> {
        self.no_gpu.as_ref().map(|why| format!("Pictures are judged at intervals, by the CPU: {why}"))
    }

    /// Returns the last judged picture.
    pub(super) fn picture(&self) -> Option<JudgedPicture<'_>> {
        let judged = self.judged.as_ref()?;
        let depth = judged.seen.as_ref().map(ProbeTargets::depth_view);
        Some(JudgedPicture { classes: &judged.view, size: judged.size, camera: judged.key.camera, depth })
    }

    /// Returns the classes of the last judged picture. Each picture has its own texture.
    pub(super) fn judged_view(&self) -> Option<wgpu::TextureView> {
        self.judged.as_ref().map(|judged| judged.view.clone())
    }

    /// Returns the latest figures, at a time of the stage's clock in seconds.
    pub(super) fn figures(&self, clock: f32) -> Option<JudgedFigures> {
        let Sums { of, figures, .. } = self.sums.as_ref()?;
        let compared = self.compared.as_ref().filter(|compared| compared.key == of.key && compared.size == of.size);
        let flip = compared.and_then(|compared| compared.flip.mean());
        Some(JudgedFigures { flip, ..judged_figures(figures.as_ref()?, of.size, clock - of.at) })
    }

    /// Returns the GPU time of judging the picture of the latest figures, in milliseconds, without its probe.
    pub(super) fn gpu_ms(&self) -> Option<f32> {
        self.sums.as_ref()?.gpu_ms
    }

    /// Returns whether the last drawn view has been judged, and its sums have arrived.
    pub(super) fn is_up_to_date(&self) -> bool {
        let (Some(judged), Some(sums), Some((last, _))) = (&self.judged, &self.sums, &self.last) else { return false };
        judged.key == *last && sums.of.key == *last
    }

    /// Returns whether the thread is idle.
    #[cfg(test)]
    pub(super) fn is_idle(&self) -> bool {
        !self.background.as_ref().is_some_and(BackgroundJudge::is_busy)
    }

    /// Judges the view that is about to be drawn, and takes results that have arrived. Returns whether the
    /// maps were drawn for it, so that the picture need not draw them again.
    ///
    /// # Errors
    ///
    /// If the view cannot be drawn, or the scene is too large for the adapter.
    pub(super) fn judge(
        &mut self,
        evaluator: &mut Evaluator,
        shot: &mut Shot<'_>,
        view: &View,
        maps: &[FittedMap],
        size: [u32; 2],
    ) -> Result<bool> {
        self.has_compared = false;
        if self.by == JudgedBy::Nobody {
            return Ok(false);
        }
        let key = Key {
            camera: view.camera,
            technique: shot.settings.technique,
            direction: view.direction,
            seconds: shot.seconds,
            ray_offset: shot.ray_offset(),
            maps: maps.to_vec(),
        };
        let rests_since = self.last.as_ref().filter(|(last, _)| *last == key).map(|(_, since)| *since);
        let since = rests_since.unwrap_or(shot.clock);
        self.last = Some((key.clone(), since));
        self.take(shot.gpu)?;
        if shot.scene.ready_rays().is_none() && !self.pose_rays(shot) {
            return Ok(false);
        }
        if self.waits && shot.is_unseen {
            return Ok(false);
        }
        let rests = rests_since.is_some() && (self.waits || shot.clock - since >= STILL);
        let may_compare = rests && shot.settings.view.judge && !IS_PAGE;
        if self.by == JudgedBy::Gpu {
            let maps_stay = self.judge_on_gpu(evaluator, shot, view, key, size)?;
            if may_compare {
                self.compare_looks(evaluator, shot, view)?;
            }
            return Ok(maps_stay && !self.has_compared);
        }
        let is_asked = shot.settings.view.mode.is_judged() || shot.settings.view.marks != ErrorMarks::Off;
        let waited = self.begun.map_or(f32::MAX, |begun| shot.clock - begun);
        let is_due = self.waits || is_asked || shot.clock - since >= STILL || waited >= MOVING;
        let is_known = self.judged.as_ref().is_some_and(|judged| judged.key == key);
        let is_busy = self.background.as_ref().is_some_and(BackgroundJudge::is_busy) || !self.drawn.is_empty();
        if is_known && may_compare {
            self.compare_looks(evaluator, shot, view)?;
        }
        if is_known || !is_due || is_busy {
            return Ok(false);
        }
        self.begun = Some(shot.clock);
        let size = if self.waits { size } else { background_size(size) };
        if self.by == JudgedBy::Threads {
            return self.start(evaluator, shot, view, key, size);
        }
        let maps_stay = self.judge_on_gpu(evaluator, shot, view, key, size)?;
        // Later frames of other views need to know its surfaces.
        if let Some(judged) = &mut self.judged {
            judged.seen = evaluator.take_probe();
        }
        Ok(maps_stay)
    }

    /// Compares the judged picture with the same picture with true shadows, unless that was done or another
    /// comparison goes on. A comparison that fails is not repeated.
    fn compare_looks(&mut self, evaluator: &mut Evaluator, shot: &mut Shot<'_>, view: &View) -> Result<()> {
        let Some(judged) = &self.judged else { return Ok(()) };
        let is_same = |compared: &Compared| compared.key == judged.key && compared.size == judged.size;
        if self.compared.as_ref().is_some_and(|compared| is_same(compared) || compared.flip.is_busy()) {
            return Ok(());
        }
        let of_gpu = if judged.seen.is_none() { evaluator.take_probe() } else { None };
        let Some(probe) = judged.seen.as_ref().or(of_gpu.as_ref()) else { return Ok(()) };
        let (key, size, flip) = (judged.key.clone(), judged.size, Flip::default());
        let compared = self.compared.insert(Compared { key, size, flip });
        self.has_compared = true;
        let (gpu, maps, classes) = (shot.gpu, &compared.key.maps, judged.view.texture());
        let probe = probe.read(gpu)?;
        match gpu.try_making(|| compared.flip.measure(evaluator, shot, (view, maps), (&probe, classes), self.waits)) {
            // Without memory for the pictures, the error stays unknown.
            Err(DeviceFault::OutOfMemory(_)) => Ok(()),
            made => made?,
        }
    }

    /// Makes rays of the current pose: at once if that is quick, otherwise on a thread for a later frame.
    /// Returns whether they exist.
    fn pose_rays(&self, shot: &mut Shot<'_>) -> bool {
        let is_small = shot.scene.latest_rays().is_some_and(|(rays, _)| rays.tracer.len() <= MOST_POSED);
        if self.waits || is_small {
            shot.scene.rays();
            return true;
        }
        shot.scene.request_rays();
        shot.scene.take_rays();
        shot.scene.ready_rays().is_some()
    }

    fn judge_on_gpu(
        &mut self,
        evaluator: &mut Evaluator,
        shot: &mut Shot<'_>,
        view: &View,
        key: Key,
        size: [u32; 2],
    ) -> Result<bool> {
        let live = match self.gpu.take() {
            Some(mut live) => {
                if self.posed != Some(shot.seconds) {
                    live.set_pose(shot.gpu, shot.scene)?;
                }
                live
            }
            None => match shot.gpu.try_making(|| LiveTruth::new(shot.gpu, shot.scene)) {
                Ok(live) => live?,
                Err(fault @ DeviceFault::OutOfMemory(_)) if !IS_PAGE => {
                    (self.by, self.no_gpu) = (JudgedBy::Threads, Some(fault.to_string()));
                    return Ok(false);
                }
                Err(fault) => return Err(fault.into()),
            },
        };
        self.posed = Some(shot.seconds);
        let live = self.gpu.insert(live);
        evaluator.judging.size = size;
        evaluator.judging.crawl = true;
        evaluator.judge_in_place(shot.gpu, shot.scene, view, &key.maps, live)?;
        if self.drawn.len() == FRAMES {
            self.drawn.remove(0);
        }
        self.drawn.push((live.pictures(), Drawn { key: key.clone(), size, at: shot.clock }));
        let classes = live.classes().ok_or_else(|| anyhow!("the picture was not judged"))?;
        self.judged = Some(Judged { key, view: classes.create_view(&Default::default()), size, seen: None });
        if self.waits {
            shot.gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
            self.take(shot.gpu)?;
        }
        Ok(true)
    }

    /// Draws the probe for the thread, and starts the thread's work.
    fn start(
        &mut self,
        evaluator: &mut Evaluator,
        shot: &mut Shot<'_>,
        view: &View,
        key: Key,
        size: [u32; 2],
    ) -> Result<bool> {
        let Some(rays) = shot.scene.ready_rays() else { return Ok(false) };
        evaluator.judging.size = size;
        evaluator.judging.crawl = !self.waits;
        let (job, seen) = evaluator.judge_job(shot.gpu, shot.scene, view, &key.maps, rays)?;
        let measures_crawl = job.before.is_some();
        let size = job.judging.size;
        let mut background = match self.background.take() {
            Some(background) => background,
            None => BackgroundJudge::new()?,
        };
        background.start(job);
        self.background = Some(background);
        self.started = Some((Drawn { key, size, at: shot.clock }, seen));
        if self.waits {
            while self.background.as_ref().is_some_and(BackgroundJudge::is_busy) && self.started.is_some() {
                std::thread::sleep(std::time::Duration::from_millis(1));
                self.take(shot.gpu)?;
            }
        }
        // Measuring crawl has replaced this view's maps by the previous view's.
        Ok(!measures_crawl)
    }

    /// Takes results that have arrived.
    fn take(&mut self, gpu: &Gpu) -> Result<()> {
        let tally = self.gpu.as_mut().map(|live| live.take(gpu)).transpose()?.flatten();
        let gpu_ms = self.gpu.as_ref().and_then(LiveTruth::milliseconds);
        if let Some(tally) = tally {
            let place = self.drawn.iter().position(|(picture, _)| *picture == tally.picture);
            // Earlier pictures were overtaken.
            let of = place.and_then(|place| self.drawn.drain(..=place).next_back());
            if let Some((_, of)) = of {
                self.sums = Some(Sums { of, figures: tally.figures(), gpu_ms });
            }
        }
        let Some(found) = self.background.as_mut().and_then(BackgroundJudge::take) else { return Ok(()) };
        let Some((of, seen)) = self.started.take() else { return Ok(()) };
        let found = found?;
        let view = classes_texture(gpu, &found.classes, of.size);
        self.judged = Some(Judged { key: of.key.clone(), view, size: of.size, seen: Some(seen) });
        self.sums = Some(Sums { of, figures: found.judged.tally.figures(), gpu_ms: None });
        Ok(())
    }
}

/// Returns the size at which a thread or a software GPU judges a picture of a size.
fn background_size(size: [u32; 2]) -> [u32; 2] {
    let scale = (BACKGROUND_WIDTH as f32 / size[0] as f32).min(1.0);
    size.map(|side| ((side as f32 * scale).round() as u32).max(1))
}

/// Converts figures for the panel.
pub(crate) fn judged_figures(figures: &PictureFigures, size: [u32; 2], age: f32) -> JudgedFigures {
    JudgedFigures {
        wrong: figures.wrong as f32,
        false_shadow: figures.false_shadow as f32,
        false_light: figures.false_light as f32,
        hole: figures.hole as f32,
        edge: figures.edge as f32,
        light_error: figures.light_error as f32,
        flip: figures.flip.map(|flip| flip as f32),
        uncovered: figures.uncovered as f32,
        pixels_per_texel: figures.pixels_per_texel.map(|quantiles| quantiles.map(|value| value as f32)),
        crawl: figures.crawl.map(|crawl| crawl as f32),
        age,
        size,
    }
}
