//! Figures of a fit compared with numeric differentiation, other algorithms and hand-computed cases.

use proptest::prelude::*;
use shadowfit::bias::{FilterRadius, normal_offset};
use shadowfit::diagnostics::{
    Coverage, DepthStorage, acne_margin, coverage, depth_step, depth_step_at, pixels_per_texel, share_of_map,
};
use shadowfit::glam::{DMat2, DVec2, DVec3, Mat4, UVec2, Vec3};
use shadowfit::settings::{FitKind, MapFormat};
use shadowfit::{Bias, DepthConvention, LightProjection, PerspectiveCamera};

use crate::support::{DIRECTION, any_camera, any_direction, any_kind, camera, cases, double, exact, fitted, float};

const VIEWPORT: UVec2 = UVec2::new(1280, 720);

fn pixel(clip_from_world: &Mat4, p: DVec3) -> DVec2 {
    let clip = clip_from_world.as_dmat4() * p.extend(1.0);
    clip.truncate().truncate() / clip.w * 0.5 * VIEWPORT.as_dvec2()
}

fn texel(fit: &LightProjection, p: DVec3) -> DVec2 {
    (fit.uv_from_world.as_dmat4() * p.extend(1.0)).truncate().truncate() * fit.resolution.as_dvec2()
}

/// Returns ∂(pixel)/∂(texel) by central differences over the surface.
fn numeric(fit: &LightProjection, clip: &Mat4, point: DVec3, normal: DVec3, step: f64) -> DMat2 {
    let (a, b) = normal.any_orthonormal_pair();
    let difference = |f: &dyn Fn(DVec3) -> DVec2, t: DVec3| (f(point + t * step) - f(point - t * step)) / (2.0 * step);
    let jacobian = |f: &dyn Fn(DVec3) -> DVec2| DMat2::from_cols(difference(f, a), difference(f, b));
    jacobian(&|p| pixel(clip, p)) * jacobian(&|p| texel(fit, p)).inverse()
}

/// Returns the greatest stretch of a unit vector, by trying 3600 of them (with an error of at most 4e-7 of
/// itself).
fn greatest_stretch(matrix: DMat2) -> f64 {
    (0..3600)
        .map(|i| (f64::from(i) * std::f64::consts::PI / 3600.0).sin_cos())
        .map(|(s, c)| (matrix * DVec2::new(c, s)).length())
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(cases(256))]

    /// Central differences over a thousandth of the distance have an error of its square, 1e-6, and the
    /// search for the worse axis of 4e-7 (of the axis itself): 1e-4 leaves a margin for surfaces that are
    /// nearly edge-on.
    #[test]
    fn pixels_per_texel_equals_numeric_differentiation(
        camera in any_camera(), direction in any_direction(), kind in any_kind(), normal in any_direction(),
        (x, y, t) in (float(-0.9, 0.9), float(-0.9, 0.9), float(0.1, 0.9)),
    ) {
        prop_assume!(normal.dot(direction).abs() > 0.1);
        let frustum = camera.frustum().unwrap();
        let fit = fitted(&camera, direction, &exact(kind));
        let c = frustum.corners;
        let far = (c[4] + c[6]) * 0.5 + (c[5] - c[4]) * (0.5 * x) + (c[4] - c[7]) * (0.5 * y);
        let point = far * t;
        let clip = camera.clip_from_world(DepthConvention::ZeroToOne);
        let result = pixels_per_texel(&fit, &clip, VIEWPORT, point, normal).unwrap().unwrap();
        let step = 1e-4 * f64::from(point.length());
        let matrix = numeric(&fit, &clip, point.as_dvec3(), normal.as_dvec3(), step);
        let worse = greatest_stretch(matrix);
        prop_assert!((f64::from(result.worse_axis) / worse - 1.0).abs() < 1e-4, "{result:?} for {worse}");
        // The area cancels where the surface is edge-on to the camera: compare on the axes' scale.
        let area = matrix.determinant().abs();
        prop_assert!((f64::from(result.area) - area).abs() < 1e-4 * worse * worse, "{result:?} for {area}");
    }
}

