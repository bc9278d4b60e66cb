//! A sun that moves all day: the cost of its shadows, and the largest jump of an edge from one frame to the
//! next.

use anyhow::{Context, Result};
use glam::{DQuat, DVec3, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit_params::tool::LightSettings;
use shadowfit_render::{Gpu, read_texture};
use shadowfit_wgpu::LightSteps;

use super::Bench;
use super::edges::{Change, Factors, Surfaces};
use super::engine::{Engine, SIZE};
use super::fullscreen::Fullscreen;
use super::scene::BenchScene;
use super::timer::Timer;
use crate::table::{Table, ms};

/// Frames of the day, as a multiple of the frames that other parts time. With 240 of them, it is a minute at
/// 60 frames a second.
const FRAMES: usize = 15;
const RATE: f64 = 60.0;

/// Frames until windows are settled. Later changes are caused by the sun.
const SETTLED: usize = 120;

/// Hour of the start, and rotation of the sun per second, in radians.
const HOUR: f32 = 10.0;
const REAL: f64 = core::f64::consts::TAU / 86_400.0;

/// A way to follow the sun.
#[derive(Clone, Copy)]
struct Way {
    name: &'static str,
    steps: Option<LightSteps>,
}

const AT_ONCE: LightSteps = LightSteps { texels: 1.0, fade: 0 };

const WAYS: [Way; 4] = [
    Way { name: "followed in each frame", steps: None },
    Way { name: "steps", steps: Some(AT_ONCE) },
    Way { name: "steps, a fade of 1 frame", steps: Some(AT_ONCE.with_fade(1)) },
    Way { name: "steps, a fade of 30 frames", steps: Some(AT_ONCE.with_fade(30)) },
];

const COLUMNS: [&str; 9] = [
    "sun, way",
    "texels, mean",
    "most",
    "GPU, mean",
    "most",
    "in the walk, mean",
    "most",
    "largest jump of an edge",
    "of a factor",
];

/// Measurements of a day.
#[derive(Default)]
struct Taken {
    /// Texels drawn in each frame.
    texels: Vec<f64>,
    /// Time of the shadow passes, in milliseconds.
    gpu: Vec<f64>,
    change: Change,
}

/// The sun of a day.
struct Sun {
    morning: DVec3,
    axis: DVec3,
    /// Radians a second.
    speed: f64,
}

impl Sun {
    fn new(speed: f64) -> Self {
        let at = |hour: f32| LightSettings { hour: Some(hour), ..LightSettings::default() }.direction().as_dvec3();
        // The sun moves along a great circle through the east.
        Self { morning: at(HOUR).normalize(), axis: at(12.0).cross(at(18.0)).normalize(), speed }
    }

    fn direction(&self, frame: usize) -> Vec3 {
        (DQuat::from_axis_angle(self.axis, self.speed * frame as f64 / RATE) * self.morning).as_vec3()
    }
}

/// A day with one way of following the sun. The camera either stands still, so that only the sun moves, or
/// walks.
#[derive(Clone, Copy)]
struct Run<'a> {
    way: Way,
    sun: &'a Sun,
    walks: bool,
}

/// The picture of factors from a camera that stands still.
struct Picture {
    pass: Fullscreen,
    surfaces: Surfaces,
    before: Factors,
}

impl Picture {
    fn new(gpu: &Gpu, engine: &Engine<'_>, camera: &PerspectiveCamera) -> Result<Self> {
        let pass = Fullscreen::new(gpu, Some((engine.sun.map(), false)), camera, &engine.depth);
        let bytes = read_texture(gpu, engine.depth.texture(), SIZE, 4).context("no depth came back")?;
        let surfaces = Surfaces::new(&bytemuck::pod_collect_to_vec(&bytes), camera, engine.direction);
        Ok(Self { pass, surfaces, before: Factors::new() })
    }

