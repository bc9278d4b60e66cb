//! Selection of the map that a point reads.

use proptest::prelude::*;
use shadowfit::glam::{DVec2, DVec3, Vec2};
use shadowfit::selection::{DepthRange, MapBlend, MapOrder, MapRead, by_coverage, by_view_depth};
use shadowfit::settings::{MAX_MAPS, MapSelection};
use shadowfit::{FitInput, FitState, FittedMaps, LightProjection, PRESETS, Scratch, Technique};

use crate::scenes::{any_light, any_technique, any_view};
use crate::support::{DIRECTION, camera, cases, double, float, read_by};

fn alone(map: usize) -> MapRead {
    MapRead { map, blend: None }
}

fn blended(map: usize, other: usize, weight: f64) -> MapRead {
    MapRead { map, blend: Some(MapBlend { map: other, weight }) }
}

/// Returns the maps that are read, given the free texels around the point in each map, finest first. Reach 3,
/// blend 8.
fn read(free: &[Option<f64>]) -> Option<MapRead> {
    by_coverage(0..free.len(), 3.0, 8.0, |map| free[map])
}

#[test]
fn the_finest_map_that_holds_a_point_with_the_filter_is_read() {
    assert_eq!(read(&[Some(20.0), Some(50.0)]), Some(alone(0)));
    assert_eq!(read(&[None, Some(50.0), Some(90.0)]), Some(alone(1)));
    assert_eq!(read(&[Some(2.9), Some(50.0)]), Some(alone(1)));
    assert_eq!(by_coverage([2, 0, 1], 3.0, 0.0, |_| Some(9.0)), Some(alone(2)));
}

#[test]
fn toward_its_border_a_map_gives_way_to_the_next_one_that_holds_the_point() {
    assert_eq!(read(&[Some(11.0), Some(50.0)]), Some(alone(0)));
    assert_eq!(read(&[Some(9.0), Some(50.0)]), Some(blended(0, 1, 0.25)));
    assert_eq!(read(&[Some(3.0), Some(50.0)]), Some(blended(0, 1, 1.0)));
    // Maps without room for the filter are skipped, and the second map is not blended again.
    assert_eq!(read(&[Some(5.0), Some(2.0), None, Some(4.0), Some(50.0)]), Some(blended(0, 3, 0.75)));
    assert_eq!(read(&[Some(5.0), Some(2.0), None]), Some(alone(0)));
    assert_eq!(by_coverage(0..2, 3.0, 0.0, |_| Some(3.0)), Some(alone(0)));
}

#[test]
fn where_the_filter_fits_nowhere_it_is_clamped_to_the_finest_map_that_holds_the_point() {
    assert_eq!(read(&[None, Some(1.0), Some(2.0)]), Some(alone(1)));
    assert_eq!(read(&[None, None]), None);
    assert_eq!(read(&[]), None);
}

#[test]
fn by_view_depth_the_first_map_that_ends_behind_a_point_and_holds_it_is_read() {
    let ends = [Some(10.0), Some(20.0), None];
    let at = |depth: f64, held: [bool; 3]| {
        let ranges = ends.map(|far| Some(DepthRange::new(0.0, far)));
        by_view_depth(ranges, depth, |map| held[map])
    };
    assert_eq!([5.0, 10.0, 20.0].map(|depth| at(depth, [true; 3])), [Some(alone(0)), Some(alone(1)), Some(alone(2))]);
    assert_eq!(at(5.0, [false, false, true]), Some(alone(2)));
    assert_eq!(at(15.0, [true, false, false]), None);
    assert_eq!(at(f64::NAN, [true; 3]), None);
}

#[test]
fn by_view_depth_maps_are_blended_where_they_overlap() {
    let at = |depth: f64, holds_next: bool| {
        let ranges = [(0.0, Some(10.0)), (8.0, Some(20.0)), (20.0, None)];
        let ranges =
            ranges.map(|(start, far)| Some(DepthRange { covered_from: Some(start), ..DepthRange::new(start, far) }));
        by_view_depth(ranges, depth, |map| map != 1 || holds_next)
    };
    assert_eq!([7.0, 8.0].map(|depth| at(depth, true)), [Some(alone(0)); 2]);
    assert_eq!(at(9.5, true), Some(blended(0, 1, 0.75)));
    assert_eq!(at(9.5, false), Some(alone(0)));
    assert_eq!(at(19.9, true), Some(alone(1)));
}

#[test]
fn the_map_that_weighs_more_is_the_first_one_unless_the_second_has_more_than_half() {
    let main = |weight: f64| blended(3, 5, weight).main();
    assert_eq!([0.0, 0.5, 0.51, 1.0].map(main), [3, 3, 5, 5]);
}

#[test]
fn the_order_has_no_more_than_the_greatest_number_of_maps() {
    let maps = [LightProjection::default(); MAX_MAPS + 1];
    for selection in [MapSelection::default(), MapSelection::ViewDepth { overlap: 0.0 }] {
        assert!(MapOrder::new(selection, &maps).iter().eq(0..MAX_MAPS));
    }
}

proptest! {
    #[test]
    fn the_order_is_that_of_areas_and_then_of_indices(sides in prop::collection::vec((1_u8..4, 1_u8..4), 0..9)) {
        let texel_size = |(x, y)| Vec2::new(f32::from(x), f32::from(y));
        let maps: Vec<LightProjection> =
            sides.iter().map(|side| LightProjection { texel_size: texel_size(*side), ..LightProjection::default() }).collect();
        let mut wanted: Vec<usize> = (0..maps.len()).collect();
        wanted.sort_by_key(|map| u32::from(sides[*map].0) * u32::from(sides[*map].1));
        prop_assert!(MapOrder::new(MapSelection::default(), &maps).iter().eq(wanted));
    }
}

