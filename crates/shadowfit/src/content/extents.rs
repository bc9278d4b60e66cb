//! Extents of the boxes of a frame: in view depth, from the eyes and across the light.

use glam::{DVec2, DVec3};

use super::Content;
use super::boxes::Bounds;
use super::views::ViewPart;
use super::visit::{Found, Query, Visit};
use crate::light::LightAxes;
use crate::view::{Depths, Range, Slice};

impl Content<'_> {
    /// Returns the least and greatest view depth of the lit receivers in view, if there are any.
    pub(crate) fn depth_range(&self) -> Option<Depths> {
        let (mut near, mut far) = (None, None);
        for part in self.whole_views() {
            let mut seen = SeenDepths { part: &part, whole: part.slice(), near, far };
            self.visit(Query::Lit(&part), &mut seen);
            (near, far) = (seen.near, seen.far);
        }
        near.zip(far).map(|(near, far)| Depths { near, far }).filter(|depths| depths.near < depths.far)
    }

    /// Returns the greatest distance of any receiver from an eye, in view or not. View depths do not exceed
    /// it in any camera direction. `None` if no receiver is known.
    pub(crate) fn farthest(&self) -> Option<f64> {
        let mut squared = None;
        for view in self.views {
            let range = Range { near: f32::NEG_INFINITY, far: f32::INFINITY };
            let mut farthest = Farthest::new(self.origin - view.origin, range, squared);
            self.visit(Query::Receivers, &mut farthest);
            squared = farthest.squared;
        }
        squared.map(libm::sqrt)
    }

    /// Returns the greatest distance from the origin to a corner of the lit receivers in a range of view
    /// depths, in metres. Returns at least `least`.
    pub(crate) fn farthest_seen(&self, range: Range, least: f64) -> f64 {
        let mut farthest = Farthest::new(DVec3::ZERO, range, Some(least * least));
        if self.knows_receivers() {
            self.whole_views().for_each(|part| self.visit(Query::Lit(&part), &mut farthest));
        }
        farthest.squared.map_or(least, libm::sqrt)
    }

    /// Returns the bounds of all receivers across the light, in view or not, along the light's axes. `None` if no
    /// receiver is known.
    pub(crate) fn receivers_across(&self, axes: &LightAxes) -> Option<(DVec2, DVec2)> {
        *self.across.get_or_init(|| {
            let mut across = Across { axes, bounds: None };
            self.visit(Query::Receivers, &mut across);
            across.bounds
        })
    }

    /// Returns a box around all casters, in view or not, if there are any.
    pub(crate) fn caster_bounds(&self) -> Option<(DVec3, DVec3)> {
        let mut union = Union(None);
        self.visit(Query::Casters, &mut union);
        union.0
    }
}

/// View depths of the parts of boxes that lie in a view.
struct SeenDepths<'p> {
    part: &'p ViewPart,
    whole: Slice,
    /// Least and greatest depth so far.
    near: Option<f64>,
    far: Option<f64>,
}

impl Visit for SeenDepths<'_> {
    #[inline(always)]
    fn wants(&self, bounds: &Bounds) -> bool {
        self.near.is_none_or(|near| bounds.depths.near < near)
            || self.far.is_none_or(|far| bounds.depths.far.min(self.part.far) > far)
    }

    #[inline(always)]
    fn take(&mut self, Found { bounds, .. }: &Found) {
        let (view, nearest) = (&self.part.view, &mut self.near);
        let far = bounds.depths.far.min(view.far);
        self.far = Some(self.far.map_or(far, |known| known.max(far)));
        // The part of a box that is in view may begin much farther away than the box.
        if nearest.is_none_or(|near| bounds.depths.near < near) {
            self.whole.clip(bounds.min, bounds.max, &mut |p| {
                let near = view.depth.distance(p).max(view.near);
                *nearest = Some(nearest.map_or(near, |known| known.min(near)));
            });
        }
    }
}

/// The farthest corner of boxes in a range of view depths.
struct Farthest {
    /// Offset from the point that distances are measured from to the fit's origin.
    offset: DVec3,
    depths: Depths,
    /// Squared distance of the farthest corner so far.
    squared: Option<f64>,
}

impl Farthest {
    fn new(offset: DVec3, range: Range, squared: Option<f64>) -> Self {
        Self { offset, depths: Depths { near: f64::from(range.near), far: f64::from(range.far) }, squared }
    }

    /// Returns whether bounds reach into the range.
    fn is_in(&self, bounds: &Bounds) -> bool {
        bounds.depths.near <= self.depths.far && bounds.depths.far >= self.depths.near
    }

    /// Returns the squared distance of the farthest corner of bounds.
    fn squared_of(&self, bounds: &Bounds) -> f64 {
        let corner = (bounds.min + self.offset).abs().max((bounds.max + self.offset).abs());
        corner.dot(corner)
    }
}

/// Enlargement of the distance of bounds, so that rounding does not skip a box in them.
const ROUNDED_UP: f64 = 1.0 + 1e-9;

impl Visit for Farthest {
    #[inline(always)]
    fn wants(&self, bounds: &Bounds) -> bool {
        let may_be_farther = |squared| self.squared_of(bounds) * ROUNDED_UP >= squared;
        self.is_in(bounds) && self.squared.is_none_or(may_be_farther)
    }

    #[inline(always)]
    fn take(&mut self, Found { bounds, .. }: &Found) {
        if self.is_in(bounds) {
            self.squared = Some(self.squared_of(bounds).max(self.squared.unwrap_or(0.0)));
        }
    }
}

/// Bounds of boxes across the light.
struct Across<'a> {
    axes: &'a LightAxes,
    bounds: Option<(DVec2, DVec2)>,
}

impl Across<'_> {
    #[inline(always)]
    fn of(&self, bounds: &Bounds) -> (DVec2, DVec2) {
        let (centre, half) = self.axes.project_box(bounds.min, bounds.max);
        ((centre - half).truncate(), (centre + half).truncate())
    }
}

impl Visit for Across<'_> {
    #[inline(always)]
    fn wants(&self, bounds: &Bounds) -> bool {
        let (low, high) = self.of(bounds);
        self.bounds.is_none_or(|(min, max)| !(low.cmpge(min).all() && high.cmple(max).all()))
    }

    #[inline(always)]
    fn take(&mut self, Found { bounds, .. }: &Found) {
        let (low, high) = self.of(bounds);
        self.bounds = Some(self.bounds.map_or((low, high), |(min, max)| (min.min(low), max.max(high))));
    }
}

/// A box around all boxes.
struct Union(Option<(DVec3, DVec3)>);

impl Visit for Union {
    #[inline(always)]
    fn wants(&self, &Bounds { min, max, .. }: &Bounds) -> bool {
        self.0.is_none_or(|(low, high)| !(min.cmpge(low).all() && max.cmple(high).all()))
    }

    #[inline(always)]
    fn take(&mut self, Found { bounds: Bounds { min, max, .. }, .. }: &Found) {
        self.0 = Some(self.0.map_or((*min, *max), |(low, high)| (low.min(*min), high.max(*max))));
    }
}