#[test]
fn a_floor_seen_and_lit_from_straight_above_has_the_obvious_figure() {
    let above = PerspectiveCamera { forward: Vec3::NEG_Y, up: Vec3::NEG_Z, aspect: 16.0 / 9.0, ..camera() };
    let fit = fitted(&above, Vec3::NEG_Y, &exact(FitKind::FrustumAabb));
    let clip = above.clip_from_world(DepthConvention::Reversed);
    let result = pixels_per_texel(&fit, &clip, VIEWPORT, Vec3::new(0.0, -10.0, 0.0), Vec3::Y).unwrap().unwrap();
    let pixels_per_metre = 720.0 / (2.0 * 10.0 * (above.fov_y * 0.5).tan());
    let expected = fit.texel_size * pixels_per_metre;
    assert!((result.worse_axis / expected.max_element() - 1.0).abs() < 1e-5, "{result:?} for {expected}");
    assert!((result.area / (expected.x * expected.y) - 1.0).abs() < 1e-5, "{result:?} for {expected}");
}

#[test]
fn points_behind_the_camera_and_surfaces_edge_on_to_the_light_have_no_figure() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let clip = camera().clip_from_world(DepthConvention::ZeroToOne);
    let at = |point, normal| pixels_per_texel(&fit, &clip, VIEWPORT, point, normal).unwrap();
    assert!(at(camera().forward * 10.0, Vec3::Y).is_some());
    assert_eq!(at(camera().forward * -10.0, Vec3::Y), None);
    assert_eq!(at(camera().forward * 10.0, DIRECTION.cross(Vec3::Y)), None);
}

#[test]
fn the_depth_step_is_one_ulp_of_a_float_just_below_one() {
    for format in [MapFormat::Depth32Float, MapFormat::R32Float] {
        assert_eq!(depth_step(format, 100.0), 100.0 * (1.0 - 1.0_f32.next_down()));
    }
}

#[test]
fn depth_steps_are_those_of_the_formats() {
    let at = |storage: DepthStorage, depth| depth_step_at(storage, 100.0, depth).unwrap();
    for depth in [0.0, 0.3, 1.0] {
        assert_eq!(at(DepthStorage::Unorm8, depth), 100.0 / 255.0);
        assert_eq!(at(DepthStorage::Unorm16, depth), 100.0 / 65_535.0);
        assert_eq!(at(DepthStorage::Unorm24, depth), (100.0 / 16_777_215.0_f64) as f32);
    }
    let power = |exponent: i32| (100.0 * 2.0_f64.powi(exponent)) as f32;
    let float16 =
        [(1.0, -11), (0.75, -11), (0.5, -11), (0.499, -12), (0.25, -12), (0.001, -20), (0.0, -24), (1e-45, -24)];
    for (depth, exponent) in float16 {
        assert_eq!(at(DepthStorage::Float16, depth), power(exponent), "at {depth}");
    }
    for depth in [0.9_f32, 0.5, 0.3, 1e-3, 1e-30] {
        assert_eq!(at(DepthStorage::Float32, depth), ((depth.next_up() - depth) as f64 * 100.0) as f32, "at {depth}");
    }
    assert_eq!(at(DepthStorage::Float32, 1.0), power(-24));
    assert_eq!(at(DepthStorage::Float32, 0.0), power(-126));
    // The XNA sample's casters have depths up to 0.5, where half a step is its well-known 0.00012.
    assert!((depth_step_at(DepthStorage::Float16, 1.0, 0.499).unwrap() / 2.0 - 0.000_122).abs() < 1e-6);
    for storage in [DepthStorage::Unorm16, DepthStorage::Float16, DepthStorage::Float32] {
        assert_eq!(depth_step(storage, 100.0), at(storage, 1.0), "the coarsest step is at the far end");
    }
}

