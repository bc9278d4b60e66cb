//! The boxes in view: the nearest few along each ray of a coarse grid.
//!
//! Fits estimate the visible surfaces from these boxes if no earlier frame gives the visible demand. A box is
//! not its surface. If the estimate is wrong, maps are less sharp than possible, but still hold all
//! receivers. Windows and splits weigh the same rays differently.

use glam::DVec3;

use crate::content::{Bounds, Found, ViewPart, Visit};
use crate::view::{Picture, RayCount, covered, crossing};

/// Boxes kept along each ray. A box is mostly air, so a box behind the first one may be visible.
const LAYERS: usize = 4;

/// Weight of the box that a ray begins in. A surface may lie anywhere up to the end of this box.
pub(crate) const AROUND: f32 = 1.0 / 3.0;

/// Greatest number of rays through a picture.
const MOST_RAYS: usize = RayCount::FINE.columns * RayCount::FINE.rows;

/// Rounding of shares of a ray to f32, and of view depths to such shares.
const SHARE_ROUNDING: f64 = 1e-6;

/// A box that a ray passes through.
#[derive(Clone, Copy)]
pub(crate) struct Layer {
    /// Shares of the ray at which it enters and leaves the box.
    pub(crate) enter: f32,
    pub(crate) leave: f32,
    /// [Number](Found::index) of the box.
    pub(crate) index: u32,
}

/// A ray through a picture, from its near to its far rectangle. A share of the ray is the same share of the
/// view depth.
#[derive(Clone, Copy)]
pub(crate) struct Ray {
    /// Start, in metres relative to the fit's origin, and vector from there to the end.
    pub(crate) start: DVec3,
    pub(crate) along: DVec3,
    /// The nearest boxes that the ray enters.
    layers: [Option<Layer>; LAYERS],
    /// The box that the ray begins in and leaves last.
    pub(crate) around: Option<Layer>,
}

impl Ray {
    /// Returns the nearest boxes that the ray enters, in order.
    pub(crate) fn layers(&self) -> impl Iterator<Item = &Layer> {
        self.layers.iter().flatten()
    }

    /// Returns whether the ray may enter a box before the kept ones, at this share, or begin in it.
    fn may_meet(&self, share: f64) -> bool {
        share <= 0.0 || self.layers[LAYERS - 1].is_none_or(|last| share < f64::from(last.enter))
    }

    /// Adds a box that the ray begins in.
    fn add_around(&mut self, layer: Layer) {
        if self.around.is_none_or(|around| around.leave < layer.leave) {
            self.around = Some(layer);
        }
    }

    /// Adds a box that the ray enters.
    fn add(&mut self, layer: Layer) {
        let mut layer = Some(layer);
        for kept in &mut self.layers {
            if layer.is_some_and(|layer| kept.is_none_or(|kept| layer.enter < kept.enter)) {
                core::mem::swap(&mut layer, kept);
            }
        }
    }
}

/// Rays through the picture of a part of a view, row by row.
pub(crate) struct Rays<'a> {
    part: &'a ViewPart,
    count: RayCount,
    picture: Picture,
    all: [Ray; MOST_RAYS],
}

impl<'a> Rays<'a> {
    /// Creates rays that have met no box.
    #[expect(clippy::large_stack_arrays, reason = "72 KiB, only while the rays are traced")]
    pub(crate) fn new(part: &'a ViewPart, count: RayCount) -> Self {
        let (c, zero) = (part.slice().corners, DVec3::ZERO);
        let mut all = [Ray { start: zero, along: zero, layers: [None; LAYERS], around: None }; MOST_RAYS];
        for (i, ray) in all.iter_mut().enumerate().take(count.columns * count.rows) {
            let (column, row) = (i % count.columns, i / count.columns);
            let (x, y) = ((column as f64 + 0.5) / count.columns as f64, (row as f64 + 0.5) / count.rows as f64);
            let at =
                |i: usize| (c[i] * (1.0 - x) + c[i + 1] * x) * (1.0 - y) + (c[i + 3] * (1.0 - x) + c[i + 2] * x) * y;
            ray.start = at(0);
            ray.along = at(4) - ray.start;
        }
        Self { part, count, picture: part.view.picture(), all }
    }

    /// Returns the rays.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Ray> {
        self.all[..self.count.columns * self.count.rows].iter()
    }

    /// Returns the least share of a ray at which it may enter a box.
    fn least_share(&self, bounds: &Bounds) -> f64 {
        let ViewPart { near, far, .. } = *self.part;
        (bounds.depths.near - near) / (far - near) * (1.0 - SHARE_ROUNDING) - SHARE_ROUNDING
    }
}

impl Visit for Rays<'_> {
    /// Returns whether a box may be among the nearest ones along a ray.
    #[inline(always)]
    fn wants(&self, bounds: &Bounds) -> bool {
        let covered = covered(&self.part.view, &self.picture, self.count, bounds.min, bounds.max);
        let Some((columns, rows)) = covered else { return false };
        let share = self.least_share(bounds);
        let mut rays = rows.flat_map(|row| &self.all[row * self.count.columns..][columns.clone()]);
        rays.any(|ray| ray.may_meet(share))
    }

    /// Intersects all rays with a box.
    #[inline(always)]
    fn take(&mut self, Found { bounds, index }: &Found) {
        let covered = covered(&self.part.view, &self.picture, self.count, bounds.min, bounds.max);
        let Some((columns, rows)) = covered else { return };
        let share = self.least_share(bounds);
        for row in rows {
            for ray in &mut self.all[row * self.count.columns..][columns.clone()] {
                if ray.may_meet(share)
                    && let Some((enter, leave)) = crossing(ray.start, ray.along, bounds.min, bounds.max)
                {
                    let layer = Layer { enter: enter as f32, leave: leave as f32, index: *index as u32 };
                    if enter <= 0.0 { ray.add_around(layer) } else { ray.add(layer) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_keeps_the_nearest_boxes_in_order_and_the_one_that_it_leaves_last() {
        let mut ray = Ray { start: DVec3::ZERO, along: DVec3::X, layers: [None; LAYERS], around: None };
        let layer = |enter: f32, leave: f32| Layer { enter, leave, index: 0 };
        assert!(ray.may_meet(0.99));
        for enter in [0.5, 0.2, 0.9, 0.4, 0.3] {
            ray.add(layer(enter, 1.0));
        }
        assert!(ray.layers().map(|layer| layer.enter).eq([0.2, 0.3, 0.4, 0.5]));
        assert!(ray.may_meet(0.49) && !ray.may_meet(0.5) && ray.may_meet(-0.1));
        for leave in [0.1, 0.7, 0.6] {
            ray.add_around(layer(0.0, leave));
        }
        assert_eq!(ray.around.map(|around| around.leave), Some(0.7));
    }
}
