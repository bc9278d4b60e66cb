//! Judges pictures on threads, with rays on the CPU, for adapters on which the passes of
//! [`LiveTruth`](crate::LiveTruth) would block the picture.
//!
//! One core is left for drawing. Judging stops between two pixels if another picture is submitted or the
//! judge is dropped. A panic becomes an error that can be shown.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;
use web_time::Instant;

use anyhow::{Context, Result, anyhow, ensure};
use rayon::{ThreadPool, ThreadPoolBuilder};
use shadowfit_truth::gpu::GpuPixel;
use shadowfit_truth::{Judged, Truth};

use crate::picture::JudgeJob;
use crate::{Judging, View};

/// A judged picture.
#[derive(Clone, Debug)]
pub struct JudgeResult {
    /// The verdicts. Their sums are in [`Judged::tally`].
    pub judged: Judged,
    /// The verdicts as texels, rows from the top: the bits of a [`GpuPixel`] for each pixel, ready to be
    /// written to an `R32Uint` texture of [`Judging::size`].
    pub classes: Vec<u32>,
    /// The view that was judged. If the camera has moved since, it shows other pixels.
    pub view: View,
    /// Settings that it was judged with.
    pub judging: Judging,
    /// Duration, in seconds.
    pub seconds: f32,
}

/// Judges one picture at a time, in the background.
///
/// ```no_run
/// # use shadowfit_study::{BackgroundJudge, JudgeJob};
/// # fn frame(judge: &mut BackgroundJudge, job: impl FnOnce() -> JudgeJob) {
/// if let Some(found) = judge.take() {
///     match found {
///         Ok(picture) => println!("judged in {} s: {:?}", picture.seconds, picture.judged.tally.figures()),
///         Err(error) => println!("{error:#}"),
///     }
/// }
/// if !judge.is_busy() {
///     judge.start(job());
/// }
/// # }
/// ```
#[derive(Debug)]
pub struct BackgroundJudge {
    threads: ThreadPool,
    work: Option<Work>,
}

/// A picture that is being judged.
#[derive(Debug)]
struct Work {
    is_given_up: Arc<AtomicBool>,
    result: Receiver<Result<JudgeResult>>,
}

impl Drop for Work {
    fn drop(&mut self) {
        self.is_given_up.store(true, Ordering::Relaxed);
    }
}

impl BackgroundJudge {
    /// Creates a judge with one thread less than there are cores, and at least one thread.
    ///
    /// # Errors
    ///
    /// If the system cannot start threads.
    pub fn new() -> Result<Self> {
        let cores = thread::available_parallelism().map_or(1, Into::into);
        let threads = ThreadPoolBuilder::new()
            .num_threads(cores.saturating_sub(1).max(1))
            .thread_name(|index| format!("judge {index}"))
            .build()
            .context("the threads that judge pictures cannot be started")?;
        Ok(Self { threads, work: None })
    }

    /// Starts to judge a picture, and cancels the previous one if it is not done.
    pub fn start(&mut self, job: JudgeJob) {
        let is_given_up = Arc::new(AtomicBool::new(false));
        let (sender, result) = channel();
        self.work = Some(Work { is_given_up: Arc::clone(&is_given_up), result });
        self.threads.spawn(move || {
            let goes_on = || !is_given_up.load(Ordering::Relaxed);
            let judged = catch_unwind(AssertUnwindSafe(|| job.judge(goes_on)));
            let judged = judged.unwrap_or_else(|panic| Err(anyhow!("judging this picture failed: {}", text(&*panic))));
            // If the picture was cancelled, there is no receiver.
            let _ = sender.send(judged);
        });
    }

    /// Cancels the current picture. [`Self::take`] then returns no result for it.
    pub fn give_up(&mut self) {
        self.work = None;
    }

    /// Returns whether a picture is being judged or a result can be taken.
    pub fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// Takes the judged picture without waiting. Returns `None` if it is not done.
    ///
    /// # Errors
    ///
    /// If the parts of the job do not fit together, or judging failed.
    pub fn take(&mut self) -> Option<Result<JudgeResult>> {
        let result = match self.work.as_ref()?.result.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Ok(result) => result,
            Err(TryRecvError::Disconnected) => Err(anyhow!("judging this picture ended without a result")),
        };
        self.work = None;
        Some(result)
    }
}

