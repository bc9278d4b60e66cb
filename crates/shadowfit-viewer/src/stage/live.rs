//! Pictures judged against rays while they are shown: each one on a graphics card; without one, the next as soon as a
//! thread is done with the last. Browsers have no threads, so what draws judges there, too: where the CPU draws, as
//! rarely as a thread would.

use anyhow::{Result, anyhow};
use shadowfit::{Camera, FittedMap, Technique};
use shadowfit_params::figures::JudgedFigures;
use shadowfit_params::tool::ErrorMarks;
use shadowfit_render::{DeviceFault, Gpu, JudgedPicture, ProbeTargets, classes_texture};
use shadowfit_study::{BackgroundJudge, Evaluator, LiveTruth, View};
use shadowfit_truth::PictureFigures;

use super::shot::Shot;
use crate::platform::IS_PAGE;

/// Width of a picture that a thread judges, in pixels: enough for every artefact, and judged in a fraction of a second.
const BACKGROUND_WIDTH: u32 = 480;
/// How long a view must have stood still before a thread judges it, in seconds, unless it is asked for.
const STILL: f32 = 0.3;
/// How often a view that does not stand still is judged by a thread, in seconds.
const MOVING: f32 = 2.0;
/// Most triangles that are moved to a new pose within a frame, so that frames do not stall.
const MOST_POSED: usize = 150_000;
/// Frames whose time is remembered until their sums come back.
const FRAMES: usize = 8;

/// The content of a picture: where any field differs, the picture is another one.
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
    /// They differ in a view that stands still, too, once it is known what it showed.
    pub(super) maps: Vec<FittedMap>,
}

/// A picture that was judged, with its classes as a texture.
#[derive(Debug)]
struct Judged {
    key: Key,
    view: wgpu::TextureView,
    size: [u32; 2],
    /// The probe that it was judged by, whose depth buffer tells which surfaces it shows; `None` where the next frame
    /// is judged again.
    seen: Option<ProbeTargets>,
}

/// A picture whose sums are on their way.
#[derive(Debug)]
struct Drawn {
    key: Key,
    size: [u32; 2],
    /// When it was drawn, by the stage's clock in seconds.
    at: f32,
}

/// The sums of a picture.
#[derive(Debug)]
struct Sums {
    of: Drawn,
    /// `None` for a picture without a pixel that counts, such as one of the sky.
    figures: Option<PictureFigures>,
    /// How long the GPU judged it, in milliseconds; `None` where it does not, or is not timed.
    gpu_ms: Option<f32>,
}

/// Who judges pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum JudgedBy {
    /// Threads, with rays of the CPU.
    #[default]
    Threads,
    /// A graphics card, each picture.
    Gpu,
    /// What a browser takes for one, as rarely as a thread would.
    SlowGpu,
    /// Nobody: a browser has no threads, and WebGL2 no compute shaders.
    Nobody,
}

/// The judge of a side's pictures.
#[derive(Debug, Default)]
pub(super) struct Live {
    /// Who judges.
    pub(super) by: JudgedBy,
    /// Why the GPU cannot judge this scene, if it should and threads do so instead.
    no_gpu: Option<String>,
    gpu: Option<LiveTruth>,
    background: Option<BackgroundJudge>,
    /// The picture that the thread judges, and its probe.
    started: Option<(Drawn, ProbeTargets)>,
    /// When the thread last got a picture, by the stage's clock in seconds.
    begun: Option<f32>,
    judged: Option<Judged>,
    sums: Option<Sums>,
    /// The last pictures that the GPU got, by their numbers.
    drawn: Vec<(u64, Drawn)>,
    /// The view of the frame before, and since when it has been the same, by the stage's clock in seconds.
    last: Option<(Key, f32)>,
    /// Time of the scene's pose that the GPU's rays have.
    posed: Option<f32>,
    /// Pictures are judged at once, as scripts and headless pictures need it.
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

    /// Forgets all pictures, for another scene.
    pub(super) fn forget(&mut self) {
        let waits = self.waits;
        let by = if self.no_gpu.is_some() { JudgedBy::Gpu } else { self.by };
        // The thread stops judging.
        *self = Self { by, waits, ..Self::default() };
    }

    /// Why pictures are judged otherwise than usual, as a line.
    pub(super) fn notice(&self) -> Option<String> {
        self.no_gpu.as_ref().map(|why| format!("Pictures are judged now and then, by the CPU: {why}"))
    }

