//! Numbers of points per cell, in a hash table of a fixed size.
//!
//! If the table is full, the cells with the fewest points are removed. With n points in all cells, the first
//! removal takes cells with at most n / 4096 points each. This is a quarter of the mean of 1,024 cells, so
//! less than a quarter of the points are lost, even if they are spread evenly. Each further removal doubles
//! that limit, or raises it to n / 4096 at that time. A cell with more points than the limit is never
//! removed, so windows still find all places with many points.

use crate::demand::grid::{LEVELS, SIDE};

/// Greatest number of cells.
pub(super) const MAX_CELLS: usize = 1024;

/// Numbers of points in the cells of a space.
pub(super) struct Counted {
    /// Index of each cell, and its number of points or a share of it.
    cells: [(u32, f32); MAX_CELLS],
    len: usize,
    /// Position in `cells` plus one, by the cell's hash; zero for none.
    table: [u16; TABLE],
    /// Cells with no more points than this are left out.
    least: f32,
}

/// Slots of the hash table: twice the number of cells.
const TABLE: usize = 2 * MAX_CELLS;

impl Counted {
    pub(super) const fn new() -> Self {
        Self { cells: [(0, 0.0); MAX_CELLS], len: 0, table: [0; TABLE], least: 0.0 }
    }

    /// Adds a new cell with points.
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
        // NaN does not count either.
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

    /// Returns the slot of a cell in the table, or the slot where it would be added.
    fn place(&self, key: u32) -> usize {
        let mut place = (key.wrapping_mul(2_654_435_769) >> 21) as usize % TABLE;
        while self.table[place] != 0 && self.cells[usize::from(self.table[place]) - 1].0 != key {
            place = (place + 1) % TABLE;
        }
        place
    }

    /// Returns the cells, each with its index and its number of points.
    pub(super) fn cells(&self) -> &[(u32, f32)] {
        &self.cells[..self.len]
    }

    /// Returns the width below which the finest demands lie, for the given share of the points. It is
    /// relative to the texel of the finest level.
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

    /// Removes the cells with the fewest points. The module's documentation has a bound of the error.
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
