//! The search for the place where a window holds the greatest cost.
//!
//! The cost of all cells is entered into a raster. The sum over every square as large as the window is
//! computed in steps: of 4 and 16 rows, then of 4 and 16 columns.

use glam::Vec2;

use super::cells::{Cells, PerCell};
use super::lattice::Rect;
use crate::base::checks::{greater, lesser};

/// Squares of the raster per window side: four times four.
const ACROSS: usize = 16;

/// Squares of the raster along each axis: four windows.
const RASTER: usize = 64;

/// Positions along each axis at which a window may begin.
const PLACES: usize = RASTER - ACROSS + 1;

/// Greatest width of a cell, in squares of the raster. Wider cells are left out, since their demand is far
/// coarser.
const WIDEST: f32 = 16.0;

/// Squares that a cell of this width may touch in a row, in groups of four.
const TOUCHED: usize = 20;
const GROUP: usize = 4;

/// Length of a row, with room for the squares that a cell in the last square touches.
const ROW: usize = RASTER + TOUCHED;

/// Costs by squares of the plane.
struct Raster {
    /// Least corner of the first square.
    corner: Vec2,
    /// Size of a square.
    pitch: Vec2,
    /// Costs, row by row.
    rows: [[f32; ROW]; RASTER],
}

/// Returns the rectangle of a size with the greatest cost inside, to the nearest sixteenth of its size. `left` has the
/// shares of the cells that no finer window holds.
pub(super) fn best(cells: &Cells, left: &PerCell, size: Vec2) -> Rect {
    let mut raster = Raster::new(cells, left, size / ACROSS as f32);
    raster.enter(cells, left);
    raster.sum_rows(1);
    raster.sum_rows(4);
    // Around the middle if no cost is left.
    let (mut most, mut at) = (0.0, ((RASTER - ACROSS) / 2, (RASTER - ACROSS) / 2));
    for (y, row) in raster.rows[..PLACES].iter().enumerate() {
        let row = sum_columns::<4>(&sum_columns::<1>(row));
        let highest = row[..PLACES].iter().fold(f32::MIN, |highest, sum| greater(*sum, highest));
        if highest > most {
            most = highest;
            at = (row[..PLACES].iter().position(|sum| *sum == highest).unwrap_or(0), y);
        }
    }
    Rect { min: raster.corner + Vec2::new(at.0 as f32, at.1 as f32) * raster.pitch, size }
}

impl Raster {
    /// Creates an empty raster around the middle of the costs.
    #[expect(clippy::large_stack_arrays, reason = "21 KiB, for the time of a search")]
    fn new(cells: &Cells, left: &PerCell, pitch: Vec2) -> Self {
        let corner = middle(cells, left) - pitch * (RASTER / 2) as f32;
        Self { corner, pitch, rows: [[0.0; ROW]; RASTER] }
    }

    /// Spreads the costs over the squares of the cells.
    fn enter(&mut self, cells: &Cells, left: &PerCell) {
        let per_pitch = Vec2::ONE / self.pitch;
        let size = RASTER as f32;
        for (i, left) in left.iter().enumerate().take(cells.len) {
            let cost = cells.cost[i] * left;
            let from_corner = Vec2::new(cells.x[i], cells.y[i]) - self.corner;
            let (low, high) = ((from_corner - cells.half[i]) * per_pitch, (from_corner + cells.half[i]) * per_pitch);
            let is_in = high.x > 0.0 && high.y > 0.0 && low.x < size && low.y < size;
            let sides = high - low;
            // False for NaN too.
            if cost > 0.0 && is_in && sides.x <= WIDEST && sides.y <= WIDEST {
                self.enter_cell(low, high, cost / (sides.x * sides.y));
            }
        }
    }

    /// Adds a cell, given by its corners in squares, with its cost per square.
    #[inline(always)]
    fn enter_cell(&mut self, low: Vec2, high: Vec2, per_square: f32) {
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
            let row = &mut self.rows[y as usize][x as usize..][..groups * GROUP];
            for (sums, widths) in row.chunks_exact_mut(GROUP).zip(&widths) {
                for (sum, width) in sums.iter_mut().zip(widths) {
                    *sum += width * height;
                }
            }
        }
    }

    /// Adds to each row the next three rows at a distance.
    fn sum_rows(&mut self, distance: usize) {
        for y in 0..RASTER - 3 * distance {
            let [row, one, two, three] = [0, 1, 2, 3].map(|k| y + k * distance);
            let (low, high) = self.rows.split_at_mut(one);
            let others = high[0].iter().zip(&high[two - one]).zip(&high[three - one]);
            for (sum, ((one, two), three)) in low[row].iter_mut().zip(others) {
                *sum += one + two + three;
            }
        }
    }
}

/// Sums each square of a row and the next three squares at a distance.
fn sum_columns<const DISTANCE: usize>(row: &[f32; ROW]) -> [f32; ROW] {
    let mut sums = [0.0; ROW];
    for (x, sum) in sums[..RASTER - 3 * DISTANCE].iter_mut().enumerate() {
        *sum = row[x] + row[x + DISTANCE] + row[x + 2 * DISTANCE] + row[x + 3 * DISTANCE];
    }
    sums
}

/// Returns the mean position of the costs.
fn middle(cells: &Cells, left: &PerCell) -> Vec2 {
    let (mut sum, mut total) = (Vec2::ZERO, 0.0);
    for (i, left) in left.iter().enumerate().take(cells.len) {
        let cost = cells.cost[i] * left;
        (sum, total) = (sum + Vec2::new(cells.x[i], cells.y[i]) * cost, total + cost);
    }
    if total > 0.0 { sum / total } else { Vec2::ZERO }
}