impl JudgeJob {
    /// Judges the picture while `goes_on` returns `true`.
    fn judge(&self, goes_on: impl Fn() -> bool + Sync) -> Result<JudgeResult> {
        let start = Instant::now();
        self.check()?;
        let judge = |truth: &Truth| {
            let judged = self.judge_while(truth, &goes_on)?;
            Some((classes(truth, &judged), judged))
        };
        let truth = self.trace_while(&goes_on);
        let (classes, judged) = truth.as_ref().and_then(judge).context("judging was cancelled")?;
        let seconds = start.elapsed().as_secs_f32();
        Ok(JudgeResult { judged, classes, view: self.view, judging: self.judging, seconds })
    }

    /// Returns an error if the sizes of the lists do not match.
    fn check(&self) -> Result<()> {
        let [width, height] = self.judging.size;
        let (wanted, given) = (u64::from(width) * u64::from(height), self.pixels.len());
        ensure!(given as u64 == wanted, "a picture of {width} × {height} needs {wanted} pixels, not {given}");
        let before = self.before.as_ref().map_or(given, |before| before.factors.len());
        ensure!(before == given, "the previous frame has {before} factors for {given} pixels");
        let last = (self.rays.tracer.len() as u32).checked_sub(1).and_then(|last| self.rays.instance(last));
        let instances = last.map_or(0, |last| last as usize + 1);
        let counted = self.counted.len();
        ensure!(counted >= instances, "`counted` has {counted} elements for {instances} instances");
        Ok(())
    }
}

/// Returns the texels of a judged picture.
fn classes(truth: &Truth, judged: &Judged) -> Vec<u32> {
    let bits = |pixel: usize| {
        let pixel = GpuPixel {
            class: judged.classes[pixel],
            is_lit: truth.verdict(pixel) == Some(true),
            is_in_edge_zone: judged.edge_zone[pixel],
            map_index: judged.map_index[pixel],
            pixels_per_texel: judged.pixels_per_texel[pixel],
        };
        pixel.to_bits()
    };
    (0..judged.classes.len()).map(bits).collect()
}

