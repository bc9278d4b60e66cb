//! How fine each window's texels are, and where each stands.
//!
//! A plan says both for all windows. Its cost is what the visible points pay for texels that are too wide; the
//! [search](super::search) compares plans by it.

use core::ops::Range;

use glam::Vec2;

use super::cells::{self, Cells, MAX_CELLS, PerCell, Rect};
use super::cost_of;
use crate::light::grid;
use crate::technique::settings::MAX_MAPS;

/// Texels and places of all windows, the finest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plan {
    /// Widths of texels, in eighths of an octave of a metre.
    pub(super) steps: [i32; MAX_MAPS],
    pub(super) rects: [Rect; MAX_MAPS],
}

impl Plan {
    /// Takes a window from another plan.
    fn replace(&mut self, window: usize, other: &Self) {
        (self.steps[window], self.rects[window]) = (other.steps[window], other.rects[window]);
    }

    /// This plan with a window of another one.
    fn replaced(mut self, window: usize, other: &Self) -> Self {
        self.replace(window, other);
        self
    }
}

/// Compares and changes plans.
pub(super) struct Planner<'a> {
    pub(super) cells: &'a Cells,
    /// Texels of a window between its borders.
    pub(super) usable: Vec2,
    /// Least width of texels, in eighths of an octave of a metre.
    pub(super) least: i32,
    pub(super) count: usize,
}

/// What the finer windows of a plan hold, and what they leave to coarser ones.
#[derive(Clone)]
struct Served {
    /// Shares of the cells that none of them holds.
    left: PerCell,
    /// Cost of what they hold, as a multiple of the cost of a texel of one metre.
    price: PerCell,
}

/// Ratios of the texels of neighbours with which a search begins, in eighths of an octave.
const LADDERS: [i32; 6] = [4, 7, 10, 13, 17, 22];

/// How much finer than the last window's the first one's texels may be, in eighths of an octave: more than the
/// octaves of a demand grid, and little enough that all its lines are exact.
const FINEST: i32 = 20 * 8;

/// Changes of a window's texels that are tried, in eighths of an octave.
const CHANGES: [i32; 6] = [4, -4, 8, -8, 2, -2];

/// Share of the cost in the best place that a window must hold to stay where it is.
const HOLDS: f32 = 0.993;

/// Share of what it held that a window must hold for its best place not to be looked for out of turn.
const LOOKS: f32 = 0.99;

/// Share of the way to the best place that a window moves beyond what it must.
const MOVE_ON: f32 = 0.3;

/// Cost of the drawn windows over that of the best plan up to which none is replaced.
pub(super) const SERVES: f32 = 1.1;

/// Share of the points that every change counts for, at least.
const FEW: f32 = 0.02;

