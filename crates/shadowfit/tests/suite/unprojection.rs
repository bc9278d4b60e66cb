//! Frusta from matrices: precision bound, depth ranges, infinite far planes, other projections.

use proptest::prelude::*;
use shadowfit::glam::{DMat4, DVec3, DVec4, Mat4, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{DepthConvention, FitError, PerspectiveCamera, ViewFrustum};

use crate::support::{DIRECTION, any_camera, camera, exact, fitted, xna_cases};

const DEPTHS: [DepthConvention; 3] =
    [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne];

/// Returns the matrix from world axes, relative to the eye, to clip space, in f64. The far plane may be
/// infinite.
fn clip_from_eye(camera: &PerspectiveCamera, depth: DepthConvention) -> DMat4 {
    let (n, f) = (f64::from(camera.near), f64::from(camera.far));
    let (scale, offset) = match depth {
        DepthConvention::ZeroToOne if f.is_infinite() => (-1.0, -n),
        DepthConvention::Reversed if f.is_infinite() => (0.0, n),
        DepthConvention::NegativeOneToOne if f.is_infinite() => (-1.0, -2.0 * n),
        DepthConvention::ZeroToOne => (f / (n - f), n * f / (n - f)),
        DepthConvention::Reversed => (n / (f - n), n * f / (f - n)),
        DepthConvention::NegativeOneToOne => ((f + n) / (n - f), 2.0 * n * f / (n - f)),
    };
    let y = 1.0 / (f64::from(camera.fov_y) * 0.5).tan();
    let projection = DMat4::from_cols(
        DVec4::new(y / f64::from(camera.aspect), 0.0, 0.0, 0.0),
        DVec4::new(0.0, y, 0.0, 0.0),
        DVec4::new(0.0, 0.0, scale, -1.0),
        DVec4::new(0.0, 0.0, offset, 0.0),
    );
    let forward = camera.forward.as_dvec3().normalize();
    let right = forward.cross(camera.up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let world = DMat4::from_cols(right.extend(0.0), up.extend(0.0), (-forward).extend(0.0), DVec4::W);
    projection * world.transpose()
}

fn world_from_clip(camera: &PerspectiveCamera, depth: DepthConvention) -> DMat4 {
    DMat4::from_translation(camera.eye) * clip_from_eye(camera, depth).inverse()
}

/// Returns the documented bound: 4 · 2⁻²⁴ · r · (|corner| + |eye|).
fn bound(camera: &PerspectiveCamera, depth: DepthConvention, corner: usize, length: f64, eye: f64) -> f64 {
    let far_and_cancelling = corner >= 4 && depth != DepthConvention::Reversed;
    let ratio = if far_and_cancelling { f64::from(camera.far / camera.near) } else { 1.0 };
    4.0 / 16_777_216.0 * ratio * (length + eye)
}

/// Returns the worst error of all corners as a share of its bound. Asserts that it is at most 1.
fn worst_share(camera: &PerspectiveCamera, depth: DepthConvention, frustum: &ViewFrustum, eye: f64) -> f64 {
    let expected = camera.frustum().unwrap();
    let mut worst: f64 = 0.0;
    for (i, (a, e)) in frustum.corners.into_iter().zip(expected.corners).enumerate() {
        let error = (a.as_dvec3() - e.as_dvec3()).length();
        let share = error / bound(camera, depth, i, e.as_dvec3().length(), eye);
        assert!(share <= 1.0, "{depth:?} corner {i}: {a} for {e}, {share} of the bound");
        worst = worst.max(share);
    }
    worst
}

#[test]
fn corners_of_an_f32_world_matrix_stay_within_the_stated_bound() {
    let mut worst: f64 = 0.0;
    for case in xna_cases() {
        for depth in DEPTHS {
            let matrix = world_from_clip(&case.camera, depth).as_mat4();
            let frustum = ViewFrustum::from_world_from_clip(&matrix, case.camera.eye, depth, f32::MAX).unwrap();
            worst = worst.max(worst_share(&case.camera, depth, &frustum, case.camera.eye.length()));
        }
    }
    // The bound is tight within a factor of 20: some corner uses at least a twentieth of it.
    assert!(worst > 0.05, "{worst}");
}

#[test]
fn corners_of_an_eye_relative_f32_matrix_stay_within_the_bound_without_the_eye() {
    for case in xna_cases() {
        for depth in DEPTHS {
            let matrix = clip_from_eye(&case.camera, depth).inverse().as_mat4();
            let frustum = ViewFrustum::from_eye_from_clip(&matrix, case.camera.eye, depth, f32::MAX).unwrap();
            worst_share(&case.camera, depth, &frustum, 0.0);
        }
    }
}

proptest! {
    #[test]
    fn corners_of_any_f32_world_matrix_stay_within_the_stated_bound(camera in any_camera()) {
        for depth in DEPTHS {
            let matrix = world_from_clip(&camera, depth).as_mat4();
            let frustum = ViewFrustum::from_world_from_clip(&matrix, camera.eye, depth, f32::MAX).unwrap();
            worst_share(&camera, depth, &frustum, camera.eye.length());
        }
    }
}

#[test]
fn xna_boxes_of_an_f32_world_matrix_stay_within_twice_the_corners_bound() {
    for (i, case) in xna_cases().into_iter().enumerate() {
        for depth in DEPTHS {
            let matrix = world_from_clip(&case.camera, depth).as_mat4();
            let frustum = ViewFrustum::from_world_from_clip(&matrix, case.camera.eye, depth, f32::MAX).unwrap();
            let settings = exact(FitKind::XnaSample);
            let actual = shadowfit::fit(&frustum, case.direction, &settings).unwrap();
            let expected = fitted(&case.camera, case.direction, &settings);
            let reach = case.camera.frustum().unwrap().corners[4].as_dvec3().length();
            let limit = 2.0 * bound(&case.camera, depth, 4, reach, case.camera.eye.length());
            let error = ((actual.box_max - actual.box_min) - (expected.box_max - expected.box_min)).abs();
            assert!(f64::from(error.max_element()) <= limit, "case {i} {depth:?}: {error} above {limit:e}");
        }
    }
}

#[test]
fn an_f64_world_matrix_gives_the_camera_s_own_corners() {
    for case in xna_cases() {
        for depth in DEPTHS {
            let matrix = world_from_clip(&case.camera, depth);
            let frustum = ViewFrustum::from_world_from_clip_f64(&matrix, case.camera.eye, depth, f32::MAX).unwrap();
            let expected = case.camera.frustum().unwrap();
            for (a, e) in frustum.corners.into_iter().zip(expected.corners) {
                // f32 rounding of the corners, and f64 rounding times near/far and eye distance.
                assert!((a - e).length() <= 1e-6 * e.length(), "{depth:?}: {a} for {e}");
            }
            assert!(frustum.forward.abs_diff_eq(expected.forward, 1e-6));
            assert!((frustum.near / expected.near - 1.0).abs() < 1e-5);
            assert!((frustum.far / expected.far - 1.0).abs() < 1e-5);
        }
    }
}

#[test]
fn an_infinite_far_plane_is_brought_to_the_maximum_distance() {
    for depth in DEPTHS {
        let infinite = PerspectiveCamera { far: f32::INFINITY, ..camera() };
        let matrix = clip_from_eye(&infinite, depth).inverse().as_mat4();
        let frustum = ViewFrustum::from_eye_from_clip(&matrix, camera().eye, depth, 80.0).unwrap();
        let expected = camera().frustum().unwrap();
        for (a, e) in frustum.corners.into_iter().zip(expected.corners) {
            assert!((a - e).length() <= 1e-6 * e.length(), "{depth:?}: {a} for {e}");
        }
        let endless = ViewFrustum::from_eye_from_clip(&matrix, camera().eye, depth, f32::MAX);
        assert_eq!(endless, Err(FitError::Endless));
        assert!(FitError::Endless.to_string().contains("set a maximum shadow distance"));
    }
}

#[test]
fn a_far_plane_beyond_the_maximum_distance_is_brought_to_it() {
    for depth in DEPTHS {
        let matrix = clip_from_eye(&camera(), depth).inverse().as_mat4();
        let frustum = ViewFrustum::from_eye_from_clip(&matrix, camera().eye, depth, 20.0).unwrap();
        let expected = PerspectiveCamera { far: 20.0, ..camera() }.frustum().unwrap();
        for (a, e) in frustum.corners.into_iter().zip(expected.corners) {
            // ε far/near is 2e-5 here for the ranges that cancel.
            assert!((a - e).length() <= 2e-5 * e.length(), "{depth:?}: {a} for {e}");
        }
    }
}

#[test]
fn a_negated_matrix_is_the_same_projection() {
    let matrix = clip_from_eye(&camera(), DepthConvention::ZeroToOne).inverse().as_mat4();
    let read = |m: Mat4| ViewFrustum::from_eye_from_clip(&m, camera().eye, DepthConvention::ZeroToOne, 80.0);
    assert_eq!(read(matrix * -1.0), read(matrix));
}

#[test]
fn an_orthographic_matrix_gives_its_box() {
    // Clip x, y = ±1 at ±4 and ±3 m, near and far at 2 and 10 m along -z.
    let matrix = DMat4::from_cols(
        DVec4::new(4.0, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 3.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -8.0, 0.0),
        DVec4::new(0.0, 0.0, -2.0, 1.0),
    );
    let frustum =
        ViewFrustum::from_eye_from_clip(&matrix.as_mat4(), DVec3::new(7.0, 8.0, 9.0), DepthConvention::ZeroToOne, 6.0)
            .unwrap();
    assert_eq!((frustum.near, frustum.far, frustum.forward), (2.0, 6.0, Vec3::NEG_Z));
    assert_eq!(frustum.corners[0], Vec3::new(-4.0, 3.0, -2.0));
    assert_eq!(frustum.corners[6], Vec3::new(4.0, -3.0, -6.0));
}

#[test]
fn off_axis_and_mirrored_matrices_are_fitted_tightly() {
    let shear = DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.4, -0.2, 1.0, 0.0), DVec4::W);
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    for change in [shear, mirror] {
        // Sheared in view space: the eye stays the apex, the picture's centre moves.
        let view = camera().view_from_world().as_dmat4();
        let clip = camera().clip_from_view(DepthConvention::Reversed).as_dmat4() * change * view;
        let matrix = clip.inverse();
        let frustum =
            ViewFrustum::from_eye_from_clip(&matrix.as_mat4(), DVec3::ZERO, DepthConvention::Reversed, 80.0).unwrap();
        let expected = camera().frustum().unwrap();
        assert!(frustum.forward.abs_diff_eq(expected.forward, 1e-6), "{}", frustum.forward);
        assert!((frustum.far - 80.0).abs() < 1e-4 && (frustum.near - 0.25).abs() < 1e-6);
        let fit = shadowfit::fit(&frustum, DIRECTION, &exact(FitKind::FrustumAabb)).unwrap();
        for corner in frustum.corners {
            assert!(fit.covers(fit.origin + corner.as_dvec3()));
        }
    }
}

