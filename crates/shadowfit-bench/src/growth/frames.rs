//! Frames of `SunShadows` with growing numbers of casters, some of which move, on the CPU.

use anyhow::Result;
use glam::Vec3;
use shadowfit::{Aabb, Boxes, FitInput, StaticBoxes, Technique, VisibleDemand, Windows};
use shadowfit_render::Gpu;
use shadowfit_study::tell;
use shadowfit_wgpu::{Casters, SunFrame, SunShadows};

use super::picture::{Curve, Picture, grouped};
use super::town::Town;
use super::{Extent, Found};
use crate::open;
use crate::table::{Table, ms};
use crate::times::{LEAD, Times, timed};

/// Share of moving casters, and whether the camera walks.
struct Way {
    name: &'static str,
    /// One of `every` casters moves, or none if 0.
    every: usize,
    walks: bool,
}

const WAYS: [Way; 5] = [
    Way { name: "at rest", every: 0, walks: false },
    Way { name: "camera moves", every: 0, walks: true },
    Way { name: "1% move", every: 100, walks: true },
    Way { name: "10% move", every: 10, walks: true },
    Way { name: "all move", every: 1, walks: true },
];

/// Sides of the maps, in texels, numbers of maps, and number of casters in the town of these measurements.
const SIDES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];
const SIDE: u32 = 2048;
const NUMBERS: [u32; 8] = [1, 2, 3, 4, 5, 6, 7, 8];
const NUMBER: u32 = 4;
const CASTERS: usize = 10_000;

const NOTE: &str = "`windows-4` with visible demand. The camera walks in all rows except those at rest. `update` is \
    the fit and all further work up to the passes, which are not drawn. The columns after it exclude the fit: median, \
    worst, and the frame after them, in which a static caster was added. *List* has all casters in the frame's list. \
    *Hierarchy* has static casters in a `StaticBoxes` (`SunFrame::static_boxes`).";

const COLUMNS: [&str; 9] = [
    "casters, what moves",
    "list: update",
    "without the fit",
    "worst",
    "one more",
    "hierarchy: update",
    "without the fit",
    "worst",
    "one more",
];

/// Number of casters in a scene of current engines, in addition to the powers of ten.
const TYPICAL: usize = 30_000;

/// A chimney in view, added at the end.
const NEW: Aabb = Aabb::new(Vec3::new(0.6, 8.0, -10.0), Vec3::new(2.4, 9.0, -8.0));

/// Amplitude of moving casters, in metres.
const BOB: f32 = 0.5;

/// Times of the two halves of `SunShadows::update`, and of the second half after a static caster was added.
struct Halves {
    fit: Times,
    prepare: Times,
    one_more: f64,
}

impl Halves {
    fn cells(&self) -> Vec<String> {
        let Self { fit, prepare, one_more } = self;
        [fit.median() + prepare.median(), prepare.median(), prepare.worst(), *one_more].map(ms).to_vec()
    }
}

/// Measures times by the number of casters.
pub(crate) fn measure(extent: &Extent) -> Result<Found> {
    let gpu = open(&extent.adapter)?;
    let technique = Technique::default();
    let curves_of = |make: fn(String, usize) -> Curve, handed: &str| -> Vec<Curve> {
        let curve = |(place, way): (usize, &Way)| make(format!("{}, {handed}", way.name), place);
        WAYS.iter().enumerate().map(curve).collect()
    };
    let (mut list_curves, mut tree_curves) = (curves_of(Curve::thin, "list"), curves_of(Curve::new, "hierarchy"));
    let mut rows = Vec::new();
    for count in sizes(extent) {
        let town = Town::new(count);
        let seen = town.seen(extent.frames, &technique)?;
        let run = Run { gpu: &gpu, town: &town, seen: &seen, extent };
        for (way, curves) in WAYS.iter().zip(list_curves.iter_mut().zip(&mut tree_curves)) {
            let [list, tree] = [false, true].map(|stands| run.walk(&technique, way, stands));
            let (list, tree) = (list?, tree?);
            let [in_list, in_tree] = [&list, &tree].map(|halves| halves.prepare.median());
            tell(format_args!("frames, {count} casters, {}: {}, {}", way.name, ms(in_list), ms(in_tree)));
            curves.0.add(count, in_list);
            curves.1.add(count, in_tree);
            rows.push([vec![format!("{}, {}", grouped(count), way.name)], list.cells(), tree.cells()].concat());
        }
    }
    let columns = COLUMNS.map(str::to_owned).to_vec();
    Ok(Found {
        table: Table { title: "Frames of `SunShadows`", note: NOTE.to_owned(), columns, rows },
        pictures: vec![Picture {
            file: "frames",
            title: "SunShadows::update without the fit",
            axes: ["casters", "milliseconds, median"],
            curves: [list_curves, tree_curves].concat(),
        }],
    })
}

/// Returns the numbers of casters.
fn sizes(extent: &Extent) -> Vec<usize> {
    let mut sizes: Vec<usize> = extent.sizes().chain([TYPICAL]).filter(|size| *size <= extent.largest).collect();
    sizes.sort_unstable();
    sizes
}

