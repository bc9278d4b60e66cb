//! Frames without a window: the picture set, and scripts.

pub(crate) mod device_check;
mod sample;
mod timings;

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use egui::{Pos2, RawInput, Rect, vec2};
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit_egui::Artefact;
use shadowfit_params::tool::{ErrorMarks, InsetMaps, ViewMode};
use shadowfit_render::{Gpu, own_time};
use shadowfit_scene::Scene;
use shadowfit_study::make_folder;

use crate::arguments::{Arguments, check_animation};
use crate::interface::{Canvas, Interface, InterfaceInput};
use crate::keep::picture_file::write_png;
use crate::keep::saved::Saved;
use crate::platform::output;
use crate::scene_source::SceneSource;
use crate::stage::{Stage, compared_with};
use crate::viewer::{Renewals, Start, Viewer};
use timings::Timings;

/// Number of pictures of a scene.
pub const PICTURES: usize = 24;
/// How often the bar tells how much time has passed.
const TICK: Duration = Duration::from_millis(250);
/// Samples per pixel of headless pictures.
const SAMPLES: u32 = 4;
/// Time of the animation at which the pictures are taken, in seconds.
const PICTURE_TIME: f32 = 0.0;
/// Time of a frame of a script, in seconds.
const FRAME: f32 = 1.0 / 60.0;
/// Frames that egui needs until a layout is stable.
const SETTLING: u32 = 4;
/// Format of headless frames.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Renders the pictures that the arguments ask for and prints each one's name when it is written. Notes of the import go
/// to the standard error. Nothing is restored from the last time, and nothing is saved for the next one.
pub(crate) fn run(arguments: &Arguments, folder: &Path) -> Result<()> {
    make_folder(folder)?;
    if arguments.script.is_some() {
        return play(arguments, folder);
    }
    if let Some(SceneSource::Sample { sample, variant }) = arguments.source()? {
        return sample::run(arguments, (sample, variant), folder);
    }
    let scene = load_scene(arguments)?;
    if let Some(file) = &arguments.scene {
        scene.warnings(file).for_each(output::tell);
    }
    let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
    let mut stage = Stage::new(gpu, scene, SAMPLES)?;
    let mut settings = stage.settings;
    stage.choose_camera(arguments.settings(), &mut settings);
    arguments.apply(&mut settings)?;
    stage.restore_settings(&settings);
    stage.animation = arguments.animation;
    stage.set_home();
    let mut progress = Progress::begin(PICTURES, &stage.scene().name, &stage, folder)?;
    let gpu = stage.gpu().clone();
    let size = arguments.size();
    gpu.unless_lost(|| render_pictures(&mut stage, folder, size, &mut |path| progress.wrote(path)))
        .context("the graphics device was lost; start again, with smaller pictures if it was too slow")??;
    progress.end()
}

/// Loads the scene that the arguments name.
///
/// # Errors
///
/// If the file cannot be loaded, or has no scene or animation of the requested index.
fn load_scene(arguments: &Arguments) -> Result<Scene> {
    let scene = pollster::block_on(arguments.source()?.unwrap_or_default().load(&|_, _| ()))?;
    check_animation(arguments.animation, scene.animations.len(), &scene.name)?;
    Ok(scene)
}

/// Tells of pictures while they are rendered: each one's name on the standard output as soon as it is written, and how
/// long the rest will take on the standard error, if that is a terminal.
struct Progress {
    bar: ProgressBar,
    count: usize,
    written: usize,
    /// The first error of the lines that were printed.
    printed: Result<()>,
}

impl Progress {
    fn begin(count: usize, name: &str, stage: &Stage, folder: &Path) -> Result<Self> {
        let noun = if count == 1 { "picture" } else { "pictures" };
        output::print(format_args!("{count} {noun} of {name} by {}, in {}:\n", stage.gpu().name(), folder.display()))?;
        let bar = ProgressBar::new(count as u64);
        bar.set_style(ProgressStyle::with_template("{wide_bar} {pos}/{len} pictures, {elapsed} so far, {eta} left")?);
        bar.enable_steady_tick(TICK);
        Ok(Self { bar, count, written: 0, printed: Ok(()) })
    }

