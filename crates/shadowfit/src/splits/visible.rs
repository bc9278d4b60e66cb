//! Which depths are visible, by what the boxes alone tell: the nearest few boxes along each ray of
//! a coarse grid, each spread over the depths that the ray is in it.
//!
//! ```text
//!    eye      ┌────┐       ┌───────┐
//!     ●───────┼────┼───────┼───────┼──────    each box stops a share of the ray,
//!             └────┘       └───────┘          its opacity in that direction,
//!              0.5        0.5 of the rest     and lets the rest through
//! ```
//!
//! A box is not its surface, so this is a guess; where it errs, maps are less sharp than they
//! could be, and nothing else.

use glam::{DVec3, Vec3, Vec4};

use super::{BINS, Bins, CLASSES, Weights, needed_texel};
use crate::checks;
use crate::fits::Content;
use crate::view::{View, box_corners};

/// Rays across the picture.
const COLUMNS: usize = 32;
/// Rays down the picture.
const ROWS: usize = 18;

/// Boxes kept along each ray. A box is mostly air, so what is behind the first one may be seen.
const LAYERS: usize = 4;

/// Opacity of boxes of which none is known. Chosen with the weight below on real scenes: counting
/// the first box alone misjudges cuts where boxes are loose.
const UNKNOWN: Vec4 = Vec4::new(0.0, 0.0, 0.0, 0.15);

/// What a ray counts for the boxes that it begins in, which may hold anything up to their ends.
const AROUND: f64 = 0.05;

/// Last class that boxes tell: the normals of their surfaces scatter about the axes, so the
/// steepest that those would give are not to be had.
const STEEPEST: usize = 1;

/// Shares of the rays that first meet a box in each bin; even ones where no box is known.
pub(super) fn weights(content: &Content, to_light: Vec3, bins: &Bins) -> Weights {
    let mut spread = Spread { starts: core::array::from_fn(|bin| bins.start(bin)), weights: [[0.0; CLASSES]; BINS] };
    for (view_index, view) in content.views().enumerate() {
        let mut rays = [Ray::NOTHING; COLUMNS * ROWS];
        let grid = Grid::new(&view);
        content.each_receiver(view_index, |min, max, opacity| {
            grid.meet(&view, bins, min, max, opacity, &mut rays);
        });
        for (i, ray) in rays.iter().enumerate() {
            let is_known = ray.layers.iter().any(|layer| layer.stopped[..3] != [0; 3]);
            let [x, y, z] = if is_known { grid.classes(i, to_light.as_dvec3()) } else { [None; 3] };
            let classes = [x, y, z, Some(0)];
            let mut through = 1.0;
            for layer in ray.layers.iter().filter(|layer| layer.first < NOWHERE) {
                let stopped = layer.stopped.map(|share| f64::from(share) / 255.0);
                for (stopped, class) in stopped.into_iter().zip(classes) {
                    if let Some(class) = class {
                        spread.add(layer.first, layer.last, through * stopped, class);
                    }
                }
                through *= (1.0 - stopped.iter().sum::<f64>()).max(0.0);
            }
            if ray.around < NOWHERE {
                spread.add(0, ray.around, through * AROUND, 0);
            }
        }
    }
    let total: f64 = spread.weights.iter().flatten().sum();
    if total == 0.0 {
        // Each depth alike; of slopes nothing is known.
        return core::array::from_fn(|_| core::array::from_fn(|c| if c == 0 { 1.0 / BINS as f64 } else { 0.0 }));
    }
    spread.weights.map(|classes| classes.map(|weight| weight / total))
}

/// Stands for no bin.
const NOWHERE: u8 = u8::MAX;

/// A box on a ray.
#[derive(Clone, Copy)]
struct Layer {
    /// Bin of the view depth at which the ray enters the box.
    first: u8,
    /// Bin of the view depth at which it leaves.
    last: u8,
    /// Shares of the ray that surfaces upright to the x, y and z axis stop, and unknown ones, in
    /// steps of 1/255.
    stopped: [u8; 4],
}

/// What a ray meets.
#[derive(Clone, Copy)]
struct Ray {
    /// The nearest boxes, in order.
    layers: [Layer; LAYERS],
    /// Bin of the view depth at which it leaves the boxes that it begins in.
    around: u8,
}

impl Ray {
    const NOTHING: Self = {
        let layer = Layer { first: NOWHERE, last: NOWHERE, stopped: [0; 4] };
        Self { layers: [layer; LAYERS], around: NOWHERE }
    };
}

/// Weights spread over bins.
struct Spread {
    /// View depths at which the bins begin and the last one ends, in metres.
    starts: [f64; BINS + 1],
    weights: Weights,
}

