//! `shadowfit-report figures`: the figures of README and BENCHMARKS, on scenes that code generates. Our presets and the
//! fits of other engines are drawn by one renderer, with one filter and bias, and judged by rays.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::Gpu;
use shadowfit_report::page::{FileWriter, Output};
use shadowfit_report::peers::{FitFile, Frame};
use shadowfit_study::{Judging, PreparedScene, SharedTruth, View, make_folder, print, write_whole};

use crate::interrupt::Interrupt;

mod contestants;
mod glb;
mod measured;
mod peers_check;
mod scenes;
mod tables;

use contestants::{Contestant, Shown};
use measured::Measured;
use scenes::{FigureScene, Figures};

/// Size of the pictures on a software driver, in pixels.
const SOFTWARE_SIZE: [u32; 2] = [640, 360];
/// As above, for a quick look.
const QUICK_SIZE: [u32; 2] = [480, 270];
/// Size of the pictures on a GPU, in pixels.
const GPU_SIZE: [u32; 2] = [1280, 720];
/// Frames of a path to each one that is judged, on a software driver. All are fitted.
const SOFTWARE_STEP: u32 = 5;
/// As above, for a quick look.
const QUICK_STEP: u32 = 20;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// A quick look of less than two minutes on a software driver: one frame of each path, and the fits of
    /// the README
    #[arg(long)]
    quick: bool,
    /// Judge every Nth frame of each path [default: 1 on a GPU, 5 on a software driver, 20 with --quick]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=20))]
    every: Option<u32>,
    /// Width and height of the judged pictures, in pixels [default: 1280x720 on a GPU, 640x360 on a software driver,
    /// 480x270 with --quick]
    #[arg(long, value_name = "WxH", value_parser = crate::drawing::size)]
    size: Option<[u32; 2]>,
    /// Scene, by name; give it once for each [default: all]
    #[arg(long = "scene", value_name = "NAME")]
    scenes: Vec<String>,
    /// Only write the frames to a file of scenarios, for the fits of other programs
    #[arg(long, value_name = "FILE")]
    write_scenarios: Option<PathBuf>,
    /// Only write the frames and the scenes, as binary glTF, to a folder, for measurements in other engines
    #[arg(long, value_name = "DIR")]
    write_scenes: Option<PathBuf>,
    /// Folder with fit files that the engines' own code wrote for these frames: compares them with our versions
    #[arg(long, value_name = "DIR")]
    peers: Option<PathBuf>,
    #[command(flatten)]
    adapter: AdapterOptions,
    /// Folder for the figures
    #[arg(short, value_name = "DIR", default_value = "out/figures")]
    out: PathBuf,
}

/// Measures all contestants and writes the figures. Returns whether all frames were measured.
pub(crate) fn run(args: &Args, interrupt: &Interrupt) -> Result<bool> {
    let figures = Figures::new(&args.scenes)?;
    if let Some(file) = &args.write_scenarios {
        write_whole(file, serde_json::to_string(&figures.scenarios)?.as_bytes())?;
        print(format_args!("{}: {} frames\n", file.display(), figures.scenarios.frames.len()))?;
        return Ok(true);
    }
    if let Some(folder) = &args.write_scenes {
        make_folder(folder)?;
        write_whole(&folder.join("scenarios.json"), serde_json::to_string(&figures.scenarios)?.as_bytes())?;
        for scene in &figures.scenes {
            write_whole(&folder.join(format!("{}.glb", scene.name)), &glb::glb(&scene.scene)?)?;
        }
        print(format_args!("{}: {} scenes\n", folder.display(), figures.scenes.len()))?;
        return Ok(true);
    }
    let peers = match &args.peers {
        Some(folder) => Some(peers_check::compare(&figures.scenarios, folder)?),
        None => None,
    };
    let gpu = pollster::block_on(Gpu::headless(&args.adapter.choice()))?;
    let output = Output::create(&args.out, FileWriter { make_folder, write: write_whole })?;
    let mut study = Study::new(args, gpu, figures)?;
    study.run(&output, interrupt)?;
    let mut measured = study.measured;
    measured.notes.extend(peers.into_iter().flatten());
    measured.drop_unfinished();
    write(&measured, &args.out, &output)?;
    print(tables::overall(&measured))?;
    Ok(measured.is_finished)
}

