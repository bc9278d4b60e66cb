//! The visible demand of an earlier picture: the counts that decide where fits place their maps.
//!
//! The counts come from a depth buffer (`shadowfit-wgpu` has a compute pass for it), or from rays against the
//! triangles. Pass them as a [`VisibleDemand`] to
//! [`ShadowFitter::set_visible_demand`](crate::ShadowFitter::set_visible_demand). Without counts, fits
//! estimate the visible surfaces from the boxes.

use alloc::boxed::Box;
use alloc::vec::Vec;

use glam::DVec3;

use super::counts::{COUNTS, Counts, VisibleDemandSpace};
use super::grid::DemandGrid;
use super::histogram::DepthHistogram;
use super::rows::DepthRows;
use crate::base::FitError;

/// Visible demand: counts of the points in a picture that face the light.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleDemand {
    space: VisibleDemandSpace,
    counts: Box<Counts>,
}

impl VisibleDemand {
    /// Creates a demand without points.
    #[allow(clippy::large_stack_arrays, reason = "optimised builds write the zeros to the heap")]
    pub fn new(space: VisibleDemandSpace) -> Self {
        Self { space, counts: Box::new([0; COUNTS]) }
    }

    /// Creates a demand from counts: the cells of the grid, then the bins of the histogram, class by class.
    /// Returns `None` if their number is not [`COUNTS`].
    pub fn from_counts(space: VisibleDemandSpace, counts: Vec<u32>) -> Option<Self> {
        let counts = counts.into_boxed_slice().try_into().ok()?;
        Some(Self { space, counts })
    }

    /// Counts a point in a cell of the grid: [`VisibleDemandSpace::count_cell`].
    pub fn count_cell(&mut self, index: usize) {
        self.space.count_cell(&mut self.counts, index);
    }

    /// Counts a point in a bin of the histogram: [`VisibleDemandSpace::count_depth`].
    pub fn count_depth(&mut self, depth: f32, class: f32) {
        self.space.count_depth(&mut self.counts, depth, class);
    }

    /// Counts the points of a depth buffer that face the light: [`VisibleDemandSpace::count_rows`].
    ///
    /// # Errors
    ///
    /// As [`VisibleDemandSpace::count_rows`].
    pub fn count_rows(&mut self, rows: &DepthRows, stride: u32) -> Result<(), FitError> {
        self.space.count_rows(&mut self.counts, rows, stride)
    }

    /// Returns the space of the counts.
    pub fn space(&self) -> &VisibleDemandSpace {
        &self.space
    }

    /// Returns this demand with its origin moved by this many metres along each axis.
    #[must_use]
    pub fn moved(mut self, by: DVec3) -> Self {
        self.space.demand.origin += by;
        self
    }

    /// Returns the grid of visible points and the texel sizes that they need.
    pub fn demand(&self) -> DemandGrid<'_> {
        self.space.grid(&self.counts)
    }

    /// Returns the histogram of the points' view depths.
    pub fn histogram(&self) -> DepthHistogram<'_> {
        self.space.histogram(&self.counts)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use glam::Vec3;

    use super::*;
    use crate::demand::CELLS;
    use crate::view::PerspectiveCamera;

    #[test]
    fn points_count_in_cells_and_bins_and_what_does_not_fit_is_ignored() {
        let camera = PerspectiveCamera {
            eye: DVec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 100.0,
        };
        let view = camera.frustum().expect("a camera");
        let space = VisibleDemandSpace::new(&view, Vec3::NEG_Y, Vec3::Y, 50.0).expect("a space");
        assert_eq!((space.near, space.far), (0.1, 50.0));
        let mut seen = VisibleDemand::new(space);
        seen.count_cell(7);
        seen.count_cell(CELLS);
        seen.count_depth(10.0, 2.0);
        for depth in [0.05, 50.0, f32::NAN] {
            seen.count_depth(depth, 0.0);
        }
        let sum = |counts: &[u32]| counts.iter().sum::<u32>();
        assert_eq!((seen.demand().counts[7], sum(seen.demand().counts), sum(seen.histogram().bins)), (1, 1, 1));
        let moved = seen.clone().moved(DVec3::X);
        assert_eq!(moved.demand().space.origin, DVec3::X);
        assert_eq!(VisibleDemand::from_counts(space, vec![0; CELLS]), None);
        assert_eq!(VisibleDemand::from_counts(space, vec![0; COUNTS]), Some(VisibleDemand::new(space)));
    }
}