/// Returns a point at texture coordinates and a distance from the near plane, all 0..1 inside.
fn in_map(fit: &LightProjection, u: f64, v: f64, depth: f64) -> DVec3 {
    let corners = fit.corners().map(Vec3::as_dvec3);
    let edge = |i: usize, share: f64| (corners[i] - corners[0]) * share;
    fit.origin + corners[0] + edge(1, u) + edge(3, v) + edge(4, depth)
}

#[test]
fn coverage_names_the_side_on_which_a_point_is_out() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
        for kind in [FitKind::XnaSample, FitKind::FrustumAabb] {
            let settings = exact(kind).with_depth(depth).with_resolution(UVec2::new(100, 200));
            let fit = fitted(&camera(), DIRECTION, &settings);
            let at = |u, v, depth| coverage(&fit, FilterRadius::kernel(3), in_map(&fit, u, v, depth)).unwrap();
            assert_eq!(at(0.5, 0.5, 0.5), Coverage::Covered);
            assert_eq!(at(0.5, 0.5, -0.1), Coverage::BeforeNear);
            assert_eq!(at(0.5, 0.5, 1.1), Coverage::BehindFar);
            for (u, v) in [(-0.1, 0.5), (1.1, 0.5), (0.5, -0.1), (0.5, 1.1), (-0.1, 1.3)] {
                assert_eq!(at(u, v, 0.5), Coverage::Aside);
                assert_eq!(at(u, v, -5.0), Coverage::Aside, "across the light comes first");
            }
            // A 3×3 kernel reads two texels each way, so it needs one and a half to the border.
            assert_eq!((at(0.0151, 0.5, 0.5), at(0.0149, 0.5, 0.5)), (Coverage::Covered, Coverage::Border));
            assert_eq!((at(0.5, 0.992_4, 0.5), at(0.5, 0.992_6, 0.5)), (Coverage::Covered, Coverage::Border));
            let point = |u| coverage(&fit, FilterRadius::POINT, in_map(&fit, u, 0.5, 0.5)).unwrap();
            assert_eq!(point(0.001), Coverage::Covered, "the nearest texel is always inside");
            assert!(Coverage::Border.is_inside() && !Coverage::Aside.is_inside());
        }
    }
}

/// Returns the area of the convex hull of points, clipped to the unit square: Andrew's monotone chain, then
/// Sutherland and Hodgman's clipping.
fn clipped_hull_area(mut points: Vec<DVec2>) -> f64 {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut polygon = chain(&mut points.iter().copied());
    polygon.extend(chain(&mut points.iter().rev().copied()));
    for (inward, offset) in [(DVec2::X, 0.0), (DVec2::NEG_X, 1.0), (DVec2::Y, 0.0), (DVec2::NEG_Y, 1.0)] {
        let inside = |p: DVec2| p.dot(inward) + offset;
        let mut clipped = Vec::new();
        for i in 0..polygon.len() {
            let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            if inside(a) >= 0.0 {
                clipped.push(a);
            }
            if (inside(a) >= 0.0) != (inside(b) >= 0.0) {
                clipped.push(a + (b - a) * (inside(a) / (inside(a) - inside(b))));
            }
        }
        polygon = clipped;
    }
    let doubled: f64 = (0..polygon.len()).map(|i| polygon[i].perp_dot(polygon[(i + 1) % polygon.len()])).sum();
    0.5 * doubled
}

proptest! {
    #[test]
    fn the_share_of_the_map_is_the_area_of_the_clipped_hull(
        shared in prop::collection::vec((double(-0.5, 1.5), double(-0.5, 1.5)), 0..24), grid in any::<bool>(),
    ) {
        let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
        // With `grid`, many points are collinear or equal.
        let round = |x: f64| if grid { (x * 4.0).round() / 4.0 } else { x };
        let points: Vec<Vec3> =
            shared.iter().map(|(u, v)| (in_map(&fit, round(*u), round(*v), 0.3) - fit.origin).as_vec3()).collect();
        let m = fit.uv_from_world.as_dmat4();
        let expected = clipped_hull_area(points.iter().map(|p| m.transform_point3(p.as_dvec3()).truncate()).collect());
        let share = f64::from(share_of_map(&fit, &points).unwrap());
        prop_assert!((share - expected).abs() < 1e-6, "{share} for {expected}");
    }

    /// The hull touches all four sides of its box, but may be as thin as the diagonal.
    #[test]
    fn a_frustum_fills_some_of_its_own_box_and_no_more_than_all(camera in any_camera(), direction in any_direction()) {
        let fit = fitted(&camera, direction, &exact(FitKind::FrustumAabb));
        let share = share_of_map(&fit, &camera.frustum().unwrap().corners).unwrap();
        prop_assert!(share > 0.0 && share <= 1.0, "{share}");
    }
}

