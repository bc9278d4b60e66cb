//! Frames of `SunShadows` with more and more casters, some of which move, on the CPU.

use anyhow::{Context, Result};
use glam::Vec3;
use shadowfit::{Aabb, Boxes, FitInput, Seen, Technique, Windows};
use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_wgpu::{Casters, SunFrame, SunShadows};

use crate::picture::{Curve, Picture};
use crate::table::{Table, ms};
use crate::times::{LEAD, Times, timed};
use crate::town::Town;
use crate::{Extent, Found};

/// What moves in a frame, and whether the camera walks.
struct Way {
    name: &'static str,
    /// Every so many casters one moves; none if 0.
    every: usize,
    walks: bool,
}

const WAYS: [Way; 5] = [
    Way { name: "all at rest", every: 0, walks: false },
    Way { name: "the camera moves", every: 0, walks: true },
    Way { name: "and 1% of the casters", every: 100, walks: true },
    Way { name: "and 10% of them", every: 10, walks: true },
    Way { name: "and all of them", every: 1, walks: true },
];

/// Sides of the maps, in texels, and numbers of them, and casters in the town that these are tried in.
const SIDES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];
const SIDE: u32 = 2048;
const NUMBERS: [u32; 8] = [1, 2, 3, 4, 5, 6, 7, 8];
const NUMBER: u32 = 4;
const CASTERS: usize = 10_000;

/// Casters that a scene of today's engines has, beside the powers of ten.
const TYPICAL: usize = 30_000;

/// Height to which what moves bobs, in metres.
const BOB: f32 = 0.5;

/// Times of the two halves of `SunShadows::update`, and of the second one where a static caster comes.
struct Halves {
    fit: Times,
    prepare: Times,
    one_more: f64,
}

/// Times by the number of casters.
pub(crate) fn measure(extent: &Extent) -> Result<Found> {
    let gpu = open()?;
    let mut rows = Vec::new();
    let mut curves: Vec<Curve> = WAYS.iter().map(|way| Curve::new(way.name)).collect();
    let mut sizes: Vec<usize> = extent.sizes().chain([TYPICAL].into_iter().filter(|n| *n <= extent.largest)).collect();
    sizes.sort_unstable();
    let technique = Technique::default();
    for count in sizes {
        let town = Town::new(count);
        let seen = town.seen(extent.frames, &technique)?;
        for (way, curve) in WAYS.iter().zip(&mut curves) {
            let Halves { fit, prepare, one_more } = walk(&gpu, &town, way, &technique, &seen, extent)?;
            eprintln!("frames, {count} casters, {}: {}", way.name, ms(prepare.median()));
            curve.add(count, prepare.median());
            let times = [fit.median() + prepare.median(), prepare.median(), prepare.worst(), one_more];
            rows.push([vec![format!("{count}, {}", way.name)], times.map(ms).to_vec()].concat());
        }
    }
    let columns = ["casters, what moves", "update", "without the fit", "worst", "a static caster comes"];
    Ok(Found {
        table: Table {
            title: "Frames of `SunShadows`",
            note: "`windows-4`, told what was seen, along the walk. `update` is the fit and what is found to be drawn; the \
                   other columns are the latter alone."
                .to_owned(),
            columns: columns.map(str::to_owned).to_vec(),
            rows,
        },
        pictures: vec![Picture {
            file: "frames",
            title: "SunShadows::update without the fit",
            axes: ["casters", "ms, median"],
            curves,
        }],
    })
}

