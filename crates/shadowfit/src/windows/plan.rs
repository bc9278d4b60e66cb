//! Sizes and places of all windows, and how they change.
//!
//! A plan P has a texel width tᵢ and a place for each window i. Its cost is the sum over all visible points
//! that read too wide texels:
//!
//! ```text
//!   cost(P) = Σ over cells c   w_c · Σ over windows i   share_i(c) · (t_i / s_c)^(3/2)
//!
//!   w_c        points in cell c               share_i(c)   part of c inside window i and in no finer window
//!   s_c        texel width that c asks for    t_i          texel width of window i
//! ```
//!
//! The [search](super::search) has three plans, only one of which is drawn. In each frame:
//!
//! ```text
//!   drawn ──move_windows: each keeps 99.3% of its best place──▶ drawn'       best ◀── try_changes: one window a frame
//!   drawn' ──if cost(drawn') > limit · cost(best): replace_one──▶ drawn''    limit 1.35 → 1.1 over 60 frames
//!   restart ──after a whole round: if cheaper, becomes best; then a new ladder──▶ restart
//! ```
//!
//! Texel widths ascend from window to window in every plan (`is_in_order`).

use core::ops::Range;

use glam::Vec2;

use super::cells::{Cells, PerCell};
use super::counted::MAX_CELLS;
use super::lattice::{MOVE_ON, Rect, cost_of};
use super::raster;
use crate::light::grid;
use crate::technique::settings::MAX_MAPS;

/// Texels and places of all windows, finest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plan {
    /// Texel widths, in eighths of an octave of a metre.
    pub(super) steps: [i32; MAX_MAPS],
    pub(super) rects: [Rect; MAX_MAPS],
}

impl Plan {
    /// Takes a window from another plan.
    fn replace(&mut self, window: usize, other: &Self) {
        (self.steps[window], self.rects[window]) = (other.steps[window], other.rects[window]);
    }

    /// Returns this plan with one window of another plan.
    fn replaced(mut self, window: usize, other: &Self) -> Self {
        self.replace(window, other);
        self
    }
}

/// Context for comparing and changing plans.
pub(super) struct Planner<'a> {
    pub(super) cells: &'a Cells,
    /// Texels of a window between its borders.
    pub(super) usable: Vec2,
    /// Least texel width, in eighths of an octave of a metre.
    pub(super) least: i32,
    pub(super) count: usize,
}

/// Coverage by the finest windows of a plan.
#[derive(Clone)]
struct Coverage {
    /// Share of each cell that none of these windows covers.
    left: PerCell,
    /// Price of each cell: `Σ share_i · t_i^(3/2)` over these windows.
    price: PerCell,
}

/// A drawn plan after a replacement.
pub(super) struct Replacement {
    pub(super) plan: Plan,
    /// Whether further windows will be replaced in the next frames.
    pub(super) has_more_to_come: bool,
}

/// A plan and its cost.
struct Candidate {
    plan: Plan,
    cost: f32,
}

/// Ratios of neighbouring windows' texels with which a search begins, in eighths of an octave.
const LADDERS: [i32; 6] = [4, 7, 10, 13, 17, 22];

/// Greatest ratio of the last window's texels to the first window's, in eighths of an octave. It exceeds the
/// octaves of a demand grid, and is small enough that all grid lines are exact.
const GREATEST_RATIO: i32 = 20 * 8;

/// Changes of a window's texels to try, in eighths of an octave.
const CHANGES: [i32; 6] = [4, -4, 8, -8, 2, -2];

/// Share of the cells' cost inside its best place that a window must contain to stay in its place.
const HOLDS: f32 = 0.993;

/// Factor for the share of the cost that a window held at its last search. Below it, the window is searched
/// out of turn.
const LOOKS: f32 = 0.99;

/// Greatest ratio of the drawn windows' cost to the best plan's at which no window is replaced.
pub(super) const SERVES: f32 = 1.1;

/// Least share of the points that a change counts for.
const FEW: f32 = 0.02;

