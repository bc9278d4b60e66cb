//! Visible demand of a frame, estimated from the [boxes along rays](crate::demand::from_boxes). If the
//! surfaces in a box are nearly flat, a ray meets the plane through the middle of the box. Otherwise it may
//! meet a surface anywhere in the box.

use glam::DVec3;

use super::cells::Cells;
use super::counted::Counted;
use crate::base::checks;
use crate::content::normal_cone::NormalCone;
use crate::content::{Query, ViewPart};
use crate::demand::from_boxes::{AROUND, Layer, Ray, Rays};
use crate::demand::grid::{DemandSpace, PIXELS, Plane, needed_texel};
use crate::fits::Frame;
use crate::view::RayCount;

/// The surfaces in a box.
struct Surface {
    cone: NormalCone,
    /// Middle of the box.
    middle: DVec3,
}

/// Adds the demand of the boxes in the views of a frame.
pub(super) fn add(cells: &mut Cells, frame: &Frame, plane: &Plane) {
    let Frame { input, content, .. } = frame;
    for part in content.whole_views() {
        let frustum = &content.views[part.index];
        let Ok(space) = DemandSpace::new(frustum, -plane.axes.z, frame.light.up().as_vec3(), frame.range.far) else {
            continue;
        };
        let mut rays = Rays::new(&part, RayCount::FINE);
        content.visit(Query::Visible(&part), &mut rays);
        let picture = Picture::new(&part, plane);
        let mut counted = Counted::new();
        let offset = frustum.origin - content.origin;
        for ray in rays.iter() {
            // Counts the surfaces of a box that a ray meets. Returns the share of the ray that ends there.
            let mut count = |layer: &Layer, weight: f32| {
                let index = layer.index as usize;
                let cone = input.receiver_cones.get(index).copied().unwrap_or(NormalCone::ALL);
                let Some((min, max)) = content.receiver(index) else { return 0.0 };
                let surface = Surface { cone, middle: (min + max) * 0.5 };
                picture.look(ray, layer, &surface, |point, texel, share| {
                    let place = plane.of(plane.axes.project(point - offset)).as_vec2();
                    if let Some(cell) = space.cell_of(place, texel as f32) {
                        counted.add(cell, weight * share);
                    }
                })
            };
            let mut weight = 1.0;
            for layer in ray.layers() {
                weight *= 1.0 - count(layer, weight);
            }
            if let Some(around) = &ray.around {
                count(around, AROUND);
            }
        }
        cells.add(&counted, OVERRATED, &space, plane, content.origin);
    }
}

/// The pixels of a picture.
struct Picture<'a> {
    plane: &'a Plane,
    /// Unit vectors across and down the picture.
    right: DVec3,
    down: DVec3,
    /// Width of a pixel at the near and the far rectangle, in metres.
    pixels: [f64; 2],
}

impl<'a> Picture<'a> {
    fn new(part: &ViewPart, plane: &'a Plane) -> Self {
        let c = part.slice().corners;
        let (right, down) = (c[5] - c[4], c[7] - c[4]);
        let heights = [checks::length(c[3] - c[0]), checks::length(down)];
        let (right, down) = (right / checks::length(right), down / heights[1]);
        let pixels = heights.map(|height| height / f64::from(PIXELS));
        Self { plane, right, down, pixels }
    }

    /// Emits the points of a box that a ray may meet, each with the texel that it needs and its share.
    /// Returns the share of the ray that ends there.
    fn look(&self, ray: &Ray, layer: &Layer, surface: &Surface, mut emit: impl FnMut(DVec3, f64, f32)) -> f32 {
        let (Ray { start, along, .. }, Surface { cone, middle }) = (*ray, surface);
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
        // A ray along the surface never meets it.
        let met = if t >= enter && t <= leave { MET } else { BESIDE };
        let is_lit = normal.dot(self.plane.axes.z.as_dvec3()) * -across > 0.0;
        if is_lit && t.is_finite() {
            let t = t.max(enter).min(leave);
            let slide = |v: DVec3| v - along * (v.dot(normal) / across);
            let seen = |v: DVec3| self.plane.of(self.plane.axes.project(slide(v))).as_vec2();
            let texel = f64::from(needed_texel(seen(self.right), seen(self.down)));
            emit(start + along * t, texel * pixel(t), met);
        }
        met
    }
}

/// Share of the points with the finest demands. They count as no finer than the other points, since estimates
/// from boxes find too many points near the eye.
const OVERRATED: f32 = 0.1;

/// Cosine of the half angle of a cone above which its surfaces count as flat.
const FLAT: f32 = 0.97;

/// Share of the rays through a box that meet a surface in it, if the surfaces face in all directions.
const SOLID: f32 = 0.3;

/// Share of the rays that meet a surface if the surfaces are nearly flat and the ray meets their plane in the
/// box.
const MET: f32 = 0.85;

/// Share of the rays that meet a surface if the surfaces are nearly flat and the ray meets their plane beside
/// the box.
const BESIDE: f32 = 0.3;

/// Positions along a ray's way through a box at which it may meet a surface, as shares of this way.
const SAMPLES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
