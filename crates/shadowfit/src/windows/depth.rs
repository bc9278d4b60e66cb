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

/// Boxes as the light sees them, three elements each: least and greatest x and y, and z.
pub(super) struct Shadows<'a> {
    receivers: Option<&'a [DVec2]>,
    casters: Option<&'a [DVec2]>,
    /// Least and greatest corner of what is in view, along the light's axes.
    min: DVec3,
    max: DVec3,
    pub(super) is_empty: bool,
}

/// Elements of storage for a box.
const PER_BOX: usize = 3;

impl<'a> Shadows<'a> {
    pub(super) fn new(
        content: &Content,
        axes: LightAxes,
        range: Range,
        points: &'a mut [DVec2],
    ) -> Result<Self, FitError> {
        let count = |boxes: &Option<Boxes>| boxes.map_or(0, |boxes| boxes.boxes.len() * PER_BOX);
        let (r, c) = (count(&content.receivers), count(&content.casters));
        if points.len() < r + c {
            return Err(FitError::ScratchTooSmall { given: points.len(), required: r + c });
        }
        let (for_receivers, rest) = points.split_at_mut(r);
        let for_casters = &mut rest[..c];
        if let Some(boxes) = &content.receivers {
            project(boxes, content.origin, &axes, for_receivers);
        }
        if let Some(boxes) = &content.casters {
            project(boxes, content.origin, &axes, for_casters);
        }
        let mut shadows = Self {
            receivers: content.receivers.map(|_| &*for_receivers),
            casters: content.casters.map(|_| &*for_casters),
            min: DVec3::MAX,
            max: DVec3::MIN,
            is_empty: false,
        };
        shadows.find_bounds(content, &axes, range);
        Ok(shadows)
    }

    /// Finds what is in view.
    fn find_bounds(&mut self, content: &Content, axes: &LightAxes, range: Range) {
        let receivers = self.receivers;
        if let Some(boxes) = receivers {
            let (mut min, mut max) = (DVec3::MAX, DVec3::MIN);
            let _ = content.receivers_in(range, |i, slice, low, high| {
                let b = &boxes[i * PER_BOX..][..PER_BOX];
                let (b_min, b_max) = (b[0].extend(b[2].x), b[1].extend(b[2].y));
                if b_min.cmpge(min).all() && b_max.cmple(max).all() {
                    return Ok::<(), core::convert::Infallible>(());
                }
                slice.clip(low, high, &mut |p| {
                    let p = axes.project(p);
                    (min, max) = (min.min(p), max.max(p));
                    Ok(())
                })
            });
            (self.min, self.max) = (min, max);
        }
        self.is_empty = receivers.is_some() && self.min.cmpgt(self.max).any();
        if receivers.is_none() || self.is_empty {
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
        if let Some(boxes) = self.receivers.filter(|_| !self.is_empty) {
            over(boxes, min, max, |z| (low, high) = (low.min(z.x), high.max(z.y)));
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
                over(self.casters.unwrap_or_default(), min, max, |z| high = high.max(z.y));
                near_by = if high > covered { Constraint::Casters } else { near_by };
            }
        }
        let farthest = min.abs().max(max.abs()).max_element() + low.abs().max(high.abs());
        let pad = ROUNDING * (farthest + high - low) + rule.margin + farthest * THINNEST;
        WindowDepth { low: low - pad, high: high + pad, far_by, near_by }
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
    for b in boxes.chunks_exact(PER_BOX) {
        if b[0].x <= max.x && b[0].y <= max.y && b[1].x >= min.x && b[1].y >= min.y {
            visit(b[2]);
        }
    }
}

/// Boxes along the light's axes; an empty one lies over nothing.
fn project(boxes: &Boxes, origin: DVec3, axes: &LightAxes, out: &mut [DVec2]) {
    let offset = boxes.origin - origin;
    let (x, y, z) = (axes.x.as_dvec3().abs(), axes.y.as_dvec3().abs(), axes.z.as_dvec3().abs());
    for (aabb, out) in boxes.boxes.iter().zip(out.chunks_exact_mut(PER_BOX)) {
        if aabb.is_empty() {
            out.copy_from_slice(&[DVec2::MAX, DVec2::MIN, DVec2::ZERO]);
            continue;
        }
        let (min, max) = moved(aabb, offset);
        let (centre, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let rounding = (centre.abs().element_sum() + half.element_sum()) * 2.0 * ROUNDING;
        let middle = axes.project(centre);
        let reach = DVec3::new(x.dot(half), y.dot(half), z.dot(half)) + rounding;
        let (low, high) = (middle - reach, middle + reach);
        out.copy_from_slice(&[low.truncate(), high.truncate(), DVec2::new(low.z, high.z)]);
    }
}
