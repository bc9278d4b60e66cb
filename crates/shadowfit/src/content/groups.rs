//! Runs of neighbours in a list of boxes, with the bounds of each.

use glam::{DVec2, DVec3};

use crate::base::{Aabb, Boxes, moved};

/// Number of boxes in a run. Smaller runs cost more tests, larger ones hold more space. 8 and 32 are both
/// slower with 1,024 clusters of real scenes.
const RUN: usize = 16;

/// Number of storage elements for the bounds of a run.
const ELEMENTS: usize = 3;

/// Boxes in runs, with the bounds of each.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Groups<'a> {
    boxes: &'a [Aabb],
    bounds: &'a [DVec2],
    /// Offset from the fit's origin to the origin of the boxes.
    offset: DVec3,
}

impl<'a> Groups<'a> {
    /// Returns the number of storage elements for the runs of a number of boxes.
    pub(crate) const fn required(boxes: usize) -> usize {
        boxes.div_ceil(RUN) * ELEMENTS
    }

    /// Computes the runs of boxes relative to an origin. The storage has at least [`Self::required`]
    /// elements.
    pub(crate) fn new(boxes: &Boxes<'a>, origin: DVec3, storage: &'a mut [DVec2]) -> Self {
        for (run, bounds) in boxes.boxes.chunks(RUN).zip(storage.chunks_exact_mut(ELEMENTS)) {
            let all = run.iter().filter(|aabb| !aabb.is_empty()).fold(Aabb::EMPTY, |all, aabb| all.union(*aabb));
            let (min, max) = (all.min.as_dvec3(), all.max.as_dvec3());
            bounds.copy_from_slice(&[min.truncate(), DVec2::new(min.z, max.x), DVec2::new(max.y, max.z)]);
        }
        Self { boxes: boxes.boxes, bounds: storage, offset: boxes.origin - origin }
    }

    /// Returns whether a box of the list is not empty.
    #[inline]
    pub(crate) fn has_box(&self, index: usize) -> bool {
        !self.boxes[index].is_empty()
    }

    /// Returns the least and the greatest corner of a listed box, relative to the fit's origin.
    #[inline]
    pub(crate) fn corners(&self, index: usize) -> (DVec3, DVec3) {
        moved(&self.boxes[index], self.offset)
    }

    /// Returns the runs: the indices of their boxes, and the corners of their bounds relative to the fit's
    /// origin. Empty boxes do not count for the bounds. Runs of empty boxes are skipped.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (core::ops::Range<usize>, DVec3, DVec3)> + use<'a> {
        let (offset, count) = (self.offset, self.boxes.len());
        self.bounds.chunks_exact(ELEMENTS).enumerate().filter_map(move |(i, bounds)| {
            let min = DVec3::new(bounds[0].x, bounds[0].y, bounds[1].x);
            let max = DVec3::new(bounds[1].y, bounds[2].x, bounds[2].y);
            let run = RUN * i..count.min(RUN * (i + 1));
            (min.x <= max.x && !run.is_empty()).then_some((run, min + offset, max + offset))
        })
    }
}
