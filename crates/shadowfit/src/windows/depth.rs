//! The region that windows must hold: the extent of the receivers in view, and the depths of all casters and
//! receivers over a window.

use glam::{DVec2, DVec3};

use crate::base::checks::{ROUNDING, THINNEST};
use crate::base::{Boxes, FitError, moved};
use crate::content::{Bounds, Content, Found, Query, Visit, VisitCorners};
use crate::demand::grid::Plane;
use crate::fits::{Depth, FitRule};
use crate::light::{BoundSource, Column, LightAxes};
use crate::view::Range;

/// Boxes as seen from the light. Boxes of the lists have three elements each: least x and y, greatest x and
/// y, and range of z.
pub(super) struct Shadows<'a, 'b> {
    content: &'a Content<'b>,
    axes: LightAxes,
    receivers: &'a [DVec2],
    casters: &'a [DVec2],
    /// Least and greatest corner of the content in view, along the light's axes.
    min: DVec3,
    max: DVec3,
    pub(super) is_empty: bool,
}

/// Elements of storage per box.
const PER_BOX: usize = 3;

impl<'a, 'b> Shadows<'a, 'b> {
    pub(super) fn new(
        content: &'a Content<'b>,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        let count = |boxes: &Option<Boxes>| boxes.map_or(0, |boxes| boxes.boxes.len() * PER_BOX);
        let lists = content.lists();
        let [r, c] = [count(&lists[0]), count(&lists[1])];
        if points.len() < r + c {
            return Err(FitError::ScratchTooSmall { given: points.len(), required: r + c });
        }
        let (for_receivers, rest) = points.split_at_mut(r);
        let for_casters = &mut rest[..c];
        for (boxes, out) in lists.iter().zip([&mut *for_receivers, &mut *for_casters]) {
            if let Some(boxes) = boxes {
                project(boxes, content.origin, &axes, out);
            }
        }
        let mut shadows = Self {
            content,
            axes,
            receivers: for_receivers,
            casters: for_casters,
            min: DVec3::MAX,
            max: DVec3::MIN,
            is_empty: false,
        };
        shadows.find_bounds(range);
        Ok(shadows)
    }

    /// Finds the bounds of the content in view.
    fn find_bounds(&mut self, range: Range) {
        let content = self.content;
        if content.knows_receivers() {
            let projected = self.receivers.as_chunks().0;
            let mut seen = SeenBounds { axes: &self.axes, projected, min: self.min, max: self.max };
            content.visit_corners(range, &mut seen);
            (self.min, self.max) = (seen.min, seen.max);
        }
        self.is_empty = content.knows_receivers() && self.min.cmpgt(self.max).any();
        if !content.knows_receivers() || self.is_empty {
            for p in content.corners(range) {
                let p = self.axes.project(p);
                (self.min, self.max) = (self.min.min(p), self.max.max(p));
            }
        }
    }

    /// Returns the bounds of the last window's content in the plane, with room for rounding.
    pub(super) fn bounds(&self, plane: &Plane) -> (DVec2, DVec2) {
        let (min, max) = (plane.of(self.min), plane.of(self.max));
        let far = |min: f64, max: f64| min.abs().max(max.abs());
        let farthest = far(min.x, max.x) + far(min.y, max.y) + far(self.min.z, self.max.z);
        let pad = ((max - min).max_element() * WIDENING + farthest) * ROUNDING;
        (min - pad, max + pad)
    }

