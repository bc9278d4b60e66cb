//! What a depth buffer of the frame before would show, found by rays against the triangles.

use glam::{DVec3, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit::histogram::{DepthHistogram, needed_texel};
use shadowfit_truth::Tracer;

/// Rays across the picture.
const COLUMNS: u32 = 64;
/// Rays down the picture.
const ROWS: u32 = 36;
/// Bins at even steps of log view depth between the near and the far plane.
const DEPTHS: usize = 128;
/// Octaves of foreshortening that are told apart.
const CLASSES: usize = 6;

/// Counts of what a camera sees that faces the light.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenDepths {
    near: f32,
    far: f32,
    bins: Vec<u32>,
}

impl SeenDepths {
    /// Counts by rays. `direction` is the light's direction of travel in world axes.
    pub fn trace(tracer: &Tracer, camera: &PerspectiveCamera, direction: Vec3) -> Self {
        let world_from_view = camera.view_from_world().inverse();
        let [right, up, back] = [world_from_view.x_axis, world_from_view.y_axis, world_from_view.z_axis]
            .map(|axis| axis.truncate().as_dvec3());
        let tan_y = (f64::from(camera.fov_y) * 0.5).tan();
        let tan_x = tan_y * f64::from(camera.aspect);
        let mut bins = vec![0; DEPTHS * CLASSES];
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let x = (2.0 * (f64::from(column) + 0.5) / f64::from(COLUMNS) - 1.0) * tan_x;
                let y = (1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(ROWS)) * tan_y;
                let ray: DVec3 = right * x + up * y - back;
                let Some(hit) = tracer.first_hit(camera.eye.as_vec3(), ray.as_vec3()) else { continue };
                let normal = tracer.normal(hit.triangle).as_dvec3();
                if normal.dot(ray) * normal.dot(direction.as_dvec3()) <= 0.0 {
                    continue;
                }
                // One metre across the picture at a depth of one metre, moved along the surface.
                let slide = |across: DVec3| (across - ray * (across.dot(normal) / ray.dot(normal))).as_vec3();
                let texel = needed_texel(slide(right), slide(-up), direction);
                let class = -texel.log2();
                let bin = DepthHistogram::bin(camera.near, camera.far, DEPTHS, CLASSES, hit.distance, class);
                if let Some(bin) = bin {
                    bins[bin] += 1;
                }
            }
        }
        Self { near: camera.near, far: camera.far, bins }
    }

    /// As fits take it.
    pub fn histogram(&self) -> DepthHistogram<'_> {
        DepthHistogram { near: self.near, far: self.far, bins: &self.bins, classes: CLASSES }
    }
}
