//! What is visible, estimated from the boxes alone: the nearest few boxes along each ray of a coarse
//! grid. Where their surfaces are nearly flat, the ray meets the plane through the middle of the box;
//! elsewhere it may meet a surface anywhere in it.
//!
//! A box is not its surface, so this is an estimate; where it is wrong, windows are less sharp than
//! they could be, and nothing worse.

use glam::{DVec3, Vec2};

use super::cells::{Cells, Counted};
use crate::content::Content;
use crate::need::{NeedSpace, PIXELS, Plane, needed_texel};
use crate::normal_cone::NormalCone;
use crate::view::{Slice, View, box_corners};
use crate::{FitInput, checks};

/// Rays across the picture.
const COLUMNS: usize = 32;
/// Rays down the picture.
const ROWS: usize = 18;
/// Boxes kept along each ray. A box is mostly air, so what is behind the first one may be seen.
const LAYERS: usize = 4;

/// A box that a ray goes through.
#[derive(Clone, Copy)]
struct Layer {
    /// Shares of the ray at which it enters and leaves it.
    enter: f32,
    leave: f32,
    index: u32,
}

const NOTHING: Layer = Layer { enter: f32::MAX, leave: f32::MAX, index: u32::MAX };

/// A ray's boxes: the nearest, and the one that it begins in and leaves last.
#[derive(Clone, Copy)]
struct Ray {
    layers: [Layer; LAYERS],
    around: Layer,
}

/// Adds what the views see of the boxes.
pub(super) fn add(cells: &mut Cells, input: &FitInput, content: &Content, plane: &Plane, up: DVec3, distance: f32) {
    for (view, frustum) in content.views().zip(content.views) {
        let direction = -plane.axes.z;
        let Ok(space) = NeedSpace::new(frustum, direction, up.as_vec3(), distance) else { continue };
        let picture = Picture::new(&view);
        let mut rays = [Ray { layers: [NOTHING; LAYERS], around: NOTHING }; COLUMNS * ROWS];
        content.each_in_view(&view, |i, min, max| picture.meet(&view, i, (min, max), &mut rays));
        let mut counted = Counted::new();
        let offset = frustum.origin - content.origin;
        for (i, ray) in rays.iter().enumerate() {
            let line = picture.ray(i % COLUMNS, i / COLUMNS);
            let mut weight = 1.0;
            let count = |layer: &Layer, weight: f32, counted: &mut Counted| -> f32 {
                let cone = input.receiver_cones.get(layer.index as usize).copied().unwrap_or(NormalCone::ALL);
                let Some(bounds) = content.receiver(layer.index as usize) else { return 0.0 };
                picture.count(line, layer, &cone, bounds, &mut |p: DVec3, texel: f64, share: f32| {
                    let q = plane.of(plane.axes.project(p - offset));
                    if let Some(cell) = space.cell_of(q.as_vec2(), texel as f32) {
                        counted.add(cell, weight * share);
                    }
                }, plane, view.near, view.far)
            };
            for layer in ray.layers.iter().take_while(|layer| layer.index != u32::MAX) {
                weight *= 1.0 - count(layer, weight, &mut counted);
            }
            if ray.around.index != u32::MAX {
                _ = count(&ray.around, crate::tune::get(6, 0.33), &mut counted);
            }
        }
        cells.add(&counted, &space, plane, content.origin);
    }
}

/// Rays through a picture, from its near to its far rectangle.
struct Picture {
    whole: Slice,
    right: DVec3,
    down: DVec3,
    /// Width of a pixel at a view depth of one metre, in metres.
    pixel: f64,
}

impl Picture {
    fn new(view: &View) -> Self {
        let whole = view.slice(view.near, view.far);
        let c = whole.corners;
        let (right, down) = (c[5] - c[4], c[7] - c[4]);
        let height = checks::length(down);
        let (right, down) = (right / checks::length(right), down / height);
        Self { whole, right, down, pixel: height / (f64::from(PIXELS) * view.far) }
    }

    /// Start and end of a ray.
    fn ray(&self, column: usize, row: usize) -> (DVec3, DVec3) {
        let (x, y) = ((column as f64 + 0.5) / COLUMNS as f64, (row as f64 + 0.5) / ROWS as f64);
        let c = &self.whole.corners;
        let at = |i: usize| (c[i] * (1.0 - x) + c[i + 1] * x) * (1.0 - y) + (c[i + 3] * (1.0 - x) + c[i + 2] * x) * y;
        (at(0), at(4))
    }

