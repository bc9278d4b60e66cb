//! `shadowfit-bench gpu`: times shadows on a GPU: redrawn and cached passes, culling, filters, the pass over
//! the depth buffer, a moving sun, exact edges, rays.
//!
//! A small engine with its own buffers and pipelines draws each scene through `SunShadows`. The camera walks
//! at 1.5 m/s and turns by 10° a second, at 60 frames a second. Every tenth node bobs by half a metre once a
//! second. Times are medians by the GPU's clock, from the start of a frame's first shadow pass to the end of
//! the last one.

mod day;
mod edges;
mod engine;
mod field;
mod filters;
mod fullscreen;
mod passes;
mod rays;
mod scene;
mod streaming;
mod timer;
mod traced;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::Gpu;
use shadowfit_study::{check_place, print, write_whole};

use self::scene::BenchScene;
use crate::open;
use crate::page::Section;
use crate::table::Table;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write the tables to docs/figures/gpu.md
    #[arg(long)]
    page: bool,
    /// Take the tables from a file that `--out` wrote on another machine, without measuring
    #[arg(long, value_name = "FILE", requires = "page", conflicts_with_all = ["scenes", "out", "only"])]
    from: Option<PathBuf>,
    /// glTF files, in addition to the built-in scene
    scenes: Vec<PathBuf>,
    /// Timed frames for each way of drawing, after a warm-up of a fifth; default 240, on software adapters 5
    #[arg(long)]
    frames: Option<usize>,
    /// Markdown file for the tables
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    adapter: AdapterOptions,
    /// Width and height of the maps, in texels; some maps have half of it
    #[arg(long, default_value_t = 2048, value_parser = clap::value_parser!(u32).range(512..=8192))]
    map: u32,
    /// Height of the picture of exact edges, in pixels, in place of 720 and 1080
    #[arg(long, value_parser = clap::value_parser!(u32).range(36..=4320))]
    height: Option<u32>,
    /// Only these parts
    #[arg(long, value_enum, num_args = 1..)]
    only: Vec<Part>,
}

/// Part of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Shadow passes, redrawn and cached
    Passes,
    /// Caster orders, formats and rectangles that reduce the fill
    Fill,
    /// Culling of 10,000 instances
    Culling,
    /// A walk during which casters appear and disappear
    Streaming,
    /// The look-up with each filter
    Filters,
    /// The pass over the depth buffer
    Demand,
    /// A minute with a moving sun
    Day,
    /// Exact edges, and the instances of their rays
    Edges,
    /// Rays and classes on the GPU
    Rays,
}

/// Settings that all parts share.
struct Bench {
    gpu: Gpu,
    frames: usize,
    map: u32,
    height: Option<u32>,
}

/// Frames on a GPU, and on software adapters, whose times mean little.
const FRAMES: usize = 240;
const SOFTWARE_FRAMES: usize = 5;

impl Part {
    /// Times the part. `files` are the scenes after the first one.
    fn time(self, bench: &Bench, scenes: &[BenchScene], files: &[PathBuf]) -> Result<Vec<Table>> {
        Ok(vec![match self {
            Self::Passes => passes::time(bench, scenes)?,
            Self::Fill => passes::time_fill(bench, scenes)?,
            Self::Culling => field::time(bench)?,
            Self::Streaming => streaming::time(bench)?,
            Self::Filters => filters::time(bench, &scenes[0])?,
            Self::Demand => passes::time_demand(bench, scenes)?,
            Self::Day => day::time(bench, &scenes[0])?,
            Self::Edges => {
                let mut tables = scenes.iter().map(|scene| traced::time(bench, scene)).collect::<Result<Vec<_>>>()?;
                tables.push(traced::time_instances(bench)?);
                return Ok(tables);
            }
            Self::Rays => rays::time(bench, files)?,
        }])
    }
}

/// Times shadows, then prints and writes the tables.
pub(crate) fn run(args: &Args) -> Result<()> {
    if let Some(file) = &args.from {
        let tables = fs::read_to_string(file).with_context(|| format!("{}: cannot be read", file.display()))?;
        return Section::Gpu.publish(&tables);
    }
    args.out.iter().try_for_each(|out| check_place(out))?;
    let bench = Bench::new(args)?;
    let mut scenes = vec![BenchScene::built_in()];
    for file in &args.scenes {
        scenes.push(BenchScene::load(file).with_context(|| format!("{}: cannot be drawn", file.display()))?);
    }
    let (name, map) = (bench.gpu.name(), bench.map);
    let mut text = format!("Measured on {name}, four maps of {map} × {map} texels unless a row says otherwise.\n");
    print(&text)?;
    let wants = |part: &&Part| args.only.is_empty() || args.only.contains(part);
    for part in Part::value_variants().iter().filter(wants) {
        for table in part.time(&bench, &scenes, &args.scenes)? {
            let table = format!("\n{table}");
            print(&table)?;
            text += &table;
        }
    }
    args.out.iter().try_for_each(|out| write_whole(out, text.as_bytes()))?;
    if args.page { Section::Gpu.publish(&text) } else { Ok(()) }
}

impl Bench {
    fn new(args: &Args) -> Result<Self> {
        let gpu = open(&args.adapter)?;
        let can_time = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        ensure!(can_time, "{} cannot time its passes: it has no timestamp queries", gpu.name());
        let usual = if gpu.is_software() { SOFTWARE_FRAMES } else { FRAMES };
        Ok(Self { frames: args.frames.unwrap_or(usual).max(1), map: args.map, height: args.height, gpu })
    }
}
