//! Frusta from cameras, and their slices.

use proptest::prelude::*;
use shadowfit::{Camera, DepthConvention, FitError, Lens, PerspectiveCamera, ViewFrustum};

use crate::support::{any_camera, camera, float};

#[test]
fn a_slice_over_the_whole_range_is_the_frustum_itself() {
    let frustum = camera().frustum().unwrap();
    assert_eq!(frustum.slice(frustum.near, frustum.far), Ok(frustum));
    assert_eq!(frustum.slice(f32::MIN, f32::MAX), Ok(frustum));
}

#[test]
fn a_slice_outside_the_frustum_is_refused_with_its_depths() {
    let frustum = camera().frustum().unwrap();
    assert_eq!(frustum.slice(90.0, 100.0), Err(FitError::NearNotBelowFar { near: 90.0, far: 80.0 }));
    assert_eq!(frustum.slice(5.0, 5.0), Err(FitError::NearNotBelowFar { near: 5.0, far: 5.0 }));
    assert_eq!(frustum.slice(0.0, 0.1), Err(FitError::NearNotBelowFar { near: 0.25, far: 0.1 }));
}

#[test]
fn an_orthographic_lens_without_a_height_is_refused_by_name() {
    let half = |half_height: f32| Camera { lens: Lens::Orthographic { half_height }, ..camera().into() }.frustum();
    assert!(half(2.0).is_ok());
    for bad in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
        let error = half(bad).expect_err("no height").to_string();
        assert!(error.contains("half height"), "{bad}: {error}");
    }
    let flat = Camera { lens: Lens::Orthographic { half_height: 2.0 }, far: 0.25, ..camera().into() };
    assert_eq!(flat.frustum(), Err(FitError::NearNotBelowFar { near: 0.25, far: 0.25 }));
}

proptest! {
    /// Corners, matrix and frustum of the matrix agree: each is rounded to f32 by 2⁻²⁴ of the distance from
    /// the eye.
    #[test]
    fn a_camera_of_either_lens_has_the_frustum_of_its_matrices(camera in any_camera(), height in float(0.01, 100.0)) {
        let perspective = Camera::from(camera);
        prop_assert_eq!(perspective.frustum(), camera.frustum());
        for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
            prop_assert_eq!(perspective.clip_from_world(depth), camera.clip_from_world(depth));
            let half_height = height * camera.near;
            let flat = Camera { lens: Lens::Orthographic { half_height }, ..perspective };
            let frustum = flat.frustum().unwrap();
            let clip = flat.clip_from_world(depth);
            for (i, corner) in frustum.corners.into_iter().enumerate() {
                let found = clip.project_point3(corner);
                let tolerance = 1e-6 + 1e-6 * corner.length() / (half_height * flat.aspect.min(1.0));
                let off = (found.x.abs() - 1.0).abs().max((found.y.abs() - 1.0).abs());
                prop_assert!(off < tolerance, "corner {i}: {found}");
            }
            let inverse = flat.clip_from_world(depth).as_dmat4().inverse();
            let other = ViewFrustum::from_eye_from_clip(&inverse.as_mat4(), flat.eye, depth, f32::MAX).unwrap();
            for (found, expected) in frustum.corners.into_iter().zip(other.corners) {
                let scale = expected.length().max(flat.far);
                prop_assert!((found - expected).length() <= 1e-4 * scale, "{found} for {expected}");
            }
        }
    }

    /// Corners are rounded to f32 once for the frustum and once for its slice, each by 2⁻²⁴ of their
    /// distance; for a slice near the eye the far corner's rounding shrinks with it.
    #[test]
    fn a_slice_is_the_frustum_of_a_camera_with_those_planes(
        camera in any_camera(), (a, b) in (float(0.0, 1.0), float(0.0, 1.0)),
    ) {
        prop_assume!((a - b).abs() > 1e-3);
        let depth = |t: f32| camera.near * (camera.far / camera.near).powf(t);
        let (near, far) = (depth(a.min(b)), depth(a.max(b)));
        let slice = camera.frustum().unwrap().slice(near, far).unwrap();
        let expected = PerspectiveCamera { near, far, ..camera }.frustum().unwrap();
        for (i, (s, e)) in slice.corners.into_iter().zip(expected.corners).enumerate() {
            prop_assert!((s - e).length() <= 4e-7 * e.length(), "corner {i}: {s} for {e}");
        }
        prop_assert_eq!((slice.near, slice.far), (near, far));
    }

    #[test]
    fn view_depths_of_the_corners_are_near_and_far(camera in any_camera()) {
        let frustum = camera.frustum().unwrap();
        for (i, corner) in frustum.corners.into_iter().enumerate() {
            let depth = corner.as_dvec3().dot(frustum.forward.as_dvec3());
            let expected = f64::from(if i < 4 { camera.near } else { camera.far });
            // Corners and forward are rounded to f32, and a corner may be 5 times its depth away.
            prop_assert!((depth / expected - 1.0).abs() < 1e-6, "corner {i}: {depth} for {expected}");
        }
    }
}