impl Planner<'_> {
    /// The best of several even ladders of windows in front of the last one.
    pub(super) fn ladder(&self, last: i32, rect: Rect) -> Plan {
        let mut best: Option<(f32, Plan)> = None;
        for ratio in LADDERS {
            let mut plan = Plan::default();
            for i in 0..self.count {
                let even = last.saturating_sub(ratio * i32::from((self.count - 1 - i) as u8));
                plan.steps[i] = even.max(self.least_of(i));
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
        let mut cost = self.cost(plan);
        for _ in 0..changes {
            let number = *turn % (others * CHANGES.len() as u32);
            *turn = turn.wrapping_add(1);
            let (window, change) = ((number % others) as usize, CHANGES[(number / others) as usize]);
            let served = self.served(plan, window);
            // A round begins with windows in their best places.
            let replaced = (number < others).then(|| self.with(plan, &served, window, 0)).flatten();
            for (other, its) in [replaced, self.with(plan, &served, window, change)].into_iter().flatten() {
                if its < cost {
                    (*plan, cost) = (other, its);
                }
            }
        }
    }

    /// Number of all changes of all windows but the last.
    pub(super) const fn round(&self) -> u32 {
        (self.count as u32 - 1) * CHANGES.len() as u32
    }

    /// A plan for a last window that may have other texels than its own.
    pub(super) fn below(&self, mut plan: Plan, last: i32, rect: Rect) -> Plan {
        plan.steps[self.count - 1] = last;
        plan.rects[self.count - 1] = rect;
        for i in (0..self.count - 1).rev() {
            let least = self.least_of(i).max(last.saturating_sub(FINEST));
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

    /// Moves each window that no longer holds most of what it could. `holds` has the shares of the cost
    /// that windows held when their best places were last looked for: one window is looked at in each
    /// turn, and those that hold less than they did.
    pub(super) fn keep(&self, plan: &mut Plan, best: &Plan, holds: &mut [f32; MAX_MAPS], turn: u32) {
        let mut left = [1.0; MAX_CELLS];
        for (i, holds) in holds.iter_mut().enumerate().take(self.count - 1) {
            let all = self.cells.sum(&self.cells.cost, &left, |cost, left| cost * left);
            let share = |rect: &Rect| if all > 0.0 { self.held(rect, &left) / all } else { 1.0 };
            let is_turn = turn as usize % (self.count - 1) == i;
            if is_turn || share(&plan.rects[i]) < *holds * LOOKS {
                let mut moved = *plan;
                moved.rects[i] = self.kept(&plan.rects[i], &left);
                // For what a coarser window holds already, two do not change places, and none leaves the place that it has
                // in the best plan: it would be put back again and again.
                let way = (moved.rects[i].min - plan.rects[i].min).abs();
                let is_leap = way.cmpgt(plan.rects[i].size * 0.5).any();
                let is_best = (plan.steps[i], plan.rects[i]) == (best.steps[i], best.rects[i]);
                if !(is_leap || is_best) || self.cost(&moved) < self.cost(plan) {
                    *plan = moved;
                }
                *holds = share(&plan.rects[i]);
            }
            self.take(&plan.rects[i], &mut left);
        }
    }

    /// The drawn windows, as many of them replaced by their counterparts in the best plan as it takes to be nearly as
    /// good.
    pub(super) fn follow_at_once(&self, drawn: Plan, target: &Plan) -> Plan {
        let found = self.cost(target);
        let mut plan = drawn;
        while self.cost(&plan) > found * SERVES {
            let Some(run) = self.worth_most(&plan, target) else { return plan };
            for i in run {
                plan.replace(i, target);
            }
        }
        plan
    }

    /// The drawn windows, while they cost no more than the best plan times `most`, and whether there is more to do. Beyond
    /// that one is replaced by its counterpart in the best plan. Its texels must lie between those of its neighbours, so
    /// that it may take some that follow one another to gain: then it goes on in the next frames.
    pub(super) fn follow(&self, drawn: Plan, target: &Plan, most: f32) -> (Plan, bool) {
        if self.cost(&drawn) <= self.cost(target) * most {
            return (drawn, false);
        }
        let Some(run) = self.worth_most(&drawn, target) else { return (drawn, false) };
        let replaced = run.clone().map(|i| drawn.replaced(i, target));
        // Of windows that all become coarser it is the coarsest, of those that become finer the finest.
        let may_be = replaced.filter(|plan| *plan != drawn && self.is_in_order(&plan.steps));
        let best = may_be.min_by(|a, b| self.cost(a).total_cmp(&self.cost(b)));
        (best.unwrap_or(drawn), run.len() > 1)
    }

    /// Those windows that follow one another with whose counterparts in another plan most is gained for each point whose
    /// texels change; `None` where nothing is.
    fn worth_most(&self, plan: &Plan, target: &Plan) -> Option<Range<usize>> {
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

    /// Shares of the points that read each window.
    fn readers(&self, plan: &Plan) -> [f32; MAX_MAPS] {
        let points = |left: &PerCell| self.cells.sum(&self.cells.weight, left, |weight, left| weight * left);
        let mut left = [1.0; MAX_CELLS];
        let all = points(&left);
        let mut rest = all;
        core::array::from_fn(|i| {
            let before = rest;
            if i < self.count - 1 {
                self.take(&plan.rects[i], &mut left);
                rest = points(&left);
            }
            (before - rest) / all
        })
    }

    /// A plan with other texels of one window, which is put where it is best, and its cost; `None` where sizes would
    /// cross. `served` is what finer windows do.
    fn with(&self, plan: &Plan, served: &Served, window: usize, change: i32) -> Option<(Plan, f32)> {
        let mut other = *plan;
        other.steps[window] += change;
        if !self.is_in_order(&other.steps) {
            return None;
        }
        other.rects[window] = cells::best(self.cells, &served.left, self.size(other.steps[window]));
        let cost = self.cost_beyond(served.clone(), &other, window);
        Some((other, cost))
    }

    /// The held place while it holds nearly as much as the best one, else the least move to it.
    fn kept(&self, held: &Rect, left: &PerCell) -> Rect {
        let best = cells::best(self.cells, left, held.size);
        let enough = self.held(&best, left) * HOLDS;
        if self.held(held, left) >= enough {
            return *held;
        }
        let way = best.min - held.min;
        let at = |share: f32| Rect { min: held.min + way * share, size: held.size };
        let share = (1..8).map(|i| i as f32 / 8.0).find(|share| self.held(&at(*share), left) >= enough);
        share.map_or(best, |share| at(share + (1.0 - share) * MOVE_ON))
    }

    /// Puts all windows but the last where they are best.
    fn place_all(&self, plan: &mut Plan) {
        let mut left = [1.0; MAX_CELLS];
        for i in 0..self.count - 1 {
            plan.rects[i] = cells::best(self.cells, &left, self.size(plan.steps[i]));
            self.take(&plan.rects[i], &mut left);
        }
    }

    /// The cheaper one of two plans.
    pub(super) fn better(&self, one: Plan, other: Plan) -> Plan {
        if self.cost(&other) < self.cost(&one) { other } else { one }
    }

    /// What a plan costs.
    pub(super) fn cost(&self, plan: &Plan) -> f32 {
        self.cost_beyond(self.served(plan, 0), plan, 0)
    }

    /// Cost of a plan whose first windows are served already.
    fn cost_beyond(&self, mut served: Served, plan: &Plan, first: usize) -> f32 {
        self.serve(&mut served, plan, first..self.count - 1);
        let last = price_of(plan.steps[self.count - 1]);
        for (price, left) in served.price.iter_mut().zip(&served.left) {
            *price += left * last;
        }
        self.cells.sum(&self.cells.cost, &served.price, |cost, price| cost * price)
    }

    /// What the first windows of a plan hold and leave.
    fn served(&self, plan: &Plan, windows: usize) -> Served {
        let mut served = Served { left: [1.0; MAX_CELLS], price: [0.0; MAX_CELLS] };
        self.serve(&mut served, plan, 0..windows);
        served
    }

    /// Adds what more windows hold.
    fn serve(&self, served: &mut Served, plan: &Plan, windows: Range<usize>) {
        let mut shares = [0.0; MAX_CELLS];
        for i in windows {
            self.cells.shares(&plan.rects[i], &mut shares);
            let its = price_of(plan.steps[i]);
            let n = self.cells.len;
            let all = served.price[..n].iter_mut().zip(&mut served.left[..n]);
            for ((price, left), share) in all.zip(&shares[..n]) {
                let taken = share * *left;
                *price += taken * its;
                *left -= taken;
            }
        }
    }

    /// Cost of the cells inside a rectangle, as far as they are left.
    fn held(&self, rect: &Rect, left: &PerCell) -> f32 {
        let mut shares = [0.0; MAX_CELLS];
        self.cells.shares(rect, &mut shares);
        for (share, left) in shares.iter_mut().zip(left) {
            *share *= left;
        }
        self.cells.sum(&self.cells.cost, &shares, |cost, share| cost * share)
    }

    /// Takes away what a window holds.
    fn take(&self, rect: &Rect, left: &mut PerCell) {
        let mut shares = [0.0; MAX_CELLS];
        self.cells.shares(rect, &mut shares);
        for (left, share) in left.iter_mut().zip(&shares) {
            *left -= share * *left;
        }
    }

    fn size(&self, steps: i32) -> Vec2 {
        self.usable * grid::eighths(steps) as f32
    }

    /// Least texels of a window, which are coarser than those of the ones before it.
    fn least_of(&self, window: usize) -> i32 {
        self.least.saturating_add(i32::from(window as u8))
    }

    fn is_in_order(&self, steps: &[i32; MAX_MAPS]) -> bool {
        let is_fine = steps[self.count - 1].saturating_sub(steps[0]) > FINEST || steps[0] < self.least;
        !is_fine && steps[..self.count].windows(2).all(|pair| pair[0] < pair[1])
    }
}

/// What a point that asks for texels of one metre costs in a window.
fn price_of(steps: i32) -> f32 {
    cost_of(grid::eighths(steps) as f32)
}
