//! How fine each window's texels are, and where each stands.

use glam::Vec2;

use super::cells::{Cell, MAX_CELLS};
use super::placement::{self, Rect};
use super::{Change, MOVE_ON, cost_of};
use crate::grid;
use crate::settings::MAX_MAPS;

/// Texels and places of all windows, the finest first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plan {
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

/// Changes of a window's texels that are tried, in eighths of an octave.
const CHANGES: [i32; 6] = [4, -4, 8, -8, 2, -2];

/// Rounds of changes in the first frame.
const ROUNDS: usize = 3;

impl Planner<'_> {
    /// New windows in front of a last one.
    pub(super) fn fresh(&self, last: i32, rect: Rect) -> Plan {
        let mut best: Option<(f32, Plan)> = None;
        for ratio in LADDERS {
            let mut plan = Plan::default();
            for i in 0..self.count {
                plan.steps[i] = last - ratio * (self.count - 1 - i) as i32;
            }
            plan.rects[self.count - 1] = rect;
            let cost = self.place_from(0, &mut plan);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, plan));
            }
        }
        let (mut least, mut plan) = best.unwrap_or_default();
        for _ in 0..ROUNDS {
            for window in 0..self.count - 1 {
                for by in CHANGES {
                    let mut other = plan;
                    other.steps[window] += by;
                    if !self.is_in_order(&other.steps) {
                        continue;
                    }
                    let cost = self.place_from(window, &mut other);
                    if cost < least {
                        (least, plan) = (cost, other);
                    }
                }
            }
        }
        plan
    }

    /// The windows of a guess, of which as few are replaced as make it nearly as good as new ones.
    pub(super) fn settle(&self, held: Plan) -> Plan {
        let (last, rect) = (held.steps[self.count - 1], held.rects[self.count - 1]);
        let fresh = self.fresh(last, rect);
        let enough = self.cost(&fresh) * crate::tune::get(9, 1.1);
        let mut plan = held;
        for _ in 1..self.count {
            if self.cost(&plan) <= enough {
                return plan;
            }
            let mut best = None;
            for i in 0..self.count - 1 {
                let mut other = plan;
                (other.steps[i], other.rects[i]) = (fresh.steps[i], fresh.rects[i]);
                let cost = self.cost(&other);
                if other.steps[i] != plan.steps[i] || other.rects[i] != plan.rects[i] {
                    if self.is_in_order(&other.steps) && best.is_none_or(|(least, _)| cost < least) {
                        best = Some((cost, other));
                    }
                }
            }
            let Some((_, other)) = best else { return fresh };
            plan = other;
        }
        if self.cost(&plan) <= enough { plan } else { fresh }
    }

    /// The windows of the frame before, each kept or moved, and at most one of them with other texels.
    pub(super) fn go_on(&self, held: Plan, pending: Option<Change>, turn: u32) -> (Plan, Option<Change>, u32) {
        let mut plan = held;
        for i in (0..self.count - 1).rev() {
            plan.steps[i] = plan.steps[i].min(plan.steps[i + 1] - 1);
            plan.rects[i].size = self.size(i, plan.steps[i]);
        }
        let hold = crate::tune::get(1, 0.975);
        let mut left = [1.0; MAX_CELLS];
        for i in 0..self.count - 1 {
            plan.rects[i] = self.kept(&plan.rects[i], &left, hold);
            self.take(&plan.rects[i], &mut left);
        }
        let cost = self.cost(&plan);
        let gain = cost_of(crate::tune::get(2, 1.18));
        if let Some(change) = pending
            && let Some((other, its)) = self.changed(&plan, change)
            && its * gain < cost
        {
            return (other, None, turn);
        }
        let count = (self.count - 1) * CHANGES.len();
        let tries = crate::tune::get(3, 2.0) as u32;
        for t in 0..tries {
            if count == 0 {
                break;
            }
            let number = (turn.wrapping_add(t)) as usize % count;
            let change = Change { window: number % (self.count - 1), by: CHANGES[number / (self.count - 1)] };
            if let Some((_, its)) = self.changed(&plan, change)
                && its * gain < cost
            {
                return (plan, Some(change), turn.wrapping_add(tries));
            }
        }
        (plan, None, turn.wrapping_add(tries))
    }

    /// A plan with other texels of one window, which is put where it is best, and its cost.
    fn changed(&self, plan: &Plan, change: Change) -> Option<(Plan, f32)> {
        let mut other = *plan;
        let Change { window, by } = change;
        other.steps[window] += by;
        if !self.is_in_order(&other.steps) {
            return None;
        }
        let mut left = [1.0; MAX_CELLS];
        for rect in &other.rects[..window] {
            self.take(rect, &mut left);
        }
        other.rects[window] = placement::best(self.cells, &left, self.size(window, other.steps[window]));
        let cost = self.cost(&other);
        Some((other, cost))
    }

    /// The held place while it holds nearly as much as the best one, else the least move to it.
    fn kept(&self, held: &Rect, left: &Left, hold: f32) -> Rect {
        let best = placement::best(self.cells, left, held.size);
        let enough = best.cost(self.cells, left) * hold;
        if held.cost(self.cells, left) >= enough {
            return *held;
        }
        let way = best.min - held.min;
        let at = |share: f32| Rect { min: held.min + way * share, size: held.size };
        let share = (1..8).map(|i| i as f32 / 8.0).find(|share| at(*share).cost(self.cells, left) >= enough);
        share.map_or(best, |share| at(share + (1.0 - share) * MOVE_ON as f32))
    }

    /// Puts all windows from one on where they are best; gives the cost of all.
    fn place_from(&self, first: usize, plan: &mut Plan) -> f32 {
        let mut left = [1.0; MAX_CELLS];
        for i in 0..self.count - 1 {
            if i >= first {
                plan.rects[i] = placement::best(self.cells, &left, self.size(i, plan.steps[i]));
            }
            self.take(&plan.rects[i], &mut left);
        }
        self.cost(plan)
    }

    /// What a plan costs.
    fn cost(&self, plan: &Plan) -> f32 {
        let price = |i: usize| cost_of(grid::eighths(plan.steps[i]) as f32);
        let mut prices = [0.0; MAX_MAPS];
        for (i, p) in prices.iter_mut().enumerate().take(self.count) {
            *p = price(i);
        }
        let mut cost = 0.0;
        for cell in self.cells {
            let mut left = 1.0;
            for i in 0..self.count - 1 {
                let share = plan.rects[i].share(cell) * left;
                cost += cell.cost * share * prices[i];
                left -= share;
            }
            cost += cell.cost * left * prices[self.count - 1];
        }
        cost
    }

    fn take(&self, rect: &Rect, left: &mut Left) {
        for (cell, left) in self.cells.iter().zip(left) {
            *left *= 1.0 - rect.share(cell);
        }
    }

    fn size(&self, window: usize, steps: i32) -> Vec2 {
        self.usable[window] * grid::eighths(steps) as f32
    }

    fn is_in_order(&self, steps: &[i32; MAX_MAPS]) -> bool {
        steps[..self.count].windows(2).all(|pair| pair[0] < pair[1])
    }
}
