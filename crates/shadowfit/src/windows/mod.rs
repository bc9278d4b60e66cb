//! Windows: squares of the plane across the light, each put where it helps most of what is visible.

mod boxes;
mod cells;
mod depth;
mod placement;
mod plan;

use glam::{DVec2, DVec3};

use crate::axes::Light;
use crate::content::Content;
use crate::need::Plane;
use crate::rule::FitRule;
use crate::settings::{MAX_MAPS, NeedSource};
use crate::view::Range;
use crate::volume::{Constraint, Grid, ROUNDING, Volume};
use crate::{FitError, FitInput, Technique, grid};
use cells::Cells;
use depth::Shadows;
use placement::Rect;
use plan::{Plan, Planner};

/// What a texel that is this many times too wide costs.
pub(crate) fn cost_of(ratio: f32) -> f32 {
    let p = crate::tune::get(0, 1.0);
    if p == 1.0 { ratio } else { libm::powf(ratio, p) }
}

/// A window of an earlier frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Window {
    /// Width of a texel, in eighths of an octave of a metre.
    steps: i32,
    /// Grid lines of its left and bottom side, counted from the world's origin.
    first: DVec2,
    /// Range along the light, from the world's origin, in metres.
    z: Option<(f64, f64)>,
}

/// A change of one window's texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Change {
    window: usize,
    by: i32,
}

/// The windows of the last frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct HeldWindows {
    plane: Plane,
    windows: [Window; MAX_MAPS],
    /// The change that was better in the last frame.
    pending: Option<Change>,
    /// Whether no grid of need was known yet.
    is_guess: bool,
    /// Number of the next change that is tried.
    turn: u32,
}

/// One frame's input.
pub(crate) struct Frame<'a, 'b> {
    pub(crate) input: &'a FitInput<'b>,
    pub(crate) technique: &'a Technique,
    pub(crate) content: &'a Content<'b>,
    pub(crate) light: Light,
    pub(crate) range: Range,
}

impl Frame<'_, '_> {
    /// The windows of this frame, finest first, and what the next frame begins with.
    pub(crate) fn fit(
        &self,
        rule: impl Fn(usize) -> FitRule,
        before: Option<&HeldWindows>,
        points: &mut [DVec2],
    ) -> Result<([Option<Volume>; MAX_MAPS], HeldWindows), FitError> {
        let plane = Plane::new(self.light.direction(), self.light.up());
        let count = self.technique.count as usize;
        let mut usable = [DVec2::ONE; MAX_MAPS];
        for (i, usable) in usable.iter_mut().enumerate().take(count) {
            *usable = grid::usable(&rule(i));
        }
        let border = rule(0).border;
        let anchor = plane.of(plane.axes.project(self.content.origin));
        let t0 = std::time::Instant::now();
        // 1. What all windows together must hold, and what is visible of it.
        let shadows = Shadows::new(self.content, plane.axes, self.range, points)?;
        let t1 = std::time::Instant::now();
        let (cells, is_guess) = self.cells(&plane);
        let before = before.filter(|_| crate::tune::get(4, 0.0) != 1.0).map(|before| before.moved_to(&plane, self.content.origin));
        let t2 = std::time::Instant::now();
        // 2. The last window, which holds everything.
        let bounds = shadows.bounds(&plane);
        let last = hold_all(before.map(|before| before.windows[count - 1]), bounds, usable[count - 1], border, anchor);
        // 3. The others, finest first.
        let planner = Planner { cells: cells.as_slice(), usable: usable.map(DVec2::as_vec2), count };
        let to_rect = |i: usize, window: &Window| rect_of(window, usable[i], border, anchor);
        let (plan, pending, turn) = match &before {
            None => (planner.fresh(last.steps, to_rect(count - 1, &last)), None, 0),
            Some(before) => {
                let mut held = Plan::default();
                for i in 0..count - 1 {
                    held.steps[i] = before.windows[i].steps;
                    held.rects[i] = to_rect(i, &before.windows[i]);
                }
                (held.steps[count - 1], held.rects[count - 1]) = (last.steps, to_rect(count - 1, &last));
                if before.is_guess && !is_guess {
                    (planner.settle(held), None, 0)
                } else {
                    planner.go_on(held, before.pending, before.turn)
                }
            }
        };
        let t3 = std::time::Instant::now();
        let mut held = HeldWindows { plane, windows: [Window::default(); MAX_MAPS], pending, turn, is_guess };
        let mut volumes = [None; MAX_MAPS];
        for i in 0..count {
            let mut window = if i == count - 1 {
                last
            } else {
                let kept = before.as_ref().map(|before| before.windows[i]).filter(|window| {
                    window.steps == plan.steps[i] && to_rect(i, window) == plan.rects[i]
                });
                kept.unwrap_or_else(|| window_of(plan.steps[i], &plan.rects[i], border, anchor))
            };
            let was = before.as_ref().map(|before| before.windows[i]).filter(|was| was.steps == window.steps);
            let z = was.and_then(|was| was.z);
            let volume = self.volume(&mut window, z, &plane, &rule(i), &shadows);
            volumes[i] = Some(volume);
            held.windows[i] = window;
        }
        let t4 = std::time::Instant::now();
        if crate::tune::get(15, 0.0) == 2.0 { std::eprintln!("time shadows {:?} cells {:?} plan {:?} volumes {:?} n {}", t1-t0, t2-t1, t3-t2, t4-t3, cells.as_slice().len()); }
        Ok((volumes, held))
    }