/// Measures times by the number of maps and by their sides.
pub(crate) fn measure_maps(extent: &Extent) -> Result<Found> {
    let gpu = open(&extent.adapter)?;
    let town = Town::new(CASTERS.min(extent.largest));
    let seen = town.seen(extent.frames, &Technique::default())?;
    let numbers = NUMBERS.map(|number| (number, SIDE));
    let sides = SIDES.map(|side| (NUMBER, side));
    let run = Run { gpu: &gpu, town: &town, seen: &seen, extent };
    let mut rows = Vec::new();
    let mut curves = [Curve::new("fit", 0), Curve::new("the rest", 1)];
    for (number, side) in numbers.into_iter().chain(sides) {
        let windows = Windows::default().with_count(number);
        let technique = Technique::default().with_maps(windows).with_resolution(side, side);
        let Halves { fit, prepare, .. } = run.walk(&technique, &WAYS[1], true)?;
        tell(format_args!("maps, {number} of {side}²: {}, {}", ms(fit.median()), ms(prepare.median())));
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
    let columns = ["windows", "fit", "worst", "the rest of `update`"].map(str::to_owned).to_vec();
    let casters = grouped(town.boxes.len());
    let note = format!("`windows-4` and others with visible demand, in a hierarchy of {casters} casters.");
    Ok(Found {
        table: Table { title: "Number and size of the maps", note, columns, rows },
        pictures: vec![Picture {
            file: "maps",
            title: "SunShadows::update by the number of windows",
            axes: ["windows", "ms, median"],
            curves: curves.to_vec(),
        }],
    })
}

/// Input that walks share.
#[derive(Clone, Copy)]
struct Run<'a> {
    gpu: &'a Gpu,
    town: &'a Town,
    seen: &'a [VisibleDemand],
    extent: &'a Extent,
}

impl Run<'_> {
    /// Runs the frames of the walk, and one more frame after a static caster was added. Static casters are in
    /// each frame's list or in a hierarchy.
    fn walk(&self, technique: &Technique, way: &Way, is_tree: bool) -> Result<Halves> {
        let mut halves = Halves { fit: Times::default(), prepare: Times::default(), one_more: f64::INFINITY };
        let last = LEAD + self.extent.frames;
        for _ in 0..self.extent.rounds {
            let mut sun = SunShadows::new(&self.gpu.device, &self.gpu.queue, &(*technique).into())?;
            let mut casters = Handed::new(&self.town.boxes, way.every, is_tree)?;
            let (mut fits, mut rest) = (Vec::new(), Vec::new());
            for frame in 0..=last {
                let place = if way.walks { frame } else { 0 };
                if let Some(seen) =
                    frame.checked_sub(1).and_then(|before| self.seen.get(if way.walks { before } else { 0 }))
                {
                    sun.fitter_mut().set_visible_demand(seen.clone());
                }
                casters.bob(frame);
                if frame == last {
                    casters.add(NEW)?;
                }
                let [fit, prepare] = casters.time(self.gpu, &mut sun, place)?;
                fits.push(fit);
                rest.push(prepare);
            }
            halves.one_more = halves.one_more.min(rest.pop().unwrap_or_default());
            halves.fit.add(&fits[..last]);
            halves.prepare.add(&rest);
        }
        Ok(halves)
    }
}

/// The casters as an engine passes them.
struct Handed {
    /// Each frame's list, at rest and now, and which of its boxes move.
    at_rest: Vec<Aabb>,
    boxes: Vec<Aabb>,
    moves: Vec<bool>,
    static_boxes: Option<StaticBoxes>,
}

impl Handed {
    fn new(boxes: &[Aabb], every: usize, is_tree: bool) -> Result<Self> {
        let moves = |number: usize| every > 0 && (number + 1).is_multiple_of(every);
        let numbered = boxes.iter().copied().enumerate();
        if !is_tree {
            let moves = (0..boxes.len()).map(moves).collect();
            return Ok(Self { at_rest: boxes.to_vec(), boxes: boxes.to_vec(), moves, static_boxes: None });
        }
        let (moving, static_boxes): (Vec<_>, Vec<_>) = numbered.partition(|(number, _)| moves(*number));
        let [moving, static_boxes] =
            [moving, static_boxes].map(|list| list.into_iter().map(|(_, aabb)| aabb).collect::<Vec<_>>());
        let static_boxes = Some(StaticBoxes::from_boxes(Boxes::world(&static_boxes))?);
        Ok(Self { moves: vec![true; moving.len()], boxes: moving.clone(), at_rest: moving, static_boxes })
    }

    /// Adds a static caster.
    fn add(&mut self, aabb: Aabb) -> Result<()> {
        match &mut self.static_boxes {
            Some(tree) => drop(tree.insert(aabb)?),
            None => self.boxes.push(aabb),
        }
        Ok(())
    }

    /// Moves the moving casters.
    fn bob(&mut self, frame: usize) {
        let by = Vec3::Y * (BOB * (frame as f32 * 0.1).sin());
        for ((aabb, at_rest), _) in
            self.boxes.iter_mut().zip(&self.at_rest).zip(&self.moves).filter(|(_, moves)| **moves)
        {
            *aabb = Aabb::new(at_rest.min + by, at_rest.max + by);
        }
    }

    /// Returns the times of the two halves of a frame.
    fn time(&self, gpu: &Gpu, sun: &mut SunShadows, place: usize) -> Result<[f64; 2]> {
        let views = [Town::camera(place).frustum()?];
        let (boxes, static_boxes) = (Boxes::world(&self.boxes), self.static_boxes.as_ref());
        let casters = Casters { boxes, moves: &self.moves, ..Casters::default() };
        let frame = SunFrame { static_boxes, ..SunFrame::new(&views, Town::direction(), boxes, casters) };
        let input = FitInput {
            receivers: Some(boxes),
            casters: Some(boxes),
            static_boxes,
            ..FitInput::new(&views, frame.direction)
        };
        let (fitted, fit) = timed(|| sun.fit(&input).copied());
        let fitted = fitted?;
        let (prepared, prepare) = timed(|| sun.prepare(&gpu.queue, &frame, &fitted));
        prepared?;
        // The queue keeps written data in memory until a submission.
        gpu.queue.submit([]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        Ok([fit, prepare])
    }
}