    /// Computes the depths of the parts of all boxes over a rectangle.
    pub(super) fn depth(&self, min: DVec2, max: DVec2, rule: &FitRule) -> WindowDepth {
        let [receivers, casters] = self.content.lists();
        let mut over = Over::new(&self.axes, min, max);
        if !self.is_empty {
            over.add_list(receivers, self.receivers, self.content.origin);
            self.content.visit(Query::StaticBoxes, &mut over);
        }
        let (mut far_by, mut near_by) = (BoundSource::Receivers, BoundSource::Receivers);
        if over.low > over.high {
            (over.low, over.high) = (self.min.z, self.max.z);
            (far_by, near_by) = (BoundSource::View, BoundSource::View);
        }
        let (low, covered, vertices) = (over.low, over.high, over.farthest_squared);
        let mut high = covered;
        match rule.depth {
            Depth::AtCovered | Depth::Doubled => {}
            Depth::Extended(metres) => (high, near_by) = (high + metres, BoundSource::CasterExtension),
            Depth::AtCasterBounds | Depth::AtCasters => {
                // Casters only move the near plane.
                (over.low, over.farthest_squared) = (f64::MIN, f64::MAX);
                over.add_list(casters, self.casters, self.content.origin);
                if self.is_empty {
                    over.add_list(receivers.filter(|_| casters.is_none()), self.receivers, self.content.origin);
                    self.content.visit(Query::StaticBoxes, &mut over);
                }
                high = over.high;
                near_by = if high > covered { BoundSource::Casters } else { near_by };
            }
        }
        let farthest = min.abs().max(max.abs()).max_element() + low.abs().max(high.abs());
        let pad = ROUNDING * (farthest + high - low) + rule.margin + farthest * THINNEST;
        WindowDepth { low: low - pad, high: high + pad, far_by, near_by, vertices: libm::sqrt(vertices) }
    }
}

/// Least and greatest corner of the receivers in view, along the light's axes.
struct SeenBounds<'a> {
    axes: &'a LightAxes,
    /// Boxes of the list, projected by [`project`].
    projected: &'a [[DVec2; PER_BOX]],
    min: DVec3,
    max: DVec3,
}

impl SeenBounds<'_> {
    /// Returns whether a projected box reaches beyond the bounds.
    fn may_widen(&self, b: &[DVec2; PER_BOX]) -> bool {
        let (min, max) = (b[0].extend(b[2].x), b[1].extend(b[2].y));
        !(min.cmpge(self.min).all() && max.cmple(self.max).all())
    }
}

impl VisitCorners for SeenBounds<'_> {
    fn wants(&self, bounds: &Bounds) -> bool {
        self.may_widen(&projected(bounds.min, bounds.max, self.axes))
    }

    fn wants_box(&self, found: &Found) -> bool {
        // The tree has already tested its boxes with `wants`.
        self.projected.get(found.index).is_none_or(|b| self.may_widen(b))
    }

    fn take(&mut self, corner: DVec3) {
        let p = self.axes.project(corner);
        (self.min, self.max) = (self.min.min(p), self.max.max(p));
    }
}

/// Depths of the parts of boxes over a rectangle, in metres along the light's z.
struct Over<'a> {
    axes: &'a LightAxes,
    column: Column,
    low: f64,
    high: f64,
    /// Square of the greatest distance of a corner of these boxes from the origin, along the light's axes.
    farthest_squared: f64,
}

impl<'a> Over<'a> {
    /// Creates an empty range of depths. Only corners farther away than the rectangle's own corners count.
    fn new(axes: &'a LightAxes, min: DVec2, max: DVec2) -> Self {
        let corner = min.abs().max(max.abs());
        let column = Column::new(axes, min, max);
        Self { axes, column, low: f64::MAX, high: f64::MIN, farthest_squared: corner.dot(corner) }
    }

    /// Adds the boxes of a list, projected by [`project`].
    fn add_list(&mut self, list: Option<Boxes>, projected: &[DVec2], origin: DVec3) {
        let Some(list) = list else { return };
        for (aabb, b) in list.boxes.iter().zip(projected.as_chunks().0) {
            if is_over(b, self.column.min, self.column.max) && self.is_new(b[2], b) {
                let (min, max) = moved(aabb, list.origin - origin);
                self.add(min, max, b);
            }
        }
    }

    /// Returns whether a box with depths over the rectangle extends the depths so far, or has a corner
    /// farther away.
    #[inline]
    fn is_new(&self, z: DVec2, b: &[DVec2; PER_BOX]) -> bool {
        z.x <= z.y && (z.x < self.low || z.y > self.high || farthest_squared(b) > self.farthest_squared)
    }

