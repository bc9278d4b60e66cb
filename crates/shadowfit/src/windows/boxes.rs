//! What is visible, estimated from the boxes alone: the nearest few boxes along each ray of a coarse
//! grid. Where their surfaces are nearly flat, the ray meets the plane through the middle of the box;
//! elsewhere it may meet a surface anywhere in it.
//!
//! A box is not its surface, so this is an estimate; where it is wrong, windows are less sharp than
//! they could be, and nothing worse.

use glam::DVec3;

use super::cells::Cells;
use super::counted::Counted;
use crate::base::checks;
use crate::content::normal_cone::NormalCone;
use crate::content::{Bounds, Found, Query, Visit};
use crate::demand::grid::{DemandSpace, PIXELS, Plane, needed_texel};
use crate::fits::Frame;
use crate::view::{Picture as Positions, RayCount, Slice, View, covered, crossing};

/// Rays across and down the picture.
const RAYS: RayCount = RayCount::FINE;
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

/// A ray from its start to its end, in metres relative to the fit's origin.
#[derive(Clone, Copy)]
struct Line {
    start: DVec3,
    along: DVec3,
}

/// The surfaces in a box.
struct Surface {
    cone: NormalCone,
    /// Middle of the box.
    middle: DVec3,
}

/// A ray's boxes: the nearest, and the one that it begins in and leaves last.
#[derive(Clone, Copy)]
struct Ray {
    layers: [Layer; LAYERS],
    around: Layer,
}

/// Adds the demand of the boxes that the views of a frame see.
pub(super) fn add(cells: &mut Cells, frame: &Frame, plane: &Plane) {
    let Frame { input, content, .. } = frame;
    for part in content.whole_views() {
        let frustum = &content.views[part.index];
        let Ok(space) = DemandSpace::new(frustum, -plane.axes.z, frame.light.up().as_vec3(), frame.range.far) else {
            continue;
        };
        let mut rays = Rays::new(&part.view, plane);
        content.visit(Query::Visible(&part), &mut rays);
        let Rays { picture, all, .. } = &rays;
        let mut counted = Counted::new();
        let offset = frustum.origin - content.origin;
        for (i, ray) in all.iter().enumerate() {
            let line = picture.ray(i % RAYS.columns, i / RAYS.columns);
            // Counts what a ray meets in a box; returns the share of it that goes no farther.
            let mut count = |layer: &Layer, weight: f32| {
                let index = layer.index as usize;
                let cone = input.receiver_cones.get(index).copied().unwrap_or(NormalCone::ALL);
                let Some((min, max)) = content.receiver(index) else { return 0.0 };
                let surface = Surface { cone, middle: (min + max) * 0.5 };
                picture.look(&line, layer, &surface, |point, texel, share| {
                    let place = plane.of(plane.axes.project(point - offset)).as_vec2();
                    if let Some(cell) = space.cell_of(place, texel as f32) {
                        counted.add(cell, weight * share);
                    }
                })
            };
            let mut weight = 1.0;
            for layer in ray.layers.iter().take_while(|layer| layer.index != NOTHING.index) {
                weight *= 1.0 - count(layer, weight);
            }
            if ray.around.index != NOTHING.index {
                count(&ray.around, AROUND);
            }
        }
        cells.add(&counted, OVERRATED, &space, plane, content.origin);
    }
}

/// Rays through a picture, from its near to its far rectangle.
struct Picture<'a> {
    plane: &'a Plane,
    whole: Slice,
    right: DVec3,
    down: DVec3,
    /// Width of a pixel at the near and the far rectangle, in metres.
    pixels: [f64; 2],
}

impl<'a> Picture<'a> {
    fn new(view: &View, plane: &'a Plane) -> Self {
        let whole = view.slice(view.near, view.far);
        let c = whole.corners;
        let (right, down) = (c[5] - c[4], c[7] - c[4]);
        let heights = [checks::length(c[3] - c[0]), checks::length(down)];
        let (right, down) = (right / checks::length(right), down / heights[1]);
        let pixels = heights.map(|height| height / f64::from(PIXELS));
        Self { plane, whole, right, down, pixels }
    }

    /// A ray from the near to the far rectangle.
    fn ray(&self, column: usize, row: usize) -> Line {
        let (x, y) = ((column as f64 + 0.5) / RAYS.columns as f64, (row as f64 + 0.5) / RAYS.rows as f64);
        let c = &self.whole.corners;
        let at = |i: usize| (c[i] * (1.0 - x) + c[i + 1] * x) * (1.0 - y) + (c[i + 3] * (1.0 - x) + c[i + 2] * x) * y;
        let start = at(0);
        Line { start, along: at(4) - start }
    }