fn fitted(technique: &Technique, input: &FitInput) -> FittedMaps {
    let mut storage = vec![DVec2::ZERO; Scratch::required(0, 1)];
    FitState::new().fit(input, technique, &mut Scratch::new(&mut storage)).expect("a fit")
}

#[test]
fn free_texels_are_counted_from_the_nearest_side() {
    let camera = camera();
    let fit = shadowfit::fit(&camera.frustum().expect("a view"), DIRECTION, &Default::default()).expect("a fit");
    let (size, texel) = (fit.resolution.as_dvec2(), fit.texel_size.as_dvec2());
    let axis = |row: usize| fit.light_from_world.row(row).truncate().as_dvec3();
    let [near_left, .., far_right, _] = fit.corners().map(|corner| fit.origin + corner.as_dvec3());
    let middle = (near_left + far_right) * 0.5;
    for (texels, expected) in [
        (DVec2::ZERO, Some(size.min_element() * 0.5)),
        (DVec2::new(size.x * 0.5 - 7.0, 3.0), Some(7.0)),
        (DVec2::new(3.0, size.y * -0.5 + 2.5), Some(2.5)),
        (DVec2::new(0.0, size.y * 0.5 + 0.5), None),
    ] {
        let free = fit.texels_to_edge(middle + axis(0) * (texels.x * texel.x) + axis(1) * (texels.y * texel.y));
        // f32 rows of the matrix, 4 roundings of 2⁻²⁴ of half of a map of 2048 texels.
        let is_near = match (free, expected) {
            (Some(free), Some(expected)) => (free - expected).abs() < 1e-3,
            (free, expected) => free == expected,
        };
        assert!(is_near, "{free:?} instead of {expected:?} at {texels}");
    }
    assert_eq!(fit.texels_to_edge(DVec3::NAN), None);
}

#[test]
fn no_map_is_read_beyond_the_shadow_distance() {
    let camera = camera();
    let views = [camera.frustum().expect("a camera")];
    let mut reaching_beyond = 0;
    for preset in &PRESETS {
        let technique = preset.technique().with_max_distance(40.0);
        let maps = fitted(&technique, &FitInput::new(&views, DIRECTION));
        let read = |depth: f64| {
            let point = camera.eye + camera.forward.as_dvec3().normalize() * depth;
            (maps.read(&technique, point, depth), maps.iter().any(|map| map.projection.covers(point)))
        };
        assert!(read(39.9).0.is_some(), "{}", preset.name);
        let (beyond, is_covered) = read(40.1);
        assert_eq!(beyond, None, "{}", preset.name);
        reaching_beyond += usize::from(is_covered);
    }
    assert!(reaching_beyond > 0, "the distance decides, not the maps' borders");
}

proptest! {
    #![proptest_config(cases(500))]

    /// Checks against an independent implementation of the definition: maps sorted by area, first all that
    /// contain the point with the filter's footprint, then all that contain the point.
    #[test]
    fn fitted_maps_are_read_by_the_definition(
        view in any_view(), direction in any_light(), technique in any_technique(), blend in float(0.0, 64.0),
        places in prop::collection::vec((double(0.0, 1.0), double(0.0, 1.0), double(0.0, 1.0)), 20),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let views = [view.frustum()];
        let technique = read_by(&technique, MapSelection::Coverage { blend });
        let maps = fitted(&technique, &FitInput::new(&views, direction));
        let mut sorted: Vec<usize> = (0..maps.len()).filter(|map| !maps[*map].projection.is_empty).collect();
        let area = |map: usize| f64::from(maps[map].projection.texel_size.x) * f64::from(maps[map].projection.texel_size.y);
        sorted.sort_by(|a, b| area(*a).total_cmp(&area(*b)));
        let corners = views[0].corners.map(|corner| views[0].origin + corner.as_dvec3());
        for (u, v, w) in places {
            let across = |side: usize| corners[side].lerp(corners[side + 1], u).lerp(corners[side + 3].lerp(corners[side + 2], u), v);
            let point = across(0).lerp(across(4), w);
            let free = |map: usize| maps[map].projection.texels_to_edge(point);
            let needed = f64::from(technique.filter_radius());
            let roomy: Vec<usize> =
                sorted.iter().copied().filter(|map| free(*map).is_some_and(|free| free >= needed)).collect();
            let clamped = sorted.iter().copied().find(|map| free(*map).is_some());
            let read = maps.read(&technique, point, 1.0);
            prop_assert_eq!(read.map(|read| read.map), roomy.first().copied().or(clamped));
            let Some((first, others)) = roomy.split_first() else { continue };
            let weight = (free(*first).unwrap_or(0.0) - needed) / f64::from(blend);
            let second = others.first().filter(|_| weight < 1.0);
            prop_assert_eq!(read.and_then(|read| read.blend).map(|blend| blend.map), second.copied());
            let by_depth = read_by(&technique, MapSelection::ViewDepth { overlap: 0.0 });
            let by_depth = maps.read(&by_depth, point, f64::from(views[0].near));
            prop_assert!(by_depth.is_none_or(|read| maps[read.map].projection.covers(point)));
        }
    }
}
