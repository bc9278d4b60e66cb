//! The tree of static boxes. In builds without it, an empty type takes its place.

#[cfg(not(feature = "cache"))]
use glam::DVec3;

#[cfg(not(feature = "cache"))]
use crate::base::Aabb;

#[cfg(feature = "cache")]
pub(crate) use super::tree::StaticBoxes;

/// A type without values, for builds without the tree.
#[cfg(not(feature = "cache"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StaticBoxes {}

#[cfg(not(feature = "cache"))]
impl StaticBoxes {
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