    fn wrote(&mut self, path: &Path) {
        self.written += 1;
        self.bar.inc(1);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let line = format!("  {}/{} {name}\n", self.written, self.count);
        let printed = self.bar.suspend(|| output::print(line));
        if self.printed.is_ok() {
            self.printed = printed;
        }
    }

    /// Returns the first error of the lines that were printed.
    fn end(mut self) -> Result<()> {
        std::mem::replace(&mut self.printed, Ok(()))
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Plays a script without a window; the files that it saves are put into the folder.
fn play(arguments: &Arguments, folder: &Path) -> Result<()> {
    let mut timings = Timings::start();
    let start = Start::new(arguments)?.saving_into(folder);
    let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
    timings.step("graphics device");
    gpu.keep_faults();
    let mut renewals = Renewals::default();
    let mut stage = Stage::empty(gpu, SAMPLES)?;
    stage.read_depths();
    stage.wait_for_rays();
    timings.step("renderer");
    let mut viewer = Viewer::new(stage, FORMAT, start, None);
    let mut size = arguments.size();
    let mut canvas = Canvas::new(&viewer.stage.gpu().device, size, FORMAT);
    let mut clock = 0.0;
    timings.step("interface");
    while !viewer.has_played() && !viewer.window_requests.quit {
        let begin = Instant::now();
        let gpu = viewer.stage.gpu().clone();
        let (_, own) = own_time(|| {
            gpu.unless_lost(|| {
                let (layout, _) = viewer.frame(input(size, clock), FRAME);
                viewer.paint(&layout, &canvas.view, size);
            })
        });
        clock += f64::from(FRAME);
        if let Some(why) = gpu.lost() {
            renewals.next(&why)?;
            let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
            gpu.keep_faults();
            canvas = Canvas::new(&gpu.device, size, FORMAT);
            viewer.move_to(gpu, FORMAT, &why)?;
        }
        viewer.tell_faults();
        if let Some(wanted) = viewer.window_requests.resize.take() {
            size = wanted;
            canvas = Canvas::new(&viewer.stage.gpu().device, size, FORMAT);
        }
        if viewer.is_waiting() {
            // A software driver draws on the cores that the awaited thread needs.
            let share = if viewer.stage.gpu().is_software() { 3 * begin.elapsed() } else { Duration::ZERO };
            std::thread::sleep(share.max(Duration::from_millis(5)));
        }
        timings.frame(viewer.player.place().as_deref().unwrap_or("random actions"), own);
    }
    let ended = end(&mut viewer);
    drop((viewer, canvas));
    timings.step("end");
    if arguments.timings {
        output::tell(timings.table().trim_end());
    }
    ended
}

/// Returns the error that a script ended with.
fn end(viewer: &mut Viewer) -> Result<()> {
    match viewer.failure.take() {
        Some(failure) => Err(failure),
        None if viewer.player.failed => Err(anyhow!("the script did not end as it should")),
        None => Ok(()),
    }
}

/// egui's input for a window of a size in pixels, at a time in seconds.
fn input(size: [u32; 2], clock: f64) -> RawInput {
    RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(size[0] as f32, size[1] as f32))),
        time: Some(clock),
        ..Default::default()
    }
}

/// Pictures on their way into a folder.
struct Album<'a> {
    /// What is told of each picture that is written.
    tell: &'a mut dyn FnMut(&Path),
    stage: &'a mut Stage,
    interface: Interface,
    folder: &'a Path,
    size: [u32; 2],
    canvas: Canvas,
}

/// Renders the views of a stage into a folder, which is made if it is missing: every view, the inset, two techniques side
/// by side, each artefact shown, marked and fixed, and the whole interface dark and light. `tell` is called with the path
/// of each of these [`PICTURES`] files when it is written.
///
/// # Errors
///
/// If a file cannot be written.
pub fn render_pictures(stage: &mut Stage, folder: &Path, size: [u32; 2], tell: &mut dyn FnMut(&Path)) -> Result<()> {
    make_folder(folder)?;
    stage.reset();
    stage.wait_for_rays();
    if stage.settings.view.play {
        stage.set_time(PICTURE_TIME);
    }
    let canvas = Canvas::new(&stage.gpu().device, size, FORMAT);
    let interface = Interface::new(stage, FORMAT);
    // Nothing is caught half faded in.
    interface.context.all_styles_mut(|style| style.animation_time = 0.0);
    let mut album = Album { tell, stage, interface, folder, size, canvas };
    album.views()?;
    album.artefacts()?;
    album.windows()?;
    album.stage.reset();
    Ok(())
}

