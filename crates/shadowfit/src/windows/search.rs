//! The search for better windows, a few changes in each frame.
//!
//! Three plans are kept: the windows that are drawn, the best plan found so far, and a second search that is
//! restarted from scratch whenever it has tried all its changes. Nobody sees the two searches. Drawn windows
//! keep their texels and move as little as they can; only where the best plan is better by enough, one of them
//! is replaced by its counterpart there, or some are in as many frames.

use glam::DVec3;

use super::cells::{Cells, Rect};
use super::plan::{Plan, Planner, SERVES};
use super::{Lattice, Window};
use crate::demand::grid::Plane;
use crate::technique::settings::MAX_MAPS;

/// What windows begin with in the next frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Held {
    plane: Plane,
    /// The windows that are drawn. Only these have depths.
    pub(super) drawn: [Window; MAX_MAPS],
    /// The best windows found so far.
    best: [Window; MAX_MAPS],
    /// The windows of the second search, which is restarted from scratch.
    restart: [Window; MAX_MAPS],
    progress: Progress,
}

/// How far the search has come.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Progress {
    /// Number of the change that is tried next in the best plan, and in the second search.
    next: u32,
    next_of_restart: u32,
    /// Share of the cost in each place that the drawn windows held when their places were last looked for.
    holds: [f32; MAX_MAPS],
    /// Frames since a drawn window was replaced, up to [`OLD`].
    age: u8,
    /// Whether no demand grid is known yet, so that what is visible is estimated from boxes.
    is_guess: bool,
}

/// Rounds of changes that are tried for a first frame.
const ROUNDS_AT_FIRST: u32 = 3;

/// Number of windows for which one change is tried in a frame.
const WINDOWS_PER_CHANGE: u32 = 4;

/// What is added to [`SERVES`] right after a window was replaced. It falls to 0 over [`OLD`] frames, so that
/// changes are rare but never stop.
const SERVES_LONGER: f32 = 0.25;
const OLD: u8 = 60;

/// One frame's search.
pub(super) struct Search<'a> {
    planner: Planner<'a>,
    lattice: &'a Lattice,
    /// The windows that were drawn in the frame before.
    before: Option<&'a [Window; MAX_MAPS]>,
    /// Texels and place of the last window, which is given.
    whole: (&'a Window, Rect),
    drawn: Plan,
    best: Plan,
    restart: Plan,
    progress: Progress,
    is_guess: bool,
}

