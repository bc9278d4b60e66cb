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
//! its texels; all places are compared by sums over a raster. The sizes are searched one at a time,
//! frame after frame, in a plan that nobody sees, and in a second one that begins anew again and again. The
//! windows that are drawn move as little as they can, when they hold less than 98.5% of what they could, and
//! one of them is replaced by its counterpart in the plan when they cost 1.35 times as much as the plan, or 1.1
//! times for a second at 60 frames a second. Only in the frame in which it becomes known what is visible may
//! more of them be replaced at once.
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

use glam::DVec2;

use crate::base::FitError;
use crate::content::Content;
use crate::demand::need::Plane;
use crate::fits::{Constraint, FitInput, FitRule, Grid, Volume};
use crate::light::{Light, grid};
use crate::technique::Technique;
use crate::technique::settings::{MAX_MAPS, NeedSource};
use crate::view::Range;
use cells::Cells;
use depth::Shadows;
use lattice::{Lattice, Window};
use plan::{Plan, Planner};

/// What a point costs whose texel is this many times too wide: the ratio's power of 3/2.
///
/// By the ratio itself, or its square, pictures are as good on average; the one leaves more points with
/// far too wide texels, the other has wider ones where most points are.
fn cost_of(ratio: f32) -> f32 {
    ratio * libm::sqrtf(ratio)
}

/// The windows of the last frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct HeldWindows {
    plane: Plane,
    /// Those that were drawn, those that are sought, and those that are sought anew, whose depths are not known.
    drawn: [Window; MAX_MAPS],
    sought: [Window; MAX_MAPS],
    anew: [Window; MAX_MAPS],
    /// Shares of the cost that the drawn ones held when they were last looked at.
    holds: [f32; MAX_MAPS],
    /// Numbers of the changes that were tried of those that are sought, and of those that are sought anew.
    turn: u32,
    turn_anew: u32,
    /// Frames since one was replaced.
    age: u8,
    /// Whether no grid of need was known yet.
    is_guess: bool,
}

/// Rounds of changes that are tried for a first frame.
const ROUNDS_AT_FIRST: u32 = 3;

/// Windows for each change that is tried in a frame.
const WINDOWS_PER_CHANGE: u32 = 4;

/// What the ratio of [`plan::SERVES`] is more for windows of which one has just been replaced, and the frames after
/// which it is no more: changes are rare while the scene changes, and nothing is left as it is for ever.
const SERVES_LONGER: f32 = 0.25;
const OLD: u8 = 60;

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
        rule: &FitRule,
        before: Option<&HeldWindows>,
        points: &mut [DVec2],
    ) -> Result<([Option<Volume>; MAX_MAPS], HeldWindows), FitError> {
        let count = self.technique.count as usize;
        let origin = self.content.origin;
        // 1. The plane across the light, and the windows of the frame before in it.
        let plane = Plane::new(self.light.direction(), self.light.up());
        let lattice = Lattice::new(plane, origin, rule);
        let before = before.map(|before| before.in_plane(&lattice, origin));
        // 2. What all windows together must hold, and what is visible of it.
        let shadows = Shadows::new(self.content, plane.axes, self.range, points)?;
        let (mut cells, is_guess) = self.cells(&plane);
        // 3. The last window, which holds everything, then the others.
        let last =
            lattice.last(count - 1, before.as_ref().map(|before| &before.drawn[count - 1]), shadows.bounds(&plane));
        cells.keep_near(&lattice.rect(&last));
        let mut held = plan_windows(&lattice, (count, &last), &cells, before.as_ref(), is_guess);
        // 4. Their depths, held while they serve.
        let mut volumes = [None; MAX_MAPS];
        for (i, volume) in volumes.iter_mut().enumerate().take(count) {
            let window = &mut held.drawn[i];
            let before = before.as_ref().map(|before| &before.drawn[i]).filter(|was| was.steps == window.steps);
            window.z = before.and_then(|before| before.z);
            *volume = Some(self.volume(&lattice, window, rule, &shadows));
        }
        Ok((volumes, held))
    }

    /// What is visible, and whether it is estimated from the boxes.
    fn cells(&self, plane: &Plane) -> (Cells, bool) {
        let mut cells = Cells::new();
        if self.technique.need == NeedSource::LastFrame {
            for grid in self.input.need.iter().filter(|grid| grid.is_for(plane)) {
                cells.add_grid(grid, plane, self.content.origin);
            }
        }
        let is_guess = cells.len == 0;
        if is_guess {
            boxes::add(&mut cells, self.input, self.content, plane, (self.light.up(), self.range.far));
        }
        (cells, is_guess)
    }

    /// A window's box. Its depth range is taken from the window while it serves, and written to it.
    fn volume(&self, lattice: &Lattice, window: &mut Window, rule: &FitRule, shadows: &Shadows) -> Volume {
        let axes = lattice.plane.axes;
        let anchor = grid::anchor(&axes, self.content.origin);
        let texel = lattice.texel(window.steps);
        let min = window.first * texel - anchor.truncate();
        let max = min + texel * rule.resolution.as_dvec2();
        // A texel more on all sides, for the rasteriser.
        let depth = shadows.depth((min - texel, max + texel), rule);
        let (low, high) = (depth.low + anchor.z, depth.high + anchor.z);
        let z = grid::stabilised_depth(window.z, (low, high), f64::from(self.technique.hold.waste));
        window.z = Some(z);
        let side = Constraint::Window;
        let mut volume = Volume {
            axes,
            min: min.extend(z.0 - anchor.z),
            max: max.extend(z.1 - anchor.z),
            light_z: 0.0,
            depth_range: 0.0,
            set_by: [side, side, side, side, depth.far_by, depth.near_by],
            is_empty: shadows.is_empty,
            grid: Some(Grid { first: window.first, texel, z }),
        };
        volume.light_at_near_plane();
        volume
    }
}

