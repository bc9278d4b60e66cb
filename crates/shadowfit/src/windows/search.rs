//! The search for better windows, a few changes in each frame.
//!
//! There are three [plans](super::plan): the drawn windows, the best plan so far, and a second search that is
//! restarted from scratch whenever it has tried all its changes. The phase of a frame decides which of them
//! changes:
//!
//! | phase | condition | tried changes | windows that may be drawn |
//! |---|---|---|---|
//! | `First` | no frame before | a ladder and three rounds of changes of `best` | `best` |
//! | `FirstDemand` | demand is known for the first time | a ladder and a round of changes of `best` | all necessary windows of `best` |
//! | `ImproveBest` | `restart` has tried the same number of changes or more | one change of `best` for every four windows | moved windows, and one of `best` |
//! | `ImproveRestart` | `best` has tried more changes | one change of `restart` for every four windows; after a round the cheaper plan becomes `best`, and `restart` a new ladder | moved windows, and one of `best` |
//!
//! Drawn windows keep their texels and move as little as possible. One of them is replaced by its counterpart
//! in the best plan only if that plan is sufficiently cheaper.

use glam::DVec3;

use super::cells::Cells;
use super::lattice::{Lattice, Rect, Window};
use super::plan::{Plan, Planner, Replacement, SERVES};
use crate::demand::grid::Plane;
use crate::technique::settings::MAX_MAPS;

/// State of the windows from one frame to the next.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Held {
    plane: Plane,
    /// The drawn windows. Only these have depths.
    pub(super) drawn: [Window; MAX_MAPS],
    /// The best windows found so far.
    best: [Window; MAX_MAPS],
    /// The windows of the second search, which is restarted from scratch.
    restart: [Window; MAX_MAPS],
    progress: Progress,
}

/// Progress of the search.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Progress {
    /// Number of the next change to try in the best plan.
    next: u32,
    /// Number of the next change to try in the second search.
    next_of_restart: u32,
    /// Share of the cost that each drawn window held at its last search.
    holds: [f32; MAX_MAPS],
    /// Frames since a drawn window was replaced, up to [`OLD`].
    age: u8,
    /// Whether no demand grid is known yet, so that the visible demand is estimated from boxes.
    is_guess: bool,
}

/// Rounds of changes to try for a first frame.
const ROUNDS_AT_FIRST: u32 = 3;

/// Number of windows per change that a frame tries.
const WINDOWS_PER_CHANGE: u32 = 4;

/// Addition to [`SERVES`] right after a window was replaced. It falls to 0 over [`OLD`] frames, so that
/// replacements are rare but never stop.
const SERVES_LONGER: f32 = 0.25;
const OLD: u8 = 60;

/// Task of the search in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    First,
    FirstDemand,
    ImproveBest,
    ImproveRestart,
}

/// One frame's search.
pub(super) struct Search<'a> {
    planner: Planner<'a>,
    lattice: &'a Lattice,
    /// Windows drawn in the last frame.
    before: Option<&'a [Window; MAX_MAPS]>,
    /// The given last window, and its rectangle.
    whole: &'a Window,
    whole_rect: Rect,
    drawn: Plan,
    best: Plan,
    restart: Plan,
    progress: Progress,
    is_guess: bool,
}

impl<'a> Search<'a> {
    /// Creates the search of a frame. The last window `whole` is given, with its index `last`.
    pub(super) fn new(
        lattice: &'a Lattice,
        cells: &'a Cells,
        last: usize,
        whole: &'a Window,
        before: Option<&'a Held>,
        is_guess: bool,
    ) -> Self {
        let planner = Planner { cells, usable: lattice.usable.as_vec2(), least: lattice.least, count: last + 1 };
        let whole_rect = lattice.rect(whole);
        let plan = |windows: &[Window; MAX_MAPS]| {
            let mut plan = Plan::default();
            for (i, window) in windows.iter().enumerate().take(last + 1) {
                (plan.steps[i], plan.rects[i]) = (window.steps, lattice.rect(window));
            }
            planner.below(plan, whole.steps, whole_rect)
        };
        let plan_of =
            |windows: fn(&Held) -> &[Window; MAX_MAPS]| before.map_or_else(Plan::default, |h| plan(windows(h)));
        let (drawn, best, restart) = (plan_of(|h| &h.drawn), plan_of(|h| &h.best), plan_of(|h| &h.restart));
        let progress = before.map_or_else(Progress::default, |before| before.progress);
        let before = before.map(|before| &before.drawn);
        Self { planner, lattice, before, whole, whole_rect, drawn, best, restart, progress, is_guess }
    }

    /// Continues the search. Returns this frame's windows, which are also the state for the next frame.
    pub(super) fn next(mut self) -> Held {
        let phase = self.phase();
        match phase {
            Phase::First => self.begin(),
            Phase::FirstDemand => self.learn(),
            Phase::ImproveBest => self.improve_best(),
            Phase::ImproveRestart => self.improve_restart(),
        }
        if phase != Phase::First {
            self.draw(phase);
        }
        self.held()
    }

