//! Several maps of one view: their selection, maps that are smaller than their layers, and casters at any
//! bind group.

use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::selection::{DepthRange, MapOrder, MapRead, by_coverage, by_view_depth};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, FitSettings, MapSelection};
use shadowfit::{Bias, FittedMap, LightProjection, PerspectiveCamera, fit};
use shadowfit_wgpu::{MAX_MAPS, MapView, ShadowMapDescriptor};

use super::engine::Engine;
use super::engine::points::Point;
use super::harness::{Harness, Selection};

const NO_BIAS: BiasSettings =
    BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
/// Direction of travel of the light.
const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.2);

/// Returns a map for the first `distance` metres of a view along -z.
fn map_to(distance: f32, texels: u32) -> LightProjection {
    let camera = PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 200.0,
    };
    let settings = FitSettings::default()
        .with_kind(FitKind::FrustumAabb)
        .with_max_distance(distance)
        .with_resolution(UVec2::splat(texels));
    fit(&camera.frustum().expect("a camera"), DIRECTION, &settings).expect("a fit")
}

/// Returns a triangle that shadows the whole map, at the near plane.
fn lid(fit: &LightProjection) -> Vec<Vec3> {
    let c = fit.corners();
    let down = (c[4] - c[0]) * 0.01;
    let (corner, right, below) = (c[0] + down, c[1] - c[0], c[3] - c[0]);
    let start = corner - right - below;
    vec![start, start + right * 5.0, start + below * 5.0]
}

/// Returns a map without biases that ends at a view depth.
fn map_fit(fit: &LightProjection, far: f32) -> FittedMap {
    FittedMap::new(*fit, Bias::default()).with_depths(DepthRange::new(0.0, Some(far.into())))
}

/// Returns the view depth at which a map ends, in metres.
fn end(map: &FittedMap) -> f64 {
    map.depths.and_then(|range| range.far).expect("it ends")
}

fn descriptor(maps: &[FittedMap]) -> ShadowMapDescriptor {
    ShadowMapDescriptor {
        resolution: [256; 2],
        maps: maps.len() as u32,
        filter: FilterKind::Point,
        selection: MapSelection::ViewDepth { overlap: 0.0 },
        ..ShadowMapDescriptor::default()
    }
}

/// Returns points of level ground, relative to the origin.
fn ground(points: &[Vec3]) -> Vec<Point> {
    points.iter().map(|point| Point { position: point.to_array(), normal: [0.0, 1.0, 0.0] }).collect()
}

/// Returns casters that cover one of the maps.
fn lids(maps: &[FittedMap], shadowed: usize) -> Vec<Vec<Vec3>> {
    maps.iter().enumerate().map(|(i, map)| if i == shadowed { lid(&map.projection) } else { Vec::new() }).collect()
}

fn ask(view: &MapView, maps: &[FittedMap], shadowed: usize, points: &[Vec3]) -> Vec<f32> {
    let gpu = Engine::shared();
    let harness = Harness::with_maps(&gpu, &descriptor(maps), view, maps, &lids(maps, shadowed));
    harness.ask(0, &ground(points)).iter().map(|answer| answer.factor).collect()
}

#[test]
fn a_point_reads_the_first_map_that_reaches_as_far_or_the_next_one_that_holds_it() {
    let fits = [map_to(5.0, 256), map_to(20.0, 256), map_to(60.0, 256)];
    let maps: Vec<FittedMap> = fits.iter().zip([4.0, 15.0, f32::MAX]).map(|(fit, far)| map_fit(fit, far)).collect();
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    // Points along the axis at these view depths. The last one is near, but beside the first map.
    let is_aside = |point: &Vec3| !fits[0].covers(point.as_dvec3()) && fits[1].covers(point.as_dvec3());
    let aside = (1..200).map(|step| Vec3::new(step as f32 * 0.1, 0.0, -3.0)).find(is_aside).expect("a point aside");
    let points = [2.0_f32, 3.9, 4.1, 10.0, 14.9, 15.1, 40.0].map(|depth| Vec3::NEG_Z * depth);
    let points = [&points[..], &[aside]].concat();
    let read = [0, 0, 1, 1, 1, 2, 2, 1];
    for shadowed in 0..3 {
        let expected: Vec<f32> = read.iter().map(|map| if *map == shadowed { 0.0 } else { 1.0 }).collect();
        assert_eq!(ask(&view, &maps, shadowed, &points), expected, "shadow in map {shadowed}");
    }
    // From an eye 10 m farther back, every view depth is 10 m greater, with the same origin.
    let view = MapView { eye: DVec3::new(0.0, 0.0, 10.0), ..view };
    let read = [1, 1, 1, 2, 2, 2, 2, 1];
    for shadowed in 0..3 {
        let expected: Vec<f32> = read.iter().map(|map| if *map == shadowed { 0.0 } else { 1.0 }).collect();
        assert_eq!(ask(&view, &maps, shadowed, &points), expected, "from farther back, shadow in map {shadowed}");
    }
}

