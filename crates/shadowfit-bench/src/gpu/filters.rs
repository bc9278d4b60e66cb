//! Time of the look-up with each filter and format.

use anyhow::Result;
use shadowfit::Technique;
use shadowfit::settings::{FilterKind, MapFormat};

use super::Bench;
use super::engine::Engine;
use super::fullscreen::Fullscreen;
use super::scene::BenchScene;
use super::timer::Timer;
use crate::table::{Table, ms, share};
use crate::times::median;

/// Frames until windows are settled.
const SETTLED: usize = 60;

/// A filter and a format.
struct Case {
    name: &'static str,
    filter: FilterKind,
    format: MapFormat,
    /// Whether discs are rotated from pixel to pixel.
    is_turned: bool,
}

const fn case(name: &'static str, filter: FilterKind, format: MapFormat) -> Case {
    Case { name, filter, format, is_turned: true }
}

const CASES: [Case; 13] = [
    case("hardware 2×2", FilterKind::Hardware2x2, MapFormat::Depth32Float),
    case("point", FilterKind::Point, MapFormat::Depth32Float),
    case("PCF 3×3", FilterKind::Pcf3x3, MapFormat::Depth32Float),
    case("PCF 5×5", FilterKind::Pcf5x5, MapFormat::Depth32Float),
    case("PCF 7×7", FilterKind::Pcf7x7, MapFormat::Depth32Float),
    case("Vogel disc, 8", FilterKind::Vogel8, MapFormat::Depth32Float),
    case("Vogel disc, 16", FilterKind::Vogel16, MapFormat::Depth32Float),
    case("Vogel disc, 32", FilterKind::Vogel32, MapFormat::Depth32Float),
    case("PCSS", FilterKind::Pcss, MapFormat::Depth32Float),
    Case { is_turned: false, ..case("Vogel disc, 16, not turned", FilterKind::Vogel16, MapFormat::Depth32Float) },
    case("Vogel disc, 16, Depth16Unorm", FilterKind::Vogel16, MapFormat::Depth16Unorm),
    case("PCF 5×5, Depth16Unorm", FilterKind::Pcf5x5, MapFormat::Depth16Unorm),
    case("PCF 5×5, R32Float", FilterKind::Pcf5x5, MapFormat::R32Float),
];

pub(crate) fn time(bench: &Bench, scene: &BenchScene) -> Result<Table> {
    let mut rows = Vec::new();
    let mut unit = 0.0;
    for case in CASES {
        let (whole, positions) = of_filter(bench, scene, &case)?;
        unit = if rows.is_empty() { whole } else { unit };
        rows.push(vec![case.name.to_owned(), ms(whole), share(whole, unit), ms(whole - positions)]);
    }
    Ok(Table {
        title: "The look-up",
        note: format!(
            "A full-screen triangle over 1920 × 1080 pixels of the {} that computes positions from the depth buffer, \
             and only `shadowfit_factor_at`: as a whole, relative to the hardware's 2×2, and without the time of \
             positions and normals.",
            scene.name
        ),
        columns: ["filter", "time", "of 2×2", "look-up alone"].map(str::to_owned).to_vec(),
        rows,
    })
}

/// Returns the time of the pass, and without the look-up.
fn of_filter(bench: &Bench, scene: &BenchScene, case: &Case) -> Result<(f64, f64)> {
    let gpu = &bench.gpu;
    let technique =
        Technique::default().with_filter(case.filter).with_format(case.format).with_resolution(bench.map, bench.map);
    let mut engine = Engine::new(gpu, scene, &technique)?;
    let mut timer = Timer::new(gpu);
    let frames = if gpu.is_software() { 3 } else { SETTLED };
    for _ in 0..frames {
        engine.update(0)?;
        let camera = engine.camera(0);
        timer.frame(gpu, |encoder, _| {
            engine.shadow_passes(encoder, None);
            engine.seen_pass(encoder, &camera)
        })?;
    }
    let camera = engine.camera(0);
    let whole = Fullscreen::new(gpu, Some((engine.sun.map(), case.is_turned)), &camera, &engine.depth);
    let bare = Fullscreen::new(gpu, None, &camera, &engine.depth);
    let mut times = [Vec::new(), Vec::new()];
    for frame in 0..bench.frames + bench.frames / 5 {
        let both = [
            timer.frame(gpu, |encoder, times| {
                whole.record(encoder, Some(engine.sun.map()), times);
                Ok(())
            })?,
            timer.frame(gpu, |encoder, times| {
                bare.record(encoder, None, times);
                Ok(())
            })?,
        ];
        if frame >= bench.frames / 5 {
            times.iter_mut().zip(both).for_each(|(times, time)| times.push(time));
        }
    }
    let [whole, positions] = times.map(median);
    Ok((whole, positions))
}