impl Planner<'_> {
    /// Returns the best of several even ladders of windows below a given last window.
    pub(super) fn ladder(&self, last: i32, rect: Rect) -> Plan {
        let mut best: Option<Candidate> = None;
        for ratio in LADDERS {
            let mut plan = Plan::default();
            for i in 0..self.count {
                let even = last.saturating_sub(ratio * i32::from((self.count - 1 - i) as u8));
                plan.steps[i] = even.max(self.least_of(i));
            }
            plan.rects[self.count - 1] = rect;
            self.place_all(&mut plan);
            let cost = self.cost(&plan);
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Candidate { plan, cost });
            }
        }
        best.map_or_else(Plan::default, |best| best.plan)
    }

    /// Improves a plan: moves one window to its best place, and tries changes of single windows. `turn`
    /// counts the tried changes.
    pub(super) fn try_changes(&self, plan: &mut Plan, turn: &mut u32, changes: u32) {
        let others = self.count as u32 - 1;
        if others == 0 {
            return;
        }
        let mut cost = self.cost(plan);
        for _ in 0..changes {
            let number = *turn % (others * CHANGES.len() as u32);
            *turn = turn.wrapping_add(1);
            let (window, change) = ((number % others) as usize, CHANGES[(number / others) as usize]);
            let finer = self.coverage(plan, window);
            // A round begins with windows in their best places.
            let moved = (number < others).then(|| self.changed(plan, &finer, window, 0)).flatten();
            for candidate in [moved, self.changed(plan, &finer, window, change)].into_iter().flatten() {
                if candidate.cost < cost {
                    (*plan, cost) = (candidate.plan, candidate.cost);
                }
            }
        }
    }

    /// Returns the number of all changes of all windows except the last.
    pub(super) const fn changes_per_round(&self) -> u32 {
        (self.count as u32 - 1) * CHANGES.len() as u32
    }

    /// Fits a plan below a last window whose texels may differ from the plan's.
    pub(super) fn below(&self, mut plan: Plan, last: i32, rect: Rect) -> Plan {
        plan.steps[self.count - 1] = last;
        plan.rects[self.count - 1] = rect;
        for i in (0..self.count - 1).rev() {
            let least = self.least_of(i).max(last.saturating_sub(GREATEST_RATIO));
            let steps = plan.steps[i].max(least).min(plan.steps[i + 1] - 1);
            if steps != plan.steps[i] {
                plan.steps[i] = steps;
                let middle = plan.rects[i].min + plan.rects[i].size * 0.5;
                plan.rects[i].size = self.size(plan.steps[i]);
                plan.rects[i].min = middle - plan.rects[i].size * 0.5;
            }
        }
        plan
    }

    /// Moves each window that no longer contains most of the cells' cost that its best place would contain.
    /// `holds` has the shares of the cost that the windows contained at their last searches. Each call searches one window in
    /// turn, and the windows whose shares have fallen.
    pub(super) fn move_windows(&self, plan: &mut Plan, best: &Plan, holds: &mut [f32; MAX_MAPS], turn: u32) {
        let mut left = [1.0; MAX_CELLS];
        for (i, holds) in holds.iter_mut().enumerate().take(self.count - 1) {
            let all = self.cells.sum(&self.cells.cost, &left, |cost, left| cost * left);
            let share = |rect: &Rect| if all > 0.0 { self.cost_inside(rect, &left) / all } else { 1.0 };
            let is_turn = turn as usize % (self.count - 1) == i;
            if is_turn || share(&plan.rects[i]) < *holds * LOOKS {
                let mut moved = *plan;
                moved.rects[i] = self.least_move(&plan.rects[i], &left);
                // Two windows must not swap places for each other's content. A window in its place of the
                // best plan would be moved back there again and again.
                let way = (moved.rects[i].min - plan.rects[i].min).abs();
                let is_leap = way.cmpgt(plan.rects[i].size * 0.5).any();
                let is_best = (plan.steps[i], plan.rects[i]) == (best.steps[i], best.rects[i]);
                if !(is_leap || is_best) || self.cost(&moved) < self.cost(plan) {
                    *plan = moved;
                }
                *holds = share(&plan.rects[i]);
            }
            self.add_window(&plan.rects[i], &mut left);
        }
    }

    /// Replaces drawn windows by their counterparts in the best plan until the drawn plan is nearly as good.
    pub(super) fn replace_all(&self, drawn: Plan, best: &Plan) -> Plan {
        let found = self.cost(best);
        let mut plan = drawn;
        while self.cost(&plan) > found * SERVES {
            let Some(run) = self.best_run(&plan, best) else { return plan };
            for i in run {
                plan.replace(i, best);
            }
        }
        plan
    }

    /// Replaces one drawn window by its counterpart in the best plan, if the drawn plan costs more than the
    /// best one times `limit`. The window's texels must lie between its neighbours' texels, so several
    /// windows in a row may have to be replaced for a gain. The others follow in the next frames.
    pub(super) fn replace_one(&self, drawn: Plan, best: &Plan, limit: f32) -> Replacement {
        let is_good = self.cost(&drawn) <= self.cost(best) * limit;
        let run = if is_good { None } else { self.best_run(&drawn, best) };
        let Some(run) = run else { return Replacement { plan: drawn, has_more_to_come: false } };
        let replaced = run.clone().map(|i| drawn.replaced(i, best));
        // If all windows of the run become coarser, this is the coarsest. If they become finer, it is the
        // finest.
        let may_be = replaced.filter(|plan| *plan != drawn && self.is_in_order(&plan.steps));
        let cheapest = may_be.min_by(|a, b| self.cost(a).total_cmp(&self.cost(b)));
        Replacement { plan: cheapest.unwrap_or(drawn), has_more_to_come: run.len() > 1 }
    }

    /// Returns the run of consecutive windows whose replacement by the other plan's windows gains most per
    /// point that then reads other texels. Returns `None` if no run gains anything.
    fn best_run(&self, plan: &Plan, target: &Plan) -> Option<Range<usize>> {
        let (cost, readers) = (self.cost(plan), self.readers(plan));
        let mut best: Option<(f32, Range<usize>)> = None;
        for first in 0..self.count - 1 {
            let (mut other, mut changed) = (*plan, FEW);
            for (i, readers) in readers.iter().enumerate().take(self.count - 1).skip(first) {
                other.replace(i, target);
                changed += readers;
                let gain = (cost - self.cost(&other)) / changed;
                let is_better = gain > 0.0 && best.as_ref().is_none_or(|(most, _)| gain > *most);
                if is_better && self.is_in_order(&other.steps) {
                    best = Some((gain, first..i + 1));
                }
            }
        }
        best.map(|(_, run)| run)
    }

    /// Returns the shares of the points that read each window.
    fn readers(&self, plan: &Plan) -> [f32; MAX_MAPS] {
        let points = |left: &PerCell| self.cells.sum(&self.cells.weight, left, |weight, left| weight * left);
        let mut left = [1.0; MAX_CELLS];
        let all = points(&left);
        let mut rest = all;
        core::array::from_fn(|i| {
            let before = rest;
            if i < self.count - 1 {
                self.add_window(&plan.rects[i], &mut left);
                rest = points(&left);
            }
            (before - rest) / all
        })
    }

    /// Returns a plan with other texels of one window, which is moved to its best place. Returns `None` if
    /// sizes would cross. `finer` is the coverage of the finer windows.
    fn changed(&self, plan: &Plan, finer: &Coverage, window: usize, change: i32) -> Option<Candidate> {
        let mut plan = *plan;
        plan.steps[window] += change;
        if !self.is_in_order(&plan.steps) {
            return None;
        }
        plan.rects[window] = raster::best(self.cells, &finer.left, self.size(plan.steps[window]));
        let cost = self.cost_from(finer.clone(), &plan, window);
        Some(Candidate { plan, cost })
    }

    /// Returns the held place if it holds nearly as much as the best one. Otherwise returns the least move
    /// that does, and [some more](MOVE_ON).
    fn least_move(&self, held: &Rect, left: &PerCell) -> Rect {
        let best = raster::best(self.cells, left, held.size);
        let enough = self.cost_inside(&best, left) * HOLDS;
        if self.cost_inside(held, left) >= enough {
            return *held;
        }
        let way = best.min - held.min;
        let at = |share: f32| Rect { min: held.min + way * share, size: held.size };
        let share = (1..8).map(|i| i as f32 / 8.0).find(|share| self.cost_inside(&at(*share), left) >= enough);
        share.map_or(best, |share| at(share + (1.0 - share) * MOVE_ON as f32))
    }

    /// Moves all windows except the last to their best places, one after the other.
    fn place_all(&self, plan: &mut Plan) {
        let mut left = [1.0; MAX_CELLS];
        for i in 0..self.count - 1 {
            plan.rects[i] = raster::best(self.cells, &left, self.size(plan.steps[i]));
            self.add_window(&plan.rects[i], &mut left);
        }
    }

    /// Returns the cheaper one of two plans.
    pub(super) fn cheaper(&self, one: Plan, other: Plan) -> Plan {
        if self.cost(&other) < self.cost(&one) { other } else { one }
    }

    /// Returns the cost of a plan.
    pub(super) fn cost(&self, plan: &Plan) -> f32 {
        self.cost_from(self.coverage(plan, 0), plan, 0)
    }

    /// Returns the cost of a plan for which the coverage of the windows before `first` is known.
    fn cost_from(&self, mut coverage: Coverage, plan: &Plan, first: usize) -> f32 {
        self.add_windows(&mut coverage, plan, first..self.count - 1);
        let last = price_of(plan.steps[self.count - 1]);
        for (price, left) in coverage.price.iter_mut().zip(&coverage.left) {
            *price += left * last;
        }
        self.cells.sum(&self.cells.cost, &coverage.price, |cost, price| cost * price)
    }

    /// Returns the coverage of the first windows of a plan.
    fn coverage(&self, plan: &Plan, windows: usize) -> Coverage {
        let mut coverage = Coverage { left: [1.0; MAX_CELLS], price: [0.0; MAX_CELLS] };
        self.add_windows(&mut coverage, plan, 0..windows);
        coverage
    }

    /// Adds windows of a plan to a coverage.
    fn add_windows(&self, coverage: &mut Coverage, plan: &Plan, windows: Range<usize>) {
        let mut shares = [0.0; MAX_CELLS];
        for i in windows {
            self.cells.shares(&plan.rects[i], &mut shares);
            let its = price_of(plan.steps[i]);
            let n = self.cells.len;
            let all = coverage.price[..n].iter_mut().zip(&mut coverage.left[..n]);
            for ((price, left), share) in all.zip(&shares[..n]) {
                let taken = share * *left;
                *price += taken * its;
                *left -= taken;
            }
        }
    }

    /// Returns the cost of the uncovered shares of the cells inside a rectangle.
    fn cost_inside(&self, rect: &Rect, left: &PerCell) -> f32 {
        let mut shares = [0.0; MAX_CELLS];
        self.cells.shares(rect, &mut shares);
        for (share, left) in shares.iter_mut().zip(left) {
            *share *= left;
        }
        self.cells.sum(&self.cells.cost, &shares, |cost, share| cost * share)
    }

    /// Removes the part inside a window from the uncovered shares of the cells.
    fn add_window(&self, rect: &Rect, left: &mut PerCell) {
        let mut shares = [0.0; MAX_CELLS];
        self.cells.shares(rect, &mut shares);
        for (left, share) in left.iter_mut().zip(&shares) {
            *left -= share * *left;
        }
    }

    fn size(&self, steps: i32) -> Vec2 {
        self.usable * grid::eighths(steps) as f32
    }

    /// Returns the least texels of a window, which are coarser than the least texels of the windows before
    /// it.
    fn least_of(&self, window: usize) -> i32 {
        self.least.saturating_add(i32::from(window as u8))
    }

    fn is_in_order(&self, steps: &[i32; MAX_MAPS]) -> bool {
        let is_fine = steps[self.count - 1].saturating_sub(steps[0]) > GREATEST_RATIO || steps[0] < self.least;
        !is_fine && steps[..self.count].windows(2).all(|pair| pair[0] < pair[1])
    }
}

/// Returns the cost of a point that needs texels of one metre and reads this window.
fn price_of(steps: i32) -> f32 {
    cost_of(grid::eighths(steps) as f32)
}
