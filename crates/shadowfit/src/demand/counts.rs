//! The space of the visible points of a picture, with counts in memory that the caller owns.

use glam::Vec3;

use super::grid::{CELLS, DemandGrid, DemandSpace};
use super::histogram::DepthHistogram;
use crate::base::FitError;
use crate::view::ViewFrustum;

/// Bins of the histogram, in even steps of log view depth.
pub const DEPTHS: usize = 128;

/// Classes of the histogram: octaves of foreshortening.
pub const CLASSES: usize = 6;

/// Length of the counts: cells of the grid, then bins of the histogram.
pub const COUNTS: usize = CELLS + DEPTHS * CLASSES;

/// Counts of visible points: cells of the grid, then bins of the histogram, class by class.
pub type Counts = [u32; COUNTS];

/// Cells and bins that count the points of a picture.
///
/// Its methods count in memory that the caller owns. [`VisibleDemand`](crate::VisibleDemand) owns its memory and needs
/// the feature `alloc`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleDemandSpace {
    /// The cells of the grid.
    pub demand: DemandSpace,
    /// View depth at which the first bin begins, in metres.
    pub near: f32,
    /// View depth at which the last bin ends, in metres.
    pub far: f32,
}

impl VisibleDemandSpace {
    /// Creates the space for a view and a light. The arguments are the same as for [`DemandSpace::new`].
    ///
    /// # Errors
    ///
    /// As [`DemandSpace::new`].
    pub fn new(view: &ViewFrustum, direction: Vec3, up: Vec3, distance: f32) -> Result<Self, FitError> {
        let demand = DemandSpace::new(view, direction, up, distance)?;
        Ok(Self { demand, near: view.near, far: view.far.min(distance) })
    }

    /// Counts a point in a cell of the grid, by [`DemandSpace::index`]. An index outside the grid is ignored.
    pub fn count_cell(&self, counts: &mut Counts, index: usize) {
        if let Some(count) = counts[..CELLS].get_mut(index) {
            *count = count.saturating_add(1);
        }
    }

    /// Counts a point in a bin of the histogram. `depth` is its view depth, in metres, and `class` its class,
    /// as for [`DepthHistogram::bin`].
    pub fn count_depth(&self, counts: &mut Counts, depth: f32, class: f32) {
        if let Some(bin) = DepthHistogram::bin(self.near, self.far, DEPTHS, CLASSES, depth, class) {
            let count = &mut counts[CELLS + bin];
            *count = count.saturating_add(1);
        }
    }

    /// Returns the grid of visible points and the texel sizes that they need.
    pub fn grid<'a>(&self, counts: &'a Counts) -> DemandGrid<'a> {
        DemandGrid { space: self.demand, counts: &counts[..CELLS] }
    }

    /// Returns the histogram of the points' view depths.
    pub fn histogram<'a>(&self, counts: &'a Counts) -> DepthHistogram<'a> {
        DepthHistogram { near: self.near, far: self.far, bins: &counts[CELLS..], classes: CLASSES }
    }
}
