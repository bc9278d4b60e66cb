//! The cells of demand that windows are placed by, in the plane across the light, and where a window holds most of what
//! is left to be served.
//!
//! For a place the cost of all cells is entered into a raster, of which the sum over every square as large as the
//! window is found in steps: of 4 and of 16 rows, then of as many columns.

use glam::{DVec3, Vec2};

use crate::base::checks::{greater, lesser};
use crate::demand::grid::{DemandGrid, DemandSpace, LEVELS, Plane, SIDE};

/// Most cells that are kept; those with the fewest points are left out where there are more.
pub(super) const MAX_CELLS: usize = 1024;

/// A number for each cell.
pub(super) type PerCell = [f32; MAX_CELLS];

/// Share of the visible points with the finest demands, which count as no finer than those of the rest:
/// surfaces seen at grazing angles ask for arbitrarily fine texels.
const FINEST: f32 = 0.02;

/// A little more than one, by which cells that lie in a rectangle but for rounding do so wholly. What rounding would
/// leave of them has no place: it would be all that the last of many windows are put by.
const INSIDE: f64 = 1.0 + 1e-5;

/// The cells of a frame: squares of the plane, and what the points in them ask for. They lie in columns, so that four
/// at a time are computed with.
pub(super) struct Cells {
    /// Middles, relative to the origin of the fit, in metres of the plane.
    pub(super) x: PerCell,
    pub(super) y: PerCell,
    /// Halves of the sides, in metres, and one over the sides, times [`INSIDE`].
    pub(super) half: PerCell,
    per_side: PerCell,
    /// Numbers of points, or shares of them.
    pub(super) weight: PerCell,
    /// What a texel of one metre costs the points.
    pub(super) cost: PerCell,
    pub(super) len: usize,
}

/// Points by the cells of a space.
pub(super) struct Counted {
    /// Index of a cell and number of its points, or a share of it.
    cells: [(u32, f32); MAX_CELLS],
    len: usize,
    /// Places in `cells` plus one by the cells' hash; zero for none.
    table: [u16; TABLE],
    /// Cells with no more points than this are left out.
    least: f32,
}

/// Places of the hash table: twice as many as cells.
const TABLE: usize = 2 * MAX_CELLS;

impl Counted {
    pub(super) const fn new() -> Self {
        Self { cells: [(0, 0.0); MAX_CELLS], len: 0, table: [0; TABLE], least: 0.0 }
    }

    /// Adds points to a cell that has none.
    fn push(&mut self, index: usize, weight: f32) {
        if self.len == MAX_CELLS {
            self.thin();
        }
        if self.len < MAX_CELLS && weight > self.least {
            self.cells[self.len] = (index as u32, weight);
            self.len += 1;
        }
    }

    /// Adds points to a cell.
    pub(super) fn add(&mut self, index: usize, weight: f32) {
        // NaN is no weight either.
        let counts = weight > 0.0;
        if !counts {
            return;
        }
        let key = index as u32;
        let place = self.place(key);
        if self.table[place] != 0 {
            self.cells[usize::from(self.table[place]) - 1].1 += weight;
        } else if self.len < MAX_CELLS {
            self.cells[self.len] = (key, weight);
            self.len += 1;
            self.table[place] = self.len as u16;
        } else {
            self.thin();
            if self.len < MAX_CELLS {
                self.add(index, weight);
            }
        }
    }

    /// Where a cell is in the table, or would be.
    fn place(&self, key: u32) -> usize {
        let mut place = (key.wrapping_mul(2_654_435_769) >> 21) as usize % TABLE;
        while self.table[place] != 0 && self.cells[usize::from(self.table[place]) - 1].0 != key {
            place = (place + 1) % TABLE;
        }
        place
    }

    /// The texel that the share of the points with the finest demands are taken to ask for, over that of
    /// the finest level.
    fn finest(&self, share: f32) -> f32 {
        let mut levels = [0.0_f32; LEVELS];
        for (index, weight) in &self.cells[..self.len] {
            levels[*index as usize / (SIDE * SIDE)] += weight;
        }
        let mut rest = levels.iter().sum::<f32>() * share;
        for (level, weight) in levels.iter().enumerate() {
            if rest < *weight {
                return libm::exp2f(level as f32 + rest / weight);
            }
            rest -= weight;
        }
        0.0
    }