    /// Returns the change since the previous frame.
    fn change(&mut self, gpu: &Gpu, engine: &Engine<'_>, timer: &mut Timer) -> Result<Change> {
        timer.frame(gpu, |encoder, times| {
            self.pass.record(encoder, Some(engine.sun.map()), times);
            Ok(())
        })?;
        let now = read_texture(gpu, self.pass.color.texture(), SIZE, 1).context("no factors came back")?;
        let before = core::mem::replace(&mut self.before, now);
        Ok(if before.is_empty() { Change::default() } else { self.surfaces.change(&before, &self.before) })
    }
}

/// Draws a day.
fn day(bench: &Bench, scene: &BenchScene, run: &Run<'_>) -> Result<Taken> {
    let Run { way, sun, walks } = *run;
    let gpu = &bench.gpu;
    let mut engine = Engine::new(gpu, scene, &bench.technique())?;
    engine.set_light_steps(way.steps)?;
    if !walks {
        engine.stand_still();
    }
    let (mut timer, mut taken) = (Timer::new(gpu), Taken::default());
    let mut picture: Option<Picture> = None;
    let warm_up = bench.warm_up().max(SETTLED);
    for frame in 0..warm_up + bench.frames * FRAMES {
        // The sun starts to move when the windows are settled.
        engine.direction = sun.direction(frame.saturating_sub(warm_up));
        let place = if walks { frame } else { 0 };
        let camera = engine.camera(place);
        engine.update(place)?;
        let time = timer.frame(gpu, |encoder, times| {
            engine.shadow_passes(encoder, Some(times));
            Ok(())
        })?;
        timer.frame(gpu, |encoder, _| engine.seen_pass(encoder, &camera))?;
        engine.sun.wait_for_demand()?;
        if frame < warm_up {
            continue;
        }
        let regions = engine.sun.passes().flat_map(|pass| pass.regions());
        taken.texels.push(regions.map(|region| f64::from(region.scissor[2]) * f64::from(region.scissor[3])).sum());
        taken.gpu.push(time);
        if !walks {
            let picture = match &mut picture {
                Some(picture) => picture,
                None => picture.insert(Picture::new(gpu, &engine, &camera)?),
            };
            taken.change = taken.change.max(picture.change(gpu, &engine, &mut timer)?);
        }
    }
    Ok(taken)
}

/// Times all ways, at the sun's real speed and at a speed of one light step per second. Software adapters,
/// whose times mean little, only run the latter, without the walk.
pub(crate) fn time(bench: &Bench, scene: &BenchScene) -> Result<Table> {
    let fast = 2.0 * f64::from(AT_ONCE.texels) / f64::from(bench.map);
    let mut rows = Vec::new();
    let suns = [(REAL, "real"), (fast, "fast")];
    for (speed, name) in if bench.gpu.is_software() { &suns[1..] } else { &suns } {
        for way in WAYS {
            let sun = Sun::new(*speed);
            let run = Run { way, sun: &sun, walks: false };
            let stands = day(bench, scene, &run)?;
            let is_software = bench.gpu.is_software();
            let walk = if is_software { Taken::default() } else { day(bench, scene, &Run { walks: true, ..run })? };
            rows.push(vec![
                format!("{name}, {}", way.name),
                millions(mean(&stands.texels)),
                millions(greatest(&stands.texels)),
                ms(mean(&stands.gpu)),
                ms(greatest(&stands.gpu)),
                ms(mean(&walk.gpu)),
                ms(greatest(&walk.gpu)),
                format!("{:.2} px", stands.change.jump),
                format!("{:.2}", stands.change.factor),
            ]);
        }
    }
    Ok(Table {
        title: "A sun that moves all day",
        note: format!(
            "{:.0} seconds of the {} at 60 frames a second: texels drawn per frame, time of the shadow passes, and \
             the largest change between two frames in {} × {} pixels, from one place where only the sun moves. Then \
             the time along the walk, where every tenth node bobs. Real is 15° an hour, fast is one light step a \
             second, {:.3}°.",
            (bench.frames * FRAMES) as f64 / RATE,
            scene.name,
            SIZE[0],
            SIZE[1],
            fast.to_degrees()
        ),
        columns: COLUMNS.map(str::to_owned).to_vec(),
        rows,
    })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn millions(texels: f64) -> String {
    format!("{:.3} M", texels / 1e6)
}
