//! Windows: maps that are no slices of the view, but squares of the plane across the light, each put
//! where it helps most of what is visible. Sharp, and still: the
//! [recommended technique](crate::Technique) has four of them.
//!
//! ```text
//!   ┌───────────────────────────────────┐ last window: every receiver in view
//!   │            ┌─────────┐            │
//!   │   ┌────────┼─┐       │            │ a point reads the finest
//!   │   │  ┌──┐  │ │       │            │ window that holds it,
//!   │   │  │  │eye│        │            │ whatever its view depth
//!   │   │  └──┘  │ │       │            │
//!   │   └────────┼─┘       │            │
//!   │            └─────────┘            │
//!   └───────────────────────────────────┘
//! ```
//!
//! **Still.** A window never turns: its axes follow from the light alone. Its texels have a width from
//! a fixed ladder, 2^(k/8) metres, which it keeps as long as it serves, and lie on lines that are counted
//! from the world's origin in f64. So a window moves by whole texels, and what is in two frames of it is
//! rasterised alike. Depth ranges are held too. Under a low sun ground is foreshortened along one axis, so
//! texels are finer up the light's plane than along the horizon, by the sine of the light's elevation to the
//! power of 0.55, at least a quarter, rounded to eighths of an octave. The roll follows the horizon of
//! [`up`](crate::settings::MapSettings::up) then, turned by an angle whose tangent is 0.45 of that ratio, so that
//! shadows of upright edges run across the columns of texels; it is the shortest arc from straight down where
//! texels are square.
//!
//! **Sharp.** Each visible point asks for a texel that is as wide as the point's pixel along its
//! narrower axis, as the light sees it; [`demand`](crate::demand) counts points by place and by that
//! width s. A point that reads texels of width t costs (t / s)^(3/2), and the windows are to make the
//! sum small. Since t and s are separate factors, the best place for a window of a given size is where
//! the sum of s^(-3/2) over the points inside, those in finer windows left out, is greatest, whatever
//! its texels; all places are compared by sums over a raster. The sizes are searched one at a time, frame
//! after frame, in a background plan, and in a second one that is restarted regularly. A window that is drawn
//! moves as little as it can, when it holds less than 99.3% of what it could, but not away from where the background
//! plan has it if all together would cost more. One of them is replaced by its counterpart in that plan when all
//! of them together cost 1.35 times as much as the plan; this limit falls to 1.1 within a second (at 60 frames a
//! second) after the last replacement. Where it takes several to gain, the others follow in the next frames;
//! several are replaced at once only in the frame in which the first demand grid arrives.
//!
//! **Whole.** The last window holds the boxes of all receivers in view, and every window's depth range
//! holds all receivers' and casters' boxes over it, seen or not: what stands still need not be drawn
//! again ([`scroll`](crate::scroll)), and a late or wrong demand grid costs sharpness, never coverage.
//! Without a grid (the first frame, a camera cut, no depth buffer) what is visible is estimated by rays
//! through the boxes.
//!
//! They are the maps of a technique with [`Windows`], fitted by
//! [`FitState`](crate::FitState), and read by [coverage](crate::selection).
//!
//! The idea of maps nested around the eye on a grid fixed to the world is that of clipmaps (C. Tanner,
//! C. Migdal, M. Jones, "The clipmap: a virtual mipmap", 1998; F. Losasso and H. Hoppe, "Geometry
//! clipmaps", 2004); here sizes and places follow what is visible.
//!
//! A window's texel lines are counted from the world's origin in f64, its rectangle from the origin of the fit, which
//! is the eye, so that both are exact wherever the camera is.

mod boxes;
mod cells;
mod depth;
mod plan;
mod search;

pub(crate) use search::Held as HeldWindows;

use glam::{DVec2, DVec3};

use crate::base::{FitError, checks};
use crate::demand::grid::Plane;
use crate::fits::{FitRule, Frame, PlacedMap, PlacedMaps};
use crate::light::grid::{self, Grid};
use crate::light::{Constraint, Volume};
use crate::technique::Windows;
use crate::technique::settings::MAX_MAPS;
use cells::{Cells, Rect};
use depth::Shadows;
use search::Search;

