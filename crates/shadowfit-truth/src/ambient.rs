//! Ray-traced ambient occlusion, the reference for screen-space ambient occlusion.
//!
//! From each visible point, rays are cast into the hemisphere above its surface. A ray that hits a triangle
//! nearby hides its share of the ambient light: all of it at the point, less with distance.

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::PixelCamera;
use crate::seen::seen_point;
use crate::spiral;
use crate::tracer::Tracer;

/// Settings of the ambient occlusion rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientSettings {
    /// Rays per pixel; 0 counts as 1. Default: 32.
    pub rays: u32,
    /// Distance at which occlusion has fallen linearly to 0, in metres. Default: 1.
    pub distance: f64,
    /// Offset of each ray's start along the geometric normal, in metres. Default: 0.001.
    pub ray_offset: f64,
}

impl Default for AmbientSettings {
    fn default() -> Self {
        Self { rays: 32, distance: 1.0, ray_offset: 1e-3 }
    }
}

/// The ambient occlusion of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct AmbientTruth {
    /// Camera of the picture.
    pub camera: PixelCamera,
    /// Settings that were used for tracing.
    pub settings: AmbientSettings,
    /// Share of the ambient light that is hidden at each pixel, 0..=1, rows from the top. `None` for the sky,
    /// and for a triangle without area, which has no normal.
    pub occlusion: Vec<Option<f32>>,
}

impl AmbientTruth {
    /// Traces the ambient occlusion of a picture.
    ///
    /// The rays are cosine-weighted around the geometric normal on the eye's side. A ray that hits a triangle
    /// at distance d below [`AmbientSettings::distance`] contributes 1 - d / distance, any other ray 0; the
    /// result is their mean. The ray pattern is deterministic and rotated from pixel to pixel. Rays respect
    /// cut-outs and the alpha test.
    ///
    /// `seen` is the triangle (index into the tracer's) that is drawn at each pixel, as for
    /// [`Truth::trace`](crate::Truth::trace).
    ///
    /// # Panics
    ///
    /// If `seen` does not have one element for each pixel.
    pub fn trace(tracer: &Tracer, camera: &PixelCamera, settings: &AmbientSettings, seen: &[Option<u32>]) -> Self {
        assert_eq!(seen.len(), camera.pixels(), "one triangle or `None` for each pixel");
        let occlusion = seen
            .par_iter()
            .enumerate()
            .map(|(pixel, seen)| {
                let triangle = seen.filter(|triangle| (*triangle as usize) < tracer.len())?;
                let point = seen_point(tracer, camera, pixel, triangle);
                let origin = point.position + point.normal * settings.ray_offset;
                point.normal.is_normalized().then(|| hidden_share(tracer, settings, pixel, origin, point.normal))
            })
            .collect();
        Self { camera: *camera, settings: *settings, occlusion }
    }

    /// Returns a picture's mean absolute error, 0..=1, over the pixels that have a truth. `None` if no pixel
    /// has one. `occlusion` is the share of the ambient light that the picture hides at each pixel, rows from
    /// the top. Values outside 0..=1 are clamped. NaN counts as an error of 1.
    ///
    /// # Panics
    ///
    /// If `occlusion` does not have one element for each pixel.
    pub fn mean_absolute_error(&self, occlusion: &[f32]) -> Option<f64> {
        assert_eq!(occlusion.len(), self.occlusion.len(), "one value for each pixel");
        let both = self.occlusion.iter().zip(occlusion).filter_map(|(truth, picture)| Some(((*truth)?, *picture)));
        let error = |(truth, picture): (f32, f32)| {
            if picture.is_nan() { 1.0 } else { f64::from((picture.clamp(0.0, 1.0) - truth).abs()) }
        };
        let (sum, count) = both.map(error).fold((0.0, 0u32), |(sum, count), error| (sum + error, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }
}

/// Returns the share of the ambient light that is hidden from a point.
fn hidden_share(tracer: &Tracer, settings: &AmbientSettings, pixel: usize, origin: DVec3, normal: DVec3) -> f32 {
    let hidden = |direction: DVec3| {
        let (start, along) = (origin.as_vec3(), direction.as_vec3());
        let Some(hit) = tracer.first_hit_within(start, along, settings.distance as f32) else { return 0.0 };
        let distance = tracer.refine(hit, tracer.plane_normal(hit.triangle), origin, direction);
        (1.0 - distance / settings.distance).clamp(0.0, 1.0)
    };
    let rays = settings.rays.max(1);
    (directions(normal, rays, spiral::turn_of(pixel)).map(hidden).sum::<f64>() / f64::from(rays)) as f32
}

/// Returns cosine-weighted unit directions around `normal`, from a spiral that is turned by `turn` radians.
fn directions(normal: DVec3, rays: u32, turn: f64) -> impl Iterator<Item = DVec3> {
    let (first, second) = normal.any_orthonormal_pair();
    (0..rays).map(move |ray| {
        // A uniform distribution on the disc, projected up, is cosine-weighted on the hemisphere (Malley's
        // method).
        let area = (f64::from(ray) + 0.5) / f64::from(rays);
        let (sin, cos) = spiral::sin_cos(ray, turn);
        normal * (1.0 - area).sqrt() + (first * cos + second * sin) * area.sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_spread_by_the_cosine() {
        let normal = DVec3::new(0.3, -0.8, 0.2).normalize();
        let of = |turn| directions(normal, 1000, turn).collect::<Vec<_>>();
        let spread = of(0.7);
        assert!(spread.iter().all(|d| d.is_normalized() && d.dot(normal) > 0.0));
        // With the density cos/π the mean cosine is the integral of 2 cos² sin = 2/3. The sideways components
        // cancel.
        let mean = spread.iter().sum::<DVec3>() / 1000.0;
        assert!(mean.abs_diff_eq(normal * (2.0 / 3.0), 2e-3), "{mean}");
        // The share within an angle is its sin²: half of the rays lie within 45 degrees.
        let half = spread.iter().filter(|d| d.dot(normal) > 0.5f64.sqrt()).count();
        assert!(half.abs_diff(500) <= 1, "{half}");
        assert_eq!(of(0.7), spread);
        assert_ne!(of(0.8), spread);
    }
}