#[test]
fn as_many_maps_as_there_may_be_are_told_apart() {
    let fits: Vec<LightProjection> = (1..=MAX_MAPS).map(|i| map_to(i as f32 * 5.0, 256)).collect();
    let maps: Vec<FittedMap> = fits.iter().enumerate().map(|(i, fit)| map_fit(fit, (i + 1) as f32 * 5.0)).collect();
    let points: Vec<Vec3> = (0..MAX_MAPS).map(|i| Vec3::NEG_Z * (i as f32 * 5.0 + 2.5)).collect();
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    for shadowed in 0..MAX_MAPS {
        let expected: Vec<f32> = (0..MAX_MAPS).map(|map| if map == shadowed { 0.0 } else { 1.0 }).collect();
        assert_eq!(ask(&view, &maps, shadowed, &points), expected, "shadow in map {shadowed}");
    }
}

#[test]
fn a_map_in_the_corner_of_a_larger_layer_is_read_like_one_that_fills_it() {
    let gpu = Engine::shared();
    let fit = map_to(20.0, 256);
    let half = {
        let c = fit.corners();
        let middle = |i: usize| (c[i] + c[i + 4]) * 0.5;
        vec![middle(0), middle(1), middle(3)]
    };
    let corners = fit.corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    // Rows of points across the map, up to its border, behind the caster.
    let points: Vec<Point> = (0..64 * 64)
        .map(|i| {
            let at = [i % 64, i / 64].map(|step| (step as f32 + 0.25) / 64.0);
            let position = corners[0] + right * at[0] + down * at[1] + away * 0.8;
            Point { position: position.to_array(), normal: (-fit.direction).to_array() }
        })
        .collect();
    for filter in FilterKind::ALL {
        let answers = [[256, 256], [512, 1024]].map(|resolution| {
            let descriptor = ShadowMapDescriptor { resolution, filter, ..ShadowMapDescriptor::default() };
            let harness = Harness::new(&gpu, &descriptor, DVec3::ZERO, &[fit], &NO_BIAS, std::slice::from_ref(&half));
            harness.ask(0, &points).iter().map(|answer| answer.factor).collect::<Vec<f32>>()
        });
        let shadowed = answers[0].iter().filter(|factor| **factor < 0.5).count();
        assert!((1500..2700).contains(&shadowed), "{filter:?}: {shadowed} of {} points in shadow", points.len());
        let [full, corner] = &answers;
        // Texture coordinates for another size are rounded differently.
        let differ: Vec<_> = (0..points.len()).filter(|index| (full[*index] - corner[*index]).abs() >= 0.02).collect();
        let shown = differ.iter().take(3).map(|index| (points[*index], full[*index], corner[*index]));
        assert!(differ.is_empty(), "{filter:?}: {} points differ, as {:?}", differ.len(), shown.collect::<Vec<_>>());
    }
}

