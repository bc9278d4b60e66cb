//! Compares f32 results with an f64 computation without rounding: from the published box, and from the
//! camera.

use proptest::prelude::*;
use shadowfit::glam::{DMat3, DQuat, DVec3, DVec4, Vec3, Vec4};
use shadowfit::settings::FitKind;
use shadowfit::{DepthConvention, LightProjection, PerspectiveCamera};

use crate::support::{any_camera, any_direction, double, exact, fitted};

/// Relative rounding error of f32.
const EPSILON: f64 = 1.0 / 16_777_216.0;

fn any_depth() -> impl Strategy<Value = DepthConvention> {
    use DepthConvention::{NegativeOneToOne, Reversed, ZeroToOne};
    prop_oneof![Just(ZeroToOne), Just(Reversed), Just(NegativeOneToOne)]
}

fn any_fit() -> impl Strategy<Value = FitKind> {
    use FitKind::{Focused, FrustumAabb, Oriented, Sphere, XnaSample};
    prop_oneof![Just(XnaSample), Just(FrustumAabb), Just(Oriented), Just(Sphere), Just(Focused)]
}

/// Returns clip depth at the near plane, and its change over the depth range.
fn depth_terms(depth: DepthConvention) -> (f64, f64) {
    let near = f64::from(depth.near());
    (near, f64::from(depth.far()) - near)
}

/// Returns the clip position of a position relative to the fit's origin, computed from the published axes,
/// box and depth range, and the sum of the magnitudes of its terms.
fn from_box(fit: &LightProjection, p: DVec3) -> (DVec3, DVec3) {
    let m = fit.light_from_world;
    let (min, max) = (fit.box_min.as_dvec3(), fit.box_max.as_dvec3());
    let row = |pick: fn(Vec4) -> f32| {
        let terms = [m.x_axis, m.y_axis, m.z_axis, m.w_axis].map(|c| f64::from(pick(c)));
        let terms = [terms[0] * p.x, terms[1] * p.y, terms[2] * p.z, terms[3]];
        (terms.iter().sum::<f64>(), terms.iter().map(|t| t.abs()).sum::<f64>())
    };
    let (x, y, z) = (row(|c| c.x), row(|c| c.y), row(|c| c.z));
    let half = (max - min) * 0.5;
    let range = f64::from(fit.depth_range);
    let (near, change) = depth_terms(fit.depth);
    let clip = DVec3::new(x.0 / half.x, y.0 / half.y, near + change * (max.z - z.0) / range);
    (clip, DVec3::new(x.1 / half.x, y.1 / half.y, near.abs() + change.abs() * (max.z.abs() + z.1) / range))
}

/// Returns an f32 matrix times a point, in f64.
fn applied(fit: &LightProjection, p: DVec3) -> DVec3 {
    let clip: DVec4 = fit.clip_from_world.as_dmat4() * p.extend(1.0);
    clip.truncate()
}

/// Returns the corners of a camera's frustum relative to its eye, computed from its fields.
fn corners(camera: &PerspectiveCamera) -> [DVec3; 8] {
    let forward = camera.forward.as_dvec3().normalize();
    let right = forward.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let tangent = (f64::from(camera.fov_y) * 0.5).tan();
    core::array::from_fn(|i| {
        let depth = f64::from(if i < 4 { camera.near } else { camera.far });
        let x = if i % 4 == 1 || i % 4 == 2 { 1.0 } else { -1.0 };
        let y = if i % 4 < 2 { 1.0 } else { -1.0 };
        (forward + right * (x * tangent * f64::from(camera.aspect)) + up * (y * tangent)) * depth
    })
}

/// Returns the matrix from world to light axes: the axes of a vertical light, turned by the shortest arc.
fn light_axes(direction: Vec3) -> DMat3 {
    let turn = DQuat::from_rotation_arc(DVec3::NEG_Y, direction.as_dvec3().normalize());
    DMat3::from_cols(turn * DVec3::X, turn * DVec3::NEG_Z, turn * DVec3::Y).transpose()
}

proptest! {
    /// Box, depth range and scales are rounded once each, and the product of two of them once more: four
    /// steps.
    #[test]
    fn matrices_say_what_axes_and_box_say(
        camera in any_camera(),
        direction in any_direction(),
        kind in any_fit(),
        depth in any_depth(),
        (x, y, z) in (double(-1.0, 1.0), double(-1.0, 1.0), double(-1.0, 1.0)),
    ) {
        let fit = fitted(&camera, direction, &exact(kind).with_depth(depth));
        let p = DVec3::new(x, y, z) * f64::from(camera.far);
        let (expected, magnitude) = from_box(&fit, p);
        let error = (applied(&fit, p) - expected).abs();
        let bound = (magnitude + 1.0) * (4.0 * EPSILON);
        prop_assert!(error.cmple(bound).all(), "{error} of {bound}");
    }

    /// The frustum's corners reach the sides of the map, up to the rounding of f32 at their distance from the
    /// eye, as a share of the map's extent, which is two. The steps are: one of the corner, three of the
    /// axes, 28 that the fit adds on each side against them (of the extent too, and twice for the depth), and
    /// the four above.
    #[test]
    fn a_fit_is_the_same_when_nothing_is_rounded(
        camera in any_camera(),
        direction in any_direction(),
        depth in any_depth(),
    ) {
        // Straight up is the only direction without a shortest arc.
        prop_assume!(direction.y < 0.999);
        let fit = fitted(&camera, direction, &exact(FitKind::FrustumAabb).with_depth(depth));
        let (corners, axes) = (corners(&camera), light_axes(direction));
        let seen = corners.map(|corner| axes * corner);
        let (min, max) = seen.iter().fold((DVec3::MAX, DVec3::MIN), |(a, b), p| (a.min(*p), b.max(*p)));
        let (near, change) = depth_terms(depth);
        let farthest = corners.iter().map(|corner| corner.length()).fold(0.0, f64::max);
        for (corner, p) in corners.iter().zip(seen) {
            let share = (p - min) / (max - min);
            let expected = DVec3::new(share.x * 2.0 - 1.0, share.y * 2.0 - 1.0, near + change * (1.0 - share.z));
            let error = (applied(&fit, *corner) - expected).abs();
            let bound = (DVec3::splat(farthest) / (max - min) + 2.0) * (72.0 * EPSILON);
            prop_assert!(error.cmple(bound).all(), "{error} of {bound}");
        }
    }
}
