//! An engine that keeps its casters on the GPU. The maps are fitted to coarse boxes, a compute shader culls
//! the casters for each region of a shadow pass, and each region is drawn with one indirect draw. The example
//! walks through a town of 3,600 blocks without a window and prints the draws of each second.
//!
//! ```sh
//! cargo run --release --example gpu_casters
//! ```

#[path = "gpu_casters/engine.rs"]
mod engine;
#[path = "gpu_casters/town.rs"]
mod town;

use anyhow::Result;
use glam::{DVec3, Vec3};
use shadowfit::{Boxes, PerspectiveCamera, Technique};
use shadowfit_adapter::AdapterChoice;
use shadowfit_render::Gpu;
use shadowfit_wgpu::{Casters, SunFrame, SunShadows};

use engine::{Draws, GpuCasters};
use town::Town;

const SECONDS: u32 = 4;
const FRAMES_PER_SECOND: u32 = 60;
/// Walking speed of a person, in metres per second.
const WALKING_SPEED: f32 = 1.4;
/// Direction of travel of the sunlight.
const SUNLIGHT: Vec3 = Vec3::new(0.45, -0.8, 0.3);

fn main() -> Result<()> {
    // Use the adapter that the environment variable `SHADOWFIT_ADAPTER` names, or the fastest one.
    let gpu = pollster::block_on(Gpu::headless(&AdapterChoice::from_env().unwrap_or_default()))?;
    let technique = Technique::default().with_max_distance(80.0);
    let mut sun = SunShadows::new(&gpu.device, &gpu.queue, &technique.into())?;
    let mut town = Town::new(20);
    let casters = GpuCasters::new(&gpu.device, &sun, &town.blocks);
    println!("second  regions  casters drawn");
    for second in 0..SECONDS {
        let (mut regions, mut drawn) = (0, 0);
        for frame in second * FRAMES_PER_SECOND..(second + 1) * FRAMES_PER_SECOND {
            town.bob(frame);
            gpu.queue.write_buffer(&casters.casters, 0, bytemuck::cast_slice(&town.blocks));
            let draws = draw(&gpu, &mut sun, &casters, &town, frame)?;
            let counts = draws.map_or(Ok(Vec::new()), |draws| counts(&gpu, &draws))?;
            regions += counts.len();
            drawn += counts.iter().sum::<u32>();
        }
        println!("{second:>6}  {regions:>6}  {drawn:>13}");
    }
    let all = SECONDS * FRAMES_PER_SECOND * technique.maps.count() * town.blocks.len() as u32;
    println!("Without culling and caching it would be {all} casters.");
    Ok(())
}

/// Draws a frame of the maps.
fn draw(gpu: &Gpu, sun: &mut SunShadows, casters: &GpuCasters, town: &Town, frame: u32) -> Result<Option<Draws>> {
    let views = [camera(frame).frustum()?];
    let boxes = Boxes::world(&town.cells);
    let coarse = Casters { boxes, moves: &town.cells_move, keys: &[] };
    let sun_frame = SunFrame::new(&views, SUNLIGHT, boxes, coarse).with_origin(DVec3::ZERO);
    sun.update(&gpu.queue, &sun_frame)?;

    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let draws = casters.cull(&mut encoder, sun);
    sun.render(&mut encoder, 0, |pass, region| {
        if let Some(draws) = &draws {
            casters.draw(pass, region, draws);
        }
    });
    gpu.queue.submit([encoder.finish()]);
    Ok(draws)
}

fn camera(frame: u32) -> PerspectiveCamera {
    let metres = WALKING_SPEED * frame as f32 / FRAMES_PER_SECOND as f32;
    PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, f64::from(40.0 - metres)),
        forward: Vec3::new(0.1, -0.1, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 100.0,
    }
}

/// Waits for the GPU and returns the number of casters that the compute shader found for each region.
fn counts(gpu: &Gpu, draws: &Draws) -> Result<Vec<u32>> {
    let size = draws.arguments.size();
    let read = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(&draws.arguments, 0, &read, 0, size);
    gpu.queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    let arguments: Vec<[u32; 5]> = bytemuck::pod_collect_to_vec(&read.slice(..).get_mapped_range()?);
    Ok(arguments.iter().map(|[_, instances, ..]| *instances).collect())
}
