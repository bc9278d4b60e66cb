//! The only way to read the boxes of a frame: a [`Query`] selects them, a [`Visit`] receives them.
//!
//! Both the lists and the tree are hierarchies: a list has [runs](super::groups) of neighbours, the tree has
//! nodes. A visitor gets the bounds of a run or node first, and skips all boxes in it if they cannot change
//! its result.

use glam::{DVec2, DVec3};

use super::Content;
use super::boxes::{Bounds, scattered};
use super::groups::Groups;
use super::views::ViewPart;
use crate::base::{Aabb, moved};
use crate::view::{Depths, Range, Slice};

/// Selection of boxes.
#[derive(Clone, Copy)]
pub(crate) enum Query<'q> {
    /// All casters, in view or not.
    Casters,
    /// All receivers, in view or not.
    Receivers,
    /// The boxes of the tree alone, in view or not.
    StaticBoxes,
    /// Receivers in a part of a view. Boxes whose surfaces face away from the light are included.
    Visible(&'q ViewPart),
    /// Receivers in a part of a view, except boxes whose surfaces face away from the light.
    Lit(&'q ViewPart),
    /// The boxes of [`Self::Lit`]. Listed boxes come with [large steps](scattered) between them and without
    /// runs, for visitors whose result depends mostly on a few boxes that lie far apart.
    Scattered(&'q ViewPart),
}

/// A box that a query found.
#[derive(Clone, Copy)]
pub(crate) struct Found {
    pub(crate) bounds: Bounds,
    /// Number of the box: its index in its list, or its number in the tree plus the number of listed
    /// receivers.
    pub(crate) index: usize,
}

/// Receives the boxes of a query. For queries by view, boxes of the tree come roughly nearest first.
pub(crate) trait Visit {
    /// Returns whether a box within these bounds may still change the result.
    fn wants(&self, bounds: &Bounds) -> bool;

    /// Takes a box. Boxes of a list may come even if they are not wanted.
    fn take(&mut self, found: &Found);
}

/// Receives the corners of boxes that are clipped to views.
pub(crate) trait VisitCorners {
    /// Returns whether a corner within these bounds may still change the result.
    fn wants(&self, bounds: &Bounds) -> bool;

    /// Returns whether a corner of a box may still change the result. Visitors that identify the box by its
    /// index can answer faster.
    #[inline]
    fn wants_box(&self, found: &Found) -> bool {
        self.wants(&found.bounds)
    }

    /// Takes a corner, relative to the fit's origin.
    fn take(&mut self, corner: DVec3);
}

/// Clips boxes to a slice of a view.
struct Clipping<'v, V> {
    corners: &'v mut V,
    slice: Slice,
}

impl<V: VisitCorners> Visit for Clipping<'_, V> {
    #[inline]
    fn wants(&self, bounds: &Bounds) -> bool {
        self.corners.wants(bounds)
    }

    #[inline]
    fn take(&mut self, found: &Found) {
        if self.corners.wants_box(found) {
            self.slice.clip(found.bounds.min, found.bounds.max, &mut |corner| self.corners.take(corner));
        }
    }
}

