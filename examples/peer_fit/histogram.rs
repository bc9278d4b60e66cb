//! What a depth buffer of the frame before would tell: rays against the triangles stand in for it.

use glam::DVec3;
use shadowfit_truth::Tracer;
use shadowfit_truth::peers::Frame;

/// Rays across the picture.
const COLUMNS: u32 = 64;
/// Rays down the picture.
const ROWS: u32 = 36;
/// Bins at even steps of log view depth between the near and the far plane.
const BINS: usize = 128;

/// Counts of visible view depths of a frame.
pub(crate) fn of_frame(frame: &Frame, tracer: &Tracer) -> Vec<u32> {
    let world_from_view = frame.view_from_world().inverse();
    let [right, up, back] = [0, 1, 2].map(|axis| world_from_view.col(axis).truncate());
    let eye = world_from_view.col(3).truncate();
    let (tan_y, tan_x) = (frame.tan_half_fov(), frame.tan_half_fov() * frame.aspect);
    let mut bins = vec![0; BINS];
    let octaves = (frame.far / frame.near).log2();
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let x = (2.0 * (f64::from(column) + 0.5) / f64::from(COLUMNS) - 1.0) * tan_x;
            let y = (1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(ROWS)) * tan_y;
            let ray: DVec3 = right * x + up * y - back;
            let Some(hit) = tracer.first_hit(eye.as_vec3(), ray.as_vec3()) else { continue };
            let depth = f64::from(hit.distance);
            if depth > frame.near && depth < frame.far {
                let bin = (depth / frame.near).log2() / octaves * BINS as f64;
                bins[(bin as usize).min(BINS - 1)] += 1;
            }
        }
    }
    bins
}