    /// Intersects all rays with a box.
    fn meet(&self, view: &View, index: usize, (min, max): (DVec3, DVec3), rays: &mut [Ray; COLUMNS * ROWS]) {
        let Some((columns, rows)) = covered(view, min, max) else { return };
        for row in rows {
            for column in columns.clone() {
                let (start, end) = self.ray(column, row);
                let Some((enter, leave)) = crossing(start, end, min, max) else { continue };
                let mut layer = Layer { enter: enter as f32, leave: leave as f32, index: index as u32 };
                let ray = &mut rays[row * COLUMNS + column];
                if enter <= 0.0 {
                    if ray.around.index == u32::MAX || ray.around.leave < layer.leave {
                        ray.around = layer;
                    }
                    continue;
                }
                for kept in &mut ray.layers {
                    if layer.enter < kept.enter {
                        core::mem::swap(&mut layer, kept);
                    }
                }
            }
        }
    }

    /// Passes on points of a box that a ray may meet, with the texel that each asks for and its share.
    #[allow(clippy::too_many_arguments)]
    fn count(&self, (start, end): (DVec3, DVec3), layer: &Layer, cone: &NormalCone, (min, max): (DVec3, DVec3), emit: &mut impl FnMut(DVec3, f64, f32), plane: &Plane, near: f64, far: f64) -> f32 {
        let along = end - start;
        let (enter, leave) = (f64::from(layer.enter), f64::from(layer.leave));
        let depth = |t: f64| near + (far - near) * t;
        if cone.cos_half_angle > FLAT {
            let normal = cone.axis.as_dvec3();
            let d = normal.dot(along);
            let ray = along / (far - near);
            if d == 0.0 {
                return crate::tune::get(10, 0.3);
            }
            let at = normal.dot((min + max) * 0.5 - start) / d;
            let hit = if at >= enter && at <= leave { crate::tune::get(11, 0.85) } else { crate::tune::get(10, 0.3) };
            if normal.dot(plane.axes.z.as_dvec3()) * -d <= 0.0 {
                return hit;
            }
            let t = at.clamp(enter, leave);
            let slide = |across: DVec3| across - ray * (across.dot(normal) / ray.dot(normal));
            let seen = |v: DVec3| plane.of(plane.axes.project(slide(v))).as_vec2();
            let texel = f64::from(needed_texel(seen(self.right), seen(self.down)));
            emit(start + along * t, texel * depth(t) * self.pixel, hit);
            return hit;
        }
        for share in SAMPLES {
            let t = enter + (leave - enter) * share;
            emit(start + along * t, f64::from(crate::tune::get(7, 0.7)) * depth(t) * self.pixel, crate::tune::get(5, 0.5) / SAMPLES.len() as f32);
        }
        crate::tune::get(5, 0.5)
    }
}

/// Cosine of the half angle of a cone above which its surfaces count as flat.
const FLAT: f32 = 0.9;

/// Shares of a ray's way through a box at which it may meet a surface.
const SAMPLES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];

/// Columns and rows of rays that may meet a box; all of them where it reaches before the near
/// plane.
fn covered(view: &View, min: DVec3, max: DVec3) -> Option<(core::ops::Range<usize>, core::ops::Range<usize>)> {
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for corner in box_corners(min, max) {
        if view.depth.distance(corner) < view.near {
            return Some((0..COLUMNS, 0..ROWS));
        }
        let position = view.picture_position(corner);
        for axis in 0..2 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let range = |axis: usize, count: usize| {
        let first = libm::ceil(low[axis] * count as f64 - 0.5).max(0.0);
        let last = libm::floor(high[axis] * count as f64 - 0.5).min(count as f64 - 1.0);
        if first > last { None } else { Some(first as usize..last as usize + 1) }
    };
    Some((range(0, COLUMNS)?, range(1, ROWS)?))
}

/// Shares of a ray at which it enters and leaves a box.
fn crossing(start: DVec3, end: DVec3, min: DVec3, max: DVec3) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let along = end[axis] - start[axis];
        if along == 0.0 {
            if start[axis] < min[axis] || start[axis] > max[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((min[axis] - start[axis]) / along, (max[axis] - start[axis]) / along);
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    if enter > leave { None } else { Some((enter, leave)) }
}

#[allow(dead_code)]
const UNUSED: Vec2 = Vec2::ZERO;