    fn cells(&self, plane: &Plane) -> (Cells, bool) {
        let mut cells = Cells::new();
        if self.technique.need == NeedSource::LastFrame {
            for grid in self.input.need.iter().filter(|grid| grid.is_for(plane)) {
                cells.add_grid(grid, plane, self.content.origin);
            }
        }
        let is_guess = cells.as_slice().is_empty();
        if is_guess {
            boxes::add(&mut cells, self.input, self.content, plane, self.light.up(), self.technique.fit.max_distance);
        }
        (cells, is_guess)
    }

    /// A window's box, with its depth range.
    fn volume(&self, window: &mut Window, z: Option<(f64, f64)>, plane: &Plane, rule: &FitRule, shadows: &Shadows) -> Volume {
        let anchor = grid::anchor(&plane.axes, self.content.origin);
        let texel = texel_of(window.steps, plane);
        let min = window.first * texel - anchor.truncate();
        let max = min + texel * rule.resolution.as_dvec2();
        let (low, high) = shadows.depth(min, max, rule);
        let z = grid::stabilised_depth(z, (low + anchor.z, high + anchor.z), f64::from(self.technique.hold.waste));
        window.z = Some(z);
        let mut volume = Volume {
            axes: plane.axes,
            min: min.extend(z.0 - anchor.z),
            max: max.extend(z.1 - anchor.z),
            light_z: 0.0,
            depth_range: 0.0,
            set_by: [Constraint::Held; 6],
            is_empty: shadows.is_empty,
            grid: Some(Grid { first: window.first, texel, z }),
        };
        volume.light_at_near_plane();
        volume
    }
}

/// Size of a window's texels, in metres.
fn texel_of(steps: i32, plane: &Plane) -> DVec2 {
    let width = grid::eighths(steps);
    DVec2::new(width, width * plane.shape)
}

/// The part of the plane that a window holds with its border, relative to the origin of the fit.
fn rect_of(window: &Window, usable: DVec2, border: f64, anchor: DVec2) -> Rect {
    let texel = grid::eighths(window.steps);
    // Half of the texel that is lost to the shift onto the grid.
    let min = (window.first + border + 0.5) * texel - anchor;
    Rect { min: min.as_vec2(), size: (usable * texel).as_vec2() }
}

/// The window on the grid that holds a part of the plane.
fn window_of(steps: i32, rect: &Rect, border: f64, anchor: DVec2) -> Window {
    let line = (rect.min.as_dvec2() + anchor) / grid::eighths(steps) - border;
    Window { steps, first: DVec2::new(grid::floor(line.x), grid::floor(line.y)), z: None }
}

/// Steps by which the last window may be too large before it is made anew.
const LAST_WASTE: i32 = 5;

/// The window that holds a rectangle of the plane: the held one while it serves.
fn hold_all(held: Option<Window>, (min, max): (DVec2, DVec2), usable: DVec2, border: f64, anchor: DVec2) -> Window {
    let needed = grid::eighths_above(((max - min) / usable).max_element());
    let steps = held.map_or(needed, |held| held.steps).clamp(needed, needed.saturating_add(LAST_WASTE));
    let steps = if held.is_some_and(|held| held.steps > needed + LAST_WASTE) { needed } else { steps };
    let texel = grid::eighths(steps);
    let held_min = held.filter(|held| held.steps == steps).map(|held| (held.first + border) * texel - anchor);
    let size = (usable + 1.0) * texel;
    if let (Some(low), Some(held)) = (held_min, held) {
        let high = low + size;
        if low.cmple(min).all() && high.cmpge(max).all() {
            return held;
        }
        // The least move, and some of what is left toward the middle.
        let least = low.clamp(max - size, min);
        let middle = (min + max - size) * 0.5;
        let to = least + (middle - least) * MOVE_ON;
        let line = (to + anchor) / texel - border;
        let first = DVec2::new(libm::ceil(line.x), libm::ceil(line.y));
        let holds = |first: DVec2| {
            let low = (first + border) * texel - anchor;
            low.cmple(min).all() && (low + size).cmpge(max).all()
        };
        if holds(first) {
            return Window { steps, first, z: None };
        }
    }
    let line = ((min + max - usable * texel) * 0.5 + anchor) / texel - border;
    Window { steps, first: DVec2::new(grid::floor(line.x), grid::floor(line.y)), z: None }
}

/// Share of the way to the best place that a window moves beyond what it must.
pub(super) const MOVE_ON: f64 = 0.3;

impl HeldWindows {
    /// These windows for another light: each keeps its texels, and what it was around.
    fn moved_to(&self, plane: &Plane, origin: DVec3) -> Self {
        if self.plane == *plane {
            return *self;
        }
        let mut moved = Self { plane: *plane, pending: None, ..*self };
        let (old, new) = (self.plane.of(self.plane.axes.project(origin)), plane.of(plane.axes.project(origin)));
        for window in &mut moved.windows {
            let texel = grid::eighths(window.steps);
            // Seen from the origin of the fit, a light that turns a little moves little.
            let line = (window.first * texel - old + new) / texel;
            window.first = DVec2::new(grid::floor(line.x), grid::floor(line.y));
            window.z = None;
        }
        moved
    }
}

/// Room for rounding around what is held, in metres.
fn rounding(extent: f64, distance: f64) -> f64 {
    (extent + distance) * ROUNDING
}
