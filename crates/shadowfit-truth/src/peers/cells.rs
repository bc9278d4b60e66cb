//! Which share of a map's area the visible points need: each marks the cells under its footprint.

use glam::DVec2;

/// Cells across and down a map.
const CELLS: usize = 256;
/// Longest side of a footprint, in cells.
const LONGEST_SIDE: f64 = 16.0;
/// Samples in a cell's length along a side of a footprint.
const SAMPLES_PER_CELL: f64 = 1.5;

/// The cells of a map.
#[derive(Clone, Debug)]
pub(crate) struct Cells {
    marked: Vec<bool>,
}

impl Default for Cells {
    fn default() -> Self {
        Self { marked: vec![false; CELLS * CELLS] }
    }
}

impl Cells {
    /// Marks the cells under a parallelogram, given in texels of a map of `size` texels by its
    /// centre and its sides.
    pub(crate) fn mark(&mut self, size: DVec2, centre: DVec2, sides: [DVec2; 2]) {
        let cells_per_texel = CELLS as f64 / size;
        let centre = centre * cells_per_texel;
        let [across, down] = sides.map(|side| (side * cells_per_texel).clamp_length_max(LONGEST_SIDE));
        if !(centre.is_finite() && across.is_finite() && down.is_finite()) {
            return;
        }
        let [samples_across, samples_down] = [across, down].map(samples);
        for row in 0..samples_down {
            let middle = centre + down * place(row, samples_down);
            for column in 0..samples_across {
                self.mark_cell(middle + across * place(column, samples_across));
            }
        }
    }

    /// Share of the cells that are marked, 0..=1.
    pub(crate) fn share(&self) -> f64 {
        self.marked.iter().filter(|marked| **marked).count() as f64 / self.marked.len() as f64
    }

    fn mark_cell(&mut self, cell: DVec2) {
        let limit = CELLS as f64;
        if cell.x >= 0.0 && cell.y >= 0.0 && cell.x < limit && cell.y < limit {
            self.marked[cell.y as usize * CELLS + cell.x as usize] = true;
        }
    }
}

/// Number of samples along a side, in cells.
fn samples(side: DVec2) -> u32 {
    ((SAMPLES_PER_CELL * side.length()).ceil() as u32).max(1)
}

/// Place of a sample along a side, from -0.5 to 0.5.
fn place(index: u32, samples: u32) -> f64 {
    (f64::from(index) + 0.5) / f64::from(samples) - 0.5
}
