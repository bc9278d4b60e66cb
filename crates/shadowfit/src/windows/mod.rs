//! Windows: squares of the plane across the light, each placed where it improves the most visible pixels.
//! Shadows are sharp, and their edges hardly ever crawl. The [recommended technique](crate::Technique) has
//! four windows.
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
//! **Still.** A window never turns: its axes depend only on the light. Its texels are 2^(k/8) metres wide,
//! and this width is held while it is good enough. Texel borders lie on lines that are counted from the
//! world's origin in f64. So a window moves by whole texels, and surfaces that stay in it are rasterised
//! alike. Depth ranges are held too.
//!
//! Under a low sun, ground is foreshortened in the map's y direction. So texels are lower than wide. The
//! ratio is the sine of the light's elevation to the power of 0.55, at least a quarter, rounded to eighths of
//! an octave. Texels that are not square are also turned from the horizon of
//! [`up`](crate::settings::MapSettings::up), by an angle whose tangent is 0.45 times that ratio, so that
//! shadows of upright edges run across the columns of texels. If texels are square, the roll is the shortest
//! arc from straight down.
//!
//! **Sharp.** Each visible point needs a texel that is as wide as the point's pixel along its narrower axis,
//! as seen from the light. [`demand`](crate::demand) counts points by position and by this width s. A point
//! that reads texels of width t costs (t / s)^(3/2), and the windows minimise the sum of all costs. Since t
//! and s are separate factors, the best place for a window of a given size does not depend on its texels. It
//! is the place with the greatest sum of s^(-3/2) over the points that are inside and in no finer window. All
//! places are compared by sums over a raster.
//!
//! The sizes are searched one at a time, frame after frame, in a background plan and in a second plan that is
//! restarted regularly. A drawn window moves when the sum of s^(-3/2) inside it falls below 99.3% of the sum
//! in its best place, and then as little as possible. A move by more than half its size, or away from its
//! place in the background plan, must also lower the cost of all windows together. One drawn window is
//! replaced by its counterpart in the background plan when all drawn windows together cost 1.35 times as much
//! as this plan. This limit falls to 1.1 within a second (at 60 frames a second) after the last replacement.
//! If a gain needs several replacements, the others follow in the next frames. Several windows are replaced
//! at once only in the frame in which the first demand grid arrives.
//!
//! **Whole.** The last window contains the boxes of all receivers in view. Every window's depth range
//! contains the boxes of all receivers and casters over it, visible or not. So objects at rest need not be
//! drawn again ([`scroll`](crate::scroll)), and a late or wrong demand grid costs sharpness, never coverage.
//! Without a grid (in the first frame, after a camera cut, or without a depth buffer), rays through the boxes
//! estimate the visible surfaces.
//!
//! Techniques with [`Windows`] use these maps. [`FitState`](crate::FitState) fits them, and points read them
//! by [coverage](crate::selection).
//!
//! Nested maps around the eye on a fixed world grid are known as clipmaps (C. Tanner, C. Migdal, M. Jones,
//! "The clipmap: a virtual mipmap", 1998; F. Losasso and H. Hoppe, "Geometry clipmaps", 2004). Here their
//! sizes and places follow the visible demand.
//!
//! A window's texel lines are counted from the world's origin in f64, and its rectangle from the origin of
//! the fit, which is the eye. Both are exact for any camera position.

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

/// Places the maps of a frame as windows, finest first.
pub(crate) fn place(
    frame: &Frame,
    settings: &Windows,
    before: Option<&HeldWindows>,
    points: &mut [DVec2],
) -> Result<(PlacedMaps, HeldWindows), FitError> {
    let (origin, last) = (frame.content.origin, settings.count as usize - 1);
    // 1. The plane across the light, and the last frame's windows in it.
    let plane = Plane::new(frame.light.direction(), frame.light.up());
    let lattice = Lattice::new(plane, origin, frame.rule);
    let before = before.map(|before| before.in_plane(&lattice, origin));
    // 2. The region that all windows together must hold, and the visible demand in it.
    let shadows = Shadows::new(frame.content, plane.axes, frame.range, points)?;
    let (mut cells, is_guess) = visible(frame, &plane);
    // 3. The last window, which holds everything, then the others.
    let drawn_before = before.as_ref().map(|before| &before.drawn);
    let (min, max) = shadows.bounds(&plane);
    let whole = lattice.last(last, drawn_before.map(|drawn| &drawn[last]), min, max);
    cells.keep_near(&lattice.rect(&whole));
    let mut held = Search::new(&lattice, &cells, last, &whole, before.as_ref(), is_guess).next();
    // 4. Their volumes, with depth ranges that are held while they are good enough.
    let mut maps = [None; MAX_MAPS];
    for (i, map) in maps.iter_mut().enumerate().take(last + 1) {
        let window = &mut held.drawn[i];
        window.z = drawn_before.map(|drawn| &drawn[i]).filter(|was| was.steps == window.steps).and_then(|was| was.z);
        let volume = volume(frame, settings.max_depth_oversize, &lattice, window, &shadows);
        let [near, far] = [frame.range.near, frame.range.far].map(f64::from);
        // Only the last window holds everything visible between any depths.
        let depths = DepthRange { near, far: Some(far), covered_from: (i == last).then_some(near) };
        *map = Some(PlacedMap { volume, depths: Some(depths) });
    }
    Ok((maps, held))
}

/// Returns the visible demand, and whether it is only estimated from the boxes.
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

/// Computes a window's box. The window's own depth range is used while it is good enough, and is updated.
fn volume(frame: &Frame, max_oversize: f32, lattice: &Lattice, window: &mut Window, shadows: &Shadows) -> Volume {
    let (axes, origin) = (lattice.plane.axes, frame.content.origin);
    let (anchor, resolution) = (grid::anchor(&axes, origin), frame.rule.resolution.as_dvec2());
    let mut grid = Grid { first: window.first, texel: lattice.texel(window.steps), z: (0.0, 0.0) };
    let (min, max) = grid.across(anchor, resolution);
    // One texel more on all sides, for the rasteriser.
    let depth = shadows.depth(min - grid.texel, max + grid.texel, frame.rule);
    grid.z = grid::stabilised_depth(window.z, depth.low + anchor.z, depth.high + anchor.z, f64::from(max_oversize));
    window.z = Some(grid.z);
    let side = BoundSource::Window;
    let bounds_from = [side, side, side, side, depth.far_by, depth.near_by];
    let volume = Volume::on_grid(axes, grid, resolution, origin, bounds_from, shadows.is_empty);
    Volume { vertex_distance: depth.vertices, ..volume }
}