/// Places the maps of a frame as windows, the finest first.
pub(crate) fn place(
    frame: &Frame,
    settings: &Windows,
    before: Option<&HeldWindows>,
    points: &mut [DVec2],
) -> Result<(PlacedMaps, HeldWindows), FitError> {
    let (origin, last) = (frame.content.origin, settings.count as usize - 1);
    // 1. The plane across the light, and the windows of the frame before in it.
    let plane = Plane::new(frame.light.direction(), frame.light.up());
    let lattice = Lattice::new(plane, origin, frame.rule);
    let before = before.map(|before| before.in_plane(&lattice, origin));
    // 2. What all windows together must hold, and what is visible of it.
    let shadows = Shadows::new(frame.content, plane.axes, frame.range, points)?;
    let (mut cells, is_guess) = visible(frame, &plane);
    // 3. The last window, which holds everything, then the others.
    let drawn_before = before.as_ref().map(|before| &before.drawn);
    let whole = lattice.last(last, drawn_before.map(|drawn| &drawn[last]), shadows.bounds(&plane));
    cells.keep_near(&lattice.rect(&whole));
    let mut held = Search::new(&lattice, &cells, (last, &whole), before.as_ref(), is_guess).next();
    // 4. Their volumes, with depth ranges that are held while they serve.
    let mut maps = [None; MAX_MAPS];
    for (i, map) in maps.iter_mut().enumerate().take(last + 1) {
        let window = &mut held.drawn[i];
        window.z = drawn_before.map(|drawn| &drawn[i]).filter(|was| was.steps == window.steps).and_then(|was| was.z);
        let volume = volume(frame, settings.max_depth_waste, &lattice, window, &shadows);
        // Only the last one holds all that is seen between any depths.
        let covered_near = if i < last { frame.range.far } else { frame.range.near };
        *map = Some(PlacedMap { volume, near: frame.range.near, far: frame.range.far, covered_near });
    }
    Ok((maps, held))
}

/// What is visible, and whether that is only estimated from the boxes.
fn visible(frame: &Frame, plane: &Plane) -> (Cells, bool) {
    let mut cells = Cells::new();
    for grid in frame.input.demand.iter().filter(|grid| grid.is_for(plane)) {
        cells.add_grid(grid, plane, frame.content.origin);
    }
    let is_guess = cells.len == 0;
    if is_guess {
        boxes::add(&mut cells, frame.input, frame.content, plane, (frame.light.up(), frame.range.far));
    }
    (cells, is_guess)
}

/// A window's box. Its depth range is taken from the window while it serves, and written to it.
fn volume(frame: &Frame, waste: f32, lattice: &Lattice, window: &mut Window, shadows: &Shadows) -> Volume {
    let (axes, origin) = (lattice.plane.axes, frame.content.origin);
    let (anchor, resolution) = (grid::anchor(&axes, origin), frame.rule.resolution.as_dvec2());
    let mut grid = Grid { first: window.first, texel: lattice.texel(window.steps), z: (0.0, 0.0) };
    let (min, max) = grid.across(anchor, resolution);
    // A texel more on all sides, for the rasteriser.
    let depth = shadows.depth((min - grid.texel, max + grid.texel), frame.rule);
    let needed = (depth.low + anchor.z, depth.high + anchor.z);
    grid.z = grid::stabilised_depth(window.z, needed, f64::from(waste));
    window.z = Some(grid.z);
    let side = Constraint::Window;
    let set_by = [side, side, side, side, depth.far_by, depth.near_by];
    let volume = Volume::on_grid(axes, grid, resolution, origin, (set_by, shadows.is_empty));
    Volume { vertex_distance: depth.vertices, ..volume }
}

/// What a point costs whose texel is this many times too wide: the ratio's power of 3/2.
///
/// By the ratio itself, or its square, pictures are as good on average; the one leaves more points with
/// far too wide texels, the other has wider ones where most points are.
fn cost_of(ratio: f32) -> f32 {
    ratio * libm::sqrtf(ratio)
}

/// A window, in absolute world coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Window {
    /// Width of a texel, in eighths of an octave of a metre.
    pub(super) steps: i32,
    /// Grid lines of its left and bottom side.
    pub(super) first: DVec2,
    /// Far and near plane along the light's z from the world's origin, in metres, if they are known.
    pub(super) z: Option<(f64, f64)>,
}