/// Returns the message of a panic.
fn text(panic: &(dyn Any + Send)) -> &str {
    let owned = || panic.downcast_ref::<String>().map(String::as_str);
    panic.downcast_ref::<&str>().copied().or_else(owned).unwrap_or("without a message")
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use glam::{DVec3, Vec3};
    use shadowfit::{PerspectiveCamera, ShadowFitter, Technique};
    use shadowfit_params::{BoxSource, Inputs};
    use shadowfit_render::{Gpu, Renderer};
    use shadowfit_scene::Scene;
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_testing::renderer_gpu;
    use shadowfit_truth::Class;
    use shadowfit_wgpu::ShadowMapDescriptor;

    use super::*;
    use crate::picture::FrameBefore;
    use crate::{Evaluator, PreparedScene, SceneRays, SharedTruth};

    const SIZE: [u32; 2] = [96, 54];

    /// A picture of the default scene with a coarse map, drawn and ready to be judged.
    struct Drawn {
        gpu: Gpu,
        scene: PreparedScene,
        fitter: ShadowFitter,
        evaluator: Evaluator,
    }

    /// Inputs with which the maps do not depend on previous frames.
    const UNTOLD: Inputs = Inputs { boxes: BoxSource::Clusters, visible_demand: false };

    impl Drawn {
        fn new() -> Self {
            let gpu = renderer_gpu();
            let technique = Technique::preset("focused-4").expect("a preset").with_resolution(256, 256);
            let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::from(&technique), 1).expect("a renderer");
            let scene = PreparedScene::new(&gpu, renderer.material_layout(), default_scene()).expect("the scene");
            let evaluator = Evaluator::new(renderer, Judging { size: SIZE, ..Judging::default() });
            Self { gpu, scene, fitter: ShadowFitter::new(&technique), evaluator }
        }

        fn job(&mut self, view: &View) -> JudgeJob {
            let maps = self.scene.fit_next(&mut self.fitter, UNTOLD, view).expect("maps");
            let rays = self.scene.shared_rays();
            self.evaluator.judge_job(&self.gpu, &mut self.scene, view, &maps, rays).expect("a job").0
        }

        fn judge(&mut self, view: &View) -> Judged {
            let maps = self.scene.fit_next(&mut self.fitter, UNTOLD, view).expect("maps");
            let truth = &mut SharedTruth::default();
            self.evaluator.judge(&self.gpu, &mut self.scene, view, &maps, truth).expect("judged")
        }
    }

    fn view(z: f64, is_first: bool) -> View {
        let camera = PerspectiveCamera {
            eye: DVec3::new(3.0, 2.0, z),
            forward: Vec3::new(-0.3, -0.2, -0.9),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: 150.0,
        };
        View { camera: camera.into(), direction: Vec3::new(0.4, -0.7, 0.3).normalize(), is_first }
    }

    fn wait(judge: &mut BackgroundJudge) -> Result<JudgeResult> {
        loop {
            if let Some(result) = judge.take() {
                return result;
            }
            thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn gpu_a_picture_is_judged_in_the_background_as_it_is_where_it_is_drawn_crawl_included() {
        let views = [view(9.0, true), view(8.9, false)];
        let mut here = Drawn::new();
        let wanted = views.map(|view| here.judge(&view));
        assert!(wanted[0].classes.contains(&Class::Edge) && wanted[1].tally.crawl_compared > 0);
        let (mut there, mut judge) = (Drawn::new(), BackgroundJudge::new().expect("threads"));
        for (view, wanted) in views.iter().zip(wanted) {
            judge.start(there.job(view));
            let found = wait(&mut judge).expect("judged");
            assert_eq!((found.judged.classes, found.judged.tally), (wanted.classes.clone(), wanted.tally));
            assert_eq!((found.view, found.judging.size), (*view, SIZE));
            let decoded: Vec<Class> = found.classes.iter().map(|bits| GpuPixel::from_bits(*bits).class).collect();
            assert_eq!(decoded, wanted.classes);
        }
    }

    #[test]
    fn gpu_of_two_pictures_the_later_one_is_judged_and_nothing_comes_of_what_was_given_up() {
        let mut drawn = Drawn::new();
        let jobs = [view(9.0, true), view(7.0, true)].map(|view| drawn.job(&view));
        let mut judge = BackgroundJudge::new().expect("threads");
        assert!(!judge.is_busy() && judge.take().is_none());
        for job in jobs.clone() {
            judge.start(job);
        }
        assert!(judge.is_busy());
        assert_eq!(wait(&mut judge).expect("judged").view, view(7.0, true));
        assert!(!judge.is_busy() && judge.take().is_none());
        let [job, _] = jobs;
        let given_up = job.judge(|| false).expect_err("it was cancelled");
        assert_eq!(given_up.to_string(), "judging was cancelled");
        judge.start(job);
        let is_given_up = judge.work.as_ref().map(|work| Arc::clone(&work.is_given_up)).expect("it works");
        judge.give_up();
        assert!(is_given_up.load(Ordering::Relaxed), "the threads see the cancellation");
        assert!(!judge.is_busy() && judge.take().is_none());
    }

    /// Returns a job of one pixel of sky.
    fn sky() -> JudgeJob {
        let scene = Scene::from_objects("one", &[vec![[Vec3::ZERO, Vec3::X, Vec3::Y]]]);
        JudgeJob {
            rays: Arc::new(SceneRays::from_origin(&scene, &scene.pose(None, 0.0), DVec3::ZERO)),
            pixels: vec![None],
            view: view(9.0, true),
            judging: Judging { size: [1, 1], ..Judging::default() },
            maps: Vec::new(),
            descriptor: ShadowMapDescriptor::default(),
            counted: vec![true],
            before: None,
            traced: None,
        }
    }

    #[test]
    fn jobs_that_do_not_fit_together_are_refused_in_words() {
        let good = sky();
        let too_few = FrameBefore { maps: Vec::new(), eye: DVec3::ZERO, forward: Vec3::Z, factors: Vec::new() };
        let mut judge = BackgroundJudge::new().expect("threads");
        for (job, words) in [
            (JudgeJob { pixels: vec![None; 2], ..good.clone() }, "1 × 1 needs 1 pixels, not 2"),
            (JudgeJob { before: Some(too_few), ..good.clone() }, "0 factors for 1 pixels"),
            (JudgeJob { counted: Vec::new(), ..good.clone() }, "`counted` has 0 elements for 1 instances"),
        ] {
            judge.start(job);
            let error = wait(&mut judge).expect_err(words);
            assert!(error.to_string().contains(words), "{error}");
        }
        judge.start(good);
        assert!(wait(&mut judge).expect("the sky").judged.tally.is_empty());
    }

    #[test]
    fn what_a_panic_says_is_kept() {
        let panic = |panic: fn()| catch_unwind(panic).expect_err("it panics");
        assert_eq!(text(&*panic(|| panic!("no such map"))), "no such map");
        assert_eq!(text(&*panic(|| std::panic::panic_any("map 7".to_owned()))), "map 7");
        assert_eq!(text(&*panic(|| std::panic::panic_any(3))), "without a message");
    }
}
