//! The cells of demand that windows are placed by, in the plane across the light.

use glam::{DVec3, Vec2};

use super::counted::{Counted, MAX_CELLS};
use super::lattice::{Rect, cost_of};
use crate::base::checks::{greater, lesser};
use crate::demand::grid::{DemandGrid, DemandSpace, Plane, SIDE};

/// A number for each cell.
pub(super) type PerCell = [f32; MAX_CELLS];

/// Share of the visible points with the finest demands. They count as no finer than the other points, since
/// surfaces at grazing angles need arbitrarily fine texels.
const GRAZING: f32 = 0.02;

/// Slight enlargement of shares, so that rounding never leaves a sliver of a covered cell. Otherwise the last
/// of many windows would be placed by such slivers alone.
const INSIDE: f64 = 1.0 + 1e-5;

/// The cells of a frame: squares of the plane, with the demand of the points in them. They are stored in
/// columns, so that four are computed at a time.
pub(super) struct Cells {
    /// Middles of the cells, relative to the origin of the fit, in metres of the plane.
    pub(super) x: PerCell,
    pub(super) y: PerCell,
    /// Halves of the cells' sides, in metres, and reciprocals of the sides, times [`INSIDE`].
    pub(super) half: PerCell,
    per_side: PerCell,
    /// Numbers of points, or shares of them.
    pub(super) weight: PerCell,
    /// Cost of a texel of one metre for the points.
    pub(super) cost: PerCell,
    pub(super) len: usize,
}

impl Cells {
    pub(super) const fn new() -> Self {
        const NONE: PerCell = [0.0; MAX_CELLS];
        Self { x: NONE, y: NONE, half: NONE, per_side: NONE, weight: NONE, cost: NONE, len: 0 }
    }

    /// Removes cells that are farther from the last window than its own size. No point is visible there, and
    /// a grid that was never filled may have cells anywhere.
    pub(super) fn keep_near(&mut self, last: &Rect) {
        let (low, high) = (last.min - last.size, last.min + last.size * 2.0);
        let mut kept = 0;
        for i in 0..self.len {
            let middle = Vec2::new(self.x[i], self.y[i]);
            if middle.cmpge(low).all() && middle.cmple(high).all() {
                for column in [&mut self.x, &mut self.y, &mut self.half, &mut self.per_side] {
                    column[kept] = column[i];
                }
                (self.weight[kept], self.cost[kept]) = (self.weight[i], self.cost[i]);
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// Adds points that were counted in a space. A `share` of them with the finest demands count as no finer
    /// than the others.
    pub(super) fn add(&mut self, counted: &Counted, share: f32, space: &DemandSpace, plane: &Plane, origin: DVec3) {
        let offset = plane.of(plane.axes.project(space.origin - origin));
        let finest = counted.finest(share);
        for (index, weight) in counted.cells() {
            if self.len == MAX_CELLS {
                return;
            }
            let (middle, half, texel) = space.cell(*index as usize);
            let texel = (texel as f32).max(finest * space.texel);
            let (middle, half, per_side) = ((middle + offset).as_vec2(), half as f32, (INSIDE * 0.5 / half) as f32);
            let cost = weight * cost_of(1.0 / texel);
            // Keeps sums over all cells finite: a grid that was never filled may hold any numbers.
            let moment = (middle.abs().max_element() + half + 1.0) * cost * MAX_CELLS as f32;
            // `max_element` may return a number even if one element is NaN.
            if middle.is_finite() && moment.is_finite() && per_side.is_finite() {
                let i = self.len;
                (self.x[i], self.y[i], self.half[i], self.per_side[i]) = (middle.x, middle.y, half, per_side);
                (self.weight[i], self.cost[i]) = (*weight, cost);
                self.len += 1;
            }
        }
    }

    /// Adds the cells of a grid.
    pub(super) fn add_grid(&mut self, grid: &DemandGrid, plane: &Plane, origin: DVec3) {
        let mut counted = Counted::new();
        for (row, counts) in grid.counts.chunks(SIDE).enumerate() {
            if counts.iter().fold(0, |all, count| all | count) == 0 {
                continue;
            }
            for (x, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
                counted.push(row * SIDE + x, *count as f32);
            }
        }
        self.add(&counted, GRAZING, &grid.space, plane, origin);
    }

    /// Computes the shares of the cells inside a rectangle.
    pub(super) fn shares(&self, rect: &Rect, shares: &mut PerCell) {
        let (min, max) = (rect.min, rect.min + rect.size);
        let n = self.len;
        let cells = self.x[..n].iter().zip(&self.y[..n]).zip(self.half[..n].iter().zip(&self.per_side[..n]));
        for (share, ((x, y), (half, per_side))) in shares[..n].iter_mut().zip(cells) {
            let over = |middle: f32, min: f32, max: f32| {
                let (low, high) = (greater(middle - half, min), lesser(middle + half, max));
                lesser(greater((high - low) * per_side, 0.0), 1.0)
            };
            *share = over(*x, min.x, max.x) * over(*y, min.y, max.y);
        }
    }

    /// Sums a value that depends on two numbers of each cell, in a fixed order.
    pub(super) fn sum(&self, of: &PerCell, other: &PerCell, value: impl Fn(f32, f32) -> f32) -> f32 {
        const LANES: usize = 8;
        let (of, other) = (&of[..self.len], &other[..self.len]);
        let mut sums = [0.0; LANES];
        let (of_lanes, other_lanes) = (of.chunks_exact(LANES), other.chunks_exact(LANES));
        let rest = of_lanes.remainder().iter().zip(other_lanes.remainder());
        let rest: f32 = rest.map(|(of, other)| value(*of, *other)).sum();
        for (of, other) in of_lanes.zip(other_lanes) {
            for (sum, (of, other)) in sums.iter_mut().zip(of.iter().zip(other)) {
                *sum += value(*of, *other);
            }
        }
        sums.iter().sum::<f32>() + rest
    }
}