    /// The picture that was judged last.
    pub(super) fn picture(&self) -> Option<JudgedPicture<'_>> {
        let judged = self.judged.as_ref()?;
        let depth = judged.seen.as_ref().map(ProbeTargets::depth_view);
        Some(JudgedPicture { classes: &judged.view, size: judged.size, camera: judged.key.camera, depth })
    }

    /// The classes of the picture that was judged last: another texture for each.
    pub(super) fn judged_view(&self) -> Option<wgpu::TextureView> {
        self.judged.as_ref().map(|judged| judged.view.clone())
    }

    /// The figures that came back last, at a time of the stage's clock in seconds.
    pub(super) fn figures(&self, clock: f32) -> Option<JudgedFigures> {
        let Sums { of, figures, .. } = self.sums.as_ref()?;
        Some(judged_figures(figures.as_ref()?, of.size, clock - of.at))
    }

    /// How long the GPU judged the picture whose figures came back last, in milliseconds, after its probe was drawn.
    pub(super) fn gpu_ms(&self) -> Option<f32> {
        self.sums.as_ref()?.gpu_ms
    }

    /// Whether the view that was drawn last has been judged, and its sums have arrived.
    pub(super) fn is_up_to_date(&self) -> bool {
        let (Some(judged), Some(sums), Some((last, _))) = (&self.judged, &self.sums, &self.last) else { return false };
        judged.key == *last && sums.of.key == *last
    }

    /// Whether the thread is idle.
    #[cfg(test)]
    pub(super) fn is_idle(&self) -> bool {
        !self.background.as_ref().is_some_and(BackgroundJudge::is_busy)
    }

    /// Judges the view that is about to be drawn, and takes results that have arrived. Returns whether the maps were
    /// drawn for it, so that the picture need not draw them again.
    ///
    /// # Errors
    ///
    /// When the view cannot be drawn, or the scene is too large for the adapter.
    pub(super) fn judge(
        &mut self,
        evaluator: &mut Evaluator,
        shot: &mut Shot<'_>,
        view: &View,
        maps: &[FittedMap],
        size: [u32; 2],
    ) -> Result<bool> {
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
        let since = match &self.last {
            Some((last, since)) if *last == key => *since,
            _ => shot.clock,
        };
        self.last = Some((key.clone(), since));
        self.take(shot.gpu)?;
        if shot.scene.ready_rays().is_none() && !self.pose_rays(shot) {
            return Ok(false);
        }
        if self.waits && shot.is_unseen {
            return Ok(false);
        }
        if self.by == JudgedBy::Gpu {
            return self.judge_on_gpu(evaluator, shot, view, key, size);
        }
        let is_asked = shot.settings.view.mode.is_judged() || shot.settings.view.marks != ErrorMarks::Off;
        let waited = self.begun.map_or(f32::MAX, |begun| shot.clock - begun);
        let is_due = self.waits || is_asked || shot.clock - since >= STILL || waited >= MOVING;
        let is_known = self.judged.as_ref().is_some_and(|judged| judged.key == key);
        let is_busy = self.background.as_ref().is_some_and(BackgroundJudge::is_busy) || !self.drawn.is_empty();
        if is_known || !is_due || is_busy {
            return Ok(false);
        }
        self.begun = Some(shot.clock);
        let size = if self.waits { size } else { background_size(size) };
        if self.by == JudgedBy::Threads {
            return self.start(evaluator, shot, view, key, size);
        }
        let maps_stay = self.judge_on_gpu(evaluator, shot, view, key, size)?;
        // Later frames of other views need to know what this one showed.
        if let Some(judged) = &mut self.judged {
            judged.seen = evaluator.take_probe();
        }
        Ok(maps_stay)
    }

    /// Makes rays of the present pose, at once where that is quick, otherwise on a thread for a later frame. Returns
    /// whether they exist.
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

    /// Draws the probe for the thread, and starts it.
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
        // Measuring crawl has drawn the maps of the view before in place of this view's.
        Ok(!measures_crawl)
    }

    /// Takes results that have arrived.
    fn take(&mut self, gpu: &Gpu) -> Result<()> {
        let tally = self.gpu.as_mut().map(|live| live.take(gpu)).transpose()?.flatten();
        let gpu_ms = self.gpu.as_ref().and_then(LiveTruth::milliseconds);
        if let Some(tally) = tally {
            let place = self.drawn.iter().position(|(picture, _)| *picture == tally.picture);
            // Those before it were overtaken.
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

/// The size at which a thread, or a GPU that is as slow, judges a picture of a size.
fn background_size(size: [u32; 2]) -> [u32; 2] {
    let scale = (BACKGROUND_WIDTH as f32 / size[0] as f32).min(1.0);
    size.map(|side| ((side as f32 * scale).round() as u32).max(1))
}

/// Figures for the panel.
pub(crate) fn judged_figures(figures: &PictureFigures, size: [u32; 2], age: f32) -> JudgedFigures {
    JudgedFigures {
        wrong: figures.wrong as f32,
        false_shadow: figures.false_shadow as f32,
        false_light: figures.false_light as f32,
        hole: figures.hole as f32,
        edge: figures.edge as f32,
        mean_error: figures.mean_error as f32,
        uncovered: figures.uncovered as f32,
        pixels_per_texel: figures.pixels_per_texel.map(|quantiles| quantiles.map(|value| value as f32)),
        crawl: figures.crawl.map(|crawl| crawl as f32),
        age,
        size,
    }
}
