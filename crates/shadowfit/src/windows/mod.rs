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
//! power of 0.62, at least a quarter, rounded to eighths of an octave; the roll follows the horizon of
//! [`up`](crate::settings::FitSettings::up) then, and the shortest arc from straight down where
//! texels are square.
//!
//! **Sharp.** Each visible point asks for a texel that is as wide as the point's pixel along its
//! narrower axis, as the light sees it; [`need`](crate::need) counts points by place and by that
//! width s. A point that reads texels of width t costs (t / s)^(3/2), and the windows are to make the
//! sum small. Since t and s are separate factors, the best place for a window of a given size is where
//! the sum of s^(-3/2) over the points inside, those in finer windows left out, is greatest, whatever
//! its texels; all places are compared by sums over a raster. The sizes are searched one at a time, frame
//! after frame, in a background plan, and in a second one that is restarted regularly. A window that is drawn
//! moves as little as it can, when it holds less than 98.5% of what it could. One of them is replaced by its
//! counterpart in the background plan when all of them together cost 1.35 times as much as the plan; this limit
//! falls to 1.1 within a second (at 60 frames a second) after the last replacement. Several are replaced at once
//! only in the frame in which the first grid of need arrives.
//!
//! **Whole.** The last window holds the boxes of all receivers in view, and every window's depth range
//! holds all receivers' and casters' boxes over it, seen or not: what stands still need not be drawn
//! again ([`scroll`](crate::scroll)), and a late or wrong grid of need costs sharpness, never coverage.
//! Without a grid (the first frame, a camera cut, no depth buffer) what is visible is estimated by rays
//! through the boxes.
//!
//! Fitted by [`MapFitter`](crate::MapFitter), with
//! [`FitKind::Windows`](crate::settings::FitKind::Windows), and read by
//! [coverage](crate::choice). [`fit`](crate::fit) and [`fit_scene`](crate::fits::fit_scene), which know a
//! single map and no frame before, give that kind the rectangle of
//! [`FitKind::Focused`](crate::settings::FitKind::Focused) along the light's axes.
//!
//! The idea of maps nested around the eye on a grid fixed to the world is that of clipmaps (C. Tanner,
//! C. Migdal, M. Jones, "The clipmap: a virtual mipmap", 1998; F. Losasso and H. Hoppe, "Geometry
//! clipmaps", 2004); here sizes and places follow what is visible.

mod boxes;
mod cells;
mod depth;
mod lattice;
mod placement;
mod plan;
mod search;

use glam::DVec2;

use crate::base::FitError;
use crate::demand::need::Plane;
use crate::fits::{Constraint, Frame, PlacedMap, PlacedMaps, Volume};
use crate::light::grid::{self, Grid};
use crate::technique::settings::{MAX_MAPS, NeedSource};
use cells::Cells;
use depth::Shadows;
use lattice::{Lattice, Window};
use search::Search;

pub(crate) use search::Held as HeldWindows;

/// Places the maps of a frame as windows, the finest first.
pub(crate) fn place(
    frame: &Frame,
    before: Option<&HeldWindows>,
    points: &mut [DVec2],
) -> Result<(PlacedMaps, HeldWindows), FitError> {
    let (origin, last) = (frame.content.origin, frame.technique.count as usize - 1);
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
        let volume = volume(frame, &lattice, window, &shadows);
        // Only the last one holds all that is seen between any depths.
        let covered_near = if i < last { frame.range.far } else { frame.range.near };
        *map = Some(PlacedMap { volume, near: frame.range.near, far: frame.range.far, covered_near });
    }
    Ok((maps, held))
}

/// What is visible, and whether that is only estimated from the boxes.
fn visible(frame: &Frame, plane: &Plane) -> (Cells, bool) {
    let mut cells = Cells::new();
    if frame.technique.need == NeedSource::LastFrame {
        for grid in frame.input.need.iter().filter(|grid| grid.is_for(plane)) {
            cells.add_grid(grid, plane, frame.content.origin);
        }
    }
    let is_guess = cells.len == 0;
    if is_guess {
        boxes::add(&mut cells, frame.input, frame.content, plane, (frame.light.up(), frame.range.far));
    }
    (cells, is_guess)
}

/// A window's box. Its depth range is taken from the window while it serves, and written to it.
fn volume(frame: &Frame, lattice: &Lattice, window: &mut Window, shadows: &Shadows) -> Volume {
    let (axes, origin) = (lattice.plane.axes, frame.content.origin);
    let (anchor, resolution) = (grid::anchor(&axes, origin), frame.rule.resolution.as_dvec2());
    let mut grid = Grid { first: window.first, texel: lattice.texel(window.steps), z: (0.0, 0.0) };
    let (min, max) = grid.across(anchor, resolution);
    // A texel more on all sides, for the rasteriser.
    let depth = shadows.depth((min - grid.texel, max + grid.texel), frame.rule);
    let needed = (depth.low + anchor.z, depth.high + anchor.z);
    grid.z = grid::stabilised_depth(window.z, needed, f64::from(frame.technique.hold.waste));
    window.z = Some(grid.z);
    let side = Constraint::Window;
    let set_by = [side, side, side, side, depth.far_by, depth.near_by];
    Volume::on_grid(axes, grid, resolution, origin, (set_by, shadows.is_empty))
}

/// What a point costs whose texel is this many times too wide: the ratio's power of 3/2.
///
/// By the ratio itself, or its square, pictures are as good on average; the one leaves more points with
/// far too wide texels, the other has wider ones where most points are.
fn cost_of(ratio: f32) -> f32 {
    ratio * libm::sqrtf(ratio)
}