#[test]
fn the_map_index_and_the_view_depth_in_wgsl_are_those_computed_here() {
    let gpu = Engine::shared();
    let forward = Vec3::new(0.25, -0.1, -1.0).normalize();
    let fits = [map_to(5.0, 256), map_to(20.0, 256), map_to(60.0, 256)];
    let maps: Vec<FittedMap> = fits.iter().zip([4.0, 15.0, 50.0]).map(|(fit, far)| map_fit(fit, far)).collect();
    let (origin, eye) = (DVec3::new(1.0, -0.5, 2.0), DVec3::new(-0.5, 0.25, 1.0));
    let view = MapView { origin, eye, forward, frame: 0 };
    let harness = Harness::with_maps(&gpu, &descriptor(&maps), &view, &maps, &lids(&maps, 0));
    // In front of the eye and behind it, in view and out of view.
    let positions: Vec<Vec3> = (0..4000)
        .map(|i| {
            let [a, b, c] = [0.754_877_7, 0.569_840_3, 0.430_159_7].map(|step: f32| (i as f32 * step).fract());
            Vec3::new((a - 0.5) * 60.0, (b - 0.5) * 30.0, 15.0 - c * 90.0)
        })
        .collect();
    let mut met = [0; 4];
    for (position, Selection { map, view_depth }) in positions.iter().zip(harness.selections(&ground(&positions))) {
        let world = position.as_dvec3() + origin;
        let expected_depth = (world - eye).dot(forward.as_dvec3());
        // A dozen roundings of 2⁻²⁴ of coordinates below 100 m.
        assert!(
            (f64::from(view_depth) - expected_depth).abs() < 1e-4,
            "{position}: {view_depth}, not {expected_depth}"
        );
        let is_at_a_border = maps.iter().any(|map| {
            let near = |point: DVec3| map.projection.covers(point);
            (expected_depth - end(map)).abs() < 1e-3
                || [DVec3::X, DVec3::Y, DVec3::Z]
                    .iter()
                    .any(|axis| near(world + axis * 1e-3) != near(world - axis * 1e-3))
        });
        if !is_at_a_border {
            let reads = |map: &FittedMap| expected_depth < end(map) && map.projection.covers(world);
            let expected = maps.iter().position(reads).map_or(-1, |index| i32::try_from(index).expect("one of eight"));
            assert_eq!(map, expected, "{position} at view depth {expected_depth}");
            met[(expected + 1) as usize] += 1;
        }
    }
    assert!(met.iter().all(|count| *count > 15), "outside, then by map: {met:?}");
}

/// Returns maps whose order differs from the order of their texel sizes and of their widths. Two have the
/// same size, and one is empty.
fn crossing_maps() -> [FittedMap; 5] {
    let mut empty = map_to(4.0, 256);
    empty.is_empty = true;
    let fits = [map_to(60.0, 256), empty, map_to(8.0, 64), map_to(20.0, 200), map_to(8.0, 64)];
    fits.map(|fit| map_fit(&fit, f32::MAX))
}

/// Returns points all over the maps, relative to the origin.
fn scattered() -> Vec<Vec3> {
    let at = |i: u16| {
        let [a, b, c] = [0.754_877_7, 0.569_840_3, 0.430_159_7].map(|step: f32| (f32::from(i) * step).fract());
        let depth = 70.0 * c * c;
        Vec3::new((a - 0.5) * depth * 2.0, (b - 0.5) * depth, 1.0 - depth)
    };
    (0..6000).map(at).collect()
}

/// Asserts that the WGSL selects the map that `read` returns at each point, with the same weights. The
/// factors show the weights, with each map in shadow in turn. Returns the number of points that read each map
/// alone, and the number of blended points.
fn assert_read(
    descriptor: &ShadowMapDescriptor,
    maps: &[FittedMap],
    points: &[Vec3],
    read: impl Fn(DVec3) -> Option<MapRead>,
) -> (Vec<usize>, usize) {
    let gpu = Engine::shared();
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    let factors: Vec<Vec<f32>> = (0..maps.len())
        .map(|shadowed| {
            let harness = Harness::with_maps(&gpu, descriptor, &view, maps, &lids(maps, shadowed));
            harness.ask(0, &ground(points)).iter().map(|answer| answer.factor).collect()
        })
        .collect();
    let selections = Harness::with_maps(&gpu, descriptor, &view, maps, &lids(maps, 0)).selections(&ground(points));
    let (mut alone, mut blended) = (vec![0; maps.len()], 0);
    for (index, point) in points.iter().enumerate() {
        let point = point.as_dvec3();
        let expected = read(point);
        // Rounding may put a point on the other side of a border of a map, or of a band.
        let beside =
            [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * 2e-4).map(|step| [read(point + step), read(point - step)]);
        let which = |read: Option<MapRead>| read.map(|read| (read.map, read.blend.map(|blend| blend.map), read.main()));
        if beside.as_flattened().iter().any(|other| which(*other) != which(expected)) {
            continue;
        }
        let main = expected.map_or(-1, |read| i32::try_from(read.main()).expect("one of eight"));
        assert_eq!(selections[index].map, main, "{point}: {expected:?}");
        let weight = |map: usize| match expected {
            Some(MapRead { blend: Some(blend), .. }) if blend.map == map => blend.weight,
            Some(read) if read.map == map => 1.0 - read.blend.map_or(0.0, |blend| blend.weight),
            _ => 0.0,
        };
        for (map, factors) in factors.iter().enumerate() {
            let factor = f64::from(factors[index]);
            // Texture coordinates are rounded to some 2⁻²² of 256 texels, and the band has eight texels.
            assert!((1.0 - factor - weight(map)).abs() < 1e-3, "{point}: {factor} with map {map} of {expected:?}");
        }
        match expected {
            Some(MapRead { map, blend: None }) => alone[map] += 1,
            Some(_) => blended += 1,
            None => {}
        }
    }
    (alone, blended)
}