/// The windows of a frame before the last one, which is given: each kept, moved, or made anew.
fn plan_windows(
    lattice: &Lattice,
    (count, last): (usize, &Window),
    cells: &Cells,
    before: Option<&HeldWindows>,
    is_guess: bool,
) -> HeldWindows {
    let planner = Planner { cells, usable: lattice.usable.as_vec2(), least: lattice.least, count };
    let rect = lattice.rect(last);
    let (mut turn, mut turn_anew) = before.map_or((0, 0), |before| (before.turn, before.turn_anew));
    let mut age = 0;
    let mut holds = before.map_or([0.0; MAX_MAPS], |before| before.holds);
    let (drawn, sought, anew) = if let Some(before) = before {
        let plan = |windows: &[Window; MAX_MAPS]| {
            let mut plan = Plan::default();
            for (i, window) in windows.iter().enumerate().take(count) {
                (plan.steps[i], plan.rects[i]) = (window.steps, lattice.rect(window));
            }
            planner.below(plan, last.steps, rect)
        };
        let (mut drawn, mut sought, mut anew) = (plan(&before.drawn), plan(&before.sought), plan(&before.anew));
        let changes = (count as u32).div_ceil(WINDOWS_PER_CHANGE);
        let is_told = before.is_guess && !is_guess;
        if is_told {
            sought = planner.better(sought, planner.ladder(last.steps, rect));
            planner.seek(&mut sought, &mut turn, planner.round());
            turn_anew = turn;
        } else if turn_anew >= turn {
            planner.seek(&mut sought, &mut turn, changes);
        } else if turn_anew % planner.round().max(1) == 0 {
            sought = planner.better(sought, anew);
            anew = planner.ladder(last.steps, rect);
            turn_anew = turn_anew.wrapping_add(changes);
        } else {
            planner.seek(&mut anew, &mut turn_anew, changes);
        }
        planner.keep(&mut drawn, &mut holds, turn);
        let young = SERVES_LONGER * (1.0 - f32::from(before.age) / f32::from(OLD));
        let followed = planner.follow(drawn, &sought, plan::SERVES + if is_told { 0.0 } else { young }, is_told);
        age = if followed == drawn { before.age.saturating_add(1).min(OLD) } else { 0 };
        (followed, sought, anew)
    } else {
        let mut plan = planner.ladder(last.steps, rect);
        planner.seek(&mut plan, &mut turn, ROUNDS_AT_FIRST * planner.round());
        turn_anew = turn;
        (plan, plan, plan)
    };
    let mut windows = HeldWindows {
        plane: lattice.plane,
        drawn: [Window::default(); MAX_MAPS],
        sought: [Window::default(); MAX_MAPS],
        anew: [Window::default(); MAX_MAPS],
        holds,
        turn,
        turn_anew,
        age,
        is_guess,
    };
    for i in 0..count {
        // Rectangles are rounded, lines are not: what stays is taken as it is.
        let stays = |window: &&Window| window.steps == drawn.steps[i] && lattice.rect(window) == drawn.rects[i];
        let kept = before.map(|before| &before.drawn[i]).filter(stays);
        windows.drawn[i] = kept.map_or_else(|| lattice.window(drawn.steps[i], &drawn.rects[i]), |kept| *kept);
        windows.sought[i] = lattice.window(sought.steps[i], &sought.rects[i]);
        windows.anew[i] = lattice.window(anew.steps[i], &anew.rects[i]);
    }
    windows.drawn[count - 1] = *last;
    windows
}

impl HeldWindows {
    /// These windows for the light of another frame.
    fn in_plane(&self, lattice: &Lattice, origin: glam::DVec3) -> Self {
        if self.plane == lattice.plane {
            return *self;
        }
        let turned = |window: Window| lattice.turned(&window, &self.plane, origin);
        let [drawn, sought, anew] = [self.drawn, self.sought, self.anew].map(|windows| windows.map(turned));
        Self { plane: lattice.plane, drawn, sought, anew, ..*self }
    }
}
