//! Properties of fits that stay unchanged when the world is moved, scaled or turned.

use proptest::prelude::*;
use shadowfit::PerspectiveCamera;
use shadowfit::glam::{DQuat, DVec3, Vec3};
use shadowfit::settings::FitKind;

use crate::support::{KINDS, any_camera, any_direction, any_kind, apply, camera, cases, double, exact, fitted, float};

/// Returns the texture coordinates of the frustum's own corners.
fn corner_uvs(camera: &PerspectiveCamera, direction: Vec3, kind: FitKind) -> [Vec3; 8] {
    let fit = fitted(camera, direction, &exact(kind));
    camera.frustum().unwrap().corners.map(|c| apply(&fit.uv_from_world, c))
}

fn difference(a: [Vec3; 8], b: [Vec3; 8]) -> f32 {
    a.into_iter().zip(b).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f32::max)
}

fn turned(camera: &PerspectiveCamera, turn: impl Fn(Vec3) -> Vec3) -> PerspectiveCamera {
    PerspectiveCamera { forward: turn(camera.forward), up: turn(camera.up), ..*camera }
}

proptest! {
    #![proptest_config(cases(256))]

    /// Bit for bit: everything is relative to the eye.
    #[test]
    fn translation_changes_no_bit_of_the_texture_matrix(
        camera in any_camera(), direction in any_direction(), kind in any_kind(),
        (x, y, z) in (double(-1e7, 1e7), double(-1e7, 1e7), double(-1e7, 1e7)),
    ) {
        let moved = PerspectiveCamera { eye: camera.eye + DVec3::new(x, y, z), ..camera };
        let here = fitted(&camera, direction, &exact(kind));
        let there = fitted(&moved, direction, &exact(kind));
        prop_assert_eq!(here.uv_from_world, there.uv_from_world);
    }

    /// The scaled distances are rounded to f32 again (6e-8), at up to six box sizes from the eye and through
    /// an f32 matrix: 1e-5, as in the tightness tests.
    #[test]
    fn unit_scale_leaves_texture_coordinates_as_they_were(
        camera in any_camera(), direction in any_direction(), kind in any_kind(), exponent in float(-3.0, 3.0),
    ) {
        let scale = 10.0_f32.powf(exponent);
        let scaled = PerspectiveCamera {
            eye: camera.eye * f64::from(scale),
            near: camera.near * scale,
            far: camera.far * scale,
            ..camera
        };
        let error = difference(corner_uvs(&camera, direction, kind), corner_uvs(&scaled, direction, kind));
        prop_assert!(error < 1e-5, "{error:e}");
    }

    /// Powers of two scale without rounding, so no bit changes.
    #[test]
    fn power_of_two_scale_changes_no_bit_of_texture_coordinates(
        camera in any_camera(), direction in any_direction(), kind in any_kind(), exponent in -20_i32..20,
    ) {
        let scale = 2.0_f32.powi(exponent);
        let scaled = PerspectiveCamera { near: camera.near * scale, far: camera.far * scale, ..camera };
        prop_assert_eq!(corner_uvs(&camera, direction, kind), corner_uvs(&scaled, direction, kind));
    }

    /// The turned vectors are rounded to f32 again (6e-8 rad each for view, up and light). The light's
    /// rounding turns the map by 6e-8 / sin θ about itself, θ its angle to the vertical; with sin θ > 0.1 and
    /// corners six box sizes away that is below 1e-5.
    #[test]
    fn turning_camera_and_light_about_up_leaves_xna_texture_coordinates_as_they_were(
        camera in any_camera(), direction in any_direction(), angle in double(0.0, 6.3),
    ) {
        prop_assume!(direction.x.hypot(direction.z) > 0.1);
        let turn = |v: Vec3| (DQuat::from_rotation_y(angle) * v.as_dvec3()).as_vec3();
        let error = difference(
            corner_uvs(&camera, direction, FitKind::XnaSample),
            corner_uvs(&turned(&camera, turn), turn(direction), FitKind::XnaSample),
        );
        prop_assert!(error < 3e-5, "{error:e}");
    }

    /// A quarter turn is exact in f32, so only the order of sums differs. The shortest arc's axes do not turn
    /// with it, which exchanges u and v: (u, v) -> (v, 1 - u).
    #[test]
    fn quarter_turns_about_up_exchange_the_axes_of_the_aabb_fit(
        camera in any_camera(), direction in any_direction(),
    ) {
        let turn = |v: Vec3| Vec3::new(v.z, v.y, -v.x);
        let mut expected = corner_uvs(&camera, direction, FitKind::FrustumAabb);
        let (mut camera, mut direction) = (camera, direction);
        for _ in 0..4 {
            (camera, direction) = (turned(&camera, turn), turn(direction));
            expected = expected.map(|uv| Vec3::new(uv.y, 1.0 - uv.x, uv.z));
            let error = difference(expected, corner_uvs(&camera, direction, FitKind::FrustumAabb));
            prop_assert!(error < 1e-5, "{error:e}");
        }
    }

    /// The shortest arc turns the roll by at most tan(α/2) times the light's own turn, α being its angle from
    /// straight down; at 150° that is 3.7, and the axes' tilt adds one.
    #[test]
    fn aabb_axes_turn_continuously_with_the_light(a in any_direction(), b in any_direction(), step in float(1e-4, 1e-2)) {
        prop_assume!(a.y < 0.86 && a.cross(b).length() > 0.1);
        let moved = (a + b * step).normalize();
        let here = fitted(&camera(), a, &exact(FitKind::FrustumAabb)).light_from_world;
        let there = fitted(&camera(), moved, &exact(FitKind::FrustumAabb)).light_from_world;
        let change = (here.row(0) - there.row(0)).truncate().length();
        prop_assert!(change < 6.0 * a.distance(moved) + 1e-6, "{change} for {}", a.distance(moved));
    }
}

#[test]
fn the_length_of_the_direction_does_not_matter() {
    for kind in KINDS {
        let unit = fitted(&camera(), Vec3::new(0.3, -0.8, 0.4), &exact(kind));
        let long = fitted(&camera(), Vec3::new(0.3, -0.8, 0.4) * 1024.0, &exact(kind));
        assert_eq!(unit, long);
    }
}
