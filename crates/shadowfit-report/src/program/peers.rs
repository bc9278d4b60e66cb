//! `report peers`: measures fit files and the pictures drawn with their maps, and writes a table as Markdown
//! and as JSON.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use glam::{DVec3, UVec2};
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit::selection::DepthRange;
use shadowfit::settings::{BiasSettings, MapFormat, MapSelection};
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection};
use shadowfit_render::{Gpu, Renderer};
use shadowfit_report::geometry::{Corners, Source};
use shadowfit_report::peers::{FitFile, FitMap, Frame, Ranking, Scenarios, overall_markdown, to_json, to_markdown};
use shadowfit_scene::Scene;
use shadowfit_study::{Evaluator, Judging, PreparedScene, SharedTruth, View, make_folder, print, write_whole};
use shadowfit_truth::Tracer;
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::drawing::Drawing;
use crate::interrupt::Interrupt;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scenes, cameras and lights
    scenarios: PathBuf,
    /// Maps that a fit computed for each frame
    #[arg(required = true)]
    fits: Vec<PathBuf>,
    #[command(flatten)]
    geometry: Source,
    /// Trace every Nth ray across and down for the figures of the fits: faster and approximate
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=180))]
    stride: u32,
    /// Measure only the fits, without drawing
    #[arg(long)]
    no_render: bool,
    /// Draw every Nth frame of each path: faster; the figures of the pictures are approximate
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
    let mut ranking = Ranking::new(Scenarios::read(&args.scenarios)?);
    // Measuring takes minutes, so fail first if a scene's triangles were not given.
    for scene in &ranking.scenarios().scenes {
        args.geometry.file(scene)?;
    }
    let mut files = Vec::new();
    for path in &args.fits {
        let file = FitFile::read(path)?;
        ranking.add(&file, path)?;
        files.push(file);
    }
    let mut pictures = if args.no_render { None } else { Some(Pictures::new(&ranking, &files, args)?) };
    measure(&mut ranking, args, pictures.as_mut(), interrupt)?;
    let tables = ranking.tables();
    print(overall_markdown(&tables))
}

/// Measures all scenes. Both tables are written after each scene, so that finished scenes can be read.
fn measure(
    ranking: &mut Ranking,
    args: &Args,
    mut pictures: Option<&mut Pictures>,
    interrupt: &Interrupt,
) -> Result<()> {
    let scenarios = ranking.scenarios().clone();
    let drawn = pictures.as_ref().map_or(0, |pictures| pictures.count(&scenarios));
    let progress = ProgressBar::new((scenarios.frames.len() + drawn) as u64);
    progress.set_style(ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len} frames, {eta} left")?);
    for (index, scene) in scenarios.scenes.iter().enumerate() {
        progress.set_message(scene.name.clone());
        let objects = args.geometry.read(scene)?;
        // Create the folder after reading the scene, so that an unreadable scene leaves no folder, and before
        // measuring.
        make_folder(&args.out)?;
        let tracer = Tracer::new(objects.iter().flatten().copied());
        ranking.measure_scene(index, &tracer, args.stride, &|| progress.inc(1));
        if let Some(pictures) = &mut pictures {
            pictures.draw_scene(ranking, index, &objects, &progress, interrupt)?;
        }
        let tables = ranking.tables();
        write_whole(&args.out.join("table.json"), to_json(&tables).as_bytes())?;
        write_whole(&args.out.join("table.md"), to_markdown(&tables).as_bytes())?;
        if interrupt.is_requested() {
            break;
        }
    }
    progress.finish_and_clear();
    Ok(())
}

/// The renderer state for all fits.
struct Pictures {
    gpu: Gpu,
    every: u32,
    bias: BiasSettings,
    format: MapFormat,
    fits: Vec<Drawn>,
}

/// The renderer state for one fit.
struct Drawn {
    name: String,
    evaluator: Evaluator,
    /// Maps of each frame, in the order of the scenarios.
    maps: Vec<Vec<FitMap>>,
}

impl Pictures {
    fn new(ranking: &Ranking, files: &[FitFile], args: &Args) -> Result<Self> {
        let gpu = args.drawing.gpu()?;
        let judging = args.drawing.judging();
        let filter = args.drawing.filter();
        let bias = args.drawing.bias(filter)?;
        let fits = files.iter().zip(&args.fits).map(|(file, path)| {
            let maps = file.maps_in_order(ranking.scenarios(), path)?;
            let maps: Vec<Vec<FitMap>> = maps.into_iter().map(<[FitMap]>::to_vec).collect();
            let descriptor = descriptor(ranking.scenarios(), file, &maps, &args.drawing);
            let descriptor = descriptor.with_context(|| format!("{}: cannot be drawn", path.display()))?;
            let evaluator = evaluator(&gpu, &descriptor, judging);
            let evaluator = evaluator.with_context(|| format!("{}: cannot be drawn", path.display()))?;
            Ok(Drawn { name: file.peer.clone(), evaluator, maps })
        });
        let fits = fits.collect::<Result<Vec<_>>>()?;
        Ok(Self { gpu, every: args.every, bias, format: args.drawing.format(), fits })
    }

    /// Returns whether a frame is drawn. With a step above 1, frames are not neighbours and have no crawl.
    fn takes(&self, frame: &Frame) -> bool {
        frame.frame.is_multiple_of(self.every)
    }

