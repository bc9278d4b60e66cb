//! The light that reaches the whole area of a pixel, not only its centre: the truth for pictures with smooth
//! edges.
//!
//! Each pixel is sampled at several points. From the surface seen at each point, a ray is cast toward the
//! light.

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::PixelCamera;
use crate::tracer::Tracer;
use crate::truth::{Truth, TruthSettings, is_blocked};

/// Sums of |factor − share of the pixel's area that is lit| over the counted pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AreaTally {
    /// Pixels with one surface: all sample points lie near the plane of the pixel's centre and face nearly
    /// the same way.
    pub single: u64,
    /// Sum of the errors of these pixels.
    pub single_error: f64,
    /// Pixels that show several surfaces.
    pub several: u64,
    /// Sum of the errors of these pixels.
    pub several_error: f64,
}

impl AreaTally {
    /// Adds the sums of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.single += other.single;
        self.single_error += other.single_error;
        self.several += other.several;
        self.several_error += other.several_error;
    }

    /// Returns the mean error in per cent of full light, for pixels with one surface and with several. `None`
    /// without pixels.
    pub fn errors(&self) -> [Option<f64>; 2] {
        let mean = |error: f64, pixels: u64| (pixels > 0).then(|| 100.0 * error / pixels as f64);
        [mean(self.single_error, self.single), mean(self.several_error, self.several)]
    }
}

/// Smallest cosine between the normals of two points that count as one surface: 11°.
const SAME_SURFACE: f64 = 0.98;

/// Multiplier that shuffles the rays of a pixel: a prime near the golden section of 256, the count of 16 × 16
/// points.
const SHUFFLE: u32 = 157;

/// Light and surfaces within the area of a pixel.
struct Area {
    lit: f64,
    is_single: bool,
}

/// Compares a picture's factors with the lit share of each counted pixel's area, sampled at `side` × `side`
/// points. Each point casts one ray. If the sun has a radius, each ray aims at a different point of the sun.
/// `counted` and `factors` have one element per pixel, rows from the top.
pub fn area(tracer: &Tracer, truth: &Truth, counted: &[bool], factors: &[f32], side: u32) -> AreaTally {
    let of_pixel = |pixel: usize| {
        let point = truth.points[pixel].filter(|_| counted[pixel])?;
        let centre = Plane { point: point.position, normal: point.normal };
        let area = seen(tracer, &truth.camera, &truth.settings, pixel, &centre, side)?;
        let error = (f64::from(factors[pixel]).clamp(0.0, 1.0) - area.lit).abs();
        Some(if area.is_single {
            AreaTally { single: 1, single_error: error, ..AreaTally::default() }
        } else {
            AreaTally { several: 1, several_error: error, ..AreaTally::default() }
        })
    };
    let found: Vec<AreaTally> = (0..factors.len()).into_par_iter().filter_map(of_pixel).collect();
    // Merges in pixel order, so that the sums are deterministic.
    found.iter().fold(AreaTally::default(), |mut all, one| {
        all.merge(one);
        all
    })
}

/// The plane of the surface at the centre of a pixel.
struct Plane {
    /// Point on the plane, world space, metres.
    point: DVec3,
    normal: DVec3,
}

/// Computes the lit share of a pixel from `side` × `side` points; `None` if all of them show the sky.
fn seen(
    tracer: &Tracer,
    camera: &PixelCamera,
    settings: &TruthSettings,
    pixel: usize,
    centre: &Plane,
    side: u32,
) -> Option<Area> {
    let ray = camera.ray_of(pixel);
    let width = 2.0 * camera.half_size.y / f64::from(camera.size[1]) * camera.spread(camera.view_depth(centre.point));
    let [right, down] = camera.pixel_axes();
    let (mut points, mut free, mut is_single) = (0_u32, 0_u32, true);
    let rays = settings.light.with_rays(side * side).rays();
    for index in 0..side * side {
        let place = |number: u32| (f64::from(number) + 0.5) / f64::from(side) - 0.5;
        let through = camera.moved(&ray, right * place(index % side) + down * place(index / side));
        let Some(hit) = tracer.first_hit(through.origin.as_vec3(), through.direction.as_vec3()) else {
            is_single = false;
            continue;
        };
        let plane = tracer.plane_normal(hit.triangle);
        let depth = tracer.refine(hit, plane, through.origin, through.direction);
        let position = through.at(depth);
        let facing = if plane.dot(through.direction) > 0.0 { -plane } else { plane };
        is_single &=
            (position - centre.point).dot(centre.normal).abs() <= width && facing.dot(centre.normal) >= SAME_SURFACE;
        points += 1;
        let is_facing = facing.dot(settings.light.ray_from(position).direction) > 0.0;
        // Neighbouring points of the pixel aim at points of the sun that are not neighbours.
        let number = (index * SHUFFLE % rays.count()) as usize;
        let origin = position + facing * settings.ray_offset;
        let is_lit =
            is_facing && rays.from(origin, pixel).nth(number).is_some_and(|ray| !is_blocked(tracer, origin, &ray));
        free += u32::from(is_lit);
    }
    (points > 0).then(|| Area { lit: f64::from(free) / f64::from(points), is_single })
}
