//! The visible triangle at a pixel's centre, and the visible point on its plane.

use glam::{DVec3, Vec3};

use crate::camera::PixelCamera;
use crate::tracer::Tracer;

/// A point that a pixel shows. World space, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenPoint {
    /// Position on the plane of the triangle.
    pub(crate) position: DVec3,
    /// Unit geometric normal on the side of the eye; zero where the triangle has no area.
    pub(crate) normal: DVec3,
    /// Distance from the eye along the view, in metres.
    pub(crate) view_depth: f64,
}

/// Returns the nearest triangle at a pixel between the near and the far plane.
pub(crate) fn seen_by_ray(tracer: &Tracer, camera: &PixelCamera, pixel: usize) -> Option<u32> {
    let ray = camera.ray_of(pixel);
    let hit = tracer.first_hit(ray.origin.as_vec3(), ray.direction.as_vec3())?;
    let depth = tracer.refine(hit, tracer.plane_normal(hit.triangle), ray.origin, ray.direction);
    (camera.near..=camera.far).contains(&depth).then_some(hit.triangle)
}

/// Returns the intersection of the ray through a pixel's centre with the plane of the visible triangle. The
/// view depth is clamped to the range of the triangle's corners, because the ray may hit the plane of an
/// edge-on sliver anywhere.
pub(crate) fn seen_point(tracer: &Tracer, camera: &PixelCamera, pixel: usize, triangle: u32) -> SeenPoint {
    let ray = camera.ray_of(pixel);
    let normal = tracer.plane_normal(triangle);
    let corners = tracer.corners(triangle).map(Vec3::as_dvec3);
    let depths = corners.map(|corner| camera.view_depth(corner));
    let nearest = depths.into_iter().fold(f64::INFINITY, f64::min).max(camera.near);
    let farthest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max).min(camera.far);
    // If the ray lies within the plane, the depth is NaN, which `max` and `min` drop.
    let along = normal.dot(ray.direction);
    let view_depth = (normal.dot(corners[0] - ray.origin) / along).max(nearest).min(farthest);
    let normal = if along > 0.0 { -normal } else { normal };
    SeenPoint { position: ray.at(view_depth), normal, view_depth }
}
