//! What is visible, estimated from the boxes alone.

use super::cells::Cells;
use crate::FitInput;
use crate::content::Content;
use crate::need::Plane;
use crate::view::{View, box_corners};
use crate::normal_cone::NormalCone;
use glam::{DVec3, Vec2};

/// Rays across the picture.
const COLUMNS: usize = 32;
/// Rays down the picture.
const ROWS: usize = 18;
const LAYERS: usize = 3;

#[derive(Clone, Copy)]
struct Layer {
    enter: f32,
    leave: f32,
    index: u32,
}

const NOTHING: Layer = Layer { enter: f32::MAX, leave: f32::MAX, index: u32::MAX };

pub(super) fn add(cells: &mut Cells, input: &FitInput, content: &Content, plane: &Plane) {
    let to_light = plane.axes.z.as_dvec3();
    for (view_index, view) in content.views().enumerate() {
        let mut rays = [[NOTHING; LAYERS]; COLUMNS * ROWS];
        let whole = view.slice(view.near, view.far);
        let c = whole.corners;
        let ray_at = |column: usize, row: usize| {
            let (x, y) = ((column as f64 + 0.5) / COLUMNS as f64, (row as f64 + 0.5) / ROWS as f64);
            let lerp = |i: usize| (c[i] * (1.0 - x) + c[i + 1] * x) * (1.0 - y) + (c[i + 3] * (1.0 - x) + c[i + 2] * x) * y;
            (lerp(0), lerp(4))
        };
        let per_pixel = 1.0 / f64::from(crate::need::PIXELS);
        let height_far = crate::checks::length(c[4] - c[7]) * per_pixel / view.far;
        let mut index = 0u32;
        content.each_receiver_indexed(view_index, |i, min, max| {
            index = i as u32;
            let Some((columns, rows)) = covered(&view, min, max) else { return };
            for row in rows {
                for column in columns.clone() {
                    let (start, end) = ray_at(column, row);
                    let Some((enter, leave)) = crossing(start, end, min, max) else { continue };
                    let mut layer = Layer { enter: enter as f32, leave: leave as f32, index };
                    for kept in &mut rays[row * COLUMNS + column] {
                        if layer.enter < kept.enter {
                            core::mem::swap(&mut layer, kept);
                        }
                    }
                }
            }
        });
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let (start, end) = ray_at(column, row);
                let mut weight = 1.0_f32;
                for layer in rays[row * COLUMNS + column] {
                    if layer.index == u32::MAX {
                        break;
                    }
                    let cone = input.receiver_cones.get(layer.index as usize).copied().unwrap_or(NormalCone::ALL);
                    let along = end - start;
                    let narrow = f64::from(cone.cos_half_angle) > 0.9;
                    let (e, l) = (f64::from(layer.enter), f64::from(layer.leave));
                    let normal = cone.axis.as_dvec3();
                    let mut t = e + (l - e) * 0.35;
                    let mut k = 0.7;
                    if narrow {
                        let Some((min, max)) = content.receiver(layer.index as usize) else { continue };
                        let centre = (min + max) * 0.5;
                        let d = normal.dot(along);
                        if d != 0.0 {
                            t = (normal.dot(centre - start) / d).clamp(e, l);
                        }
                    }
                    let p = start + along * t;
                    let depth = view.near + (view.far - view.near) * t;
                    if narrow {
                        // One pixel right and down, slid along the surface.
                        let dir = along / (view.far - view.near);
                        let right = (c[5] - c[4]) / crate::checks::length(c[5] - c[4]);
                        let down = (c[7] - c[4]) / crate::checks::length(c[7] - c[4]);
                        let slide = |a: DVec3| a - dir * (a.dot(normal) / dir.dot(normal));
                        let (a, b) = (plane.of(plane.axes.project(slide(right))), plane.of(plane.axes.project(slide(down))));
                        let facing = normal.dot(to_light) * -normal.dot(dir);
                        if facing <= 0.0 {
                            continue;
                        }
                        k = f64::from(crate::need::needed_texel(a.as_vec2(), b.as_vec2())).max(0.02);
                    }
                    let q = plane.of(plane.axes.project(p));
                    let half = depth * height_far * 30.0;
                    let texel = depth * height_far * k;
                    cells.add(q.as_vec2(), half as f32, weight, texel as f32);
                    weight *= 0.4;
                }
            }
        }
    }
    let _ = Vec2::ZERO;
}

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
