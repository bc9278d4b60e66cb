//! Ray-traced ambient occlusion: the reference for what screen-space ambient occlusion guesses.
//!
//! From each visible point, rays go into the hemisphere over its surface. What they meet nearby hides that much of the
//! ambient light, the less the farther away it is.

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::PixelCamera;
use crate::seen::seen_point;
use crate::spiral;
use crate::tracer::Tracer;

/// How ambient occlusion is traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientSettings {
    /// Rays of a pixel; 0 counts as 1. Default: 32.
    pub rays: u32,
    /// Distance from which on nothing is hidden, in metres: occlusion falls linearly to 0 there. Default: 1.
    pub distance: f64,
    /// Rays start this far along the geometric normal, in metres. Default: 0.001.
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
    /// How it was traced.
    pub settings: AmbientSettings,
    /// Share of the ambient light that is hidden at each pixel, 0..=1, rows from the top; `None` for the sky, and for a
    /// triangle without area, which has no normal.
    pub occlusion: Vec<Option<f32>>,
}

impl AmbientTruth {
    /// Traces the ambient occlusion of a picture: the mean, over rays that are spread evenly by the cosine to the
    /// geometric normal on the side of the eye, of 1 - d / [`AmbientSettings::distance`] for a ray that meets a triangle
    /// at a distance d below that, and of 0 for one that does not. The rays are the same each time, and turned from
    /// pixel to pixel. Cut-outs and the alpha test hold for these rays too.
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

    /// Mean over the pixels that have a truth of how far a picture's occlusion is from it, 0..=1; `None` where no pixel
    /// has one. `occlusion` is the share of the ambient light that the picture hides at each pixel, rows from the top;
    /// one out of 0..=1 is clamped, and one that is not a number is wrong by 1.
    ///
    /// # Panics
    ///
    /// If `occlusion` does not have one element for each pixel.
    pub fn mean_absolute_error(&self, occlusion: &[f32]) -> Option<f64> {
        assert_eq!(occlusion.len(), self.occlusion.len(), "as many values as pixels");
        let both = self.occlusion.iter().zip(occlusion).filter_map(|(truth, picture)| Some(((*truth)?, *picture)));
        let error = |(truth, picture): (f32, f32)| {
            if picture.is_nan() { 1.0 } else { f64::from((picture.clamp(0.0, 1.0) - truth).abs()) }
        };
        let (sum, count) = both.map(error).fold((0.0, 0u32), |(sum, count), error| (sum + error, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    }
}

/// Share of the ambient light that is hidden from a point.
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

/// Unit directions over a surface whose density is that of the cosine to its normal, of a spiral that is turned by
/// `turn` radians.
fn directions(normal: DVec3, rays: u32, turn: f64) -> impl Iterator<Item = DVec3> {
    let (first, second) = normal.any_orthonormal_pair();
    (0..rays).map(move |ray| {
        // Even on the disc below the hemisphere is by the cosine on the hemisphere (Malley's method).
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
        // With the density cos/π the mean cosine is the integral of 2 cos² sin = 2/3, and none to the side.
        let mean = spread.iter().sum::<DVec3>() / 1000.0;
        assert!(mean.abs_diff_eq(normal * (2.0 / 3.0), 2e-3), "{mean}");
        // The share within an angle is sin² of it: half of them within 45 degrees.
        let half = spread.iter().filter(|d| d.dot(normal) > 0.5f64.sqrt()).count();
        assert!(half.abs_diff(500) <= 1, "{half}");
        assert_eq!(of(0.7), spread);
        assert_ne!(of(0.8), spread);
    }
}
