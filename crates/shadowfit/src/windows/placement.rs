//! Where a window holds most of what is left to be served.
//!
//! The cost of all cells is entered into a raster, of which the sum over every square as large as the
//! window is found by doubling: of 2, 4, 8 and 16 rows, then of as many columns.

use glam::Vec2;

use super::cells::Cell;

/// Squares of the raster in a window's side: the sums are doubled four times.
const ACROSS: usize = 16;

/// Squares of the raster along each axis: five windows.
const RASTER: usize = 64;

/// Squares at which a window may begin.
const PLACES: usize = RASTER - ACROSS + 1;

/// Cells wider than this many squares of the raster are left out: what they ask for is far coarser.
const WIDEST: f32 = 16.0;

/// A rectangle of the plane: its least corner and its size, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Rect {
    pub(super) min: Vec2,
    pub(super) size: Vec2,
}

impl Rect {
    /// Share of a cell that lies inside.
    #[inline(always)]
    pub(super) fn share(&self, cell: &Cell) -> f32 {
        let max = self.min + self.size;
        let over = |middle: f32, min: f32, max: f32| {
            let (low, high) = ((middle - cell.half).max(min), (middle + cell.half).min(max));
            ((high - low) * cell.per_side).clamp(0.0, 1.0)
        };
        over(cell.middle.x, self.min.x, max.x) * over(cell.middle.y, self.min.y, max.y)
    }

    /// Cost of what lies inside, of the shares of the cells that are left.
    pub(super) fn cost(&self, cells: &[Cell], left: &[f32]) -> f32 {
        cells.iter().zip(left).map(|(cell, left)| cell.cost * left * self.share(cell)).sum()
    }
}

/// Costs by squares, row by row.
type Raster = [[f32; RASTER]; RASTER];

/// The rectangle of a size with the greatest cost inside, to the nearest sixteenth of its size.
pub(super) fn best(cells: &[Cell], left: &[f32], size: Vec2) -> Rect {
    let pitch = size / ACROSS as f32;
    let corner = middle(cells, left) - pitch * (RASTER / 2) as f32;
    let mut sums: Raster = [[0.0; RASTER]; RASTER];
    for (cell, left) in cells.iter().zip(left) {
        enter(&mut sums, cell, cell.cost * left, (corner, pitch));
    }
    sum_squares(&mut sums);
    let (mut most, mut at) = (f32::MIN, (0, 0));
    for (y, row) in sums[..PLACES].iter().enumerate() {
        let highest = row[..PLACES].iter().fold(f32::MIN, |highest, sum| highest.max(*sum));
        if highest > most {
            most = highest;
            at = (row[..PLACES].iter().position(|sum| *sum == highest).unwrap_or(0), y);
        }
    }
    Rect { min: corner + Vec2::new(at.0 as f32, at.1 as f32) * pitch, size }
}

/// Replaces each square by the sum over [`ACROSS`] squares to the right of and above it.
fn sum_squares(sums: &mut Raster) {
    let mut length = 1;
    while length < ACROSS {
        for y in 0..RASTER - length {
            let (low, high) = sums.split_at_mut(y + length);
            for (sum, other) in low[y].iter_mut().zip(&high[0]) {
                *sum += other;
            }
        }
        length *= 2;
    }
    for row in &mut sums[..PLACES] {
        let mut length = 1;
        while length < ACROSS {
            let before = *row;
            for (sum, other) in row.iter_mut().zip(&before[length..]) {
                *sum += other;
            }
            length *= 2;
        }
    }
}

/// Middle of the costs.
fn middle(cells: &[Cell], left: &[f32]) -> Vec2 {
    let (mut sum, mut total) = (Vec2::ZERO, 0.0);
    for (cell, left) in cells.iter().zip(left) {
        let cost = cell.cost * left;
        (sum, total) = (sum + cell.middle * cost, total + cost);
    }
    if total > 0.0 { sum / total } else { Vec2::ZERO }
}

/// Spreads a cost over the squares of a cell.
#[inline(always)]
fn enter(sums: &mut Raster, cell: &Cell, cost: f32, (corner, pitch): (Vec2, Vec2)) {
    let (low, high) = ((cell.middle - cell.half - corner) / pitch, (cell.middle + cell.half - corner) / pitch);
    let size = RASTER as f32;
    let is_beside = high.min_element() <= 0.0 || low.max_element() >= size;
    // NaN is left out too.
    let is_wide = (high - low).max_element() > WIDEST;
    if cost <= 0.0 || is_beside || is_wide {
        return;
    }
    let per_square = cost / ((high.x - low.x) * (high.y - low.y));
    let range = |low: f32, high: f32| (low.max(0.0) as usize)..RASTER.min(high.min(size) as usize + 1);
    for y in range(low.y, high.y) {
        let height = (high.y.min(y as f32 + 1.0) - low.y.max(y as f32)).max(0.0) * per_square;
        for x in range(low.x, high.x) {
            let width = (high.x.min(x as f32 + 1.0) - low.x.max(x as f32)).max(0.0);
            sums[y][x] += height * width;
        }
    }
}
