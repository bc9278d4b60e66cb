//! A world whose objects appear at the front of a walk and disappear behind it, as in many engines.

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

/// Number of houses at a time, number of houses that are replaced at once, and frames between replacements.
const HOUSES: u32 = 10_000;
const STEP: u32 = 60;
const FRAMES: usize = 10;

/// Houses in a row, distance between the middles of neighbouring houses, their width, and their least and
/// greatest height, in metres.
const ROW: u32 = 100;
const APART: f32 = 3.0;
const WIDTH: f32 = 2.0;
const HEIGHTS: [f32; 2] = [2.0, 8.0];

/// Distance of the first row behind the eye, in metres. The last initial row is 117 m ahead.
const BACK: f32 = 180.0;

/// Any number coprime to [`HOUSES`]. Its multiples visit all houses out of order.
const STRIDE: u32 = 7919;

/// Times the walk, cached and redrawn.
pub(crate) fn time(bench: &Bench) -> Result<Table> {
    // The few frames of software adapters would end before the first replacement.
    let bench = &Bench { gpu: bench.gpu.clone(), frames: bench.frames.max(2 * FRAMES), ..*bench };
    let scene = scene((bench.frames + bench.warm_up()) / FRAMES);
    let mut rows = Vec::new();
    let mut unit: Option<[f64; 3]> = None;
    for (name, keeps) in [("redrawn", false), ("cached", true)] {
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
    let columns =
        ["way", "GPU, median", "GPU, mean", "of redrawn", "CPU, mean", "draws", "of redrawn", "texels", "of redrawn"];
    Ok(Table {
        title: "A world that streams in",
        note: format!(
            "{HOUSES} static boxes on a ground. Every {FRAMES} frames, {STEP} are added at the front of the walk and \
             {STEP} are removed behind it, from the middle of the list, so the others get other numbers. Draws and \
             texels are means per frame."
        ),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
    })
}

/// Builds the ground, all initial houses, and the houses of `steps` replacements, row by row toward the
/// front.
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

/// Returns the numbers of the initial casters, out of order: the ground, which is caster 0, and the houses
/// after it.
fn at_first() -> Vec<u32> {
    [0].into_iter().chain((0..HOUSES).map(|place| 1 + place * STRIDE % HOUSES)).collect()
}

/// Replaces casters in a frame, if it is time.
fn stream(engine: &mut Engine, shown: &mut Vec<u32>, frame: usize) {
    if frame > 0 && frame.is_multiple_of(FRAMES) {
        let gone = STEP * (frame / FRAMES) as u32;
        shown.retain(|number| *number == 0 || *number > gone);
        shown.extend(1 + gone + HOUSES - STEP..1 + gone + HOUSES);
    }
    engine.show(shown);
}
