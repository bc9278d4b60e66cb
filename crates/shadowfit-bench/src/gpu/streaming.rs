//! A world that comes in at the front of a walk and goes at its back, as that of every engine does.

use anyhow::Result;
use glam::{DVec3, Vec3};
use shadowfit::Aabb;
use shadowfit_wgpu::Culling;

use super::Bench;
use super::engine::Engine;
use super::passes::{Taken, walk, way};
use super::scene::BenchScene;
use crate::table::{Table, ms, share};
use crate::times::median;

/// Houses that stand at a time, and how many of them come and go, every so many frames.
const HOUSES: u32 = 10_000;
const STEP: u32 = 60;
const FRAMES: usize = 10;

/// Houses in a row, from the middle of one to that of the next, their width, and their least and greatest height, in
/// metres.
const ROW: u32 = 100;
const APART: f32 = 3.0;
const WIDTH: f32 = 2.0;
const HEIGHTS: [f32; 2] = [2.0, 8.0];

/// Where the first row stands, behind the eye; the last of those that stand at first is 117 m ahead. In metres.
const BACK: f32 = 180.0;

/// Any number without a factor in common with [`HOUSES`]: strides through all of them out of order.
const STRIDE: u32 = 7919;

/// The walk, kept and drawn anew.
pub(crate) fn time(bench: &Bench) -> Result<Table> {
    // The few frames of software adapters would pass before anything comes or goes.
    let bench = &Bench { gpu: bench.gpu.clone(), frames: bench.frames.max(2 * FRAMES), ..*bench };
    let scene = scene((bench.frames + bench.warm_up()) / FRAMES);
    let mut rows = Vec::new();
    let mut unit: Option<[f64; 3]> = None;
    for (name, keeps) in [("anew", false), ("kept", true)] {
        let mut shown = at_first();
        let taken = walk(bench, &scene, way(name, keeps, Culling::Swept), |engine, frame| {
            stream(engine, &mut shown, frame);
        })?;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let Taken { gpu, cpu, draws, texels, .. } = taken;
        let [gpu_mean, drawn, redrawn] = [&gpu, &draws, &texels].map(|values| mean(values));
        let of = *unit.get_or_insert([gpu_mean, drawn, redrawn]);
        rows.push(vec![
            name.to_owned(),
            ms(median(gpu)),
            ms(gpu_mean),
            share(gpu_mean, of[0]),
            ms(mean(&cpu)),
            format!("{drawn:.0}"),
            share(drawn, of[1]),
            format!("{:.2} M", redrawn * 1e-6),
            share(redrawn, of[2]),
        ]);
    }
    let columns = ["way", "GPU, median", "GPU, mean", "of anew", "CPU, mean", "draws", "of anew", "texels", "of anew"];
    Ok(Table {
        title: "A world that streams in",
        note: format!(
            "{HOUSES} boxes on a ground, none of which moves. Every {FRAMES} frames {STEP} come at the front of the walk and \
             as many go at its back, from the middle of the list, so that the others get other numbers. Draws and texels \
             are means of a frame."
        ),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
    })
}

/// The ground, all houses that stand at first, and those that come `steps` times, row by row toward the front.
fn scene(steps: usize) -> BenchScene {
    let ground = Aabb::new(Vec3::new(-400.0, -0.1, -400.0), Vec3::new(400.0, 0.0, 400.0));
    let house = |number: u32| {
        let (column, row) = ((number % ROW) as f32, (number / ROW) as f32);
        let x = (column - (ROW as f32 - 1.0) * 0.5) * APART;
        let middle = Vec3::new(x, 0.0, BACK - row * APART);
        let share = (f64::from(number) * 0.618_033_988_749_895).fract() as f32;
        let height = HEIGHTS[0] + (HEIGHTS[1] - HEIGHTS[0]) * share;
        let half = Vec3::new(WIDTH, 0.0, WIDTH) * 0.5;
        Aabb::new(middle - half, middle + half + Vec3::Y * height)
    };
    let houses = (0..HOUSES + STEP * steps as u32).map(house);
    BenchScene::of_boxes("streaming", DVec3::new(0.0, 1.7, 0.0), [ground].into_iter().chain(houses))
}

/// Numbers of the casters that stand at first, out of order: the ground, which is caster 0, and the houses after it.
fn at_first() -> Vec<u32> {
    [0].into_iter().chain((0..HOUSES).map(|place| 1 + place * STRIDE % HOUSES)).collect()
}

/// What comes and goes in a frame.
fn stream(engine: &mut Engine, shown: &mut Vec<u32>, frame: usize) {
    if frame > 0 && frame.is_multiple_of(FRAMES) {
        let gone = STEP * (frame / FRAMES) as u32;
        shown.retain(|number| *number == 0 || *number > gone);
        shown.extend(1 + gone + HOUSES - STEP..1 + gone + HOUSES);
    }
    engine.show(shown);
}
