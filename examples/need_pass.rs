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
use shadowfit::settings::FitSettings;
use shadowfit::{DepthConvention, need};
use shadowfit_params::tool::{CameraSettings, LightSettings};
use shadowfit_render::{AdapterChoice, Atmosphere, FlyCamera, Frame, Gpu, GpuScene, RenderTarget, Renderer};
use shadowfit_scene::{Scene, builtin, load_gltf};
use shadowfit_wgpu::ShadowMapDescriptor;
use shadowfit_wgpu::need::{NeedPass, NeedView, SeenNeed};

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
    let mut timer = Timer::new(&gpu, args.samples)?;
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
        let (times, seen) = timer.run(&gpu, &target, &seen_from)?;
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
fn described(seen: &SeenNeed) -> String {
    let counts = seen.grid().counts;
    let points: u32 = counts.iter().sum();
    let cells = counts.iter().filter(|count| **count > 0).count();
    let levels = counts.chunks(need::SIDE * need::SIDE).filter(|level| level.iter().any(|count| *count > 0)).count();
    format!("{points} | {cells} | {levels}")
}

/// Times the pass.
struct Timer {
    pass: NeedPass,
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
}

impl Timer {
    fn new(gpu: &Gpu, samples: u32) -> Result<Self> {
        let descriptor = wgpu::QuerySetDescriptor { label: None, ty: wgpu::QueryType::Timestamp, count: 2 };
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 16,
                usage,
                mapped_at_creation: false,
            })
        };
        Ok(Self {
            pass: NeedPass::new(&gpu.device, &gpu.queue, samples)?,
            queries: gpu.device.create_query_set(&descriptor),
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            read: buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
        })
    }

    /// Times of the pass over a depth buffer, in milliseconds from the shortest, and what it counts.
    fn run(&mut self, gpu: &Gpu, target: &RenderTarget, view: &NeedView) -> Result<(Vec<f64>, SeenNeed)> {
        let repeats = if gpu.is_software() { SOFTWARE_REPEATS } else { REPEATS };
        let mut times = Vec::new();
        let mut seen = None;
        for _ in 0..repeats + repeats / 5 {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let writes = wgpu::ComputePassTimestampWrites {
                query_set: &self.queries,
                beginning_of_pass_write_index: Some(0),
                end_of_pass_write_index: Some(1),
            };
            self.pass.record(&mut encoder, target.depth_view(), view, Some(writes))?;
            encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.read, 0, None);
            encoder.map_buffer_on_submit(&self.read, wgpu::MapMode::Read, .., |_| {});
            gpu.queue.submit([encoder.finish()]);
            seen = self.pass.wait()?;
            let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&self.read.get_mapped_range(..)?);
            self.read.unmap();
            times.push(f64::from(gpu.queue.get_timestamp_period()) * (ticks[1] - ticks[0]) as f64 * 1e-6);
        }
        times.drain(..repeats / 5);
        times.sort_by(f64::total_cmp);
        Ok((times, seen.context("nothing came back")?))
    }
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
