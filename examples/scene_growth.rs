//! What scenes cost as they grow: loading, making ready, rays, the first frame, a frame at rest and one under way, and
//! the most memory until then. One line a file, as a row of a table.
//!
//! ```sh
//! cargo run --release --example scene_growth -- --software big.glb bigger.glb
//! ```

#[path = "shared/adapter.rs"]
mod adapter;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Parser;
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::RenderTarget;
use shadowfit_scene::builtin::default_scene;
use shadowfit_scene::load_gltf;
use shadowfit_study::PreparedScene;
use shadowfit_viewer::Stage;

/// Width and height of the picture, in pixels.
const SIZE: [u32; 2] = [1280, 720];
/// Samples per pixel.
const SAMPLES: u32 = 4;
/// Frames at rest and under way, of which the median is told.
const FRAMES: usize = 9;

#[derive(Parser)]
#[command(about = "Measures the cost of scenes as they grow")]
struct Args {
    /// glTF files
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    adapter: AdapterOptions,
}

fn main() -> Result<()> {
    let args = Args::parse();
    // A machine without the adapter is refused before the table begins. Each scene opens a device of its own.
    adapter::open(&args.adapter);
    println!(
        "| scene | triangles | nodes | load s | ready s | rays s | first frame ms | frame ms | moving ms | peak MiB |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for file in &args.scenes {
        measure(file, &args.adapter).with_context(|| file.display().to_string())?;
    }
    Ok(())
}

fn measure(file: &Path, adapter: &AdapterOptions) -> Result<()> {
    // From here on, the most memory is counted anew.
    let _ = fs::write("/proc/self/clear_refs", "5");
    let gpu = adapter::open(adapter);
    let mut stage = Stage::new(gpu.clone(), default_scene(), SAMPLES)?;
    let (load, scene) = timed(|| load_gltf(file));
    let scene = scene?;
    let nodes = scene.nodes.len();
    let (ready, prepared) = timed(|| PreparedScene::new(&gpu, stage.material_layout(), scene));
    stage.set_prepared(prepared?);
    let (rays, _) = timed(|| stage.prepared_scene().shared_rays());
    stage.read_depths();
    let target = stage.target(SIZE);
    let first = frame(&mut stage, &target);
    let mut times: Vec<f64> = (0..FRAMES).map(|_| frame(&mut stage, &target)).collect();
    let speed = f64::from(stage.settings.camera.speed);
    let mut moving: Vec<f64> = Vec::new();
    for _ in 0..FRAMES {
        stage.camera.position.x += speed / 60.0;
        moving.push(frame(&mut stage, &target));
    }
    let triangles = stage.prepared_scene().triangles();
    println!(
        "| {} | {triangles} | {nodes} | {load:.2} | {ready:.2} | {rays:.2} | {:.0} | {:.0} | {:.0} | {} |",
        file.file_stem().unwrap_or_default().display(),
        first * 1e3,
        median(&mut times) * 1e3,
        median(&mut moving) * 1e3,
        peak(),
    );
    Ok(())
}

/// Draws a frame and waits for it; seconds.
fn frame(stage: &mut Stage, target: &RenderTarget) -> f64 {
    let (seconds, _) = timed(|| {
        stage.draw(target);
        stage.gpu().device.poll(wgpu::PollType::wait_indefinitely())
    });
    seconds
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let made = work();
    (start.elapsed().as_secs_f64(), made)
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The most memory of this process so far, in MiB, where the system tells it.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) / 1024
}