impl Spread {
    /// Adds a weight, evenly over the depths of a range of bins.
    fn add(&mut self, first: u8, last: u8, weight: f64, class: usize) {
        let (first, last) = (usize::from(first), usize::from(last));
        let length = |first: usize, last: usize| self.starts[last + 1] - self.starts[first];
        let per_metre = weight / length(first, last);
        if !per_metre.is_finite() {
            // Depths too near one another to be told apart.
            self.weights[first][class] += weight;
        } else if weight > 0.0 {
            for bin in first..=last {
                self.weights[bin][class] += per_metre * length(bin, bin);
            }
        }
    }
}

/// Rays through a picture, from its near to its far rectangle.
struct Grid {
    start: [DVec3; 4],
    end: [DVec3; 4],
}

impl Grid {
    fn new(view: &View) -> Self {
        let whole = view.slice(view.near, view.far);
        let corners = |i: usize| [whole.corners[i], whole.corners[i + 1], whole.corners[i + 2], whole.corners[i + 3]];
        Self { start: corners(0), end: corners(4) }
    }

    /// The first and the last ray of a row, each from its start to its end.
    fn row(&self, row: usize) -> [(DVec3, DVec3); 2] {
        let y = (row as f64 + 0.5) / ROWS as f64;
        // Left-top, right-top, right-bottom, left-bottom.
        let at = |top: usize, bottom: usize| {
            let lerp = |c: &[DVec3; 4]| c[top] * (1.0 - y) + c[bottom] * y;
            (lerp(&self.start), lerp(&self.end))
        };
        let (left, right) = (at(0, 3), at(1, 2));
        let half = 0.5 / COLUMNS as f64;
        let between = |x: f64| (left.0 * (1.0 - x) + right.0 * x, left.1 * (1.0 - x) + right.1 * x);
        [between(half), between(1.0 - half)]
    }

    /// Where one ray starts and ends.
    fn ray(&self, index: usize) -> (DVec3, DVec3) {
        let [first, last] = self.row(index / COLUMNS);
        let x = (index % COLUMNS) as f64 / (COLUMNS - 1) as f64;
        (first.0 * (1.0 - x) + last.0 * x, first.1 * (1.0 - x) + last.1 * x)
    }

    /// Classes of foreshortening of surfaces upright to the x, y and z axis where a ray meets
    /// them; none for those whose seen side is turned away from the light.
    fn classes(&self, index: usize, to_light: DVec3) -> [Option<usize>; 3] {
        let (start, end) = self.ray(index);
        let (right, down) = (self.end[1] - self.end[0], self.end[3] - self.end[0]);
        let (right, down) = (right / checks::length(right), down / checks::length(down));
        let ahead = right.cross(down);
        let ray = (end - start) / (end - start).dot(ahead);
        [DVec3::X, DVec3::Y, DVec3::Z].map(|normal| {
            let facing = ray.dot(normal);
            if facing * to_light.dot(normal) >= 0.0 {
                return None;
            }
            let slide = |across: DVec3| (across - ray * (across.dot(normal) / facing)).as_vec3();
            let texel = needed_texel(slide(right), slide(down), to_light.as_vec3());
            let class = libm::round(-libm::log2(f64::from(texel)));
            Some(class.max(0.0).min(STEEPEST as f64) as usize)
        })
    }

    /// Lets all rays meet a box.
    fn meet(
        &self,
        view: &View,
        bins: &Bins,
        min: DVec3,
        max: DVec3,
        opacity: Option<Vec3>,
        rays: &mut [Ray; COLUMNS * ROWS],
    ) {
        let Some((columns, rows)) = covered(view, min, max) else { return };
        let size = max - min;
        let faces = DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
        for row in rows {
            let [first, last] = self.row(row);
            let step = 1.0 / (COLUMNS - 1) as f64;
            let (start_step, end_step) = ((last.0 - first.0) * step, (last.1 - first.1) * step);
            for column in columns.clone() {
                let x = column as f64;
                let (start, end) = (first.0 + start_step * x, first.1 + end_step * x);
                let Some((enter, leave)) = crossing(start, end, min, max) else { continue };
                let bin = |t: f64| bins.of(view.near + (view.far - view.near) * t) as u8;
                let ray = &mut rays[row * COLUMNS + column];
                let (first, last) = (bin(enter), bin(leave));
                if enter <= 0.0 {
                    // The farther of two ends; there is none yet at first.
                    ray.around = if ray.around == NOWHERE { last } else { ray.around.max(last) };
                    continue;
                }
                // What of the box's picture each pair of faces makes up.
                let seen = faces * (end - start).abs();
                let shares = (seen / seen.element_sum().max(f64::MIN_POSITIVE)).as_vec3();
                let stopped = opacity.map_or(UNKNOWN, |opacity| (shares * opacity).extend(0.0));
                let stopped = (stopped * 255.0 + 0.5).to_array().map(|share| share as u8);
                let mut layer = Layer { first, last, stopped };
                for kept in &mut ray.layers {
                    if layer.first < kept.first {
                        core::mem::swap(&mut layer, kept);
                    }
                }
            }
        }
    }
}

/// Columns and rows of rays that may meet a box; all of them where it reaches before the picture.
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
