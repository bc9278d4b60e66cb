//! Shadows that fade before the shadow distance, so that they do not end at an edge.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::FilterKind;
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection};
use shadowfit_wgpu::{MapView, ShadowMapDescriptor};

use super::engine::Engine;
use super::engine::points::Point;
use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, ROW};

/// Returns a triangle that shadows the whole map, at the near plane.
fn lid(fit: &LightProjection) -> Vec<Vec3> {
    let c = fit.corners();
    let (right, below) = (c[1] - c[0], c[3] - c[0]);
    let start = c[0] + (c[4] - c[0]) * 0.01 - right - below;
    vec![start, start + right * 5.0, start + below * 5.0]
}

/// Returns the factors of points in shadow at view depths of 0.1 to 9.9 m, and the maps that they read, for a
/// fade.
fn read(fade: [f32; 2]) -> Vec<(f32, f32, i32)> {
    let gpu = Engine::shared();
    let fit = box_fit(DepthConvention::ZeroToOne);
    let filter = FilterKind::Hardware2x2;
    let map = ShadowMapDescriptor { resolution: [ROW; 2], maps: 1, filter, fade, ..Default::default() };
    let view = MapView::from_eye(DVec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z);
    let harness = Harness::with_maps(&gpu, &map, &view, &[FittedMap::new(fit, Bias::default())], &[lid(&fit)]);
    let depths: Vec<f32> = (0..99_u16).map(|step| (f32::from(step) + 1.0) * 0.1).collect();
    let point = |depth: &f32| Point { position: [0.0, 0.0, -depth], normal: [0.0, 1.0, 0.0] };
    let points: Vec<Point> = depths.iter().map(point).collect();
    let (answers, selections) = (harness.ask(0, &points), harness.selections(&points));
    let read = answers.iter().zip(&selections).map(|(answer, selection)| (answer.factor, selection.map));
    depths.into_iter().zip(read).map(|(depth, (factor, map))| (depth, factor, map)).collect()
}

fn factors(fade: [f32; 2]) -> Vec<(f32, f32)> {
    read(fade).into_iter().map(|(depth, factor, _)| (depth, factor)).collect()
}

#[test]
fn beyond_the_end_of_shadows_no_map_is_read() {
    for (depth, _, map) in read([3.0, 7.05]) {
        assert_eq!(map, if depth < 7.05 { 0 } else { -1 }, "at {depth} m");
    }
}

#[test]
fn shadows_fade_smoothly_between_the_two_view_depths_and_points_beyond_are_lit() {
    for (depth, factor) in factors([3.0, 7.0]) {
        let share = ((depth - 3.0) / 4.0).clamp(0.0, 1.0);
        let expected = share * share * (3.0 - 2.0 * share);
        assert!((factor - expected).abs() < 1e-5, "at {depth} m: {factor}, not {expected}");
    }
}

#[test]
fn without_a_fade_shadows_reach_as_far_as_their_maps_and_one_of_no_width_is_an_end() {
    assert!(factors([f32::MAX; 2]).iter().all(|(_, factor)| *factor == 0.0));
    for (depth, factor) in factors([5.05; 2]) {
        assert_eq!(factor, if depth < 5.05 { 0.0 } else { 1.0 }, "at {depth} m");
    }
}