#[test]
fn shares_of_the_map_that_are_known_by_hand() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let share = |places: &[(f64, f64)]| {
        let points: Vec<Vec3> =
            places.iter().map(|(u, v)| (in_map(&fit, *u, *v, 0.7) - fit.origin).as_vec3()).collect();
        share_of_map(&fit, &points).unwrap()
    };
    assert!((share_of_map(&fit, &fit.corners()).unwrap() - 1.0).abs() < 1e-6);
    assert_eq!(share(&[]), 0.0);
    assert_eq!(share(&[(0.5, 0.5)]), 0.0);
    assert!(share(&[(0.1, 0.2), (0.8, 0.9), (0.8, 0.9)]) < 1e-6, "a line has no area");
    assert!((share(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]) - 0.5).abs() < 1e-6);
    assert!((share(&[(0.25, 0.25), (0.75, 0.25), (0.75, 0.75), (0.25, 0.75), (0.5, 0.5)]) - 0.25).abs() < 1e-6);
    assert!((share(&[(-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)]) - 1.0).abs() < 1e-6);
    assert!(share(&[(2.0, 0.0), (3.0, 0.0), (2.0, 1.0)]) < 1e-6, "outside of the map nothing counts");
}

/// If the bias is exactly the plane's need, only the hardware's share and the precision are missing.
#[test]
fn the_acne_margin_is_what_is_given_less_what_the_plane_needs() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb).with_resolution(UVec2::new(2048, 1024)));
    let point = in_map(&fit, 0.4, 0.6, 0.5);
    let to_light = -fit.direction;
    let texel = fit.texel_size.max_element();
    for i in 0..200 {
        let (theta, azimuth) = (1.5 * i as f32 / 199.0, i as f32 * 2.4);
        let across = to_light.any_orthonormal_vector();
        let slope = across * azimuth.cos() + to_light.cross(across) * azimuth.sin();
        let normal = to_light * theta.cos() + slope * theta.sin();
        let margin = |bias: &Bias, reach: FilterRadius| {
            let margin = acne_margin(&fit, bias, reach, DepthStorage::Float32, point, normal).unwrap().unwrap();
            assert!((margin.texels - margin.metres / texel).abs() <= 1e-6 * margin.texels.abs());
            margin.texels
        };
        for reach in [
            FilterRadius::POINT,
            FilterRadius::HARDWARE_2X2,
            FilterRadius::kernel(5),
            FilterRadius::POINT.over_disc(3.0),
        ] {
            let needed = normal_offset(&fit, reach, normal).unwrap() / texel;
            let none = margin(&Bias::default(), reach);
            assert!(none < -needed && none > -needed - 0.05, "{i}: {none} for {needed}");
            let automatic = margin(&Bias::automatic(reach, DepthStorage::Float32, &fit).unwrap(), reach);
            assert!(automatic >= 0.0, "{i}: {automatic}");
            let receiver_plane = Bias::automatic_receiver_plane(reach, DepthStorage::Float32, &fit).unwrap();
            assert!(margin(&receiver_plane, reach) >= -1e-4, "{i}: {}", margin(&receiver_plane, reach));
        }
    }
    let outside = in_map(&fit, 1.2, 0.5, 0.5);
    assert_eq!(acne_margin(&fit, &Bias::default(), 1.0, DepthStorage::Float32, outside, Vec3::Y), Ok(None));
}
