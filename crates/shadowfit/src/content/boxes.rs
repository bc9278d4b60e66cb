//! The boxes of a frame: their checks, their view depths, and a scattered order.

use glam::{DVec2, DVec3, Vec3};

use super::Scene;
use super::groups::Groups;
use super::normal_cone::NormalCone;
use crate::base::{Boxes, FitError, checks, moved};
use crate::view::{Depths, View, ViewFrustum};

/// A box, or the bounds of several, in metres relative to the fit's origin.
#[derive(Clone, Copy)]
pub(crate) struct Bounds {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
    /// Least and greatest view depth. They are infinite for runs of a list and for queries without a view.
    pub(crate) depths: Depths,
}

impl Bounds {
    /// Returns bounds without known view depths.
    #[inline]
    pub(super) fn anywhere(min: DVec3, max: DVec3) -> Self {
        Self { min, max, depths: Depths { near: f64::NEG_INFINITY, far: f64::INFINITY } }
    }
}

/// Depths of a box that is out of view.
const OUT_OF_VIEW: DVec2 = DVec2::new(f64::MAX, f64::MIN);

/// Computes the least and greatest depth of each listed receiver, view by view.
pub(super) fn compute_depths(input: &Scene, groups: &Groups, depths: &mut [DVec2]) {
    let Some(receivers) = &input.receivers else { return };
    depths.fill(OUT_OF_VIEW);
    for (view, depths) in input.views.iter().zip(depths.chunks_mut(receivers.boxes.len().max(1))) {
        compute_depths_in(view, input, receivers, groups, depths);
    }
}

/// Computes the depths in one view. Boxes that are out of view or face away from the light keep their depths.
fn compute_depths_in(view: &ViewFrustum, input: &Scene, receivers: &Boxes, groups: &Groups, depths: &mut [DVec2]) {
    let origin = input.views[0].origin;
    let (eye, offset) = (view.origin - receivers.origin, receivers.origin - origin);
    let view = View::new(view, origin);
    let to_light = -input.direction.as_dvec3();
    for (run, min, max) in groups.runs() {
        if view.depths(min, max).is_none() {
            continue;
        }
        for i in run {
            let aabb = &receivers.boxes[i];
            if aabb.is_empty() {
                continue;
            }
            let (min, max) = moved(aabb, offset);
            let Some(Depths { near, far }) = view.depths(min, max) else { continue };
            let faces_away = |cone: &NormalCone| cone.faces_away_from(aabb, eye, to_light);
            if !input.receiver_cones.get(i).is_some_and(faces_away) {
                depths[i] = DVec2::new(near, far);
            }
        }
    }
}

/// Returns all indices below a count, with large steps between them. Neighbouring boxes have similar extents.
/// A few boxes that lie apart nearly determine the extent of all boxes, and the others rarely widen it.
pub(super) fn scattered(count: usize) -> impl Iterator<Item = usize> {
    // The golden ratio leaves no large gaps. A step that divides the count would return too early.
    let step = (count * 5 / 8..count).find(|step| is_coprime(*step, count)).unwrap_or(1);
    let mut index = 0;
    (0..count).map(move |_| {
        let next = index + step;
        core::mem::replace(&mut index, if next >= count { next - count } else { next })
    })
}

fn is_coprime(mut a: usize, mut b: usize) -> bool {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// Returns whether receivers and casters are the same boxes in memory.
pub(super) fn is_same(receivers: Option<Boxes>, casters: Option<Boxes>) -> bool {
    receivers.zip(casters).is_some_and(|(a, b)| a.origin == b.origin && core::ptr::eq(a.boxes, b.boxes))
}

/// Returns an error if a coordinate is not a number or is too large. Empty boxes are allowed.
pub(super) fn check(boxes: &Boxes) -> Result<(), FitError> {
    checks::point("the boxes' origin", boxes.origin)?;
    let limit = checks::MAX_LENGTH as f32;
    let is_good = |v: Vec3| (v.x.abs() <= limit) & (v.y.abs() <= limit) & (v.z.abs() <= limit);
    if boxes.boxes.iter().fold(true, |all, aabb| all & is_good(aabb.min) & is_good(aabb.max)) {
        return Ok(());
    }
    for aabb in boxes.boxes {
        let is_nan = aabb.min.is_nan() || aabb.max.is_nan();
        if is_nan || !aabb.is_empty() {
            checks::point("a corner of a box", aabb.min.as_dvec3())?;
            checks::point("a corner of a box", aabb.max.as_dvec3())?;
        }
    }
    Ok(())
}
