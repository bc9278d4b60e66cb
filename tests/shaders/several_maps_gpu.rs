//! Several maps of one view: which of them a point reads, and maps that are smaller than their layers.

use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitSettings};
use shadowfit::{LightFit, PerspectiveCamera, fit};
use shadowfit_wgpu::{MAX_MAPS, MapFit, MapView, ShadowMapDescriptor};

use super::harness::{Harness, Point};
use crate::support::software_gpu;

const NO_BIAS: BiasSettings = BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0 };
/// The light's direction of travel.
const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.2);

/// A map around the first so many metres of a view along -z.
fn map_to(distance: f32, texels: u32) -> LightFit {
    let camera = PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 200.0,
    };
    let settings = FitSettings::default().with_max_distance(distance).with_resolution(UVec2::splat(texels));
    fit(&camera.frustum().expect("a camera"), DIRECTION, &settings).expect("a fit")
}

/// A triangle before the whole map, at the near plane.
fn lid(fit: &LightFit) -> Vec<Vec3> {
    let c = fit.corners();
    let down = (c[4] - c[0]) * 0.01;
    let (corner, right, below) = (c[0] + down, c[1] - c[0], c[3] - c[0]);
    let start = corner - right - below;
    vec![start, start + right * 5.0, start + below * 5.0]
}

fn ask(view: &MapView, maps: &[MapFit], shadowed: usize, points: &[Vec3]) -> Vec<f32> {
    let gpu = software_gpu();
    let descriptor = ShadowMapDescriptor {
        resolution: [256; 2],
        maps: maps.len() as u32,
        filter: FilterKind::Point,
        ..ShadowMapDescriptor::default()
    };
    let casters: Vec<Vec<Vec3>> =
        maps.iter().enumerate().map(|(i, map)| if i == shadowed { lid(&map.fit) } else { Vec::new() }).collect();
    let harness = Harness::with_maps(&gpu, &descriptor, view, maps, &NO_BIAS, &casters);
    let points: Vec<Point> =
        points.iter().map(|point| Point { position: point.to_array(), normal: [0.0, 1.0, 0.0] }).collect();
    harness.ask(0, &points).iter().map(|answer| answer.factor).collect()
}

#[test]
fn a_point_reads_the_first_map_that_reaches_as_far_or_the_next_one_that_holds_it() {
    let fits = [map_to(5.0, 256), map_to(20.0, 256), map_to(60.0, 256)];
    let maps: Vec<MapFit> =
        fits.iter().zip([4.0, 15.0, f32::MAX]).map(|(fit, far)| MapFit { fit: *fit, far }).collect();
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    // Along the axis at these view depths; the last one is near, but aside of the first map.
    let is_aside = |point: &Vec3| !fits[0].covers(point.as_dvec3()) && fits[1].covers(point.as_dvec3());
    let aside = (1..200).map(|step| Vec3::new(step as f32 * 0.1, 0.0, -3.0)).find(is_aside).expect("a point aside");
    let points = [2.0_f32, 3.9, 4.1, 10.0, 14.9, 15.1, 40.0].map(|depth| Vec3::NEG_Z * depth);
    let points = [&points[..], &[aside]].concat();
    let read = [0, 0, 1, 1, 1, 2, 2, 1];
    for shadowed in 0..3 {
        let expected: Vec<f32> = read.iter().map(|map| if *map == shadowed { 0.0 } else { 1.0 }).collect();
        assert_eq!(ask(&view, &maps, shadowed, &points), expected, "shadow in map {shadowed}");
    }
    // Seen from an eye that is 10 m back, every view depth is 10 m more, wherever the origin is.
    let view = MapView { eye: DVec3::new(0.0, 0.0, 10.0), ..view };
    let read = [1, 1, 1, 2, 2, 2, 2, 1];
    for shadowed in 0..3 {
        let expected: Vec<f32> = read.iter().map(|map| if *map == shadowed { 0.0 } else { 1.0 }).collect();
        assert_eq!(ask(&view, &maps, shadowed, &points), expected, "from farther back, shadow in map {shadowed}");
    }
}

#[test]
fn as_many_maps_as_there_may_be_are_told_apart() {
    let fits: Vec<LightFit> = (1..=MAX_MAPS).map(|i| map_to(i as f32 * 5.0, 256)).collect();
    let maps: Vec<MapFit> =
        fits.iter().enumerate().map(|(i, fit)| MapFit { fit: *fit, far: (i + 1) as f32 * 5.0 }).collect();
    let points: Vec<Vec3> = (0..MAX_MAPS).map(|i| Vec3::NEG_Z * (i as f32 * 5.0 + 2.5)).collect();
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    for shadowed in 0..MAX_MAPS {
        let expected: Vec<f32> = (0..MAX_MAPS).map(|map| if map == shadowed { 0.0 } else { 1.0 }).collect();
        assert_eq!(ask(&view, &maps, shadowed, &points), expected, "shadow in map {shadowed}");
    }
}

#[test]
fn a_map_in_the_corner_of_a_larger_layer_is_read_like_one_that_fills_it() {
    let gpu = software_gpu();
    let fit = map_to(20.0, 256);
    let half = {
        let c = fit.corners();
        let middle = |i: usize| (c[i] + c[i + 4]) * 0.5;
        vec![middle(0), middle(1), middle(3)]
    };
    let corners = fit.corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    // Rows of points across the map, up to its very border, behind the caster.
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
        for (point, (full, corner)) in points.iter().zip(answers[0].iter().zip(&answers[1])) {
            // Texture coordinates of another size are rounded otherwise.
            assert!((full - corner).abs() < 0.02, "{filter:?}, {point:?}: {full} and {corner}");
        }
    }
}
