//! Compares the sun shadows in Bevy's own images with rays: with Bevy's cascades, and with the fits of this
//! crate.
//!
//! Bevy draws each frame of five scenes under three lights, once without shadows and once with each fit. The
//! report divides the images, and compares every pixel with a ray toward the light. Another image of the same
//! view, with the maps of the previous frame, shows the shadow edges that crawl.
//!
//! ```text
//! cargo run --example report -- --shared DIR
//! cargo run --example report -- --shared DIR --scenes town,ship --lights 45 --every 5 --json report.json
//! ```
//!
//! `DIR` must contain `peers/scenarios.json`, with the scenes, cameras and lights, and `assets` with the glTF
//! files of the scenes. The report opens no window, and a software GPU is enough. Columns:
//!
//! | column | share of the pixels that face the light |
//! |---|---|
//! | `wrong %` | the verdict differs from the truth, edges included |
//! | `crawl %` | of the pixels at shadow edges: the same point has another verdict with the maps of the previous frame |
//! | `change %` | mean difference of their light to the image with the maps of the previous frame, at edges and elsewhere |
//! | `hole %` | lit because no cascade contains the caster |
//! | `uncov %`, `missed %` | in no cascade, and not in the one that Bevy's shader reads for their view depth |
//! | `false shadow %`, `false light %` | wrong away from edges: acne, and truncated shadows |
//!
//! The zone around an edge has the filter's radius, in texels of the map that is read. With finer texels,
//! `crawl %` is therefore a share of fewer pixels. `change %` compares all fits on the same pixels.

mod contestant;
mod entrant;
mod light_maps;
mod stage;
#[path = "../shared/sun_maps.rs"]
mod sun_maps;
mod view_depth;

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use bevy::light::{DirectionalLight, ShadowFilteringMethod};
use clap::Parser;
use image::{Rgba, RgbaImage};
use serde_json::{Value, json};
use shadowfit_report::contestant::{JudgeSettings, JudgeTimes, JudgedPicture, Judging, LookupFilter};
use shadowfit_report::geometry::Source;
use shadowfit_report::page::overlay;
use shadowfit_report::peers::{Frame, Scenarios};

use contestant::Renderer;
use entrant::{Bias, Cascades, Entrant, Splits};
use stage::{Stage, StageSettings};

/// Measures the sun shadows of Bevy's images against ray-traced truth.
#[derive(Clone, Debug, Parser)]
struct Arguments {
    /// Folder that contains `peers/scenarios.json` and `assets`
    #[arg(long, value_name = "DIR")]
    shared: PathBuf,
    /// Use the paths at ordinary speed of `peers/scenarios-slow.json`, for crawl
    #[arg(long)]
    slow: bool,
    /// Names of the scenes [default: all]
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,
    /// Elevations of the light, in degrees [default: all]
    #[arg(long, value_delimiter = ',')]
    lights: Vec<f64>,
    /// Judge every Nth frame of each path. Fits also see the frame before each, and skip the others
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Sources of the cascades
    #[arg(long, value_delimiter = ',', default_values = ["bevy", "stable", "calm", "histogram", "windows"])]
    contestants: Vec<Cascades>,
    /// Sources of the bias; Bevy's own cascades always use Bevy's bias
    #[arg(long, value_delimiter = ',', default_values = ["bevys", "ours"])]
    biases: Vec<Bias>,
    /// Source of the bounds of this crate's fits
    #[arg(long, default_value = "ours")]
    splits: Splits,
    /// Depth bias of lights with Bevy's bias, in metres
    #[arg(long, value_name = "METRES", default_value_t = DirectionalLight::DEFAULT_SHADOW_DEPTH_BIAS)]
    depth_bias: f32,
    /// Normal bias of lights with Bevy's bias, in diagonals of a texel
    #[arg(long, value_name = "N", default_value_t = DirectionalLight::DEFAULT_SHADOW_NORMAL_BIAS)]
    normal_bias: f32,
    /// Updates of the app per frame. The last one is judged. Fits with a depth prepass need some updates
    /// before they know the view
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    settle: u32,
    /// Width and height of the images, in pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size)]
    size: [u32; 2],
    /// Width and height of each shadow map, in texels
    #[arg(long, value_name = "N", default_value_t = 2048)]
    map_size: u32,
    /// Bevy's filter of shadow maps
    #[arg(long, default_value = "gaussian")]
    filter: Filter,
    /// Leave out crawl, which needs another image per frame
    #[arg(long)]
    no_crawl: bool,
    /// Write all numbers to a file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the first image of each scene and fit to a folder, also with the wrong pixels marked red
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

