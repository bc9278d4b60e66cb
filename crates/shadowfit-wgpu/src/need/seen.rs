//! The counts of a picture, as fits take them.

use shadowfit::histogram::DepthHistogram;
use shadowfit::need::{CELLS, NeedGrid, NeedSpace};

/// Bins of the histogram, at even steps of log view depth.
pub const DEPTHS: usize = 128;

/// Octaves of foreshortening that the histogram tells apart.
pub const CLASSES: usize = 6;

/// Numbers that the pass counts: cells, then bins.
pub(super) const COUNTS: usize = CELLS + DEPTHS * CLASSES;

/// What a picture showed that faces the light.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenNeed {
    pub(super) stamp: Stamp,
    /// [`COUNTS`] of them.
    pub(super) counts: Vec<u32>,
}

/// What a picture's counts mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stamp {
    pub(super) space: NeedSpace,
    /// View depths between which points are counted, in metres.
    pub(super) near: f32,
    pub(super) far: f32,
}

impl SeenNeed {
    /// How fine a texel the points ask for, and where they are: for [`FitInput::need`](shadowfit::FitInput::need).
    pub fn grid(&self) -> NeedGrid<'_> {
        NeedGrid { space: self.stamp.space, counts: &self.counts[..CELLS] }
    }

    /// How far away they are: for [`FitInput::histogram`](shadowfit::FitInput::histogram).
    pub fn histogram(&self) -> DepthHistogram<'_> {
        let Stamp { near, far, .. } = self.stamp;
        DepthHistogram { near, far, bins: &self.counts[CELLS..], classes: CLASSES }
    }
}
