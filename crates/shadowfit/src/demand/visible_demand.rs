//! The visible demand of an earlier picture: the counts that decide where fits place their maps.
//!
//! The counts come from a depth buffer (`shadowfit-wgpu` has a compute pass for it), or from rays against the
//! triangles. Pass them as a [`VisibleDemand`] to
//! [`ShadowFitter::set_visible_demand`](crate::ShadowFitter::set_visible_demand). Without counts, fits
//! estimate the visible surfaces from the boxes.

use alloc::vec;
use alloc::vec::Vec;

use glam::{DVec3, Vec3};

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

/// Space in which the points of a picture are counted.
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
}

/// Visible demand: counts of the points in a picture that face the light.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleDemand {
    space: VisibleDemandSpace,
    /// The [`COUNTS`] counts.
    counts: Vec<u32>,
}

impl VisibleDemand {
    /// Creates a demand without points.
    pub fn new(space: VisibleDemandSpace) -> Self {
        Self { space, counts: vec![0; COUNTS] }
    }

    /// Creates a demand from counts: the cells of the grid, then the bins of the histogram, class by class.
    /// Returns `None` if their number is not [`COUNTS`].
    pub fn from_counts(space: VisibleDemandSpace, counts: Vec<u32>) -> Option<Self> {
        (counts.len() == COUNTS).then_some(Self { space, counts })
    }

    /// Counts a point in a cell of the grid, by [`DemandSpace::index`]. An index outside the grid is ignored.
    pub fn count_cell(&mut self, index: usize) {
        if let Some(count) = self.counts[..CELLS].get_mut(index) {
            *count = count.saturating_add(1);
        }
    }

    /// Counts a point in a bin of the histogram. `depth` is its view depth, in metres, and `class` its class,
    /// as for [`DepthHistogram::bin`].
    pub fn count_depth(&mut self, depth: f32, class: f32) {
        let VisibleDemandSpace { near, far, .. } = self.space;
        if let Some(bin) = DepthHistogram::bin(near, far, DEPTHS, CLASSES, depth, class) {
            let count = &mut self.counts[CELLS + bin];
            *count = count.saturating_add(1);
        }
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
        DemandGrid { space: self.space.demand, counts: &self.counts[..CELLS] }
    }

    /// Returns the histogram of the points' view depths.
    pub fn histogram(&self) -> DepthHistogram<'_> {
        let VisibleDemandSpace { near, far, .. } = self.space;
        DepthHistogram { near, far, bins: &self.counts[CELLS..], classes: CLASSES }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