    /// Returns the same filter in the report's form.
    fn lookup(self) -> LookupFilter {
        match self {
            // Nine hardware look-ups. The outermost lie up to 2.25 texels from the central texel.
            Self::Gaussian => LookupFilter::Castano13,
            Self::Hardware2x2 => LookupFilter::Hardware2x2,
        }
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parts: Option<Vec<u32>> = text.split('x').map(|part| part.parse().ok().filter(|side| *side > 0)).collect();
    parts.and_then(|parts| parts.try_into().ok()).ok_or_else(|| "expected two numbers, such as 320x180".to_owned())
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let file = if arguments.slow { "scenarios-slow.json" } else { "scenarios.json" };
    let scenarios = Scenarios::read(&arguments.shared.join("peers").join(file))?;
    let is_known = |name: &String| scenarios.scenes.iter().any(|scene| scene.name == *name);
    if let Some(unknown) = arguments.scenes.iter().find(|name| !is_known(name)) {
        bail!("{file} has no scene \"{unknown}\"");
    }
    if let Some(folder) = &arguments.pictures {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let start = Instant::now();
    let mut renderer = arguments.renderer();
    let mut judging = Judging::new(&renderer, arguments.judge_settings());
    judge(&arguments, &scenarios, &mut renderer, &mut judging)?;
    let bevy = renderer.entrants.iter().position(|entrant| *entrant == Entrant::BEVY);
    println!("{}", judging.results().to_markdown(bevy));
    let mut run = arguments.run(judging.times());
    run["updates"] = renderer.stage.updates.into();
    run["seconds"] = start.elapsed().as_secs_f64().into();
    eprintln!("{run:#}");
    if let Some(file) = &arguments.json {
        let text = format!("{:#}\n", judging.results().to_json(&run));
        std::fs::write(file, text).with_context(|| file.display().to_string())?;
    }
    Ok(())
}

/// Judges the selected frames of all scenes.
fn judge(arguments: &Arguments, scenarios: &Scenarios, renderer: &mut Renderer, judging: &mut Judging) -> Result<()> {
    let source = Source { assets: Some(arguments.shared.join("assets")), triangles: None };
    for (index, scene) in scenarios.scenes.iter().enumerate() {
        let frames = scenarios.frames.iter().filter(|frame| frame.scene == index);
        let frames: Vec<&Frame> = frames.filter(|frame| arguments.wants_light(frame)).collect();
        if frames.is_empty() || !(arguments.scenes.is_empty() || arguments.scenes.contains(&scene.name)) {
            continue;
        }
        let start = Instant::now();
        let names: Vec<String> = renderer.entrants.iter().map(Entrant::name).collect();
        let mut is_shown = vec![false; names.len()];
        let look = |picture: &JudgedPicture<'_>| {
            let name = &names[picture.technique];
            let frame = &picture.frame.id;
            eprintln!(
                "{frame}, {name}: {:.3}% wrong",
                100.0 * picture.judged.tally.share(picture.judged.tally.all.wrong)
            );
            match arguments.pictures.as_deref().filter(|_| !is_shown[picture.technique]) {
                Some(folder) => {
                    is_shown[picture.technique] = true;
                    write_pictures(folder, &format!("{}, {name}", picture.scene), picture)
                }
                None => Ok(()),
            }
        };
        judging.judge_scene(renderer, &scene.name, &source.read(scene)?, &frames, look)?;
        eprintln!("{}: {:.1} s", scene.name, start.elapsed().as_secs_f64());
    }
    Ok(())
}

impl Arguments {
    fn renderer(&self) -> Renderer {
        let settings = StageSettings {
            size: self.size,
            map_size: self.map_size,
            filter: self.filter.method(),
            splits: self.splits,
            depth_bias: self.depth_bias,
            normal_bias: self.normal_bias,
        };
        let entrants = Entrant::of(&self.contestants, &self.biases);
        Renderer { stage: Stage::new(&settings), entrants, settle: self.settle, filter: self.filter.lookup() }
    }

    fn judge_settings(&self) -> JudgeSettings {
        JudgeSettings { size: self.size, every: self.every, crawl: !self.no_crawl }
    }

    fn wants_light(&self, frame: &Frame) -> bool {
        self.lights.is_empty() || self.lights.contains(&frame.elevation_deg)
    }

    /// Returns the settings and times of the measurement.
    fn run(&self, times: JudgeTimes) -> Value {
        let JudgeTimes { drawing, tracing, judging, frames, different } = times;
        json!({
            "picture": self.size,
            "map": self.map_size,
            "filter": format!("{:?}", self.filter),
            "biases": [self.depth_bias.to_string(), self.normal_bias.to_string()],
            "updates of each frame": self.settle,
            "every": self.every,
            "slow": self.slow,
            "frames": frames,
            "pixels left out %": 100.0 * different / f64::from(frames.max(1)),
            "seconds of drawing": drawing.as_secs_f64(),
            "seconds of tracing": tracing.as_secs_f64(),
            "seconds of judging": judging.as_secs_f64(),
        })
    }
}

/// Writes an image as `<name>.png`, and with its wrong pixels marked as `<name>, wrong.png`.
fn write_pictures(folder: &Path, name: &str, picture: &JudgedPicture<'_>) -> Result<()> {
    let unshadowed = picture.unshadowed.context("Bevy's pictures are brightness")?;
    // The brightest surface without shadows is white.
    let brightest = unshadowed.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    let [width, height] = picture.truth.camera.size;
    let plain = RgbaImage::from_fn(width, height, |x, y| {
        let pixel = (y * width + x) as usize;
        let grey = srgb(picture.factors[pixel] * unshadowed[pixel] / brightest);
        Rgba([grey, grey, grey, u8::MAX])
    });
    let marked = overlay(&plain, &picture.judged.classes)?;
    for (image, name) in [(plain, name.to_owned()), (marked, format!("{name}, wrong"))] {
        let file = folder.join(format!("{name}.png"));
        image.save(&file).with_context(|| file.display().to_string())?;
    }
    Ok(())
}

/// Returns the sRGB code of a linear brightness of 0..=1.
fn srgb(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let coded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (coded * 255.0).round() as u8
}