impl Album<'_> {
    /// Every view by its name.
    fn views(&mut self) -> Result<()> {
        self.interface.bare = true;
        self.judge_what_shows_it();
        let names = [
            "final",
            "truth",
            "errors",
            "pixels-per-texel",
            "maps",
            "texel-grid",
            "demand",
            "updates",
            "outside",
            "traced",
        ];
        for (mode, name) in ViewMode::ALL.into_iter().zip(names) {
            self.stage.settings.view.mode = mode;
            self.stage.settings.view.inset = InsetMaps::Off;
            self.save(name)?;
        }
        self.stage.settings.view.mode = ViewMode::Final;
        for (inset, name) in [(InsetMaps::One, "inset"), (InsetMaps::All, "inset-all")] {
            self.stage.settings.view.inset = inset;
            self.save(name)?;
        }
        self.stage.settings.view.inset = InsetMaps::Off;
        self.stage.settings.view.mode = ViewMode::Error;
        self.stage.compare_with(Some(compared_with(&self.stage.settings.technique)));
        self.save("split")?;
        self.stage.compare_with(None);
        self.stage.reset();
        Ok(())
    }

    /// Each artefact as it is shown, with its wrong pixels marked, and cured.
    fn artefacts(&mut self) -> Result<()> {
        for (artefact, name) in
            [(Artefact::Acne, "acne"), (Artefact::Aliasing, "aliasing"), (Artefact::ClippingHole, "hole")]
        {
            self.stage.show_artefact(artefact);
            self.judge_what_shows_it();
            self.stage.settings.view.inset = InsetMaps::Off;
            self.save(name)?;
            self.stage.settings.view.marks = ErrorMarks::Outline;
            self.save(&format!("{name}-marked"))?;
            self.stage.settings.view.marks = ErrorMarks::Off;
            self.stage.fix_artefact(artefact);
            self.save(&format!("{name}-fixed"))?;
        }
        self.stage.reset();
        Ok(())
    }

    /// Lets views be judged only where they show errors. Without panel no figures are seen, and judging a picture takes
    /// as long as drawing it, so that the first one comes in half the time.
    fn judge_what_shows_it(&mut self) {
        self.stage.settings.view.judge = false;
    }

    /// The whole interface.
    fn windows(&mut self) -> Result<()> {
        self.interface.bare = false;
        for (theme, name) in [(egui::Theme::Dark, "viewer"), (egui::Theme::Light, "viewer-light")] {
            self.interface.context.set_theme(theme);
            self.stage.reset();
            self.stage.show_artefact(Artefact::Acne);
            self.stage.settings.view.marks = ErrorMarks::Outline;
            self.save(name)?;
        }
        Ok(())
    }

    /// Draws until the layout is stable, and saves.
    fn save(&mut self, name: &str) -> Result<()> {
        let saved = Saved::default();
        let shown = InterfaceInput::at_rest(&saved);
        for frame in 0..SETTLING {
            let clock = f64::from(frame) * f64::from(FRAME);
            let (_, layout, _) = self.interface.layout(self.stage, &shown, input(self.size, clock));
            // Judged pictures come back with the next frame, and a legend lies in its corner in the one after that.
            if (SETTLING - 3..SETTLING - 1).contains(&frame) {
                self.interface.pictures.draw(self.stage);
            }
            self.interface.paint(self.stage, &layout, &self.canvas.view, self.size);
        }
        let path = self.folder.join(name).with_extension("png");
        write_png(&path, self.size, &self.canvas.read(self.stage.gpu())?, None)?;
        (self.tell)(&path);
        Ok(())
    }
}
