//! Pixels per texel against numeric differentiation and against cases known by hand.

use proptest::prelude::*;
use shadowfit::diagnostics::{depth_step, pixels_per_texel};
use shadowfit::glam::{DMat2, DVec2, DVec3, Mat4, UVec2, Vec3};
use shadowfit::{DepthConvention, FitKind, LightFit, MapFormat, PerspectiveCamera};

use crate::support::{DIRECTION, any_camera, any_direction, any_kind, camera, exact, fitted, float};

const VIEWPORT: UVec2 = UVec2::new(1280, 720);

fn pixel(clip_from_world: &Mat4, p: DVec3) -> DVec2 {
    let clip = clip_from_world.as_dmat4() * p.extend(1.0);
    clip.truncate().truncate() / clip.w * 0.5 * VIEWPORT.as_dvec2()
}

fn texel(fit: &LightFit, p: DVec3) -> DVec2 {
    (fit.uv_from_world.as_dmat4() * p.extend(1.0)).truncate().truncate() * fit.resolution.as_dvec2()
}

/// ∂(pixel)/∂(texel) by central differences over the surface.
fn numeric(fit: &LightFit, clip: &Mat4, point: DVec3, normal: DVec3, step: f64) -> DMat2 {
    let (a, b) = normal.any_orthonormal_pair();
    let difference = |f: &dyn Fn(DVec3) -> DVec2, t: DVec3| (f(point + t * step) - f(point - t * step)) / (2.0 * step);
    let jacobian = |f: &dyn Fn(DVec3) -> DVec2| DMat2::from_cols(difference(f, a), difference(f, b));
    jacobian(&|p| pixel(clip, p)) * jacobian(&|p| texel(fit, p)).inverse()
}

/// Greatest stretch of a unit vector, by trying 3600 of them (off by at most 4e-7 of itself).
fn greatest_stretch(matrix: DMat2) -> f64 {
    (0..3600)
        .map(|i| (f64::from(i) * std::f64::consts::PI / 3600.0).sin_cos())
        .map(|(s, c)| (matrix * DVec2::new(c, s)).length())
        .fold(0.0, f64::max)
}

proptest! {
    /// Central differences over a thousandth of the distance err by its square, 1e-6, and the
    /// search for the worse axis by 4e-7 (of the axis itself): 1e-4 leaves room for surfaces that
    /// are nearly edge-on.
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
