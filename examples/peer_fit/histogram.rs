//! What a depth buffer of the frame before would tell: rays against the triangles stand in for it.

use glam::DVec3;
use shadowfit::{DepthHistogram, needed_texel};
use shadowfit_truth::Tracer;
use shadowfit_truth::peers::Frame;

/// Rays across the picture.
const COLUMNS: u32 = 64;
/// Rays down the picture.
const ROWS: u32 = 36;
/// Bins at even steps of log view depth between the near and the far plane.
const DEPTHS: usize = 128;
/// Octaves of foreshortening that are told apart.
pub(crate) const CLASSES: usize = 6;

/// Counts of what is visible in a frame and faces the light.
pub(crate) fn of_frame(frame: &Frame, tracer: &Tracer) -> Vec<u32> {
    let world_from_view = frame.view_from_world().inverse();
    let [right, up, back] = [0, 1, 2].map(|axis| world_from_view.col(axis).truncate());
    let eye = world_from_view.col(3).truncate();
    let (tan_y, tan_x) = (frame.tan_half_fov(), frame.tan_half_fov() * frame.aspect);
    let direction = DVec3::from_array(frame.light_dir);
    let mut bins = vec![0; DEPTHS * CLASSES];
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let x = (2.0 * (f64::from(column) + 0.5) / f64::from(COLUMNS) - 1.0) * tan_x;
            let y = (1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(ROWS)) * tan_y;
            let ray: DVec3 = right * x + up * y - back;
            let Some(hit) = tracer.first_hit(eye.as_vec3(), ray.as_vec3()) else { continue };
            let normal = tracer.normal(hit.triangle).as_dvec3();
            if normal.dot(ray) * normal.dot(direction) <= 0.0 {
                continue;
            }
            // One metre across the picture at a depth of one metre, moved along the surface.
            let slide = |across: DVec3| (across - ray * (across.dot(normal) / ray.dot(normal))).as_vec3();
            let texel = needed_texel(slide(right), slide(-up), direction.as_vec3());
            let class = -texel.log2();
            let (near, far) = (frame.near as f32, frame.far as f32);
            if let Some(bin) = DepthHistogram::bin(near, far, DEPTHS, CLASSES, hit.distance, class) {
                bins[bin] += 1;
            }
        }
    }
    bins
}
