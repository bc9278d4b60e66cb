//! `shadowfit-report culling`: counts the casters and triangles of each shadow pass of a technique, once with
//! all casters that its maps can store, and once with only the casters that can throw a shadow into view.
//!
//! Prints a Markdown table of means over the first few frames of each path, without the frames that begin a
//! path.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::ValueEnum;
use glam::Vec3;
use shadowfit::{Clusters, ShadowFitter};
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::{Atmosphere, Culling, Frame, Gpu, GpuScene, MapStatistics, Renderer};
use shadowfit_report::geometry::{Corners, Source};
use shadowfit_report::peers::Scenarios;
use shadowfit_scene::Scene;
use shadowfit_study::{NamedTechnique, PreparedScene, print};
use shadowfit_wgpu::{MAX_MAPS, ShadowMapDescriptor};

use super::peers::view;

/// Heading of the table.
const HEADING: &str = "\
| scene | technique | casters by map: stored | swept | thousand triangles by map: stored | swept |
|---|---|---:|---:|---:|---:|
";

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scenes, cameras and lights
    #[arg(value_name = "SCENARIOS.json")]
    scenarios: PathBuf,
    #[command(flatten)]
    geometry: Source,
    /// Techniques, by name or as TOML files
    #[arg(long = "technique", value_name = "NAME|FILE", default_values = ["windows-4", "histogram-4"])]
    techniques: Vec<String>,
    /// Unit of culling
    #[arg(long, value_enum, default_value = "clusters")]
    casters: Casters,
    /// Number of frames of each path
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = clap::value_parser!(u32).range(2..))]
    frames: u32,
    #[command(flatten)]
    adapter: AdapterOptions,
}

/// Unit of culling.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Casters {
    /// The objects of the scenarios
    Objects,
    /// Clusters of triangles, as for the fits
    Clusters,
}

/// A scene of a file of scenarios.
struct Place<'a> {
    scenarios: &'a Scenarios,
    scene: usize,
}

/// Sums over frames of the drawn casters of each map: all that it can store, and all in the volume swept
/// from the view.
#[derive(Clone, Copy, Default)]
struct Sums {
    whole: [MapStatistics; MAX_MAPS],
    swept: [MapStatistics; MAX_MAPS],
    frames: u32,
}

/// Prints the table.
pub(crate) fn run(args: &Args) -> Result<()> {
    let scenarios = Scenarios::read(&args.scenarios)?;
    let gpu = pollster::block_on(Gpu::headless(&args.adapter.choice()))?;
    print(HEADING)?;
    for scene in 0..scenarios.scenes.len() {
        let objects = args.geometry.read(&scenarios.scenes[scene])?;
        for name in &args.techniques {
            let named = NamedTechnique::find(name)?;
            let scene_name = &scenarios.scenes[scene].name;
            let sums = measure(&gpu, args, &Place { scenarios: &scenarios, scene }, &objects, &named)
                .with_context(|| format!("{scene_name}, {name}"))?;
            let (technique, row) = (&named.name, sums.row(named.technique.maps.count()));
            print(format_args!("| {scene_name} | `{technique}` | {row} |\n"))?;
        }
    }
    Ok(())
}

/// Draws a scene's frames with a technique's maps.
fn measure(
    gpu: &Gpu,
    args: &Args,
    place: &Place<'_>,
    objects: &[Vec<Corners>],
    named: &NamedTechnique,
) -> Result<Sums> {
    let Place { scenarios, scene } = *place;
    let name = &scenarios.scenes[scene].name;
    let mut renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&named.technique), 1)?;
    let layout = renderer.material_layout();
    let prepared = PreparedScene::new(gpu, layout, Scene::from_objects(name, objects))?;
    let casters = match args.casters {
        Casters::Objects => objects.to_vec(),
        Casters::Clusters => clusters(objects)?,
    };
    let drawn = Scene::from_objects(name, &casters);
    let mut drawn = GpuScene::new(gpu, layout, &drawn, &drawn.pose(None, 0.0))?;
    // The target can be tiny: only the shadow passes are counted.
    let target = renderer.target(gpu, [1, 1]);
    let mut fitter = ShadowFitter::new(&named.technique);
    let (mut sums, atmosphere) = (Sums::default(), Atmosphere::default());
    for (index, frame) in scenarios.frames.iter().enumerate() {
        if frame.scene != scene || frame.frame >= args.frames {
            continue;
        }
        let is_first = scenarios.previous(index).is_none();
        let view = view(frame, is_first);
        let maps = prepared.fit_next(&mut fitter, named.inputs, &view)?;
        if !is_first {
            for (sums, culling) in [(&mut sums.whole, Culling::WholeMap), (&mut sums.swept, Culling::Swept)] {
                let frame = Frame { culling, ..Frame::new(view.camera, view.direction, &maps, &atmosphere) };
                add(sums, &renderer.draw(gpu, &mut drawn, &frame, &target)?.maps);
            }
            sums.frames += 1;
        }
    }
    Ok(sums)
}

/// Returns the triangles of each cluster.
fn clusters(objects: &[Vec<Corners>]) -> Result<Vec<Vec<Corners>>> {
    let slices: Vec<&[[Vec3; 3]]> = objects.iter().map(Vec::as_slice).collect();
    let clusters = Clusters::build(&slices, Clusters::DEFAULT_LIMIT)?;
    let triangle = |(object, triangle): (u32, u32)| objects[object as usize][triangle as usize];
    Ok((0..clusters.boxes().len()).map(|cluster| clusters.triangles(cluster).map(triangle).collect()).collect())
}

/// Adds the counts of each map.
fn add(sums: &mut [MapStatistics; MAX_MAPS], maps: &[MapStatistics]) {
    for (sum, map) in sums.iter_mut().zip(maps) {
        sum.casters += map.casters;
        sum.triangles += map.triangles;
    }
}

impl Sums {
    /// Returns the means as table cells, with one number per map.
    fn row(&self, maps: u32) -> String {
        let frames = f64::from(self.frames.max(1));
        let cell = |maps: &[MapStatistics], number: &dyn Fn(&MapStatistics) -> String| {
            maps.iter().map(number).collect::<Vec<_>>().join(" / ")
        };
        let casters = |map: &MapStatistics| format!("{:.0}", f64::from(map.casters) / frames);
        let thousands = |map: &MapStatistics| format!("{:.1}", map.triangles as f64 / frames / 1e3);
        let [whole, swept] = [&self.whole, &self.swept].map(|sums| &sums[..maps as usize]);
        [cell(whole, &casters), cell(swept, &casters), cell(whole, &thousands), cell(swept, &thousands)].join(" | ")
    }
}
