//! Uniform of the edge passes, and the start points of a pixel's rays.

use bytemuck::{Pod, Zeroable};
use shadowfit::settings::Edges;

use crate::wgsl::in_disc;

/// Maximum number of points per pixel.
pub(super) const MAX_POINTS: usize = Edges::MAX_SAMPLES as usize;
/// Maximum number of boxes around unknown casters.
pub(super) const MAX_UNKNOWN: usize = 64;

/// Position of WebGPU's first sample of four relative to the pixel's centre, in pixels.
const FIRST_OF_FOUR: [f32; 2] = [-0.125, -0.375];

/// Four points with different rows and columns, so that each edge that crosses the pixel has steps of a
/// quarter.
const ROTATED_GRID: [[f32; 2]; 4] = [[-0.125, -0.375], [0.375, -0.125], [-0.375, 0.125], [0.125, 0.375]];

/// Uniform of the passes: `Edges` in WGSL, where the fields are explained.
#[allow(missing_docs)]
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct EdgeUniform {
    pub world_from_pixel: [[f32; 4]; 4],
    pub eye: [f32; 3],
    pub far_depth: f32,
    pub forward: [f32; 3],
    pub ray_offset: f32,
    pub corner: [u32; 2],
    pub size: [u32; 2],
    pub depth_rounding: [f32; 2],
    pub point_reach: f32,
    pub unsure_maps: u32,
    pub sun_tangent: f32,
    pub vertex_rounding: f32,
    pub padding_1: u32,
    pub padding_2: u32,
    pub points: [[f32; 4]; MAX_POINTS],
    pub unknown: [UnknownUniform; MAX_UNKNOWN],
}

/// Box around casters that the maps or the rays lack: `Unknown` in WGSL.
#[allow(missing_docs)]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct UnknownUniform {
    pub least: [f32; 3],
    pub maps: u32,
    pub most: [f32; 3],
    pub is_filtered: u32,
}

/// Returns the points of a pixel relative to its first sample, in pixels, and their greatest distance across
/// or down. With a soft sun all rays start from that sample. `samples` is the number of samples of the depth
/// buffer per pixel.
pub(super) fn points(count: u32, samples: u32, is_soft: bool) -> ([[f32; 4]; MAX_POINTS], f32) {
    let mut points = [[0.0; 4]; MAX_POINTS];
    let first = if samples > 1 { FIRST_OF_FOUR } else { [0.0; 2] };
    let mut reach = 0.0_f32;
    for (index, point) in (0..count).zip(&mut points) {
        // Penumbrae need no antialiasing.
        let [x, y] = if is_soft { first } else { from_centre(index, count) };
        let [across, down] = if is_soft { in_disc(index, count) } else { [0.0; 2] };
        *point = [x - first[0], y - first[1], across, down];
        reach = reach.max(point[0].abs()).max(point[1].abs());
    }
    (points, reach)
}

/// Returns one of several points of a pixel relative to its centre, in pixels. A single point is the centre,
/// and four points form a rotated grid. Any other number of points has equal steps down, and the bit-reversed
/// rows as columns (J. Hammersley, "Monte Carlo methods for solving multivariable problems", 1960).
fn from_centre(index: u32, count: u32) -> [f32; 2] {
    match count {
        1 => [0.0; 2],
        4 => ROTATED_GRID[index as usize],
        _ => {
            let column = f64::from(index.reverse_bits()) / f64::from(u32::MAX);
            [column as f32 - 0.5, (index as f32 + 0.5) / count as f32 - 0.5]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_in_the_pixel_and_their_mean_is_its_centre() {
        for count in 1..=Edges::MAX_SAMPLES {
            let all: Vec<[f32; 2]> = (0..count).map(|index| from_centre(index, count)).collect();
            assert!(all.iter().flatten().all(|place| place.abs() <= 0.5), "{count}: {all:?}");
            let mean = |axis: usize| all.iter().map(|point| point[axis]).sum::<f32>() / count as f32;
            let most = if count == 4 || count == 1 { 1e-6 } else { 0.5 / (count as f32).sqrt() };
            assert!(mean(0).abs() <= most && mean(1).abs() <= most, "{count}: {} {}", mean(0), mean(1));
        }
    }

    #[test]
    fn points_are_counted_from_the_first_sample_of_the_depth_buffer() {
        let (points, reach) = points(4, 4, false);
        assert_eq!((points[0], reach), ([0.0; 4], 0.75));
        assert_eq!(super::points(1, 1, false), ([[0.0; 4]; MAX_POINTS], 0.0));
    }
}