    /// Passes on points of a box that a ray may meet, with the texel that each asks for and its share; returns
    /// the share of the ray that ends there.
    fn look(&self, line: &Line, layer: &Layer, surface: &Surface, mut emit: impl FnMut(DVec3, f64, f32)) -> f32 {
        let (Line { start, along }, Surface { cone, middle }) = (*line, surface);
        let (enter, leave) = (f64::from(layer.enter), f64::from(layer.leave));
        let pixel = |t: f64| self.pixels[0] + (self.pixels[1] - self.pixels[0]) * t;
        if cone.cos_half_angle <= FLAT {
            for share in SAMPLES {
                let t = enter + (leave - enter) * share;
                emit(start + along * t, pixel(t), SOLID / SAMPLES.len() as f32);
            }
            return SOLID;
        }
        let normal = cone.axis.as_dvec3();
        let across = normal.dot(along);
        let t = normal.dot(*middle - start) / across;
        // A ray along the surface meets it nowhere.
        let met = if t >= enter && t <= leave { MET } else { BESIDE };
        let is_lit = normal.dot(self.plane.axes.z.as_dvec3()) * -across > 0.0;
        if is_lit && t.is_finite() {
            let t = t.clamp(enter, leave);
            let slide = |v: DVec3| v - along * (v.dot(normal) / across);
            let seen = |v: DVec3| self.plane.of(self.plane.axes.project(slide(v))).as_vec2();
            let texel = f64::from(needed_texel(seen(self.right), seen(self.down)));
            emit(start + along * t, texel * pixel(t), met);
        }
        met
    }
}

/// The nearest boxes along all rays of a view.
struct Rays<'a> {
    view: &'a View,
    picture: Picture<'a>,
    positions: Positions,
    /// Row by row.
    all: [Ray; RAYS.columns * RAYS.rows],
}

impl<'a> Rays<'a> {
    #[expect(clippy::large_stack_arrays, reason = "36 KiB, for the time that it takes to look around")]
    fn new(view: &'a View, plane: &'a Plane) -> Self {
        let all = [Ray { layers: [NOTHING; LAYERS], around: NOTHING }; RAYS.columns * RAYS.rows];
        Self { view, picture: Picture::new(view, plane), positions: view.picture(), all }
    }
}

impl Visit for Rays<'_> {
    /// Returns whether a box may be among the nearest ones along a ray.
    fn wants(&self, bounds: &Bounds) -> bool {
        let view = self.view;
        let covered = covered(view, &self.positions, RAYS, bounds.min, bounds.max);
        let Some((columns, rows)) = covered else { return false };
        let nearest =
            (bounds.depths.near - view.near) / (view.far - view.near) * (1.0 - SHARE_ROUNDING) - SHARE_ROUNDING;
        let mut rays = rows.flat_map(|row| &self.all[row * RAYS.columns..][columns.clone()]);
        nearest <= 0.0 || rays.any(|ray| nearest < f64::from(ray.layers[LAYERS - 1].enter))
    }

    /// Intersects all rays with a box.
    fn take(&mut self, Found { bounds: Bounds { min, max, .. }, index }: &Found) {
        let Some((columns, rows)) = covered(self.view, &self.positions, RAYS, *min, *max) else { return };
        for row in rows {
            for column in columns.clone() {
                let Line { start, along } = self.picture.ray(column, row);
                let Some((enter, leave)) = crossing(start, along, *min, *max) else { continue };
                let mut layer = Layer { enter: enter as f32, leave: leave as f32, index: *index as u32 };
                let ray = &mut self.all[row * RAYS.columns + column];
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
}

/// Rounding of shares of a ray to f32, and of view depths to such shares.
const SHARE_ROUNDING: f64 = 1e-6;

/// Share of the points with the finest demands. They count as no finer than the others, since estimates from boxes find
/// too many near the eye.
const OVERRATED: f32 = 0.1;

/// Cosine of the half angle of a cone above which its surfaces count as flat.
const FLAT: f32 = 0.97;

/// Share of the rays through a box that meet a surface in it, where surfaces face everywhere.
const SOLID: f32 = 0.3;

/// The same where surfaces are nearly flat and the ray meets their plane in the box.
const MET: f32 = 0.85;

/// The same where the ray meets their plane beside the box.
const BESIDE: f32 = 0.3;

/// Weight of the box that a ray begins in, which may hold a surface anywhere up to its end.
const AROUND: f32 = 1.0 / 3.0;

/// Shares of a ray's way through a box at which it may meet a surface.
const SAMPLES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