impl Content<'_> {
    /// Passes the boxes of a query to a visitor, first from the list, then from the tree.
    #[inline]
    pub(crate) fn visit(&self, query: Query, visitor: &mut impl Visit) {
        let anywhere = |_: usize, min, max| Some(Bounds::anywhere(min, max));
        let (receivers, casters) = (&self.receiver_groups, &self.caster_groups);
        match query {
            Query::Casters => {
                visit_list(casters, |i| casters.has_box(i), anywhere, visitor);
                self.visit_tree(visitor);
            }
            Query::Receivers => {
                visit_list(receivers, |i| receivers.has_box(i), anywhere, visitor);
                self.visit_tree(visitor);
            }
            Query::StaticBoxes => self.visit_tree(visitor),
            Query::Visible(part) => {
                visit_list(receivers, |i| receivers.has_box(i), |_, min, max| part.bounds(min, max), visitor);
                self.visit_tree_in(part, visitor);
            }
            Query::Lit(part) => {
                let depths = |i: usize| depths_of(self.depths_in(part.index)[i]);
                let bounds = |i, min, max| Some(Bounds { min, max, depths: depths(i) });
                visit_list(receivers, |i| part.reaches(depths(i)), bounds, visitor);
                self.visit_tree_in(part, visitor);
            }
            Query::Scattered(part) => {
                let depths = self.depths_in(part.index);
                for index in scattered(depths.len()) {
                    let depths = depths_of(depths[index]);
                    if let Some((min, max)) = self.receiver(index).filter(|_| part.reaches(depths)) {
                        visitor.take(&Found { bounds: Bounds { min, max, depths }, index });
                    }
                }
                self.visit_tree_in(part, visitor);
            }
        }
    }

    /// Clips the lit receivers to the views between two view depths. Passes the corners to a visitor.
    #[inline]
    pub(crate) fn visit_corners(&self, range: Range, corners: &mut impl VisitCorners) {
        for part in self.parts(range) {
            let slice = part.slice();
            self.visit(Query::Scattered(&part), &mut Clipping { corners: &mut *corners, slice });
        }
    }

    /// Passes all boxes of the tree to a visitor.
    #[inline]
    fn visit_tree<V: Visit>(&self, visitor: &mut V) {
        let Some(tree) = self.static_boxes else { return };
        let (offset, listed) = (tree.origin() - self.origin, self.listed());
        let bounds = |aabb: &Aabb| {
            let (min, max) = moved(aabb, offset);
            Bounds::anywhere(min, max)
        };
        let enter = |visitor: &mut V, (), aabb: &Aabb| visitor.wants(&bounds(aabb)).then_some(());
        tree.visit((), visitor, enter, |visitor, (), number, aabb| {
            visitor.take(&Found { bounds: bounds(aabb), index: listed + number as usize });
        });
    }

    /// Passes the boxes of the tree in a part of a view to a visitor.
    #[inline]
    fn visit_tree_in<V: Visit>(&self, part: &ViewPart, visitor: &mut V) {
        let Some(tree) = self.static_boxes else { return };
        let (offset, listed) = (tree.origin() - self.origin, self.listed());
        let distances = |aabb: &Aabb| {
            let (min, max) = moved(aabb, offset);
            part.bounds(min, max).map(|bounds| (bounds.depths.near, bounds.depths.far))
        };
        let bounds = |(near, far): (f64, f64), aabb: &Aabb| {
            let (min, max) = moved(aabb, offset);
            Bounds { min, max, depths: Depths { near, far } }
        };
        let enter = |visitor: &V, distances, aabb: &Aabb| visitor.wants(&bounds(distances, aabb));
        tree.visit_nearest(visitor, distances, enter, |visitor, distances, number, aabb| {
            visitor.take(&Found { bounds: bounds(distances, aabb), index: listed + number as usize });
        });
    }
}

/// Passes the boxes of a list to a visitor, except boxes whose index is not `is_in` and boxes without
/// `bounds`.
#[inline]
fn visit_list(
    groups: &Groups,
    is_in: impl Fn(usize) -> bool,
    bounds: impl Fn(usize, DVec3, DVec3) -> Option<Bounds>,
    visitor: &mut impl Visit,
) {
    for (run, min, max) in groups.runs() {
        if !visitor.wants(&Bounds::anywhere(min, max)) {
            continue;
        }
        for index in run.filter(|index| is_in(*index)) {
            let (min, max) = groups.corners(index);
            if let Some(bounds) = bounds(index, min, max) {
                visitor.take(&Found { bounds, index });
            }
        }
    }
}

/// Returns the view depths of a listed receiver from their stored form.
#[inline]
fn depths_of(stored: DVec2) -> Depths {
    Depths { near: stored.x, far: stored.y }
}
