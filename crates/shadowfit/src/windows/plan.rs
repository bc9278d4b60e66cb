//! How fine each window's texels are, and where each stands.
//!
//! Two plans are kept: the windows that are drawn, and the ones that are sought. The search changes
//! one window of the sought plan at a time, frame after frame, and nobody sees it. Drawn windows keep
//! their texels, and move as little as they can; only where the sought plan is better by enough, as
//! few of them are replaced as bring most of the gain.

use glam::Vec2;

use super::cells::{Cell, MAX_CELLS};
use super::cost_of;
use super::placement::{self, Rect};
use crate::grid;
use crate::settings::MAX_MAPS;

/// Texels and places of all windows, the finest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plan {
    /// Widths of texels, in eighths of an octave of a metre.
    pub(super) steps: [i32; MAX_MAPS],
    pub(super) rects: [Rect; MAX_MAPS],
}

/// What windows are planned by.
pub(super) struct Planner<'a> {
    pub(super) cells: &'a [Cell],
    /// Texels of each window between its borders.
    pub(super) usable: [Vec2; MAX_MAPS],
    pub(super) count: usize,
}

/// Shares of the cells that finer windows leave.
type Left = [f32; MAX_CELLS];

/// Ratios of the texels of neighbours with which a search begins, in eighths of an octave.
const LADDERS: [i32; 8] = [4, 6, 8, 10, 13, 16, 20, 24];

/// How much finer than the last window's the first one's texels may be, in eighths of an octave: more than the
/// octaves of a grid of need, and little enough that all its lines are exact.
const FINEST: i32 = 20 * 8;

/// Changes of a window's texels that are tried, in eighths of an octave.
const CHANGES: [i32; 6] = [4, -4, 8, -8, 2, -2];

/// Rounds of changes with which a search begins.
const ROUNDS: u32 = 3;

/// Share of the cost in the best place that a window must hold to stay where it is.
const HOLDS: f32 = 0.985;

/// Share of what it held that a window must hold for its best place not to be looked for out of turn.
const LOOKS: f32 = 0.99;

/// Share of the way to the best place that a window moves beyond what it must.
const MOVE_ON: f32 = 0.3;

/// Cost of the drawn windows over that of the sought ones up to which no more of them are replaced.
pub(super) const SERVES: f32 = 1.15;

/// Share of the points that every change counts for, at least.
const FEW: f32 = 0.02;