/// The plane across the light as seen from the origin of a fit, and the sizes of its windows.
struct Lattice {
    pub(super) plane: Plane,
    /// Position of the origin of the fit in the plane.
    anchor: DVec2,
    /// Free texels at the border of each window, and those between the borders.
    border: f64,
    pub(super) usable: DVec2,
    /// Least width of a window's texels, in eighths of an octave of a metre.
    pub(super) least: i32,
}

/// Eighths of an octave by which the texels of the last window may be too wide before it is made anew:
/// about one and a half times.
const LAST_WASTE: i32 = 5;

/// Share of the way to the middle that the last window moves beyond what it must.
const MOVE_ON: f64 = 0.3;

impl Lattice {
    /// The lattice of windows that are fitted by a rule.
    fn new(plane: Plane, origin: DVec3, rule: &FitRule) -> Self {
        let anchor = plane.of(plane.axes.project(origin));
        // Along the plane's height texels are shorter than wide.
        let is_limited = rule.least_texel > 0.0;
        let least = if is_limited { grid::eighths_above(rule.least_texel / plane.shape) } else { i32::MIN };
        Self { plane, anchor, border: rule.border, usable: rule.usable(), least }
    }

    /// Size of a window's texels, in metres.
    fn texel(&self, steps: i32) -> DVec2 {
        let width = grid::eighths(steps);
        DVec2::new(width, width * self.plane.shape)
    }

    /// What a window holds between its borders.
    fn rect(&self, window: &Window) -> Rect {
        let texel = grid::eighths(window.steps);
        // One texel is lost to the shift onto the grid: half of it on either side.
        let min = (window.first + self.border + 0.5) * texel - self.anchor;
        Rect { min: min.as_vec2(), size: (self.usable * texel).as_vec2() }
    }

    /// The window that holds a rectangle of its size between its borders.
    fn window(&self, steps: i32, rect: &Rect) -> Window {
        self.at(steps, rect.min.as_dvec2(), checks::floor)
    }

    /// The window whose least corner between the borders is about here.
    fn at(&self, steps: i32, min: DVec2, round: impl Fn(f64) -> f64) -> Window {
        let line = (min + self.anchor) / grid::eighths(steps) - self.border;
        Window { steps, first: DVec2::new(round(line.x), round(line.y)), z: None }
    }

    /// The last window, which holds a part of the plane: the held one while it serves.
    fn last(&self, index: usize, held: Option<&Window>, (min, max): (DVec2, DVec2)) -> Window {
        let usable = self.usable;
        // Each of the finer windows has other texels.
        let least = self.least.saturating_add(i32::from(index as u8));
        let needed = grid::eighths_above(((max - min) / usable).max_element()).max(least);
        let is_wasteful = |held: &&Window| held.steps > needed.saturating_add(LAST_WASTE);
        let held = held.filter(|held| held.steps >= needed && !is_wasteful(held));
        let steps = held.map_or(needed, |held| held.steps);
        let size = (usable + 1.0) * grid::eighths(steps);
        let low = |window: &Window| (window.first + self.border) * grid::eighths(steps) - self.anchor;
        let holds = |window: &Window| low(window).cmple(min).all() && (low(window) + size).cmpge(max).all();
        let around = || self.at(steps, (min + max - usable * grid::eighths(steps)) * 0.5, checks::floor);
        let Some(held) = held else {
            return around();
        };
        if holds(held) {
            return *held;
        }
        // The least move, and some of what is left toward the middle.
        let least = low(held).clamp((max - size).min(min), min);
        let middle = (min + max - size) * 0.5;
        let moved = self.at(steps, least + (middle - least) * MOVE_ON, libm::ceil);
        if holds(&moved) { moved } else { around() }
    }

    /// A window of another plane, which keeps its texels and what it was around as seen from the origin
    /// of the fit: a light that turns a little moves little there.
    fn turned(&self, window: &Window, from: &Plane, origin: DVec3) -> Window {
        let texel = grid::eighths(window.steps);
        let line = window.first + (self.anchor - from.of(from.axes.project(origin))) / texel;
        Window { first: DVec2::new(checks::floor(line.x), checks::floor(line.y)), z: None, ..*window }
    }
}