/// Writes tables and the page.
fn write(measured: &Measured, folder: &Path, output: &Output) -> Result<()> {
    let files = [
        ("figures.csv", tables::csv(measured)),
        ("figures.md", tables::markdown(measured)),
        ("overall.md", tables::overall(measured)),
        ("short.md", tables::short(measured)),
    ];
    for (name, text) in files {
        write_whole(&folder.join(name), text.as_bytes())?;
    }
    output.write_report(&measured.run(), None)
}

/// A measurement that runs.
struct Study {
    gpu: Gpu,
    figures: Figures,
    contestants: Vec<Contestant>,
    step: u32,
    measured: Measured,
}

impl Study {
    fn new(args: &Args, gpu: Gpu, figures: Figures) -> Result<Self> {
        let software = gpu.is_software();
        let usual = match (software, args.quick) {
            (true, true) => QUICK_SIZE,
            (true, false) => SOFTWARE_SIZE,
            (false, _) => GPU_SIZE,
        };
        let size = args.size.unwrap_or(usual);
        let usual = if args.quick {
            QUICK_STEP
        } else if software {
            SOFTWARE_STEP
        } else {
            1
        };
        let step = args.every.unwrap_or(usual);
        let judging = Judging { size, flip: true, ..Judging::default() };
        let mut contestants = contestants::all(&gpu, judging)?;
        contestants.retain(|contestant| !args.quick || contestant.shown > Shown::InDetail);
        let measured = Measured::new(&gpu, size, step, &contestants);
        Ok(Self { gpu, figures, contestants, step, measured })
    }

    fn run(&mut self, output: &Output, interrupt: &Interrupt) -> Result<()> {
        let judged = self.figures.scenarios.frames.iter().filter(|frame| self.is_judged(frame)).count();
        let progress = ProgressBar::new((judged * self.contestants.len()) as u64);
        progress.set_style(ProgressStyle::with_template("{msg:20} {wide_bar} {pos}/{len} pictures, {eta} left")?);
        for index in 0..self.figures.scenes.len() {
            let FigureScene { name, scene } = self.figures.scenes[index].take();
            let layout = self.contestants[0].evaluator.renderer.material_layout();
            let mut prepared = PreparedScene::new(&self.gpu, layout, scene)?;
            self.measured.triangles += prepared.casting_triangles();
            let frames: Vec<Frame> =
                self.figures.scenarios.frames.iter().filter(|frame| frame.scene == index).cloned().collect();
            for frame in &frames {
                if interrupt.is_requested() {
                    progress.finish_and_clear();
                    return Ok(());
                }
                progress.set_message(frame.id.clone());
                self.frame(&mut prepared, &name, frame, output, &progress).with_context(|| frame.id.clone())?;
            }
        }
        progress.finish_and_clear();
        self.measured.is_finished = true;
        Ok(())
    }

    /// Frames at the end of each step, so that fits that remember earlier frames have some to remember.
    fn is_judged(&self, frame: &Frame) -> bool {
        (frame.frame + 1).is_multiple_of(self.step)
    }

    /// Fits all contestants to a frame, and judges their pictures if it is its turn.
    fn frame(
        &mut self,
        prepared: &mut PreparedScene,
        scene: &str,
        frame: &Frame,
        output: &Output,
        progress: &ProgressBar,
    ) -> Result<()> {
        let view: View = crate::peers::view(frame, frame.frame == 0);
        let is_judged = self.is_judged(frame);
        let described = &self.figures.scenarios.scenes[frame.scene];
        let mut truth = SharedTruth::default();
        if is_judged {
            self.measured.begin_frame(scene, frame);
        }
        for (place, contestant) in self.contestants.iter_mut().enumerate() {
            let maps = contestant.fit(prepared, described, frame, &view)?;
            if !is_judged {
                contestant.evaluator.note_view(&view, &maps);
                continue;
            }
            let judged = contestant.evaluator.judge(&self.gpu, prepared, &view, &maps, &mut truth)?;
            if self.figures.is_pictured(frame) && contestant.shown == Shown::WithPictures {
                let pixels = contestant.evaluator.picture(&self.gpu, prepared, &view, &maps)?;
                self.measured.add_pictures(place, pixels, &judged, output)?;
            }
            self.measured.add(place, judged.tally);
            progress.inc(1);
        }
        Ok(())
    }
}

/// Reads a fit file of a folder.
fn fit_file(folder: &Path, name: &str) -> Result<FitFile> {
    let file = folder.join(format!("{name}.json"));
    ensure!(file.exists(), "{}: there is no such file; `node fit.mjs` writes it", file.display());
    Ok(FitFile::read(&file)?)
}
