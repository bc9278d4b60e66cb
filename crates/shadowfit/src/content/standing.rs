//! Standing boxes as one frame sees them: those in view, taken from their tree once.

use glam::{DVec2, DVec3};

use crate::base::{Aabb, FitError, moved};
use crate::view::{View, ViewFrustum};

#[cfg(feature = "alloc")]
pub(crate) use super::tree::BoxTree;

/// There are no trees without an allocator.
#[cfg(not(feature = "alloc"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BoxTree {}

#[cfg(not(feature = "alloc"))]
impl BoxTree {
    pub(crate) fn origin(&self) -> DVec3 {
        match *self {}
    }

    pub(crate) fn visit<C: Copy, S>(
        &self,
        _: C,
        _: &mut S,
        _: impl Fn(&mut S, C, &Aabb) -> Option<C>,
        _: impl FnMut(&mut S, C, u32, &Aabb),
    ) {
        match *self {}
    }
}

/// Most views that boxes are tested against; where there are more, all boxes count as seen.
const MAX_VIEWS: usize = 12;

/// Boxes relative to the origin of a fit, in its storage.
#[derive(Clone, Copy, Default)]
pub(super) struct Corners<'a>(&'a [DVec2]);

impl<'a> Corners<'a> {
    /// Elements of storage for a box.
    pub(super) const ELEMENTS: usize = 3;

    /// Takes the boxes of a tree that may touch one of the views up to a view depth; returns the rest of the storage.
    pub(super) fn in_view(
        tree: &BoxTree,
        (views, reach): (&[ViewFrustum], f32),
        storage: &'a mut [DVec2],
    ) -> Result<(Self, &'a mut [DVec2]), FitError> {
        let given = storage.len();
        let mut count = 0;
        each_in_view(tree, (views, reach), |min, max| {
            if let Some(free) = storage.get_mut(count..count + Self::ELEMENTS) {
                free.copy_from_slice(&[min.truncate(), DVec2::new(min.z, max.x), DVec2::new(max.y, max.z)]);
            }
            count += Self::ELEMENTS;
        });
        if count > given {
            return Err(FitError::ScratchTooSmall { given, required: count });
        }
        let (corners, rest) = storage.split_at_mut(count);
        Ok((Self(corners), rest))
    }

    pub(super) fn len(&self) -> usize {
        self.0.len() / Self::ELEMENTS
    }

    pub(super) fn get(&self, index: usize) -> (DVec3, DVec3) {
        let corners = &self.0[index * Self::ELEMENTS..][..Self::ELEMENTS];
        (DVec3::new(corners[0].x, corners[0].y, corners[1].x), DVec3::new(corners[1].y, corners[2].x, corners[2].y))
    }
}

/// Passes on the boxes of a tree that may touch one of the views up to a view depth, relative to the first one's eye.
pub(crate) fn each_in_view(tree: &BoxTree, (views, reach): (&[ViewFrustum], f32), mut visit: impl FnMut(DVec3, DVec3)) {
    let origin = views[0].origin;
    let offset = tree.origin() - origin;
    let mut tested = [None; MAX_VIEWS];
    tested.iter_mut().zip(views).for_each(|(to, view)| *to = Some(View::new(view, origin)));
    let is_in = |view: &View, min, max| view.depths(min, max).is_some_and(|(near, _)| near <= f64::from(reach));
    let enter = |(): &mut (), (), aabb: &Aabb| {
        let (min, max) = moved(aabb, offset);
        let is_seen = views.len() > MAX_VIEWS || tested.iter().flatten().any(|view| is_in(view, min, max));
        is_seen.then_some(())
    };
    tree.visit((), &mut (), enter, |(), (), _, aabb| {
        let (min, max) = moved(aabb, offset);
        visit(min, max);
    });
}