    fn add(&mut self, min: DVec3, max: DVec3, b: &[DVec2; PER_BOX]) {
        let z = self.part(min, max, b);
        if z.x <= z.y {
            (self.low, self.high) = (self.low.min(z.x), self.high.max(z.y));
            self.farthest_squared = self.farthest_squared.max(farthest_squared(b));
        }
    }

    /// Returns the least and greatest depth of the part of a box over the rectangle. Without such a part, the
    /// least depth is above the greatest. A large ground under a low sun is many times deeper than any of its
    /// parts.
    fn part(&self, min: DVec3, max: DVec3, b: &[DVec2; PER_BOX]) -> DVec2 {
        let (low, high) = self.column.depths(min, max);
        let rounding = min.abs().max(max.abs()).element_sum() * ROUNDING;
        DVec2::new(b[2].x.max(low - rounding), b[2].y.min(high + rounding))
    }
}

impl Visit for Over<'_> {
    fn wants(&self, bounds: &Bounds) -> bool {
        let b = projected(bounds.min, bounds.max, self.axes);
        let is_over = is_over(&b, self.column.min, self.column.max);
        is_over && self.is_new(b[2], &b) && self.is_new(self.part(bounds.min, bounds.max, &b), &b)
    }

    fn take(&mut self, Found { bounds, .. }: &Found) {
        self.add(bounds.min, bounds.max, &projected(bounds.min, bounds.max, self.axes));
    }
}

/// Returns the square of the greatest distance of a box's corner from the origin, along the light's axes.
#[inline]
fn farthest_squared(b: &[DVec2; PER_BOX]) -> f64 {
    let (across, along) = (b[0].abs().max(b[1].abs()), b[2].x.abs().max(b[2].y.abs()));
    across.dot(across) + along * along
}

/// A window's depths along the light's axes, in metres, and their sources.
pub(super) struct WindowDepth {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) far_by: BoundSource,
    pub(super) near_by: BoundSource,
    /// Greatest distance of a corner of the receivers' boxes from the origin, in metres.
    pub(super) vertices: f64,
}

/// Greatest ratio of the last window's size to its content's size. It covers borders of a quarter of the
/// texels on either side, and the oversize of the grid's steps and of held texels.
const WIDENING: f64 = 4.0;

/// Returns whether a box lies over a rectangle.
fn is_over(b: &[DVec2; PER_BOX], min: DVec2, max: DVec2) -> bool {
    b[0].x <= max.x && b[0].y <= max.y && b[1].x >= min.x && b[1].y >= min.y
}

/// Projects boxes to the light's axes. An empty box lies over no rectangle.
fn project(boxes: &Boxes, origin: DVec3, axes: &LightAxes, out: &mut [DVec2]) {
    let offset = boxes.origin - origin;
    for (aabb, out) in boxes.boxes.iter().zip(out.chunks_exact_mut(PER_BOX)) {
        if aabb.is_empty() {
            out.copy_from_slice(&[DVec2::MAX, DVec2::MIN, DVec2::ZERO]);
            continue;
        }
        let (min, max) = moved(aabb, offset);
        out.copy_from_slice(&projected(min, max, axes));
    }
}

/// Projects a box to the light's axes.
#[inline]
fn projected(min: DVec3, max: DVec3, axes: &LightAxes) -> [DVec2; PER_BOX] {
    let (x, y, z) = (axes.x.as_dvec3().abs(), axes.y.as_dvec3().abs(), axes.z.as_dvec3().abs());
    let (centre, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let rounding = (centre.abs().element_sum() + half.element_sum()) * 2.0 * ROUNDING;
    let middle = axes.project(centre);
    let reach = DVec3::new(x.dot(half), y.dot(half), z.dot(half)) + rounding;
    let (low, high) = (middle - reach, middle + reach);
    [low.truncate(), high.truncate(), DVec2::new(low.z, high.z)]
}
