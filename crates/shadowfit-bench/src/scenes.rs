//! `shadowfit-bench scenes`: measures the cost of scenes as they grow. A row of the table has the times of
//! loading, preparation, rays, the first frame, a frame at rest and a frame in motion, and the peak memory.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::RenderTarget;
use shadowfit_scene::builtin::default_scene;
use shadowfit_scene::load_gltf;
use shadowfit_study::{PreparedScene, print};
use shadowfit_viewer::Stage;

use crate::open;
use crate::times::{median, timed};

/// Width and height of the picture, in pixels.
const SIZE: [u32; 2] = [1280, 720];
/// Samples per pixel.
const SAMPLES: u32 = 4;
/// Frames at rest and in motion. The median is printed.
const FRAMES: usize = 9;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// glTF files
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    adapter: AdapterOptions,
}

/// Heading of the table.
const HEADING: &str = "\
| scene | triangles | nodes | load s | ready s | rays s | first frame ms | frame ms | moving ms | peak MiB |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|
";

/// Prints the table, row by row.
pub(crate) fn run(args: &Args) -> Result<()> {
    // Fails before the table begins if the machine does not have the adapter. Each scene opens its own
    // device.
    open(&args.adapter)?;
    print(HEADING)?;
    for file in &args.scenes {
        print(measure(file, &args.adapter).with_context(|| file.display().to_string())?)?;
    }
    Ok(())
}

/// Measures a scene. Returns its row.
fn measure(file: &Path, adapter: &AdapterOptions) -> Result<String> {
    // Resets the peak memory.
    let _ = fs::write("/proc/self/clear_refs", "5");
    let gpu = open(adapter)?;
    let mut stage = Stage::new(gpu.clone(), default_scene(), SAMPLES)?;
    let (scene, load) = timed(|| load_gltf(file));
    let scene = scene?;
    let nodes = scene.nodes.len();
    let (prepared, ready) = timed(|| PreparedScene::new(&gpu, stage.material_layout(), scene));
    stage.set_prepared(prepared?);
    let (_, rays) = timed(|| stage.prepared_scene().shared_rays());
    stage.read_depths();
    let target = stage.target(SIZE);
    let first = frame(&mut stage, &target);
    let times = (0..FRAMES).map(|_| frame(&mut stage, &target)).collect();
    let speed = f64::from(stage.settings.camera.speed);
    let mut moving = Vec::new();
    for _ in 0..FRAMES {
        stage.camera.position.x += speed / 60.0;
        moving.push(frame(&mut stage, &target));
    }
    let triangles = stage.prepared_scene().triangles();
    let [load, ready, rays] = [load, ready, rays].map(|time| time * 1e-3);
    let [at_rest, moving] = [times, moving].map(median);
    let (name, peak) = (file.file_stem().unwrap_or_default().display(), peak());
    Ok(format!(
        "| {name} | {triangles} | {nodes} | {load:.2} | {ready:.2} | {rays:.2} | {first:.0} | {at_rest:.0} | {moving:.0} \
         | {peak} |\n",
    ))
}

/// Draws a frame and waits for it. Returns the time, in milliseconds.
fn frame(stage: &mut Stage, target: &RenderTarget) -> f64 {
    let (_, time) = timed(|| {
        stage.draw(target);
        stage.gpu().device.poll(wgpu::PollType::wait_indefinitely())
    });
    time
}

/// Returns the peak memory of this process in MiB, or 0 if the system does not report it.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) / 1024
}