    fn phase(&self) -> Phase {
        let Progress { next, next_of_restart, is_guess, .. } = self.progress;
        match self.before {
            None => Phase::First,
            Some(_) if is_guess && !self.is_guess => Phase::FirstDemand,
            Some(_) if next_of_restart >= next => Phase::ImproveBest,
            Some(_) => Phase::ImproveRestart,
        }
    }

    /// Tries some rounds at once. All plans are then the same.
    fn begin(&mut self) {
        self.best = self.ladder();
        let changes = ROUNDS_AT_FIRST * self.planner.changes_per_round();
        self.planner.try_changes(&mut self.best, &mut self.progress.next, changes);
        self.progress.next_of_restart = self.progress.next;
        (self.drawn, self.restart) = (self.best, self.best);
    }

    /// Uses the first demand grid, and tries a whole round at once.
    fn learn(&mut self) {
        self.best = self.planner.cheaper(self.best, self.ladder());
        self.planner.try_changes(&mut self.best, &mut self.progress.next, self.planner.changes_per_round());
        self.progress.next_of_restart = self.progress.next;
    }

    /// Tries changes of the best plan.
    fn improve_best(&mut self) {
        let changes = self.changes();
        self.planner.try_changes(&mut self.best, &mut self.progress.next, changes);
    }

    /// Tries changes in the second search, or takes its result and restarts it.
    fn improve_restart(&mut self) {
        let changes = self.changes();
        let next = &mut self.progress.next_of_restart;
        if next.is_multiple_of(self.planner.changes_per_round().max(1)) {
            *next = next.wrapping_add(changes);
            self.best = self.planner.cheaper(self.best, self.restart);
            self.restart = self.ladder();
        } else {
            self.planner.try_changes(&mut self.restart, next, changes);
        }
    }

    /// Moves the drawn windows as little as possible. Replaces some if the best plan is sufficiently cheaper.
    fn draw(&mut self, phase: Phase) {
        let Progress { next, holds, age, .. } = &mut self.progress;
        self.planner.move_windows(&mut self.drawn, &self.best, holds, *next);
        let limit = SERVES + SERVES_LONGER * (1.0 - f32::from(*age) / f32::from(OLD));
        let Replacement { plan, has_more_to_come } = if phase == Phase::FirstDemand {
            Replacement { plan: self.planner.replace_all(self.drawn, &self.best), has_more_to_come: false }
        } else {
            self.planner.replace_one(self.drawn, &self.best, limit)
        };
        *age = if plan == self.drawn {
            age.saturating_add(1).min(OLD)
        } else if has_more_to_come {
            // Counts as a long time without a replacement, until all have been replaced.
            OLD
        } else {
            0
        };
        self.drawn = plan;
    }

    /// Returns a plan with even ratios of texels in front of the last window.
    fn ladder(&self) -> Plan {
        self.planner.ladder(self.whole.steps, self.whole_rect)
    }

    /// Returns the number of changes that a frame tries.
    fn changes(&self) -> u32 {
        (self.planner.count as u32).div_ceil(WINDOWS_PER_CHANGE)
    }

    /// Returns the plans as windows on the world's grid.
    fn held(&self) -> Held {
        let windows = |plan: &Plan| {
            let mut windows = [Window::default(); MAX_MAPS];
            for (i, window) in windows.iter_mut().enumerate().take(self.planner.count) {
                *window = self.lattice.window(plan.steps[i], &plan.rects[i]);
            }
            windows
        };
        let mut drawn = windows(&self.drawn);
        for (i, window) in drawn.iter_mut().enumerate().take(self.planner.count - 1) {
            // Rectangles are rounded, but grid lines are not. So a window that did not move is copied.
            let (steps, rect) = (self.drawn.steps[i], self.drawn.rects[i]);
            let stays = |window: &&Window| window.steps == steps && self.lattice.rect(window) == rect;
            *window = self.before.map(|before| &before[i]).filter(stays).copied().unwrap_or(*window);
        }
        drawn[self.planner.count - 1] = *self.whole;
        let progress = Progress { is_guess: self.is_guess, ..self.progress };
        let (best, restart) = (windows(&self.best), windows(&self.restart));
        Held { plane: self.lattice.plane, drawn, best, restart, progress }
    }
}

impl Held {
    /// Returns whether the visible demand was only estimated from the boxes.
    pub(crate) fn is_guess(&self) -> bool {
        self.progress.is_guess
    }

    /// Returns these windows for the light of another frame.
    pub(super) fn in_plane(&self, lattice: &Lattice, origin: DVec3) -> Self {
        if self.plane == lattice.plane {
            return *self;
        }
        let turned = |window: Window| lattice.turned(&window, &self.plane, origin);
        let [drawn, best, restart] = [self.drawn, self.best, self.restart].map(|windows| windows.map(turned));
        Self { plane: lattice.plane, drawn, best, restart, ..*self }
    }
}
