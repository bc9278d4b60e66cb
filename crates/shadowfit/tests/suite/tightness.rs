//! How closely the fits enclose the frustum, computed as in a shader: f32 matrix times f32 corner.

use proptest::prelude::*;
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{DepthConvention, LightProjection, PerspectiveCamera, ViewFrustum};

use crate::support::{KINDS, any_camera, any_direction, any_kind, apply, camera, double, exact, fitted, float};

/// A corner is up to about six box sizes from the eye (the narrowest lens is 0.2 of its length wide), and a
/// matrix times a point in f32 rounds by about eight times 2⁻²⁴ of its terms: 3e-6, and 6e-6 in clip space,
/// which has width two.
const TOLERANCE: f32 = 1e-5;

/// Fits that guarantee no holes include a margin for the worst rounding: 28 times 2⁻²⁴ of the distance and
/// the extent. With twelve short sides to the farthest corner, this is 2.2e-5 of a side, and 4.4e-5 in clip
/// space.
const ROOM: f32 = 6e-5;

fn clip_bounds(fit: &LightProjection, frustum: &ViewFrustum) -> (Vec3, Vec3) {
    let clip = frustum.corners.map(|c| apply(&fit.clip_from_world, c));
    (clip.into_iter().fold(Vec3::MAX, Vec3::min), clip.into_iter().fold(Vec3::MIN, Vec3::max))
}

fn assert_bounds(fit: &LightProjection, frustum: &ViewFrustum, min: Vec3, max: Vec3, tolerance: f32) {
    let (low, high) = clip_bounds(fit, frustum);
    let error = (low - min).abs().max((high - max).abs()).max_element();
    assert!(error <= tolerance, "{low}..{high} instead of {min}..{max}");
}

fn fit_in(camera: &PerspectiveCamera, direction: Vec3, kind: FitKind, depth: DepthConvention) -> LightProjection {
    fitted(camera, direction, &exact(kind).with_depth(depth))
}

proptest! {
    #[test]
    fn aabb_fit_is_tight_on_all_six_sides(camera in any_camera(), direction in any_direction()) {
        let frustum = camera.frustum().unwrap();
        for (depth, z) in [
            (DepthConvention::ZeroToOne, 0.0),
            (DepthConvention::Reversed, 0.0),
            (DepthConvention::NegativeOneToOne, -1.0),
        ] {
            let fit = fit_in(&camera, direction, FitKind::FrustumAabb, depth);
            assert_bounds(&fit, &frustum, Vec3::new(-1.0, -1.0, z), Vec3::ONE, ROOM);
        }
    }

    #[test]
    fn xna_fit_is_tight_in_x_and_y_with_the_frustum_in_the_near_half(
        camera in any_camera(), direction in any_direction(),
    ) {
        let frustum = camera.frustum().unwrap();
        for (depth, from, to) in [
            (DepthConvention::ZeroToOne, 0.0, 0.5),
            (DepthConvention::Reversed, 0.5, 1.0),
            (DepthConvention::NegativeOneToOne, -1.0, 0.0),
        ] {
            let fit = fit_in(&camera, direction, FitKind::XnaSample, depth);
            assert_bounds(&fit, &frustum, Vec3::new(-1.0, -1.0, from), Vec3::new(1.0, 1.0, to), TOLERANCE);
        }
    }

    #[test]
    fn every_corner_is_inside_the_clip_box_whatever_is_added(
        camera in any_camera(), direction in any_direction(), kind in any_kind(),
        margin in float(0.0, 100.0), extension in float(0.0, 1000.0),
    ) {
        let settings = exact(kind).with_margin(margin).with_caster_extension(extension);
        let fit = fitted(&camera, direction, &settings);
        let frustum = camera.frustum().unwrap();
        let (low, high) = clip_bounds(&fit, &frustum);
        prop_assert!(low.cmpge(Vec3::new(-1.0, -1.0, 0.0) - TOLERANCE).all(), "{low}");
        prop_assert!(high.cmple(Vec3::ONE + TOLERANCE).all(), "{high}");
        for corner in frustum.corners {
            prop_assert!(fit.covers(frustum.origin + corner.as_dvec3()));
        }
    }

    #[test]
    fn no_point_outside_the_clip_box_is_covered(
        direction in any_direction(), kind in any_kind(), side in 0_usize..6,
        (a, b) in (double(-1.0, 1.0), double(-1.0, 1.0)), beyond in double(1e-4, 10.0),
    ) {
        let fit = fitted(&camera(), direction, &exact(kind));
        let corners = fit.corners().map(Vec3::as_dvec3);
        let centre = corners.into_iter().sum::<DVec3>() / 8.0;
        let half = [(corners[1] - corners[0]) * 0.5, (corners[0] - corners[3]) * 0.5, (corners[0] - corners[4]) * 0.5];
        let axis = side / 2;
        let sign = if side % 2 == 0 { 1.0 } else { -1.0 };
        let inside = half[(axis + 1) % 3] * a + half[(axis + 2) % 3] * b;
        let at = |share: f64| fit.origin + centre + half[axis] * (sign * share) + inside;
        prop_assert!(fit.covers(at(1.0 - 1e-4)));
        prop_assert!(!fit.covers(at(1.0 + beyond)));
    }
}

#[test]
fn caster_extension_moves_only_the_near_plane_of_the_aabb_fit() {
    let camera = camera();
    let direction = Vec3::new(0.3, -0.8, 0.4);
    let plain = fitted(&camera, direction, &exact(FitKind::FrustumAabb));
    let extended = fitted(&camera, direction, &exact(FitKind::FrustumAabb).with_caster_extension(25.0));
    assert_eq!(plain.texel_size, extended.texel_size);
    assert!((extended.depth_range - plain.depth_range - 25.0).abs() < 1e-4);
    let far_corner = plain.origin + plain.corners()[6].as_dvec3();
    let moved = extended.origin + extended.corners()[6].as_dvec3() - far_corner;
    assert!(moved.length() < 1e-4, "{moved}");
    // A caster 24 m before the frustum's box is kept only with the extension.
    let near_centre = plain.corners()[..4].iter().sum::<Vec3>().as_dvec3() / 4.0;
    let caster = plain.origin + near_centre - plain.direction.as_dvec3() * 24.0;
    assert!(!plain.covers(caster) && extended.covers(caster));
}

#[test]
fn xna_fit_ignores_the_caster_extension() {
    let plain = fitted(&camera(), Vec3::NEG_ONE, &exact(FitKind::XnaSample));
    let extended = fitted(&camera(), Vec3::NEG_ONE, &exact(FitKind::XnaSample).with_caster_extension(25.0));
    assert_eq!(plain, extended);
}

#[test]
fn the_fit_ends_at_the_maximum_distance() {
    for kind in KINDS {
        let cut = fitted(&camera(), Vec3::NEG_ONE, &exact(kind).with_max_distance(30.0));
        let short = PerspectiveCamera { far: 30.0, ..camera() };
        let same = fitted(&short, Vec3::NEG_ONE, &exact(kind));
        let error = (cut.box_max - same.box_max).abs().max_element() / same.box_max.max_element();
        assert!(error < 1e-6, "{error}");
    }
}