/// Times by the number of maps and by their sides.
pub(crate) fn measure_maps(extent: &Extent) -> Result<Found> {
    let gpu = open()?;
    let town = Town::new(CASTERS.min(extent.largest));
    let seen = town.seen(extent.frames, &Technique::default())?;
    let numbers = NUMBERS.map(|number| (number, SIDE));
    let sides = SIDES.map(|side| (NUMBER, side));
    let way = &WAYS[1];
    let mut rows = Vec::new();
    let mut curves = ["fit, by number", "the rest, by number"].map(Curve::new);
    for (number, side) in numbers.into_iter().chain(sides) {
        let windows = Windows::default().with_count(number);
        let technique = Technique::default().with_maps(windows).with_resolution(side, side);
        let Halves { fit, prepare, .. } = walk(&gpu, &town, way, &technique, &seen, extent)?;
        eprintln!("maps, {number} of {side}²: {}, {}", ms(fit.median()), ms(prepare.median()));
        rows.push(vec![
            format!("{number} of {side} × {side}"),
            ms(fit.median()),
            ms(fit.worst()),
            ms(prepare.median()),
        ]);
        if side == SIDE && rows.len() <= NUMBERS.len() {
            curves[0].add(number as usize, fit.median());
            curves[1].add(number as usize, prepare.median());
        }
    }
    let columns = ["windows", "fit", "worst", "the rest of `update`"];
    Ok(Found {
        table: Table {
            title: "Number and size of the maps",
            note: format!("{} casters that stand, told what was seen, along the walk.", town.boxes.len()),
            columns: columns.map(str::to_owned).to_vec(),
            rows,
        },
        pictures: vec![Picture {
            file: "maps",
            title: "SunShadows::update by the number of windows",
            axes: ["windows", "ms, median"],
            curves: curves.to_vec(),
        }],
    })
}

/// Any device: nothing is drawn with it.
fn open() -> Result<Gpu> {
    pollster::block_on(Gpu::headless(AdapterChoice::Any))
        .context("`SunShadows` needs a device, if only to own its maps")
}

/// Frames along the walk; in one after the last a static caster comes.
fn walk(gpu: &Gpu, town: &Town, way: &Way, technique: &Technique, seen: &[Seen], extent: &Extent) -> Result<Halves> {
    let (mut fit, mut prepare, mut one_more) = (Times::default(), Times::default(), f64::INFINITY);
    let moves: Vec<bool> = (1..=town.boxes.len()).map(|n| way.every > 0 && n % way.every == 0).collect();
    for _ in 0..extent.rounds {
        let mut sun = SunShadows::new(&gpu.device, &gpu.queue, technique)?;
        let mut boxes = town.boxes.clone();
        let (mut fits, mut rest) = (Vec::new(), Vec::new());
        let last = LEAD + extent.frames;
        for frame in 0..=last {
            let place = if way.walks { frame } else { 0 };
            let before = if way.walks { frame } else { frame.min(1) }.checked_sub(1);
            if let Some(seen) = before.and_then(|before| seen.get(before)) {
                sun.fitter_mut().see(seen.clone());
            }
            bob(&mut boxes, &town.boxes, &moves, frame);
            if frame == last {
                boxes.push(Aabb::new(Vec3::new(0.6, 8.0, -6.0), Vec3::new(2.4, 9.0, -4.0)));
            }
            let times = time(gpu, &mut sun, place, &boxes, &moves)?;
            fits.push(times[0]);
            rest.push(times[1]);
        }
        one_more = one_more.min(rest.pop().unwrap_or_default());
        fits.pop();
        fit.add(&fits);
        prepare.add(&rest);
    }
    Ok(Halves { fit, prepare, one_more })
}

/// Times of the two halves of a frame.
fn time(gpu: &Gpu, sun: &mut SunShadows, place: usize, boxes: &[Aabb], moves: &[bool]) -> Result<[f64; 2]> {
    let views = [Town::camera(place).frustum()?];
    let boxes = Boxes::world(boxes);
    let frame = SunFrame::new(&views, Town::direction(), boxes, Casters { boxes, moves });
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, frame.direction) };
    let (fitted, fit) = timed(|| sun.fit(&input).copied());
    let fitted = fitted?;
    let (prepared, prepare) = timed(|| sun.prepare(&gpu.queue, &frame, &fitted));
    prepared?;
    // What was written waits in memory of the queue until something is submitted.
    gpu.queue.submit([]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok([fit, prepare])
}

/// Moves what moves.
fn bob(boxes: &mut [Aabb], at_rest: &[Aabb], moves: &[bool], frame: usize) {
    for ((aabb, at_rest), _) in boxes.iter_mut().zip(at_rest).zip(moves).filter(|(_, moves)| **moves) {
        let by = Vec3::Y * (BOB * (frame as f32 * 0.1).sin());
        *aabb = Aabb::new(at_rest.min + by, at_rest.max + by);
    }
}
