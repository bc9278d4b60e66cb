//! Numbers of points by cells: a hash table of a fixed size.
//!
//! If it is full, the cells with the fewest points are left out. With n points in all cells, the first time leaves out
//! cells with at most n / 4096 points each: a quarter of the mean of 1,024 cells, so that less than a quarter of the
//! points are lost, even if they lie as evenly as possible. Each further time doubles that limit, or raises it to
//! n / 4096 by then. A cell that asks for more than the limit is never left out, so that windows still find all places
//! where many points lie.

use crate::demand::grid::{LEVELS, SIDE};

/// Most cells that are kept.
pub(super) const MAX_CELLS: usize = 1024;

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
    pub(super) fn push(&mut self, index: usize, weight: f32) {
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
        // False for NaN, too.
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

    /// The cells, each with its index and its number of points.
    pub(super) fn cells(&self) -> &[(u32, f32)] {
        &self.cells[..self.len]
    }

    /// Returns the texel that a share of the points with the finest demands ask for at most, relative to the texel of
    /// the finest level.
    pub(super) fn finest(&self, share: f32) -> f32 {
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

    /// Leaves out the cells with the fewest points. See the head of the file for a bound of the error.
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
