//! Shadow maps in a corner of the picture.

use std::ops::Range;

use glam::Vec3;
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, FittedMap, LightProjection};
use shadowfit_params::figures::linear_map_tints;
use shadowfit_render::Inset;

/// Least width of a picture with full-size insets, in pixels. Smaller pictures have smaller insets.
const FULL_WIDTH: f32 = 960.0;
/// Full size of an inset, in pixels.
const SIZE: [f32; 2] = [300.0, 200.0];
/// Distance of insets from the picture's corner and from each other, in pixels, at full size.
const MARGIN: f32 = 12.0;
/// Free height above several insets, as a share of the picture's height.
const FREE: f32 = 0.12;

/// Number of lines along the light, from side to side of a map, at which its depths are measured.
const LINES: u8 = 9;

/// Returns maps in the lower left corner of a picture of `size` pixels, right of the column `left`, the first
/// map lowest. `depth_range` are the stored depths shown as black and white; `None` for the depth range of
/// the scene.
pub(super) fn insets(
    shown: Range<usize>,
    maps: &[FittedMap],
    bounds: &Aabb,
    depth_range: Option<[f32; 2]>,
    left: u32,
    size: [u32; 2],
) -> Vec<Inset> {
    let picture = size.map(|side| side as f32);
    let scale = (picture[0] / FULL_WIDTH).min(1.0);
    let margin = (MARGIN * scale).round();
    // Several insets share the available height.
    let room = (picture[1] * (1.0 - FREE) - margin) / shown.len().max(1) as f32 - margin;
    let height = (SIZE[1] * scale).round().min(room.floor()).max(1.0);
    let width = (height * SIZE[0] / SIZE[1]).round();
    let inset = |(place, index): (usize, usize)| {
        let map: &FittedMap = maps.get(index)?;
        let top = picture[1] - (place + 1) as f32 * (height + margin);
        let depth_range = depth_range.or_else(|| depths(&map.projection, bounds)).unwrap_or([0.0, 1.0]);
        Some(Inset {
            rectangle: [left as f32 + margin, top, width, height],
            depth_range,
            map: index as u32,
            border: tint(index),
        })
    };
    shown.enumerate().filter_map(inset).collect()
}

/// Returns the linear colour of a map's frame.
pub(super) fn tint(map: usize) -> Vec3 {
    linear_map_tints()[map % MAX_MAPS]
}

/// Returns the least and the greatest depth of the scene's box within a map. A window is deep, and the scene
/// fills little of it.
pub(super) fn depths(fit: &LightProjection, bounds: &Aabb) -> Option<[f32; 2]> {
    let world_from_uv = fit.uv_from_world.inverse();
    let [min, max] = [bounds.min, bounds.max].map(|corner| (corner.as_dvec3() - fit.origin).as_vec3());
    let place = |line: u8| f32::from(line) / f32::from(LINES - 1);
    let mut range = [1.0_f32, 0.0];
    for (u, v) in (0..LINES).flat_map(|u| (0..LINES).map(move |v| (place(u), place(v)))) {
        let [from, to] = [0.0, 1.0].map(|depth| world_from_uv.transform_point3(Vec3::new(u, v, depth)));
        // The part of the line between each pair of the box's faces. For a line parallel to a pair, this is
        // everything or nothing.
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
    use shadowfit::FittedMap;

    use super::*;

    #[test]
    fn any_number_of_maps_fits_into_the_picture_without_touching() {
        let maps = vec![FittedMap::default(); MAX_MAPS];
        let bounds = Aabb::new(Vec3::ZERO, Vec3::ONE);
        for count in 1..=MAX_MAPS {
            for size in [[960, 540], [320, 180], [1280, 300]] {
                let insets = insets(0..count, &maps, &bounds, None, 0, size);
                assert_eq!(insets.len(), count);
                for pair in insets.windows(2) {
                    assert!(pair[1].rectangle[1] + pair[1].rectangle[3] < pair[0].rectangle[1], "{pair:?}");
                }
                assert!(insets.iter().all(|inset| inset.rectangle[1] > 0.0 && inset.rectangle[3] >= 1.0), "{insets:?}");
            }
        }
        let one = insets(3..4, &maps, &bounds, Some([0.25, 0.5]), 100, [960, 540]);
        assert_eq!((one[0].map, one[0].rectangle, one[0].depth_range), (3, [112.0, 328.0, 300.0, 200.0], [0.25, 0.5]));
    }

    #[test]
    fn grey_goes_over_the_scene_over_the_map_and_not_over_all_of_its_depth() {
        // Ten metres deep along -y from y = 8, one metre square across. The scene is flat and far wider.
        let uv_from_world = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -0.1, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.5, 0.5, 0.8, 1.0],
        ]);
        let origin = DVec3::new(100.0, 50.0, 0.0);
        let fit = LightProjection { origin, uv_from_world, ..LightProjection::default() };
        let bounds = Aabb::new(Vec3::new(60.0, 50.0, -40.0), Vec3::new(140.0, 54.0, 40.0));
        let [low, high] = depths(&fit, &bounds).expect("the map lies over the scene");
        assert!((low - 0.4).abs() < 1e-5 && (high - 0.8).abs() < 1e-5, "{low} to {high}");
        let beside = Aabb::new(Vec3::new(60.0, 50.0, 2.0), Vec3::new(140.0, 54.0, 40.0));
        assert_eq!(depths(&fit, &beside), None);
    }
}