    fn count(&self, scenarios: &Scenarios) -> usize {
        scenarios.frames.iter().filter(|frame| self.takes(frame)).count()
    }

    fn draw_scene(
        &mut self,
        ranking: &mut Ranking,
        scene: usize,
        objects: &[Vec<Corners>],
        progress: &ProgressBar,
        interrupt: &Interrupt,
    ) -> Result<()> {
        let scenarios = ranking.scenarios().clone();
        let Some(first) = self.fits.first() else { return Ok(()) };
        let plain = Scene::from_objects(&scenarios.scenes[scene].name, objects);
        let mut prepared = PreparedScene::new(&self.gpu, first.evaluator.renderer.material_layout(), plain)?;
        for (index, frame) in scenarios.frames.iter().enumerate() {
            if frame.scene != scene || !self.takes(frame) {
                continue;
            }
            if interrupt.is_requested() {
                break;
            }
            let is_first = self.every > 1 || scenarios.previous(index).is_none();
            let view = view(frame, is_first);
            let mut truth = SharedTruth::default();
            for (fit, drawn) in self.fits.iter_mut().enumerate() {
                let maps = map_fits(&drawn.maps[index], &view, &self.bias, self.format)
                    .with_context(|| format!("{}: frame {}: cannot be drawn", drawn.name, frame.id))?;
                let judged = drawn.evaluator.judge(&self.gpu, &mut prepared, &view, &maps, &mut truth)?;
                ranking.add_picture(fit, index, &judged.tally);
            }
            progress.inc(1);
        }
        Ok(())
    }
}

fn evaluator(gpu: &Gpu, descriptor: &ShadowMapDescriptor, judging: Judging) -> Result<Evaluator> {
    Ok(Evaluator::new(Renderer::new(gpu, descriptor, 1)?, judging))
}

/// Returns the descriptor of a shadow map with room for all maps of a file.
fn descriptor(
    scenarios: &Scenarios,
    file: &FitFile,
    maps: &[Vec<FitMap>],
    drawing: &Drawing,
) -> Result<ShadowMapDescriptor> {
    let most = maps.iter().map(Vec::len).max().unwrap_or(0);
    let mut resolution = [*shadowfit_wgpu::RESOLUTIONS.start(); 2];
    for map in maps.iter().flatten() {
        let size = map.size();
        resolution = [resolution[0].max(size.x as u32), resolution[1].max(size.y as u32)];
    }
    let first = maps.iter().zip(&scenarios.frames).find_map(|(maps, frame)| Some((maps.first()?, frame)));
    let depth = match first {
        Some((map, frame)) => light_fit(map, &view(frame, true))?.depth,
        None => DepthConvention::ZeroToOne,
    };
    Ok(ShadowMapDescriptor {
        resolution,
        maps: most.max(1) as u32,
        format: drawing.format(),
        filter: drawing.filter(),
        softness: drawing.softness(),
        selection: choice(maps),
        edges: drawing.edges().unwrap_or_default(),
        depth,
        depth_clamp: file.depth_clamp,
        ..ShadowMapDescriptor::default()
    })
}

/// Returns how the maps of a file are selected: by coverage if no map has an end (fit files of maps other
/// than cascades say so), else by view depth.
fn choice(maps: &[Vec<FitMap>]) -> MapSelection {
    let has_no_end = |map: &FitMap| map.split_far >= FitMap::NO_END;
    if maps.iter().flatten().all(has_no_end) {
        MapSelection::default()
    } else {
        MapSelection::ViewDepth { overlap: 0.0 }
    }
}

/// Returns the camera and light of a frame, for the study's pictures.
pub(crate) fn view(frame: &Frame, is_first: bool) -> View {
    let direction = DVec3::from_array(frame.light_dir).as_vec3();
    View { camera: frame.camera().into(), direction, is_first }
}

pub(crate) fn map_fits(maps: &[FitMap], view: &View, bias: &BiasSettings, format: MapFormat) -> Result<Vec<FittedMap>> {
    let depths = |map: &FitMap| {
        let is_last = map.split_far >= f64::from(view.camera.far);
        DepthRange::new(map.split_near, (!is_last).then_some(map.split_far))
    };
    let fitted = |map: &FitMap| {
        let fit = light_fit(map, view)?;
        Ok(FittedMap::new(fit, Bias::from_texels(bias, format, &fit)).with_depths(depths(map)))
    };
    maps.iter().map(fitted).collect()
}

fn light_fit(map: &FitMap, view: &View) -> Result<LightProjection> {
    let size = map.size();
    let resolution = UVec2::new(size.x as u32, size.y as u32);
    ensure!(size.max_element() <= 8192.0, "a map of {} by {} texels is too large to be drawn", size.x, size.y);
    let matrix = map.clip_from_world();
    // Files do not store the depth convention. If depth decreases along the light, it is reversed.
    let is_reversed = matrix.row(2).truncate().dot(view.direction.as_dvec3()) < 0.0;
    let depth = if is_reversed { DepthConvention::Reversed } else { DepthConvention::ZeroToOne };
    Ok(LightProjection::from_clip_from_world(&matrix, depth, view.direction, resolution, view.camera.eye)?)
}