impl<'a> Search<'a> {
    /// The search of a frame whose last window is given with its index.
    pub(super) fn new(
        lattice: &'a Lattice,
        cells: &'a Cells,
        (last, whole): (usize, &'a Window),
        before: Option<&'a Held>,
        is_guess: bool,
    ) -> Self {
        let planner = Planner { cells, usable: lattice.usable.as_vec2(), least: lattice.least, count: last + 1 };
        let whole = (whole, lattice.rect(whole));
        let plan = |windows: &[Window; MAX_MAPS]| {
            let mut plan = Plan::default();
            for (i, window) in windows.iter().enumerate().take(last + 1) {
                (plan.steps[i], plan.rects[i]) = (window.steps, lattice.rect(window));
            }
            planner.below(plan, whole.0.steps, whole.1)
        };
        let plan_of =
            |windows: fn(&Held) -> &[Window; MAX_MAPS]| before.map_or_else(Plan::default, |h| plan(windows(h)));
        let (drawn, best, restart) = (plan_of(|h| &h.drawn), plan_of(|h| &h.best), plan_of(|h| &h.restart));
        let progress = before.map_or_else(Progress::default, |before| before.progress);
        let before = before.map(|before| &before.drawn);
        Self { planner, lattice, before, whole, drawn, best, restart, progress, is_guess }
    }

    /// Searches on; gives this frame's windows and what the next frame begins with.
    pub(super) fn next(mut self) -> Held {
        let is_told = self.progress.is_guess && !self.is_guess;
        if self.before.is_none() {
            self.begin();
        } else {
            if is_told {
                self.learn();
            } else if self.progress.next_of_restart >= self.progress.next {
                self.improve_best();
            } else {
                self.improve_restart();
            }
            self.draw(is_told);
        }
        self.held()
    }

    /// The first frame: some rounds at once, and all plans the same.
    fn begin(&mut self) {
        self.best = self.ladder();
        let changes = ROUNDS_AT_FIRST * self.planner.round();
        self.planner.seek(&mut self.best, &mut self.progress.next, changes);
        self.progress.next_of_restart = self.progress.next;
        (self.drawn, self.restart) = (self.best, self.best);
    }

    /// The first frame in which it is known what is visible: a whole round at once.
    fn learn(&mut self) {
        self.best = self.planner.better(self.best, self.ladder());
        self.planner.seek(&mut self.best, &mut self.progress.next, self.planner.round());
        self.progress.next_of_restart = self.progress.next;
    }

    /// Tries changes of the best plan.
    fn improve_best(&mut self) {
        let changes = self.changes();
        self.planner.seek(&mut self.best, &mut self.progress.next, changes);
    }

    /// Tries changes in the second search, or takes what it found and restarts it.
    fn improve_restart(&mut self) {
        let changes = self.changes();
        let next = &mut self.progress.next_of_restart;
        if next.is_multiple_of(self.planner.round().max(1)) {
            *next = next.wrapping_add(changes);
            self.best = self.planner.better(self.best, self.restart);
            self.restart = self.ladder();
        } else {
            self.planner.seek(&mut self.restart, next, changes);
        }
    }

    /// Moves the drawn windows as little as they can be, and replaces some where the best plan is better by enough.
    fn draw(&mut self, is_told: bool) {
        let Progress { next, holds, age, .. } = &mut self.progress;
        self.planner.keep(&mut self.drawn, &self.best, holds, *next);
        let most = SERVES + SERVES_LONGER * (1.0 - f32::from(*age) / f32::from(OLD));
        let (followed, goes_on) = if is_told {
            (self.planner.follow_at_once(self.drawn, &self.best), false)
        } else {
            self.planner.follow(self.drawn, &self.best, most)
        };
        *age = if followed == self.drawn {
            age.saturating_add(1).min(OLD)
        } else if goes_on {
            // As if nothing had been replaced for long, until it is done.
            OLD
        } else {
            0
        };
        self.drawn = followed;
    }

    /// Even steps of texels in front of the last window.
    fn ladder(&self) -> Plan {
        self.planner.ladder(self.whole.0.steps, self.whole.1)
    }

    /// Number of changes that are tried in a frame.
    fn changes(&self) -> u32 {
        (self.planner.count as u32).div_ceil(WINDOWS_PER_CHANGE)
    }

    /// The plans as windows on the world's grid.
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
            // Rectangles are rounded, lines are not: what stays is taken as it is.
            let (steps, rect) = (self.drawn.steps[i], self.drawn.rects[i]);
            let stays = |window: &&Window| window.steps == steps && self.lattice.rect(window) == rect;
            *window = self.before.map(|before| &before[i]).filter(stays).copied().unwrap_or(*window);
        }
        drawn[self.planner.count - 1] = *self.whole.0;
        let progress = Progress { is_guess: self.is_guess, ..self.progress };
        let (best, restart) = (windows(&self.best), windows(&self.restart));
        Held { plane: self.lattice.plane, drawn, best, restart, progress }
    }
}

impl Held {
    /// Whether what is visible was only estimated from the boxes.
    pub(crate) fn is_guess(&self) -> bool {
        self.progress.is_guess
    }

    /// These windows for the light of another frame.
    pub(super) fn in_plane(&self, lattice: &Lattice, origin: DVec3) -> Self {
        if self.plane == lattice.plane {
            return *self;
        }
        let turned = |window: Window| lattice.turned(&window, &self.plane, origin);
        let [drawn, best, restart] = [self.drawn, self.best, self.restart].map(|windows| windows.map(turned));
        Self { plane: lattice.plane, drawn, best, restart, ..*self }
    }
}
