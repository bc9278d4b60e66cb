//! What shadows cost on a GPU: passes drawn anew and kept, culling, filters, the pass over the depth buffer, a
//! sun that moves, exact edges, rays.
//!
//! ```sh
//! cargo run --release --example gpu_cost                                   # the courtyard
//! cargo run --release --example gpu_cost -- scene.glb --out cost.md        # with a scene of its own
//! cargo xtask bench --gpu scene.glb                                        # the same, into docs/BENCHMARKS.md
//! ```
//!
//! A small engine with its own buffers and pipelines draws each scene through `SunShadows` while a camera walks at
//! 1.5 m/s and turns by 10° a second, 60 frames a second, and every tenth node bobs by half a metre once a second. Times
//! are medians by the GPU's clock, from the begin of a frame's first shadow pass to the end of the last one.

#[path = "../shared/adapter.rs"]
mod adapter;
#[path = "../shared/cuboid.rs"]
mod cuboid;
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
#[path = "../shared/table.rs"]
mod table;
mod timer;
mod traced;

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::Gpu;
use shadowfit_study::{check_place, write_whole};

use scene::BenchScene;
use table::Table;

#[derive(Parser)]
#[command(about = "Times shadows on the GPU")]
struct Args {
    /// glTF files, beside the built-in scene
    scenes: Vec<PathBuf>,
    /// Frames that are timed of each way of drawing, after a fifth as many to warm up; 240, on software adapters 5
    #[arg(long)]
    frames: Option<usize>,
    /// Where the tables are written, as Markdown
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    adapter: AdapterOptions,
    /// Width and height of the maps, in texels; some are drawn at half of it
    #[arg(long, default_value_t = 2048, value_parser = clap::value_parser!(u32).range(512..=8192))]
    map: u32,
    /// Height of the picture of exact edges, in pixels, in place of 720 and 1080
    #[arg(long, value_parser = clap::value_parser!(u32).range(36..=4320))]
    height: Option<u32>,
    /// Only these parts
    #[arg(long, value_enum, num_args = 1..)]
    only: Vec<Part>,
}

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Part {
    /// Shadow passes, drawn anew and kept
    Passes,
    /// Orders, formats and rectangles that lower the fill
    Fill,
    /// The look-up by each filter
    Filters,
    /// Culling of 10,000 instances
    Culling,
    /// A walk on which casters come and go
    Streaming,
    /// The pass over the depth buffer
    Demand,
    /// A minute of a sun that moves
    Day,
    /// Exact edges, and the instances of their rays
    Edges,
    /// Rays and classes on the GPU
    Rays,
}

/// What all parts share.
struct Bench {
    gpu: Gpu,
    frames: usize,
    map: u32,
    height: Option<u32>,
}

/// Frames on a GPU, and on software adapters, whose times say little.
const FRAMES: usize = 240;
const SOFTWARE_FRAMES: usize = 5;

fn main() -> Result<()> {
    let args = Args::parse();
    args.out.iter().try_for_each(|out| check_place(out))?;
    let gpu = adapter::open(&args.adapter);
    ensure!(
        gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        "{} cannot time its passes: it has no timestamp queries",
        gpu.name()
    );
    let usual = if gpu.is_software() { SOFTWARE_FRAMES } else { FRAMES };
    let bench = Bench { frames: args.frames.unwrap_or(usual).max(1), map: args.map, height: args.height, gpu };
    let mut scenes = vec![BenchScene::built_in()];
    for file in &args.scenes {
        scenes.push(BenchScene::load(file).with_context(|| format!("{}: cannot be drawn", file.display()))?);
    }
    let wants = |part: Part| args.only.is_empty() || args.only.contains(&part);
    let mut text = format!(
        "Measured on {}, four maps of {1} × {1} texels unless a row says otherwise.\n",
        bench.gpu.name(),
        bench.map
    );
    print!("{text}");
    let mut add = |table: Table| {
        let table = format!("\n{table}");
        print!("{table}");
        text += &table;
    };
    if wants(Part::Passes) {
        add(passes::time(&bench, &scenes)?);
    }
    if wants(Part::Fill) {
        add(passes::time_fill(&bench, &scenes)?);
    }
    if wants(Part::Culling) {
        add(field::time(&bench)?);
    }
    if wants(Part::Streaming) {
        add(streaming::time(&bench)?);
    }
    if wants(Part::Filters) {
        add(filters::time(&bench, &scenes[0])?);
    }
    if wants(Part::Demand) {
        add(passes::time_demand(&bench, &scenes)?);
    }
    if wants(Part::Day) {
        add(day::time(&bench, &scenes[0])?);
    }
    if wants(Part::Edges) {
        for scene in &scenes {
            add(traced::time(&bench, scene)?);
        }
        add(traced::time_instances(&bench)?);
    }
    if wants(Part::Rays) {
        add(rays::time(&bench, &args.scenes)?);
    }
    args.out.iter().try_for_each(|out| write_whole(out, text.as_bytes()))
}
