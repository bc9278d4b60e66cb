//! The share of a map's area that the visible points need. Each point marks the cells under its part of the
//! picture.

use glam::DVec2;

/// Number of cells along each side of a map.
const CELLS: usize = 256;
/// Greatest length of a side of a point's parallelogram, in cells. Longer sides are shortened.
const MAX_SIDE: f64 = 16.0;
/// Number of samples per cell along a side of a point's parallelogram.
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
    /// Marks the cells under a parallelogram. Its centre and sides are in texels of a map of `size` texels.
    pub(crate) fn mark(&mut self, size: DVec2, centre: DVec2, sides: [DVec2; 2]) {
        let cells_per_texel = CELLS as f64 / size;
        let centre = centre * cells_per_texel;
        let [across, down] = sides.map(|side| (side * cells_per_texel).clamp_length_max(MAX_SIDE));
        if !(centre.is_finite() && across.is_finite() && down.is_finite()) {
            return;
        }
        let [samples_across, samples_down] = [across, down].map(samples);
        for row in 0..samples_down {
            let middle = centre + down * offset(row, samples_down);
            for column in 0..samples_across {
                self.mark_cell(middle + across * offset(column, samples_across));
            }
        }
    }

    /// Returns the share of the cells that are marked, 0..=1.
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

/// Returns the number of samples along a side, which is in cells.
fn samples(side: DVec2) -> u32 {
    ((SAMPLES_PER_CELL * side.length()).ceil() as u32).max(1)
}

/// Returns the position of a sample along a side, from -0.5 to 0.5.
fn offset(index: u32, samples: u32) -> f64 {
    (f64::from(index) + 0.5) / f64::from(samples) - 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of cells that a parallelogram with these sides, in cells, marks around cell (100,
    /// 100) in a map of 512×1024 texels.
    fn marked(across: DVec2, down: DVec2) -> usize {
        let mut cells = Cells::default();
        let texels_per_cell = DVec2::new(2.0, 4.0);
        let centre = DVec2::splat(100.0) * texels_per_cell;
        cells.mark(DVec2::new(512.0, 1024.0), centre, [across * texels_per_cell, down * texels_per_cell]);
        (cells.share() * (CELLS * CELLS) as f64).round() as usize
    }

    #[test]
    fn a_parallelogram_marks_the_cells_it_covers() {
        assert_eq!(marked(DVec2::ZERO, DVec2::ZERO), 1);
        assert_eq!(marked(DVec2::new(4.0, 0.0), DVec2::new(0.0, 6.0)), 24);
        // A square on its corner covers no less than its area.
        let tilted = marked(DVec2::new(5.0, 5.0), DVec2::new(-5.0, 5.0));
        assert!((50..=72).contains(&tilted), "{tilted}");
    }

    #[test]
    fn sides_are_shortened_to_16_cells() {
        assert_eq!(marked(DVec2::new(90.0, 0.0), DVec2::ZERO), 16);
    }

    #[test]
    fn what_lies_outside_or_is_not_finite_marks_nothing() {
        let mut cells = Cells::default();
        let size = DVec2::splat(256.0);
        let side = [DVec2::X, DVec2::Y];
        for centre in [DVec2::splat(-0.1), DVec2::splat(256.0), DVec2::splat(f64::NAN), DVec2::splat(f64::INFINITY)] {
            cells.mark(size, centre, side.map(|side| side * 0.1));
        }
        cells.mark(size, DVec2::splat(9.0), [DVec2::splat(f64::INFINITY), DVec2::Y]);
        assert_eq!(cells.share(), 0.0);
    }
}