#[test]
fn by_coverage_points_read_the_finest_map_that_holds_them_and_the_next_one_toward_its_border() {
    let maps = crossing_maps();
    for (filter, blend) in [(FilterKind::Pcf5x5, 8.0), (FilterKind::Point, 0.0), (FilterKind::Pcf3x3, 64.0)] {
        let selection = MapSelection::Coverage { blend };
        let descriptor = ShadowMapDescriptor { filter, selection, ..descriptor(&maps) };
        let order = MapOrder::new(selection, maps.iter().map(|map| &map.projection));
        let read = |point: DVec3| {
            let free = |map: usize| maps[map].projection.texels_to_edge(point);
            by_coverage(order.iter(), filter.filter_radius().into(), blend.into(), free)
        };
        let (alone, blended) = assert_read(&descriptor, &maps, &scattered(), read);
        println!("{filter:?}, blend {blend}: {alone:?} alone, {blended} blended");
        // One map is empty, and the second of two equal maps is never selected.
        assert_eq!((alone[1], alone[4]), (0, 0), "{filter:?}");
        // With the widest blend the smallest map is all band.
        assert!([0, 3].iter().all(|map| alone[*map] > 30) && (alone[2] > 30 || blend > 32.0), "{filter:?}: {alone:?}");
        assert_eq!(blended > 30, blend > 0.0, "{filter:?}: {blended}");
    }
}

#[test]
fn by_view_depth_points_are_blended_where_maps_overlap() {
    let fits = [map_to(5.0, 256), map_to(20.0, 256), map_to(60.0, 256)];
    let ranges = [(None, Some(4.0)), (Some(2.5), Some(15.0)), (Some(9.0), None)];
    let ranges = ranges.map(|(covered_from, far)| Some(DepthRange { covered_from, ..DepthRange::new(0.0, far) }));
    let map = |(fit, depths)| FittedMap { depths, ..FittedMap::new(fit, Bias::default()) };
    let maps: Vec<FittedMap> = fits.into_iter().zip(ranges).map(map).collect();
    let read = |point: DVec3| by_view_depth(ranges, -point.z, |map| maps[map].projection.covers(point));
    let (alone, blended) = assert_read(&descriptor(&maps), &maps, &scattered(), read);
    assert!(alone.iter().all(|count| *count > 30) && blended > 100, "{alone:?}, {blended} blended");
}

#[test]
fn casters_are_drawn_alike_with_the_map_s_matrix_at_any_bind_group() {
    let gpu = Engine::shared();
    let maps = [map_fit(&map_to(5.0, 256), 4.0), map_fit(&map_to(20.0, 256), f32::MAX)];
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    let points = ground(&[2.0_f32, 3.9, 4.1, 15.0].map(|depth| Vec3::NEG_Z * depth));
    for (shadowed, expected) in [[0.0, 0.0, 1.0, 1.0], [1.0, 1.0, 0.0, 0.0]].into_iter().enumerate() {
        for group in 0..4 {
            let casters = lids(&maps, shadowed);
            let harness = Harness::with_caster_group(&gpu, &descriptor(&maps), &view, &maps, &casters, group);
            let factors: Vec<f32> = harness.ask(0, &points).iter().map(|answer| answer.factor).collect();
            assert_eq!(factors, expected, "group {group}, shadow in map {shadowed}");
        }
    }
}
