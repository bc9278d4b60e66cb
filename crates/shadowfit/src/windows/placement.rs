//! Where a square of the plane holds most of what is left to be served.
//!
//! The cost of all cells is entered into a raster, of which a summed-area table (F. Crow,
//! "Summed-area tables for texture mapping", 1984) gives the sum in any square.

use glam::Vec2;

use super::cells::Cell;

/// Squares of the raster in a window's side.
const ACROSS: usize = 18;

/// Squares of the raster along each axis: more than five windows.
const RASTER: usize = 96;

/// A rectangle of the plane: its least corner and its size, in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
            ((high - low) / (2.0 * cell.half)).clamp(0.0, 1.0)
        };
        over(cell.middle.x, self.min.x, max.x) * over(cell.middle.y, self.min.y, max.y)
    }

    /// Cost of what lies inside, of the shares of the cells that are left.
    pub(super) fn cost(&self, cells: &[Cell], left: &[f32]) -> f32 {
        cells.iter().zip(left).map(|(cell, left)| cell.cost * left * self.share(cell)).sum()
    }
}

/// The rectangle of a size with the greatest cost inside, to the nearest twelfth of its size.
pub(super) fn best(cells: &[Cell], left: &[f32], size: Vec2) -> Rect {
    let pitch = size / ACROSS as f32;
    let corner = middle(cells, left) - pitch * (RASTER / 2) as f32;
    let mut sums = [[0.0_f32; RASTER + 1]; RASTER + 1];
    for (cell, left) in cells.iter().zip(left) {
        enter(&mut sums, cell, cell.cost * left, corner, pitch);
    }
    for y in 1..=RASTER {
        let mut row = 0.0;
        for x in 1..=RASTER {
            row += sums[y][x];
            sums[y][x] = sums[y - 1][x] + row;
        }
    }
    let (mut most, mut at) = (f32::MIN, (0, 0));
    for y in 0..=RASTER - ACROSS {
        let (low, high) = (&sums[y], &sums[y + ACROSS]);
        for x in 0..=RASTER - ACROSS {
            let sum = high[x + ACROSS] - high[x] - low[x + ACROSS] + low[x];
            if sum > most {
                (most, at) = (sum, (x, y));
            }
        }
    }
    Rect { min: corner + Vec2::new(at.0 as f32, at.1 as f32) * pitch, size }
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

/// Cells wider than this many squares of the raster are left out: what they ask for is far coarser.
const WIDEST: f32 = 18.0;

/// Spreads a cost over the squares of a cell. The table has a free first row and column.
fn enter(sums: &mut [[f32; RASTER + 1]; RASTER + 1], cell: &Cell, cost: f32, corner: Vec2, pitch: Vec2) {
    let (low, high) = ((cell.middle - cell.half - corner) / pitch, (cell.middle + cell.half - corner) / pitch);
    let size = RASTER as f32;
    let is_beside = high.min_element() <= 0.0 || low.max_element() >= size;
    if cost <= 0.0 || is_beside || (high.x - low.x) > WIDEST {
        return;
    }
    let per_square = cost / ((high.x - low.x) * (high.y - low.y));
    let range = |low: f32, high: f32| (low.max(0.0) as usize)..(libm::ceilf(high.min(size)) as usize);
    for y in range(low.y, high.y) {
        let height = (high.y.min(y as f32 + 1.0) - low.y.max(y as f32)).max(0.0);
        for x in range(low.x, high.x) {
            let width = (high.x.min(x as f32 + 1.0) - low.x.max(x as f32)).max(0.0);
            sums[y + 1][x + 1] += per_square * width * height;
        }
    }
}
