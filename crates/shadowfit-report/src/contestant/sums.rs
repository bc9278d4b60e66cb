//! Sums over judged pictures, and their columns.

use shadowfit_truth::PictureTally;

/// Columns that contestants do not have, because they need several rays per pixel.
const LEFT_OUT: [&str; 3] = ["area error %", "area error several %", "traced %"];

/// Sums over judged pictures.
#[derive(Clone, Debug, Default)]
pub struct Sums {
    /// Sums of the classes.
    pub tally: PictureTally,
    /// Judged pixels whose point lies outside of the map that the renderer reads for it. The tally's uncovered pixels
    /// lie outside of all later maps, too.
    pub missed: u64,
}

impl Sums {
    /// Adds the sums of other pictures.
    pub fn merge(&mut self, other: &Self) {
        self.tally.merge(&other.tally);
        self.missed += other.missed;
    }

    /// Returns the titles and values of all columns.
    pub fn columns(&self) -> Vec<(&'static str, f64)> {
        let missed = if self.tally.is_empty() { f64::NAN } else { 100.0 * self.tally.share(self.missed) };
        let mut columns = self.tally.columns();
        columns.retain(|(title, _)| !LEFT_OUT.contains(title));
        columns.push(("missed %", missed));
        columns
    }

    /// Returns the value of a column; NaN if there is no such column.
    pub fn value(&self, title: &str) -> f64 {
        self.columns().iter().find(|(known, _)| *known == title).map_or(f64::NAN, |(_, value)| *value)
    }
}
