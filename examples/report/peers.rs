//! `report peers`: the measures of fit files and of the pictures that they give, as a table for people and one for
//! programs.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use glam::{DVec3, UVec2};
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat};
use shadowfit::{Bias, LightFit};
use shadowfit_render::Gpu;
use shadowfit_scene::Scene;
use shadowfit_truth::Tracer;
use shadowfit_truth::peers::{FitFile, FitMap, Frame, Scenarios, Study, overall_markdown, to_json, to_markdown};
use shadowfit_viewer::study::{Contender, Judging, SharedTruth, Shot, Subject};
use shadowfit_wgpu::{MapFit, ShadowMapDescriptor};

use crate::drawing::Drawing;
use crate::geometry::{Corners, Source};
use crate::interrupt::Interrupt;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scenes, cameras and lights
    scenarios: PathBuf,
    /// Maps that a fit made for each frame
    #[arg(required = true)]
    fits: Vec<PathBuf>,
    #[command(flatten)]
    geometry: Source,
    /// Take every Nth ray across and down for the figures of the fits: a quick look, they are approximate
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=180))]
    stride: u32,
    /// Measure the fits alone, without drawing
    #[arg(long)]
    no_render: bool,
    /// Draw every Nth frame of each path: a quick look, the figures of the pictures are approximate
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    #[command(flatten)]
    drawing: Drawing,
    /// Folder for table.json and table.md
    #[arg(short, value_name = "DIR")]
    out: PathBuf,
}

/// Measures, writes both tables, and prints the rows over all frames.
pub(crate) fn run(args: &Args, interrupt: &Interrupt) -> Result<()> {
    let mut study = Study::new(Scenarios::read(&args.scenarios)?);
    let mut files = Vec::new();
    for path in &args.fits {
        let file = FitFile::read(path)?;
        study.add(&file, path)?;
        files.push(file);
    }
    let mut pictures = if args.no_render { None } else { Some(Pictures::new(&study, &files, args)?) };
    measure(&mut study, args, pictures.as_mut(), interrupt)?;
    let tables = study.tables();
    print!("{}", overall_markdown(&tables));
    Ok(())
}

/// Measures scene after scene; both tables are written after each, so that what is finished can be read.
fn measure(study: &mut Study, args: &Args, mut pictures: Option<&mut Pictures>, interrupt: &Interrupt) -> Result<()> {
    let scenarios = study.scenarios().clone();
    let drawn = pictures.as_ref().map_or(0, |pictures| pictures.count(&scenarios));
    let progress = ProgressBar::new((scenarios.frames.len() + drawn) as u64);
    progress.set_style(ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len} frames, {eta} left")?);
    for (index, scene) in scenarios.scenes.iter().enumerate() {
        progress.set_message(scene.name.clone());
        let objects = args.geometry.read(scene)?;
        let tracer = Tracer::new(objects.iter().flatten().copied());
        study.measure_scene(index, &tracer, args.stride, &|| progress.inc(1));
        if let Some(pictures) = &mut pictures {
            pictures.draw_scene(study, index, &objects, (&progress, interrupt))?;
        }
        let tables = study.tables();
        fs::create_dir_all(&args.out).with_context(|| format!("{}: cannot be made", args.out.display()))?;
        write(&args.out.join("table.json"), &to_json(&tables))?;
        write(&args.out.join("table.md"), &to_markdown(&tables))?;
        if interrupt.is_requested() {
            break;
        }
    }
    progress.finish_and_clear();
    Ok(())
}

/// What draws all fits.
struct Pictures {
    gpu: Gpu,
    every: u32,
    bias: BiasSettings,
    fits: Vec<Drawn>,
}

/// What draws one fit.
struct Drawn {
    name: String,
    contender: Contender,
    /// Maps of each frame, in the order of the scenarios.
    maps: Vec<Vec<FitMap>>,
}

impl Pictures {
    fn new(study: &Study, files: &[FitFile], args: &Args) -> Result<Self> {
        let gpu = args.drawing.gpu()?;
        let judging = args.drawing.judging();
        let filter = args.drawing.filter();
        let bias = args.drawing.bias(filter)?;
        let fits = files.iter().zip(&args.fits).map(|(file, path)| {
            let maps = file.maps_in_order(study.scenarios(), path)?;
            let maps: Vec<Vec<FitMap>> = maps.into_iter().map(<[FitMap]>::to_vec).collect();
            let descriptor = descriptor(study.scenarios(), file, &maps, filter, args.drawing.format());
            let descriptor = descriptor.with_context(|| format!("{}: cannot be drawn", path.display()))?;
            let contender = contender(&gpu, &descriptor, judging);
            let contender = contender.with_context(|| format!("{}: cannot be drawn", path.display()))?;
            Ok(Drawn { name: file.peer.clone(), contender, maps })
        });
        let fits = fits.collect::<Result<Vec<_>>>()?;
        Ok(Self { gpu, every: args.every, bias, fits })
    }

