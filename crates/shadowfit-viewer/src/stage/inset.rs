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

/// Lines along the light, from side to side of a map, on which its depths are looked at.
const LINES: u8 = 9;

/// A map in the lower left corner of a picture of `size` pixels, with the depths of the scene over it stretched to grey.
pub(super) fn inset(map: usize, fit: &LightFit, bounds: &Aabb, size: [u32; 2]) -> Inset {
    let scale = (size[0] as f32 / FULL_WIDTH).min(1.0);
    let [width, height] = SIZE.map(|side| (side * scale).round());
    let margin = (MARGIN * scale).round();
    Inset {
        rectangle: [margin, size[1] as f32 - height - margin, width, height],
        depth_range: depths(fit, bounds).unwrap_or([0.0, 1.0]),
        map: map as u32,
        border: Inset::BORDER,
    }
}

/// Least and greatest depth of a map at which the scene's box lies over it: a window is deep, and holds little of that.
fn depths(fit: &LightFit, bounds: &Aabb) -> Option<[f32; 2]> {
    let world_from_uv = fit.uv_from_world.inverse();
    let [min, max] = [bounds.min, bounds.max].map(|corner| (corner.as_dvec3() - fit.origin).as_vec3());
    let place = |line: u8| f32::from(line) / f32::from(LINES - 1);
    let mut range = [1.0_f32, 0.0];
    for (u, v) in (0..LINES).flat_map(|u| (0..LINES).map(move |v| (place(u), place(v)))) {
        let [from, to] = [0.0, 1.0].map(|depth| world_from_uv.transform_point3(Vec3::new(u, v, depth)));
        // Where the line is between each pair of the box's faces; of a line along a face that is everywhere or nowhere.
        let (a, b) = ((min - from) / (to - from), (max - from) / (to - from));
        let (enter, leave) = (a.min(b).max_element().max(0.0), a.max(b).min_element().min(1.0));
        if enter <= leave {
            range = [range[0].min(enter), range[1].max(leave)];
        }
    }
    (range[0] < range[1]).then_some(range)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Mat4};

    use super::*;

    #[test]
    fn grey_goes_over_the_scene_over_the_map_and_not_over_all_of_its_depth() {
        // Ten metres deep along -y from y = 8 on, a square metre across; the scene is flat and far wider.
        let uv_from_world = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -0.1, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.5, 0.5, 0.8, 1.0],
        ]);
        let origin = DVec3::new(100.0, 50.0, 0.0);
        let fit = LightFit { origin, uv_from_world, ..LightFit::default() };
        let bounds = Aabb::new(Vec3::new(60.0, 50.0, -40.0), Vec3::new(140.0, 54.0, 40.0));
        let [low, high] = depths(&fit, &bounds).expect("the map lies over the scene");
        assert!((low - 0.4).abs() < 1e-5 && (high - 0.8).abs() < 1e-5, "{low} to {high}");
        let beside = Aabb::new(Vec3::new(60.0, 50.0, 2.0), Vec3::new(140.0, 54.0, 40.0));
        assert_eq!(depths(&fit, &beside), None);
    }
}
