//! Sun shadows of Bevy's own pictures against ray-traced truth: those of Bevy's cascades and of this crate's fits.
//!
//! Every frame of five real scenes under three lights is drawn by Bevy, once without shadows and once with those of
//! each fit. What the one has and the other lacks is compared, pixel by pixel, with rays toward the light. A further
//! picture of the same view with the maps of the frame before tells how much of the shadows' edges crawls.
//!
//! ```text
//! cargo run --example report -- --shared DIR
//! cargo run --example report -- --shared DIR --scenes town,ship --lights 45 --every 5 --json report.json
//! ```
//!
//! `DIR` holds `peers/scenarios.json`, with the scenes, cameras and lights, and below `assets` the glTF files of the
//! scenes. No window is opened; a software GPU will do. Columns:
//!
//! | column | share of the pixels that face the light |
//! |---|---|
//! | `wrong %` | lit where the truth is dark or the other way round, edges included |
//! | `crawl %` | of those at shadow edges: lit differently at the same point with the maps of the frame before |
//! | `change %` | mean difference of their light to that with the maps of the frame before, edges or not |
//! | `hole %` | lit because no cascade holds what should shadow them |
//! | `uncov %`, `missed %` | in no cascade, and not in the one that Bevy's shader reads for their view depth |
//! | `false shadow %`, `false light %` | wrong away from edges: acne, and shadows that are cut short |
//!
//! The zone around an edge is as wide as the filter reaches, in texels of the map that is read. So `crawl %` of a fit
//! with finer texels is a share of fewer pixels: `change %` compares fits on the same ones.

mod contestant;
mod geometry;
mod light_maps;
mod measure;
mod pictures;
mod seen;
mod stage;
mod table;
mod view_depth;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use bevy::light::{DirectionalLight, ShadowFilteringMethod};
use clap::Parser;
use serde_json::{Value, json};
use shadowfit_truth::Tracer;
use shadowfit_truth::peers::{Frame, Scenarios};

use contestant::{Bias, Contestant, Entrant, Splits};
use measure::{Measure, Picture, Times};
use stage::{Stage, StageSettings};
use table::Measured;

/// Measures the sun shadows of Bevy's pictures against ray-traced truth.
#[derive(Clone, Debug, Parser)]
struct Arguments {
    /// Folder that holds `peers/scenarios.json` and `assets`
    #[arg(long, value_name = "DIR")]
    shared: PathBuf,
    /// Take the paths at an ordinary speed of `peers/scenarios-slow.json`, for crawl
    #[arg(long)]
    slow: bool,
    /// Names of the scenes, all by default
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,
    /// Elevations of the light, in degrees, all by default
    #[arg(long, value_delimiter = ',')]
    lights: Vec<f64>,
    /// Judge every so many frames of each path; fits that remember see no others but the one before each
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Whose cascades
    #[arg(long, value_delimiter = ',', default_values = ["bevy", "stable", "calm", "histogram", "windows"])]
    contestants: Vec<Contestant>,
    /// Whose bias; Bevy's own cascades have Bevy's
    #[arg(long, value_delimiter = ',', default_values = ["bevys", "ours"])]
    biases: Vec<Bias>,
    /// Whose bounds the cascades of this crate's fits have
    #[arg(long, default_value = "ours")]
    splits: Splits,
    /// Depth bias of lights with Bevy's bias, in metres: Bevy's default unless it is given
    #[arg(long, value_name = "METRES", default_value_t = DirectionalLight::DEFAULT_SHADOW_DEPTH_BIAS)]
    depth_bias: f32,
    /// Normal bias of lights with Bevy's bias, in diagonals of a texel: Bevy's default unless it is given
    #[arg(long, value_name = "N", default_value_t = DirectionalLight::DEFAULT_SHADOW_NORMAL_BIAS)]
    normal_bias: f32,
    /// Updates of the app for each frame, the last of which is judged: fits by depth need some until they know the view
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    settle: u32,
    /// Width and height of the pictures, in pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size)]
    size: [u32; 2],
    /// Width and height of each shadow map, in texels
    #[arg(long, value_name = "N", default_value_t = 2048)]
    map_size: u32,
    /// Bevy's filter of shadow maps
    #[arg(long, default_value = "gaussian")]
    filter: Filter,
    /// Leave crawl out, which draws each frame once more
    #[arg(long)]
    no_crawl: bool,
    /// Write all numbers to a file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the first picture of each scene and fit to a folder, also with the wrong pixels marked red
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Filter {
    /// 36 texels, weighted: Bevy's default
    Gaussian,
    /// 4 texels, weighted by the hardware
    Hardware2x2,
}

impl Filter {
    fn method(self) -> ShadowFilteringMethod {
        match self {
            Self::Gaussian => ShadowFilteringMethod::Gaussian,
            Self::Hardware2x2 => ShadowFilteringMethod::Hardware2x2,
        }
    }

