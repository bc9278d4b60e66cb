//! Shadow passes: redrawn and cached, with and without culling, and ways to reduce their fill.

use std::time::Instant;

use anyhow::{Context, Result};
use shadowfit::cache::UpdatedRect;
use shadowfit::scroll::TexelRect;
use shadowfit::settings::MapFormat;
use shadowfit::{Aabb, PerspectiveCamera, Technique, VisibleDemand, demand};
use shadowfit_render::GpuProfilerQuery;
use shadowfit_wgpu::demand::{DemandPass, DemandView};
use shadowfit_wgpu::{Culling, ShadowMap, ShadowMapDescriptor, SunShadows, UpdateSchedule};

use super::Bench;
use super::engine::{Engine, SIZE};
use super::scene::BenchScene;
use super::timer::Timer;
use crate::table::{Table, ms, share};
use crate::times::median;

/// A way of drawing the maps.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Way {
    name: &'static str,
    keeps: bool,
    culling: Culling,
    schedule: UpdateSchedule,
}

/// Far maps are updated in every second, fourth and eighth frame.
const FAR_MAPS_LATER: UpdateSchedule = UpdateSchedule::Every([1, 2, 4, 8, 1, 1, 1, 1]);

const WAYS: [Way; 5] = [
    way("redrawn, swept volumes", false, Culling::Swept),
    way("redrawn, whole maps", false, Culling::WholeMap),
    way("redrawn, no culling", false, Culling::Off),
    way("cached", true, Culling::Swept),
    Way { schedule: FAR_MAPS_LATER, ..way("cached, far maps later", true, Culling::Swept) },
];

pub(crate) const fn way(name: &'static str, keeps: bool, culling: Culling) -> Way {
    Way { name, keeps, culling, schedule: UpdateSchedule::EveryFrame }
}

/// Measurements of a way of drawing.
#[derive(Default)]
pub(crate) struct Taken {
    pub(crate) gpu: Vec<f64>,
    pub(crate) cpu: Vec<f64>,
    pub(crate) draws: Vec<f64>,
    /// Texels of the drawn rectangles.
    pub(crate) texels: Vec<f64>,
    /// Number of frames in which a whole layer was cleared.
    cleared: usize,
}

impl Taken {
    /// Counts the draws and texels of a frame.
    fn count(&mut self, sun: &SunShadows) {
        let draws = sun.passes().flat_map(|pass| pass.regions()).map(|region| region.casters.len());
        self.draws.push(draws.sum::<usize>() as f64);
        let texels = |update: UpdatedRect| f64::from(update.rect.size.x) * f64::from(update.rect.size.y);
        self.texels.push(sun.updates().into_iter().map(texels).sum());
        self.cleared += usize::from(sun.passes().any(|pass| pass.is_cleared()));
    }
}

impl Engine<'_> {
    /// Draws a frame without timing, and waits for its visible demand.
    fn draw_untimed(&mut self, timer: &mut Timer, camera: &PerspectiveCamera) -> Result<()> {
        timer.frame(self.gpu(), |encoder, _| {
            self.shadow_passes(encoder, None);
            self.seen_pass(encoder, camera)
        })?;
        self.sun.wait_for_demand()?;
        Ok(())
    }
}

impl Bench {
    pub(crate) fn technique(&self) -> Technique {
        Technique::default().with_resolution(self.map, self.map)
    }

    /// Returns the number of frames before the timed ones, in which windows settle.
    pub(crate) fn warm_up(&self) -> usize {
        if self.gpu.is_software() { 3 } else { self.frames / 5 + 30 }
    }
}

/// Draws frames of a scene along its walk, in one way. `stream` adds and removes casters in each frame.
pub(crate) fn walk(
    bench: &Bench,
    scene: &BenchScene,
    way: Way,
    mut stream: impl FnMut(&mut Engine, usize),
) -> Result<Taken> {
    let gpu = &bench.gpu;
    let mut engine = Engine::new(gpu, scene, &bench.technique())?;
    engine.sun.set_caching(way.keeps);
    engine.sun.set_culling(way.culling);
    engine.sun.set_schedule(way.schedule);
    let mut timer = Timer::new(gpu);
    let mut taken = Taken::default();
    for frame in 0..bench.frames + bench.warm_up() {
        let camera = engine.camera(frame);
        stream(&mut engine, frame);
        engine.move_casters(frame);
        let begin = Instant::now();
        engine.fit(&camera)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        engine.shadow_passes(&mut encoder, None);
        let recorded = encoder.finish();
        let cpu = begin.elapsed().as_secs_f64() * 1e3;
        drop(recorded);
        let time = timer.frame(gpu, |encoder, times| {
            engine.shadow_passes(encoder, Some(times));
            Ok(())
        })?;
        timer.frame(gpu, |encoder, _| engine.seen_pass(encoder, &camera))?;
        engine.sun.wait_for_demand()?;
        if frame >= bench.warm_up() {
            taken.gpu.push(time);
            taken.cpu.push(cpu);
            taken.count(&engine.sun);
        }
    }
    Ok(taken)
}