impl Planner<'_> {
    /// The best of several even ladders of windows in front of the last one.
    pub(super) fn ladder(&self, last: i32, rect: Rect) -> Plan {
        let mut best: Option<(f32, Plan)> = None;
        for ratio in LADDERS {
            let mut plan = Plan::default();
            for i in 0..self.count {
                plan.steps[i] = last.saturating_sub(ratio * i32::from((self.count - 1 - i) as u8));
            }
            plan.rects[self.count - 1] = rect;
            self.place_all(&mut plan);
            let cost = self.cost(&plan);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, plan));
            }
        }
        best.map_or_else(Plan::default, |(_, plan)| plan)
    }

    /// Searches on from a plan: puts one window where it is best now, and tries changes of single
    /// windows. `turn` counts the changes that were tried.
    pub(super) fn seek(&self, plan: &mut Plan, turn: &mut u32, changes: u32) {
        let others = self.count as u32 - 1;
        if others == 0 {
            return;
        }
        for _ in 0..changes {
            let number = *turn % (others * CHANGES.len() as u32);
            *turn = turn.wrapping_add(1);
            let (window, change) = ((number % others) as usize, CHANGES[(number / others) as usize]);
            // A round begins with windows in their best places.
            let replaced = (number < others).then(|| self.with(plan, window, 0)).flatten();
            let mut best = (self.cost(plan), None);
            for other in [replaced, self.with(plan, window, change)].into_iter().flatten() {
                let cost = self.cost(&other);
                if cost < best.0 {
                    best = (cost, Some(other));
                }
            }
            if let (_, Some(other)) = best {
                *plan = other;
            }
        }
    }

    /// All changes of a few rounds.
    pub(super) const fn all_changes(&self) -> u32 {
        ROUNDS * (self.count as u32 - 1) * CHANGES.len() as u32
    }

    /// A plan for a last window that may have other texels than its own.
    pub(super) fn below(&self, mut plan: Plan, last: i32, rect: Rect) -> Plan {
        plan.steps[self.count - 1] = last;
        plan.rects[self.count - 1] = rect;
        for i in (0..self.count - 1).rev() {
            let steps = plan.steps[i].max(last.saturating_sub(FINEST)).min(plan.steps[i + 1] - 1);
            if steps != plan.steps[i] {
                plan.steps[i] = steps;
                let middle = plan.rects[i].min + plan.rects[i].size * 0.5;
                plan.rects[i].size = self.size(i, plan.steps[i]);
                plan.rects[i].min = middle - plan.rects[i].size * 0.5;
            }
        }
        plan
    }

    /// Moves each window that no longer holds most of what it could. `holds` has the shares of the cost
    /// that windows held when their best places were last looked for: one window is looked at in each
    /// turn, and those that hold less than they did.
    pub(super) fn keep(&self, plan: &mut Plan, holds: &mut [f32; MAX_MAPS], turn: u32) {
        let mut left = [1.0; MAX_CELLS];
        for (i, holds) in holds.iter_mut().enumerate().take(self.count - 1) {
            let all: f32 = self.cells.iter().zip(&left).map(|(cell, left)| cell.cost * left).sum();
            let share = |rect: &Rect| rect.cost(self.cells, &left) / all;
            let is_turn = turn as usize % (self.count - 1) == i;
            if is_turn || share(&plan.rects[i]) < *holds * LOOKS {
                plan.rects[i] = self.kept(&plan.rects[i], &left);
                *holds = share(&plan.rects[i]);
            }
            self.take(&plan.rects[i], &mut left);
        }
    }

    /// The drawn windows, while they cost no more than the sought ones times `most`; else as few of them
    /// replaced, and no more than `count`, as make them nearly as good.
    pub(super) fn follow(&self, drawn: Plan, sought: &Plan, most: f32, count: usize) -> Plan {
        let found = self.cost(sought);
        if self.cost(&drawn) <= found * most {
            return drawn;
        }
        let enough = found * SERVES;
        let mut plan = drawn;
        for _ in 0..count {
            let cost = self.cost(&plan);
            if cost <= enough {
                return plan;
            }
            let readers = self.readers(&plan);
            let mut best: Option<(f32, Plan)> = None;
            for (i, readers) in readers.iter().enumerate().take(self.count - 1) {
                let mut other = plan;
                (other.steps[i], other.rects[i]) = (sought.steps[i], sought.rects[i]);
                let is_new = other != plan && self.is_in_order(&other.steps);
                // What is gained for each point whose texels change.
                let gain = (cost - self.cost(&other)) / (readers + FEW);
                if is_new && best.is_none_or(|(most, _)| gain > most) {
                    best = Some((gain, other));
                }
            }
            let Some((_, other)) = best else { return *sought };
            plan = other;
        }
        plan
    }

    /// Shares of the points that read each window.
    fn readers(&self, plan: &Plan) -> [f32; MAX_MAPS] {
        let (mut readers, mut total) = ([0.0; MAX_MAPS], 0.0);
        for cell in self.cells {
            let mut left = cell.weight;
            total += left;
            for (readers, rect) in readers.iter_mut().zip(&plan.rects[..self.count - 1]) {
                let share = rect.share(cell) * left;
                *readers += share;
                left -= share;
            }
        }
        readers.map(|share| share / total)
    }

    /// A plan with other texels of one window, which is put where it is best; `None` where sizes would
    /// cross.
    fn with(&self, plan: &Plan, window: usize, change: i32) -> Option<Plan> {
        let mut other = *plan;
        other.steps[window] += change;
        if !self.is_in_order(&other.steps) {
            return None;
        }
        let mut left = [1.0; MAX_CELLS];
        for rect in &other.rects[..window] {
            self.take(rect, &mut left);
        }
        other.rects[window] = placement::best(self.cells, &left, self.size(window, other.steps[window]));
        Some(other)
    }

    /// The held place while it holds nearly as much as the best one, else the least move to it.
    fn kept(&self, held: &Rect, left: &Left) -> Rect {
        let best = placement::best(self.cells, left, held.size);
        let enough = best.cost(self.cells, left) * HOLDS;
        if held.cost(self.cells, left) >= enough {
            return *held;
        }
        let way = best.min - held.min;
        let at = |share: f32| Rect { min: held.min + way * share, size: held.size };
        let share = (1..8).map(|i| i as f32 / 8.0).find(|share| at(*share).cost(self.cells, left) >= enough);
        share.map_or(best, |share| at(share + (1.0 - share) * MOVE_ON))
    }

    /// Puts all windows but the last where they are best.
    fn place_all(&self, plan: &mut Plan) {
        let mut left = [1.0; MAX_CELLS];
        for i in 0..self.count - 1 {
            plan.rects[i] = placement::best(self.cells, &left, self.size(i, plan.steps[i]));
            self.take(&plan.rects[i], &mut left);
        }
    }

    /// The cheaper one of two plans.
    pub(super) fn better(&self, one: Plan, other: Plan) -> Plan {
        if self.cost(&other) < self.cost(&one) { other } else { one }
    }

    /// What a plan costs.
    pub(super) fn cost(&self, plan: &Plan) -> f32 {
        let last = self.count - 1;
        let prices: [f32; MAX_MAPS] = core::array::from_fn(|i| cost_of(grid::eighths(plan.steps[i]) as f32));
        let mut cost = 0.0;
        for cell in self.cells {
            let (mut left, mut price) = (1.0, 0.0);
            for (rect, its) in plan.rects[..last].iter().zip(&prices) {
                let share = rect.share(cell) * left;
                price += share * its;
                left -= share;
            }
            cost += cell.cost * (price + left * prices[last]);
        }
        cost
    }

    /// Leaves what a window does not hold.
    fn take(&self, rect: &Rect, left: &mut Left) {
        for (cell, left) in self.cells.iter().zip(left) {
            *left *= 1.0 - rect.share(cell);
        }
    }

    fn size(&self, window: usize, steps: i32) -> Vec2 {
        self.usable[window] * grid::eighths(steps) as f32
    }

    fn is_in_order(&self, steps: &[i32; MAX_MAPS]) -> bool {
        let is_fine = steps[self.count - 1].saturating_sub(steps[0]) > FINEST;
        !is_fine && steps[..self.count].windows(2).all(|pair| pair[0] < pair[1])
    }
}
