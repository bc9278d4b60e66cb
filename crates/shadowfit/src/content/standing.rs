//! Standing boxes as one frame sees them: no more of them are looked at than may change what is asked for.

use glam::DVec3;

use super::Content;
use crate::base::{Aabb, moved};
use crate::view::View;

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

    pub(crate) fn get(&self, _: u32) -> Option<Aabb> {
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

    pub(crate) fn visit_nearest<S>(
        &self,
        _: &mut S,
        _: impl Fn(&Aabb) -> Option<(f64, f64)>,
        _: impl Fn(&S, (f64, f64), &Aabb) -> bool,
        _: impl FnMut(&mut S, (f64, f64), u32, &Aabb),
    ) {
        match *self {}
    }
}

impl Content<'_> {
    /// Passes on each standing box, in view or not, with a state: those for which `is_new` is true, as it is for all
    /// boxes of the hierarchy around them.
    pub(crate) fn each_standing<S>(
        &self,
        state: &mut S,
        is_new: impl Fn(&S, DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, DVec3, DVec3),
    ) {
        let Some(tree) = self.standing else { return };
        let offset = tree.origin() - self.origin;
        let enter = |state: &mut S, (), aabb: &Aabb| {
            let (min, max) = moved(aabb, offset);
            is_new(state, min, max).then_some(())
        };
        tree.visit((), state, enter, |state, (), _, aabb| {
            let (min, max) = moved(aabb, offset);
            visit(state, min, max);
        });
    }

    /// The same of those that a view may see between two view depths, about the nearest first, with their least and
    /// greatest view depth and their numbers.
    pub(super) fn each_standing_seen<S>(
        &self,
        (view, near, far): (&View, f64, f64),
        state: &mut S,
        is_new: impl Fn(&S, (f64, f64), DVec3, DVec3) -> bool,
        mut visit: impl FnMut(&mut S, (f64, f64), u32, (DVec3, DVec3)),
    ) {
        let Some(tree) = self.standing else { return };
        let offset = tree.origin() - self.origin;
        let depths = |aabb: &Aabb| {
            let (min, max) = moved(aabb, offset);
            view.depths(min, max).filter(|(first, last)| *first <= far && *last >= near)
        };
        let enter = |state: &S, depths, aabb: &Aabb| {
            let (min, max) = moved(aabb, offset);
            is_new(state, depths, min, max)
        };
        tree.visit_nearest(state, depths, enter, |state, depths, number, aabb| {
            visit(state, depths, number, moved(aabb, offset));
        });
    }
}
