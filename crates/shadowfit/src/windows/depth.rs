//! What windows must hold: how far the receivers in view reach, and how deep all that casts and
//! receives over a window lies.

use glam::{DVec2, DVec3};

use crate::base::checks::{ROUNDING, THINNEST};
use crate::base::{Boxes, FitError, moved};
use crate::content::Content;
use crate::demand::grid::Plane;
use crate::fits::{Constraint, Depth, FitRule};
use crate::light::LightAxes;
use crate::view::Range;

/// Boxes as the light sees them, those of the lists three elements each: least and greatest x and y, and z.
pub(super) struct Shadows<'a, 'b> {
    content: &'a Content<'b>,
    axes: LightAxes,
    receivers: &'a [DVec2],
    casters: &'a [DVec2],
    /// Least and greatest corner of what is in view, along the light's axes.
    min: DVec3,
    max: DVec3,
    pub(super) is_empty: bool,
}

/// Elements of storage for a box.
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
            casters: if lists[1].is_some() { for_casters } else { for_receivers },
            min: DVec3::MAX,
            max: DVec3::MIN,
            is_empty: false,
        };
        shadows.find_bounds(range);
        Ok(shadows)
    }

    /// Finds what is in view.
    fn find_bounds(&mut self, range: Range) {
        let (content, axes) = (self.content, &self.axes);
        if content.knows_receivers() {
            let mut bounds = (DVec3::MAX, DVec3::MIN);
            let widens = |(min, max): &(DVec3, DVec3), b: &[DVec2; PER_BOX]| {
                let (b_min, b_max) = (b[0].extend(b[2].x), b[1].extend(b[2].y));
                !(b_min.cmpge(*min).all() && b_max.cmple(*max).all())
            };
            let is_new = |bounds: &(DVec3, DVec3), low, high| widens(bounds, &projected(low, high, axes));
            let receivers = self.receivers.as_chunks().0;
            let Ok(()) = content.receivers_in(range, &mut bounds, is_new, |bounds, i, slice, (low, high)| {
                if i.is_some_and(|i| !widens(bounds, &receivers[i])) {
                    return Ok::<(), core::convert::Infallible>(());
                }
                slice.clip(low, high, &mut |p| {
                    let p = axes.project(p);
                    *bounds = (bounds.0.min(p), bounds.1.max(p));
                    Ok(())
                })
            });
            (self.min, self.max) = bounds;
        }
        self.is_empty = content.knows_receivers() && self.min.cmpgt(self.max).any();
        if !content.knows_receivers() || self.is_empty {
            for p in content.corners(range) {
                let p = axes.project(p);
                (self.min, self.max) = (self.min.min(p), self.max.max(p));
            }
        }
    }

    /// What the last window must hold, with room for rounding, in the plane.
    pub(super) fn bounds(&self, plane: &Plane) -> (DVec2, DVec2) {
        let (min, max) = (plane.of(self.min), plane.of(self.max));
        let far = |min: f64, max: f64| min.abs().max(max.abs());
        let farthest = far(min.x, max.x) + far(min.y, max.y) + far(self.min.z, self.max.z);
        let pad = ((max - min).max_element() * WIDENING + farthest) * ROUNDING;
        (min - pad, max + pad)
    }

    /// The depths of everything over a rectangle.
    pub(super) fn depth(&self, (min, max): (DVec2, DVec2), rule: &FitRule) -> WindowDepth {
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        if !self.is_empty {
            over(self.receivers, min, max, |z| (low, high) = (low.min(z.x), high.max(z.y)));
            (low, high) = self.standing((min, max), (low, high));
        }
        let (mut far_by, mut near_by) = (Constraint::Receivers, Constraint::Receivers);
        if low > high {
            (low, high) = (self.min.z, self.max.z);
            (far_by, near_by) = (Constraint::View, Constraint::View);
        }
        let covered = high;
        match rule.depth {
            Depth::AtCovered | Depth::Doubled => {}
            Depth::Extended(metres) => (high, near_by) = (high + metres, Constraint::CasterExtension),
            Depth::AtCasterBounds | Depth::AtCasters => {
                over(self.casters, min, max, |z| high = high.max(z.y));
                high = self.standing((min, max), (f64::MIN, high)).1;
                near_by = if high > covered { Constraint::Casters } else { near_by };
            }
        }
        let farthest = min.abs().max(max.abs()).max_element() + low.abs().max(high.abs());
        let pad = ROUNDING * (farthest + high - low) + rule.margin + farthest * THINNEST;
        WindowDepth { low: low - pad, high: high + pad, far_by, near_by }
    }

    /// A range of depths, widened by those of standing boxes over a rectangle.
    fn standing(&self, (min, max): (DVec2, DVec2), mut depths: (f64, f64)) -> (f64, f64) {
        let is_new = |(low, high): &(f64, f64), b_min, b_max| {
            let b = projected(b_min, b_max, &self.axes);
            is_over(&b, min, max) && (b[2].x < *low || b[2].y > *high)
        };
        self.content.each_standing(&mut depths, is_new, |(low, high), b_min, b_max| {
            let [_, _, z] = projected(b_min, b_max, &self.axes);
            (*low, *high) = (low.min(z.x), high.max(z.y));
        });
        depths
    }
}

/// A window's depths along the light's axes, in metres, and what set them.
pub(super) struct WindowDepth {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) far_by: Constraint,
    pub(super) near_by: Constraint,
}

/// Greatest size of the last window over that of what it must hold: borders of a quarter of its texels on
/// either side, and the texels of the grid's steps and of what is held.
const WIDENING: f64 = 4.0;

/// Passes on the z range of each box that lies over a rectangle.
fn over(boxes: &[DVec2], min: DVec2, max: DVec2, mut visit: impl FnMut(DVec2)) {
    for b in boxes.as_chunks::<PER_BOX>().0 {
        if is_over(b, min, max) {
            visit(b[2]);
        }
    }
}

/// Whether a box lies over a rectangle.
fn is_over(b: &[DVec2; PER_BOX], min: DVec2, max: DVec2) -> bool {
    b[0].x <= max.x && b[0].y <= max.y && b[1].x >= min.x && b[1].y >= min.y
}

/// Boxes along the light's axes; an empty one lies over nothing.
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

/// A box along the light's axes.
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