/// Times passes that are redrawn in each frame, and cached passes.
pub(crate) fn time(bench: &Bench, scenes: &[BenchScene]) -> Result<Table> {
    let mut rows = Vec::new();
    for scene in scenes {
        let mut unit = 0.0;
        for way in WAYS {
            let taken = walk(bench, scene, way, |_, _| {})?;
            let mean = taken.gpu.iter().sum::<f64>() / taken.gpu.len() as f64;
            let (cleared, frames) = (taken.cleared, taken.gpu.len());
            let gpu = median(taken.gpu);
            unit = if way == WAYS[0] { gpu } else { unit };
            rows.push(vec![
                format!("{}, {}", scene.name, way.name),
                ms(gpu),
                share(gpu, unit),
                ms(mean),
                ms(median(taken.cpu)),
                format!("{:.0}", median(taken.draws)),
                format!("{cleared} of {frames}"),
            ]);
        }
        let bare = median(bare_passes(bench, scene, Bare { order: Order::AsStored, ..BARE })?);
        rows.push(vec![
            format!("{}, bare passes", scene.name),
            ms(bare),
            share(bare, unit),
            String::new(),
            String::new(),
            String::new(),
            String::new(),
        ]);
    }
    let columns = ["scene, way", "GPU, median", "of redrawn", "GPU, mean", "CPU", "draws", "frames with a whole map"];
    Ok(Table {
        title: "Shadow passes",
        note: "Along the walk. CPU is fit, culling and encoding up to `finish`. Bare passes are cleared depth-only \
            passes with the matrices and casters of the first row, in the order of their numbers. The other rows draw \
            the casters nearest to the light first."
            .to_owned(),
        columns: columns.map(str::to_owned).to_vec(),
        rows,
    })
}

/// Order of the casters.
#[derive(Clone, Copy, PartialEq)]
enum Order {
    AsStored,
    NearestFirst,
    FarthestFirst,
}

impl Order {
    /// Sorts casters, which are given nearest first.
    fn sorted(self, mut casters: Vec<u32>) -> Vec<u32> {
        match self {
            Self::NearestFirst => {}
            Self::FarthestFirst => casters.reverse(),
            Self::AsStored => casters.sort_unstable(),
        }
        casters
    }
}

/// Shadow passes without the library, as an engine would write them.
#[derive(Clone, Copy, PartialEq)]
struct Bare {
    order: Order,
    format: MapFormat,
    /// Whether they are cut to the rectangle that the view covers.
    is_cut: bool,
    /// Whether the maps have a quarter of the texels.
    is_quarter: bool,
    is_empty: bool,
}

const BARE: Bare = Bare {
    order: Order::NearestFirst,
    format: MapFormat::Depth32Float,
    is_cut: false,
    is_quarter: false,
    is_empty: false,
};

/// Returns times of bare passes with the matrices of the walk.
fn bare_passes(bench: &Bench, scene: &BenchScene, bare: Bare) -> Result<Vec<f64>> {
    let gpu = &bench.gpu;
    let side = if bare.is_quarter { bench.map / 2 } else { bench.map };
    let technique = bench.technique().with_format(bare.format).with_resolution(side, side);
    let mut engine = Engine::new(gpu, scene, &technique)?;
    engine.sun.set_caching(false);
    let mut map = ShadowMap::new(&gpu.device, &ShadowMapDescriptor::from(&technique))?;
    let mut timer = Timer::new(gpu);
    let mut times = Vec::new();
    for frame in 0..bench.frames + bench.warm_up() {
        let camera = engine.camera(frame);
        engine.move_casters(frame);
        engine.fit(&camera)?;
        let (maps, view) = engine.maps();
        map.prepare(&gpu.queue, &view, &maps)?;
        let seen = Aabb::from_points(camera.frustum()?.corners).unwrap_or_default();
        let time = timer.frame(gpu, |encoder, times| {
            for shadow in engine.sun.passes() {
                let query = times.begin("bare", encoder);
                let writes = query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes);
                let mut pass = map.begin_pass(encoder, shadow.map(), 0, writes);
                let casters = bare.order.sorted(shadow.regions().flat_map(|region| region.casters).copied().collect());
                if bare.is_cut {
                    let rect = TexelRect::of_box(&maps[shadow.map()].projection, &seen, camera.eye);
                    pass.set_scissor_rect(rect.min.x, rect.min.y, rect.size.x, rect.size.y);
                }
                engine.draw(&mut pass, if bare.is_empty { &[] } else { &casters });
                drop(pass);
                times.end(query, encoder);
            }
            Ok(())
        })?;
        engine.draw_untimed(&mut timer, &camera)?;
        if frame >= bench.warm_up() {
            times.push(time);
        }
    }
    Ok(times)
}

