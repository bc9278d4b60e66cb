//! Windows: maps that are no cascades, but squares of the plane across the light, each put
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
mod counted;
mod depth;
mod lattice;
mod plan;
mod raster;
mod search;

pub(crate) use search::Held as HeldWindows;

use glam::DVec2;

use crate::base::FitError;
use crate::demand::grid::Plane;
use crate::fits::{Frame, PlacedMap, PlacedMaps};
use crate::light::grid::{self, Grid};
use crate::light::{BoundSource, Volume};
use crate::selection::DepthRange;
use crate::technique::Windows;
use crate::technique::settings::MAX_MAPS;
use cells::Cells;
use depth::Shadows;
use lattice::{Lattice, Window};
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
    let (min, max) = shadows.bounds(&plane);
    let whole = lattice.last(last, drawn_before.map(|drawn| &drawn[last]), min, max);
    cells.keep_near(&lattice.rect(&whole));
    let mut held = Search::new(&lattice, &cells, last, &whole, before.as_ref(), is_guess).next();
    // 4. Their volumes, with depth ranges that are held while they serve.
    let mut maps = [None; MAX_MAPS];
    for (i, map) in maps.iter_mut().enumerate().take(last + 1) {
        let window = &mut held.drawn[i];
        window.z = drawn_before.map(|drawn| &drawn[i]).filter(|was| was.steps == window.steps).and_then(|was| was.z);
        let volume = volume(frame, settings.max_depth_oversize, &lattice, window, &shadows);
        let [near, far] = [frame.range.near, frame.range.far].map(f64::from);
        // Only the last one holds all that is seen between any depths.
        let depths = DepthRange { near, far: Some(far), covered_from: (i == last).then_some(near) };
        *map = Some(PlacedMap { volume, depths: Some(depths) });
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
        boxes::add(&mut cells, frame, plane);
    }
    (cells, is_guess)
}

/// A window's box. Its depth range is taken from the window while it serves, and written to it.
fn volume(frame: &Frame, max_oversize: f32, lattice: &Lattice, window: &mut Window, shadows: &Shadows) -> Volume {
    let (axes, origin) = (lattice.plane.axes, frame.content.origin);
    let (anchor, resolution) = (grid::anchor(&axes, origin), frame.rule.resolution.as_dvec2());
    let mut grid = Grid { first: window.first, texel: lattice.texel(window.steps), z: (0.0, 0.0) };
    let (min, max) = grid.across(anchor, resolution);
    // A texel more on all sides, for the rasteriser.
    let depth = shadows.depth(min - grid.texel, max + grid.texel, frame.rule);
    grid.z = grid::stabilised_depth(window.z, depth.low + anchor.z, depth.high + anchor.z, f64::from(max_oversize));
    window.z = Some(grid.z);
    let side = BoundSource::Window;
    let bounds_from = [side, side, side, side, depth.far_by, depth.near_by];
    let volume = Volume::on_grid(axes, grid, resolution, origin, bounds_from, shadows.is_empty);
    Volume { vertex_distance: depth.vertices, ..volume }
}