    /// Leaves out the cells with the fewest points.
    fn thin(&mut self) {
        let total: f32 = self.cells[..self.len].iter().map(|cell| cell.1).sum();
        self.least = (self.least * 2.0).max(total / MAX_CELLS as f32 * 0.25);
        let (cells, len) = (self.cells, self.len);
        (self.len, self.table) = (0, [0; TABLE]);
        for (key, weight) in cells[..len].iter().filter(|cell| cell.1 > self.least) {
            let place = self.place(*key);
            self.cells[self.len] = (*key, *weight);
            self.len += 1;
            self.table[place] = self.len as u16;
        }
    }
}

impl Cells {
    pub(super) const fn new() -> Self {
        const NONE: PerCell = [0.0; MAX_CELLS];
        Self { x: NONE, y: NONE, half: NONE, per_side: NONE, weight: NONE, cost: NONE, len: 0 }
    }

    /// Leaves out cells that are farther from the last window than its own size: nothing is seen there, and a
    /// grid that was never filled may put them anywhere.
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

    /// Adds points that were counted in a space.
    pub(super) fn add(&mut self, counted: &Counted, share: f32, (space, plane): (&DemandSpace, &Plane), origin: DVec3) {
        let offset = plane.of(plane.axes.project(space.origin - origin));
        let finest = counted.finest(share);
        for (index, weight) in &counted.cells[..counted.len] {
            if self.len == MAX_CELLS {
                return;
            }
            let (middle, half, texel) = space.cell(*index as usize);
            let texel = (texel as f32).max(finest * space.texel);
            let (middle, half, per_side) = ((middle + offset).as_vec2(), half as f32, (INSIDE * 0.5 / half) as f32);
            let cost = weight * super::cost_of(1.0 / texel);
            // Sums over all cells stay finite: a grid that was never filled may hold any numbers.
            let moment = (middle.abs().max_element() + half + 1.0) * cost * MAX_CELLS as f32;
            // The greatest element may be a number where one is NaN.
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
        self.add(&counted, FINEST, (&grid.space, plane), origin);
    }

    /// Shares of the cells that lie in a rectangle.
    pub(super) fn shares(&self, rect: &Rect, shares: &mut PerCell) {
        let (min, max) = (rect.min, rect.min + rect.size);
        let over = |middle: f32, (half, per_side): (f32, f32), (min, max): (f32, f32)| {
            let (low, high) = (greater(middle - half, min), lesser(middle + half, max));
            lesser(greater((high - low) * per_side, 0.0), 1.0)
        };
        let n = self.len;
        let cells = self.x[..n].iter().zip(&self.y[..n]).zip(self.half[..n].iter().zip(&self.per_side[..n]));
        for (share, ((x, y), (half, per_side))) in shares[..n].iter_mut().zip(cells) {
            *share = over(*x, (*half, *per_side), (min.x, max.x)) * over(*y, (*half, *per_side), (min.y, max.y));
        }
    }

    /// Sum of a number of each cell, which also depends on another one, in an order of its own.
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

/// Squares of the raster in a window's side: four times four.
const ACROSS: usize = 16;

/// Squares of the raster along each axis: five windows.
const RASTER: usize = 64;

/// Squares at which a window may begin.
const PLACES: usize = RASTER - ACROSS + 1;

/// Cells wider than this many squares of the raster are left out: what they ask for is far coarser.
const WIDEST: f32 = 16.0;

/// Squares that such a cell may touch in a row, in groups of four.
const TOUCHED: usize = 20;
const GROUP: usize = 4;

/// Length of a row, with room for what a cell in the last square touches.
const ROW: usize = RASTER + TOUCHED;

/// A rectangle of the plane: its least corner and its size, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rect {
    pub(super) min: Vec2,
    pub(super) size: Vec2,
}

/// Costs by squares, row by row.
type Raster = [[f32; ROW]; RASTER];

/// The rectangle of a size with the greatest cost inside, to the nearest sixteenth of its size. `left` are the shares
/// of the cells that are left.
pub(super) fn best(cells: &Cells, left: &PerCell, size: Vec2) -> Rect {
    let pitch = size / ACROSS as f32;
    let corner = middle(cells, left) - pitch * (RASTER / 2) as f32;
    #[expect(clippy::large_stack_arrays, reason = "21 KiB, for the time of a search")]
    let mut sums: Raster = [[0.0; ROW]; RASTER];
    enter(&mut sums, cells, left, (corner, pitch));
    sum_rows(&mut sums, 1);
    sum_rows(&mut sums, 4);
    // Around the middle, where nothing is left.
    let (mut most, mut at) = (0.0, ((RASTER - ACROSS) / 2, (RASTER - ACROSS) / 2));
    for (y, row) in sums[..PLACES].iter().enumerate() {
        let row = sum_columns::<4>(&sum_columns::<1>(row));
        let highest = row[..PLACES].iter().fold(f32::MIN, |highest, sum| greater(*sum, highest));
        if highest > most {
            most = highest;
            at = (row[..PLACES].iter().position(|sum| *sum == highest).unwrap_or(0), y);
        }
    }
    Rect { min: corner + Vec2::new(at.0 as f32, at.1 as f32) * pitch, size }
}

/// Adds to each row three that follow at a distance.
fn sum_rows(sums: &mut Raster, distance: usize) {
    for y in 0..RASTER - 3 * distance {
        let [row, one, two, three] = [0, 1, 2, 3].map(|k| y + k * distance);
        let (low, high) = sums.split_at_mut(one);
        let others = high[0].iter().zip(&high[two - one]).zip(&high[three - one]);
        for (sum, ((one, two), three)) in low[row].iter_mut().zip(others) {
            *sum += one + two + three;
        }
    }
}

/// Sums of each square of a row and three that follow at a distance.
fn sum_columns<const DISTANCE: usize>(row: &[f32; ROW]) -> [f32; ROW] {
    let mut sums = [0.0; ROW];
    for (x, sum) in sums[..RASTER - 3 * DISTANCE].iter_mut().enumerate() {
        *sum = row[x] + row[x + DISTANCE] + row[x + 2 * DISTANCE] + row[x + 3 * DISTANCE];
    }
    sums
}

/// Middle of the costs.
fn middle(cells: &Cells, left: &PerCell) -> Vec2 {
    let (mut sum, mut total) = (Vec2::ZERO, 0.0);
    for (i, left) in left.iter().enumerate().take(cells.len) {
        let cost = cells.cost[i] * left;
        (sum, total) = (sum + Vec2::new(cells.x[i], cells.y[i]) * cost, total + cost);
    }
    if total > 0.0 { sum / total } else { Vec2::ZERO }
}

/// Spreads the costs over the squares of the cells.
fn enter(sums: &mut Raster, cells: &Cells, left: &PerCell, (corner, pitch): (Vec2, Vec2)) {
    let per_pitch = Vec2::ONE / pitch;
    let size = RASTER as f32;
    for (i, left) in left.iter().enumerate().take(cells.len) {
        let cost = cells.cost[i] * left;
        let from_corner = Vec2::new(cells.x[i], cells.y[i]) - corner;
        let (low, high) = ((from_corner - cells.half[i]) * per_pitch, (from_corner + cells.half[i]) * per_pitch);
        let is_in = high.x > 0.0 && high.y > 0.0 && low.x < size && low.y < size;
        let sides = high - low;
        // Also for NaN.
        if !(cost > 0.0 && is_in && sides.x <= WIDEST && sides.y <= WIDEST) {
            continue;
        }
        let per_square = cost / (sides.x * sides.y);
        let (x, y) = (greater(low.x, 0.0) as u32, greater(low.y, 0.0) as u32);
        let (columns, rows) = (high.x as u32 - x, (high.y as u32).min(RASTER as u32 - 1) - y);
        let mut widths = [[0.0_f32; GROUP]; TOUCHED / GROUP];
        let groups = columns as usize / GROUP + 1;
        let mut at = x as f32;
        for group in &mut widths[..groups] {
            for (width, k) in group.iter_mut().zip([0.0, 1.0, 2.0, 3.0]) {
                let (low, high) = (greater(low.x, at + k), lesser(high.x, at + k + 1.0));
                *width = greater(high - low, 0.0) * per_square;
            }
            at += GROUP as f32;
        }
        for y in y..=y + rows {
            let height = lesser(high.y, y as f32 + 1.0) - greater(low.y, y as f32);
            let row = &mut sums[y as usize][x as usize..][..groups * GROUP];
            for (sums, widths) in row.chunks_exact_mut(GROUP).zip(&widths) {
                for (sum, width) in sums.iter_mut().zip(widths) {
                    *sum += width * height;
                }
            }
        }
    }
}