/// Times ways to reduce the fill of redrawn maps.
pub(crate) fn time_fill(bench: &Bench, scenes: &[BenchScene]) -> Result<Table> {
    let ways = [
        ("casters as stored", Bare { order: Order::AsStored, ..BARE }),
        ("nearest to the light first", BARE),
        ("farthest first", Bare { order: Order::FarthestFirst, ..BARE }),
        ("nearest first, Depth16Unorm", Bare { format: MapFormat::Depth16Unorm, ..BARE }),
        ("nearest first, cut to the view", Bare { is_cut: true, ..BARE }),
        ("nearest first, a quarter of the texels", Bare { is_quarter: true, ..BARE }),
        ("empty", Bare { is_empty: true, ..BARE }),
    ];
    let mut rows = Vec::new();
    for scene in scenes {
        let mut unit = 0.0;
        for (name, bare) in ways {
            let time = median(bare_passes(bench, scene, bare)?);
            unit = if rows.len() % ways.len() == 0 { time } else { unit };
            rows.push(vec![format!("{}, {name}", scene.name), ms(time), share(time, unit)]);
        }
    }
    Ok(Table {
        title: "Fill",
        note: "Bare passes, every map redrawn, with the casters of visible shadows.".to_owned(),
        columns: ["scene, way", "time", "of the first"].map(str::to_owned).to_vec(),
        rows,
    })
}

const DEMAND_NOTE: &str = "The compute pass that counts the visible points in a depth buffer of 1920 × 1080 pixels: \
    points, cells of the grid with points, and octaves of texels with points.";

/// Times the pass over the depth buffer.
pub(crate) fn time_demand(bench: &Bench, scenes: &[BenchScene]) -> Result<Table> {
    let gpu = &bench.gpu;
    let mut rows = Vec::new();
    for scene in scenes {
        let mut engine = Engine::new(gpu, scene, &bench.technique())?;
        let mut pass = DemandPass::new(&gpu.device, &gpu.queue, 1)?;
        let mut timer = Timer::new(gpu);
        let (mut times, mut counted) = (Vec::new(), Vec::new());
        for frame in 0..bench.frames + bench.frames / 5 {
            engine.move_casters(frame);
            let camera = engine.camera(frame);
            engine.fit(&camera)?;
            timer.frame(gpu, |encoder, _| engine.seen_pass(encoder, &camera))?;
            let settings = engine.sun.technique().fit;
            let direction = BenchScene::direction();
            let depth = shadowfit::DepthConvention::Reversed;
            let view = DemandView::from_camera(&camera, depth, direction, &settings, SIZE)?;
            let time = timer.frame(gpu, |encoder, times| {
                let query = times.begin("demand", encoder);
                let writes = query.as_ref().and_then(GpuProfilerQuery::compute_pass_timestamp_writes);
                let recorded = pass.record(encoder, &engine.depth, &view, writes);
                times.end(query, encoder);
                recorded?;
                Ok(())
            })?;
            let seen = pass.wait()?.context("nothing came back")?;
            if frame >= bench.frames / 5 {
                times.push(time);
                counted.push(counts(&seen));
            }
        }
        let counted = [0, 1, 2].map(|i| format!("{:.0}", median(counted.iter().map(|counts| counts[i]).collect())));
        rows.push([vec![scene.name.clone(), ms(median(times))], counted.to_vec()].concat());
    }
    Ok(Table {
        title: "The demand grid",
        note: DEMAND_NOTE.to_owned(),
        columns: ["scene", "time", "points", "cells", "octaves"].map(str::to_owned).to_vec(),
        rows,
    })
}

/// Returns the number of points in the grid, of cells with points, and of texel octaves with points.
fn counts(seen: &VisibleDemand) -> [f64; 3] {
    let counts = seen.demand().counts;
    let has_some = |counts: &[u32]| counts.iter().any(|count| *count > 0);
    let points: u32 = counts.iter().sum();
    let cells = counts.iter().filter(|count| **count > 0).count();
    let octaves = counts.chunks(demand::SIDE * demand::SIDE).filter(|level| has_some(level)).count();
    [f64::from(points), cells as f64, octaves as f64]
}

/// Draws frames of a scene, redrawn with one kind of culling. Returns medians of the times on GPU and CPU,
/// and of the number of draws.
pub(crate) fn with_culling(bench: &Bench, scene: &BenchScene, culling: Culling) -> Result<[f64; 3]> {
    let taken = walk(bench, scene, way("", false, culling), |_, _| {})?;
    Ok([taken.gpu, taken.cpu, taken.draws].map(median))
}
