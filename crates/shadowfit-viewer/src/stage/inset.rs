//! The shadow map in a corner of the picture.

use glam::Vec3;
use shadowfit::{Aabb, LightFit};
use shadowfit_render::Inset;

/// Width of a picture, in pixels, from which on the inset has its full size; smaller pictures have a smaller one.
const FULL_WIDTH: f32 = 960.0;
/// Full size of the inset, in pixels.
const SIZE: [f32; 2] = [300.0, 200.0];
/// Distance of the inset from the picture's corner, in pixels, at full size.
const MARGIN: f32 = 12.0;

/// A map in the lower left corner of a picture of `size` pixels, with the depths of the scene stretched to grey.
pub(super) fn inset(map: usize, fit: &LightFit, bounds: &Aabb, size: [u32; 2]) -> Inset {
    let scale = (size[0] as f32 / FULL_WIDTH).min(1.0);
    let [width, height] = SIZE.map(|side| (side * scale).round());
    let margin = (MARGIN * scale).round();
    let depths = corners(bounds)
        .map(|corner| fit.uv_from_world.transform_point3((corner.as_dvec3() - fit.origin).as_vec3()).z.clamp(0.0, 1.0));
    let low = depths.iter().copied().fold(1.0, f32::min);
    let high = depths.iter().copied().fold(0.0, f32::max);
    Inset {
        rectangle: [margin, size[1] as f32 - height - margin, width, height],
        depth_range: if low < high { [low, high] } else { [0.0, 1.0] },
        map: map as u32,
    }
}

fn corners(bounds: &Aabb) -> [Vec3; 8] {
    core::array::from_fn(|index| {
        let pick = |bit: usize, low: f32, high: f32| if index >> bit & 1 == 0 { low } else { high };
        Vec3::new(
            pick(0, bounds.min.x, bounds.max.x),
            pick(1, bounds.min.y, bounds.max.y),
            pick(2, bounds.min.z, bounds.max.z),
        )
    })
}