    /// Whether a frame is drawn. Those of quick looks are not neighbours, so that they have no crawl.
    fn takes(&self, frame: &Frame) -> bool {
        frame.frame.is_multiple_of(self.every)
    }

    fn count(&self, scenarios: &Scenarios) -> usize {
        scenarios.frames.iter().filter(|frame| self.takes(frame)).count()
    }

    fn draw_scene(
        &mut self,
        study: &mut Study,
        scene: usize,
        objects: &[Vec<Corners>],
        (progress, interrupt): (&ProgressBar, &Interrupt),
    ) -> Result<()> {
        let scenarios = study.scenarios().clone();
        let Some(first) = self.fits.first() else { return Ok(()) };
        let plain = Scene::from_objects(&scenarios.scenes[scene].name, objects);
        let mut subject = Subject::new(&self.gpu, first.contender.material_layout(), plain)?;
        for (index, frame) in scenarios.frames.iter().enumerate() {
            if frame.scene != scene || !self.takes(frame) {
                continue;
            }
            if interrupt.is_requested() {
                break;
            }
            let is_first = self.every > 1 || scenarios.previous(index).is_none();
            let shot = shot(frame, is_first);
            let mut truth = SharedTruth::default();
            for (fit, drawn) in self.fits.iter_mut().enumerate() {
                let maps = map_fits(&drawn.maps[index], &shot, &self.bias)
                    .with_context(|| format!("{}: frame {}: cannot be drawn", drawn.name, frame.id))?;
                let judged = drawn.contender.judge(&self.gpu, &mut subject, &shot, &maps, &mut truth)?;
                study.add_picture(fit, index, &judged.tally);
            }
            progress.inc(1);
        }
        Ok(())
    }
}

fn contender(gpu: &Gpu, descriptor: &ShadowMapDescriptor, judging: Judging) -> Result<Contender> {
    if descriptor.depth_clamp && !gpu.has_depth_clamp() {
        anyhow::bail!("its casters are clamped to the near plane, and this graphics adapter cannot do that");
    }
    Contender::new(gpu, descriptor, judging)
}

/// The shadow map that holds all maps of a file.
fn descriptor(
    scenarios: &Scenarios,
    file: &FitFile,
    maps: &[Vec<FitMap>],
    filter: FilterKind,
    format: MapFormat,
) -> Result<ShadowMapDescriptor> {
    let most = maps.iter().map(Vec::len).max().unwrap_or(0);
    let mut resolution = [*shadowfit_wgpu::RESOLUTIONS.start(); 2];
    for map in maps.iter().flatten() {
        let size = map.size();
        resolution = [resolution[0].max(size.x as u32), resolution[1].max(size.y as u32)];
    }
    let first = maps.iter().zip(&scenarios.frames).find_map(|(maps, frame)| Some((maps.first()?, frame)));
    let depth = match first {
        Some((map, frame)) => light_fit(map, &shot(frame, true))?.depth,
        None => shadowfit::DepthConvention::ZeroToOne,
    };
    Ok(ShadowMapDescriptor { resolution, maps: most.max(1) as u32, format, filter, depth, depth_clamp: file.pancake })
}

fn shot(frame: &Frame, is_first: bool) -> Shot {
    let direction = DVec3::from_array(frame.light_dir).as_vec3();
    Shot { camera: frame.camera(), direction, is_first }
}

fn map_fits(maps: &[FitMap], shot: &Shot, bias: &BiasSettings) -> Result<Vec<MapFit>> {
    let far = |split: f64| if split >= f64::from(shot.camera.far) { f32::MAX } else { split as f32 };
    let fitted = |map: &FitMap| {
        let fit = light_fit(map, shot)?;
        Ok(MapFit { far: far(map.split_far), ..MapFit::new(fit, Bias::from_texels(bias, &fit)) })
    };
    maps.iter().map(fitted).collect()
}

fn light_fit(map: &FitMap, shot: &Shot) -> Result<LightFit> {
    let size = map.size();
    let resolution = UVec2::new(size.x as u32, size.y as u32);
    ensure!(size.max_element() <= 8192.0, "a map of {} by {} texels is too large to be drawn", size.x, size.y);
    Ok(LightFit::from_clip_from_world(&map.clip_from_world(), shot.direction, resolution, shot.camera.eye)?)
}

fn write(file: &Path, text: &str) -> Result<()> {
    fs::write(file, text).with_context(|| format!("{}: cannot be written", file.display()))
}
