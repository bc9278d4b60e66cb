//! What the need pass of `shadowfit-wgpu` counts in a depth buffer, and how long it takes on the GPU.
//!
//! ```sh
//! cargo run --release --example need_pass
//! cargo run --release --example need_pass -- scene.glb --size 3840x2160 --samples 4
//! ```
//!
//! The scene is drawn from one place in eight directions: from the built-in scene's own camera, or from the middle of a
//! file's scene. Times are those of the pass alone, by the GPU's clock.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use glam::{DVec3, Vec3};
use shadowfit::Seen;
use shadowfit::settings::FitSettings;
use shadowfit::{DepthConvention, need};
use shadowfit_params::tool::{CameraSettings, LightSettings};
use shadowfit_render::{
    AdapterChoice, Atmosphere, FlyCamera, Frame, Gpu, GpuProfilerQuery, GpuScene, GpuTimer, RenderTarget, Renderer,
};
use shadowfit_scene::{Scene, builtin, load_gltf};
use shadowfit_wgpu::ShadowMapDescriptor;
use shadowfit_wgpu::need::{NeedPass, NeedView};

#[derive(Parser)]
#[command(about = "Counts and times the need pass")]
struct Args {
    /// glTF file; the built-in scene without one
    scene: Option<PathBuf>,
    /// Width and height of the pictures, in pixels
    #[arg(long, default_value = "1920x1080", value_name = "WIDTHxHEIGHT", value_parser = size)]
    size: [u32; 2],
    /// Samples per pixel, 1 or 4
    #[arg(long, default_value_t = 1)]
    samples: u32,
    /// Draw on the software adapter, whatever GPU there is
    #[arg(long)]
    software: bool,
}

/// Directions of view, evenly around.
const VIEWS: u16 = 8;
/// Runs that are timed for each direction, after a fifth as many to warm up.
const REPEATS: usize = 200;
/// The same on software adapters, whose times say little.
const SOFTWARE_REPEATS: usize = 5;

fn main() -> Result<()> {
    let args = Args::parse();
    let choice = if args.software { AdapterChoice::Software } else { AdapterChoice::Any };
    let gpu = pollster::block_on(Gpu::headless(choice))?;
    ensure!(
        gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        "{} cannot time its passes: it has no timestamp queries",
        gpu.name()
    );
    let (scene, camera) = scene(args.scene.as_deref())?;
    let mut renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), args.samples)?;
    let mut drawn = GpuScene::new(&gpu, renderer.material_layout(), &scene, &scene.pose(None, 0.0));
    let target = renderer.target(&gpu, args.size);
    let mut pass = NeedPass::new(&gpu.device, &gpu.queue, args.samples)?;
    let (atmosphere, direction) = (Atmosphere::default(), LightSettings::default().direction());
    println!("{}: {} on {}, {} samples", scene.name, resolution(args.size), gpu.name(), args.samples);
    println!("| view | median | slowest | points | cells | octaves of texels |\n|---|---:|---:|---:|---:|---:|");
    for view in 0..VIEWS {
        let yaw = camera.yaw + f32::from(view) * core::f32::consts::TAU / f32::from(VIEWS);
        let aspect = args.size[0] as f32 / args.size[1] as f32;
        let camera = FlyCamera { yaw, ..camera }.perspective(&CameraSettings::default(), aspect);
        renderer.draw(&gpu, &mut drawn, &Frame::new(&camera, direction, &[], &atmosphere), &target)?;
        let settings = FitSettings::default();
        let seen_from = NeedView::from_camera(&camera, DepthConvention::Reversed, direction, &settings, args.size)?;
        let (times, seen) = time(&gpu, &mut pass, &target, &seen_from)?;
        let [median, slowest] = [times[times.len() / 2], times[times.len() - 1]];
        println!("| {view} | {median:.3} ms | {slowest:.3} ms | {} |", described(&seen));
    }
    Ok(())
}

/// The scene, and a place in it.
fn scene(file: Option<&std::path::Path>) -> Result<(Scene, FlyCamera)> {
    let Some(file) = file else {
        let (eye, target) = builtin::default_camera();
        return Ok((builtin::default_scene(), FlyCamera::look_at(eye.as_dvec3(), target.as_dvec3())));
    };
    let scene = load_gltf(file)?;
    let bounds = scene.bounds(&scene.pose(None, 0.0)).context("the scene has no triangles")?;
    let eye: DVec3 = ((bounds.min + bounds.max) * 0.5).as_dvec3();
    Ok((scene, FlyCamera::look_at(eye, eye + Vec3::new(0.0, -0.2, -1.0).as_dvec3())))
}

/// Points in the grid, cells that have some, and octaves of texels that do.
fn described(seen: &Seen) -> String {
    let counts = seen.need().counts;
    let points: u32 = counts.iter().sum();
    let cells = counts.iter().filter(|count| **count > 0).count();
    let levels = counts.chunks(need::SIDE * need::SIDE).filter(|level| level.iter().any(|count| *count > 0)).count();
    format!("{points} | {cells} | {levels}")
}

/// Times of the pass over a depth buffer, in milliseconds from the shortest, and what it counts.
fn time(gpu: &Gpu, pass: &mut NeedPass, target: &RenderTarget, view: &NeedView) -> Result<(Vec<f64>, Seen)> {
    let repeats = if gpu.is_software() { SOFTWARE_REPEATS } else { REPEATS };
    let mut timer = GpuTimer::new(&gpu.device, 1);
    let mut times = Vec::new();
    let mut seen = None;
    for _ in 0..repeats + repeats / 5 {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let query = timer.begin("need", &mut encoder);
        let writes = query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes);
        pass.record(&mut encoder, target.depth_view(), view, writes)?;
        timer.end(query, &mut encoder);
        timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        timer.end_frame(gpu);
        seen = pass.wait()?;
        // The wait may have returned before the times came back.
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        times.push(timer.take_ms(gpu).context("no time came back")?);
    }
    times.drain(..repeats / 5);
    times.sort_by(f64::total_cmp);
    Ok((times, seen.context("nothing came back")?))
}

fn resolution([width, height]: [u32; 2]) -> String {
    format!("{width} by {height} pixels")
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(width, height)| [width.parse(), height.parse()]);
    match sides {
        Some([Ok(width), Ok(height)]) if width > 0 && height > 0 => Ok([width, height]),
        _ => Err("expected two numbers of pixels, such as 1920x1080".to_owned()),
    }
}