/// Returns three variants of a perspective: unchanged, off-axis, and mirrored.
fn lenses(clip_from_eye: DMat4) -> [DMat4; 3] {
    let off_axis = DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::Z, DVec4::W) + {
        let shift = |row: DVec4| DVec4::new(0.3 * row.w, -0.4 * row.w, 0.0, 0.0);
        DMat4::from_cols(shift(DVec4::X), shift(DVec4::Y), shift(DVec4::Z), shift(DVec4::W))
    };
    [clip_from_eye, off_axis * clip_from_eye, DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * clip_from_eye]
}

#[test]
fn a_perspective_that_is_named_with_the_other_end_of_its_depth_is_refused() {
    for far in [80.0, f32::INFINITY, 0.3] {
        let camera = PerspectiveCamera { far, ..camera() };
        for (has, named) in DEPTHS.into_iter().flat_map(|has| DEPTHS.map(|named| (has, named))) {
            for matrix in lenses(clip_from_eye(&camera, has)).map(|matrix| matrix.inverse()) {
                let world = DMat4::from_translation(camera.eye) * matrix;
                for scale in [1.0, -3.0] {
                    let results = [
                        ViewFrustum::from_world_from_clip_f64(&(world * scale), camera.eye, named, 100.0),
                        ViewFrustum::from_world_from_clip(&(world * scale).as_mat4(), camera.eye, named, 100.0),
                        ViewFrustum::from_eye_from_clip(&(matrix * scale).as_mat4(), camera.eye, named, 100.0),
                    ];
                    let is_reversed = has == DepthConvention::Reversed;
                    for result in results {
                        if is_reversed == (named == DepthConvention::Reversed) {
                            let frustum = result.unwrap();
                            assert!(frustum.forward.dot(camera.forward) > 0.0, "{has:?} named {named:?}: {frustum:?}");
                            // A matrix does not tell whether a plain range is 0..1 or -1..1.
                            let near = if has == named { 1.0..=1.0 } else { 0.49..=2.01 };
                            let ratio = frustum.near / camera.near;
                            assert!(
                                near.contains(&((ratio * 200.0).round() / 200.0)),
                                "{has:?} named {named:?}: {ratio}"
                            );
                        } else {
                            assert_eq!(
                                result,
                                Err(FitError::OtherDepth { named, is_reversed }),
                                "{has:?} named {named:?}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_said_of_the_other_depth_names_the_one_that_the_matrix_has() {
    let text = |named, is_reversed| FitError::OtherDepth { named, is_reversed }.to_string();
    assert_eq!(
        text(DepthConvention::ZeroToOne, true),
        "the camera's matrix has reversed depth (near 1, far 0), not near 0, far 1 as stated; use \
         DepthConvention::Reversed"
    );
    assert!(text(DepthConvention::Reversed, false).contains("DepthConvention::ZeroToOne, or NegativeOneToOne"));
}