    /// Greatest distance along an axis from the point that is looked up to a texel that counts, in texels.
    fn reach(self) -> f32 {
        match self {
            // Nine hardware look-ups, of which the outermost lie up to 2.25 texels from the middle texel.
            Self::Gaussian => 3.0,
            Self::Hardware2x2 => 1.0,
        }
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parts: Option<Vec<u32>> = text.split('x').map(|part| part.parse().ok().filter(|side| *side > 0)).collect();
    parts.and_then(|parts| parts.try_into().ok()).ok_or_else(|| "two numbers are wanted, such as 320x180".to_owned())
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let file = if arguments.slow { "scenarios-slow.json" } else { "scenarios.json" };
    let scenarios = Scenarios::read(&arguments.shared.join("peers").join(file))?;
    if let Some(unknown) =
        arguments.scenes.iter().find(|name| scenarios.scenes.iter().all(|scene| scene.name != **name))
    {
        return Err(format!("{file} has no scene \"{unknown}\"").into());
    }
    if let Some(folder) = &arguments.pictures {
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let start = Instant::now();
    let mut report = Report::new(arguments);
    for (index, scene) in scenarios.scenes.iter().enumerate() {
        let frames = scenarios.frames.iter().filter(|frame| frame.scene == index && is_wanted(arguments, frame));
        let is_wanted = arguments.scenes.is_empty() || arguments.scenes.contains(&scene.name);
        let frames: Vec<&Frame> = frames.collect();
        if is_wanted && !frames.is_empty() {
            let objects = geometry::read(&arguments.shared.join("assets"), scene)?;
            let tracer = Tracer::new(objects.iter().flatten().copied());
            report.stage.set_scene(&objects);
            report.measure_scene(&scene.name, &tracer, &frames)?;
        }
    }
    println!("{}", table::markdown(&report.fits));
    let seconds = start.elapsed().as_secs_f64();
    let run = report.run(seconds);
    eprintln!("{run:#}");
    if let Some(file) = &arguments.json {
        let text = format!("{:#}\n", table::json(&report.fits, run));
        std::fs::write(file, text).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}

fn is_wanted(arguments: &Arguments, frame: &Frame) -> bool {
    arguments.lights.is_empty() || arguments.lights.contains(&frame.elevation_deg)
}

/// What is measured, and with what.
struct Report<'a> {
    arguments: &'a Arguments,
    settings: StageSettings,
    stage: Stage,
    fits: Vec<Measured>,
    times: Times,
}

impl<'a> Report<'a> {
    fn new(arguments: &'a Arguments) -> Self {
        let Arguments { contestants, biases, .. } = arguments;
        let settings = StageSettings {
            size: arguments.size,
            map_size: arguments.map_size,
            filter: arguments.filter.method(),
            splits: arguments.splits,
            biases: [arguments.depth_bias, arguments.normal_bias],
        };
        let entrants = Entrant::of(contestants, biases);
        let fits = entrants.into_iter().map(|entrant| Measured { entrant, groups: Vec::new() }).collect();
        Self { arguments, settings, stage: Stage::new(&settings), fits, times: Times::default() }
    }

    /// Measures the paths of a scene.
    fn measure_scene(&mut self, scene: &str, tracer: &Tracer, frames: &[&Frame]) -> Result<(), Box<dyn Error>> {
        for (number, path) in frames.chunk_by(|a, b| a.elevation_deg == b.elevation_deg).enumerate() {
            let light = path[0].elevation_deg;
            let start = Instant::now();
            let mut measure = Measure {
                stage: &mut self.stage,
                tracer,
                settings: &self.settings,
                reach: self.arguments.filter.reach(),
                settle: self.arguments.settle,
                every: self.arguments.every as usize,
                crawl: !self.arguments.no_crawl,
                times: self.times,
            };
            let seen = measure.see(path)?;
            for fit in &mut self.fits {
                let name = format!("{scene}, {}", fit.entrant.name());
                let mut pictures = self.arguments.pictures.as_deref().filter(|_| number == 0);
                let look = |picture: &Picture| show(&mut pictures, &name, picture);
                let sums = measure.run(path, &seen, fit.entrant, look)?;
                let [wrong, crawl] = ["wrong %", "crawl %"].map(|title| sums.value(title));
                eprintln!("{name}, light at {light}: {wrong:.3}% wrong, {crawl:.2}% crawl");
                fit.groups.push((scene.to_owned(), light, sums));
            }
            self.times = measure.times;
            eprintln!("{scene}, light at {light}: {:.1} s", start.elapsed().as_secs_f64());
        }
        Ok(())
    }

    /// How the numbers were measured, and how long that took.
    fn run(&self, seconds: f64) -> Value {
        let Arguments { size, map_size, filter, depth_bias, normal_bias, settle, every, slow, .. } = self.arguments;
        let Times { drawing, tracing, judging, frames, different } = self.times;
        json!({
            "picture": size,
            "map": map_size,
            "filter": format!("{filter:?}"),
            "biases": [depth_bias.to_string(), normal_bias.to_string()],
            "updates of each frame": settle,
            "every": every,
            "slow": slow,
            "frames": frames,
            "pixels left out %": 100.0 * different / f64::from(frames.max(1)),
            "updates": self.stage.updates,
            "seconds": seconds,
            "seconds of drawing": drawing.as_secs_f64(),
            "seconds of tracing": tracing.as_secs_f64(),
            "seconds of judging": judging.as_secs_f64(),
        })
    }
}

/// Writes the first picture, and tells where its maps lie.
fn show(folder: &mut Option<&Path>, name: &str, picture: &Picture) -> Result<(), Box<dyn Error>> {
    let Some(folder) = folder.take() else { return Ok(()) };
    eprintln!("{name}: cascades end at {:?} m, texels {:?} m", picture.maps.bounds(), picture.maps.texels());
    pictures::write(folder, name, picture)
}
