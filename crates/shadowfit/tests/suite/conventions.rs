//! Conventions, one table each: handedness, depth, texture direction, vertical lights, origins.

use proptest::prelude::*;
use shadowfit::DepthConvention;
use shadowfit::glam::{DVec3, Mat3, Vec3};
use shadowfit::settings::FitKind;

use crate::support::{DIRECTION, KINDS, any_camera, any_direction, any_kind, apply, camera, double, exact, fitted};

#[test]
fn light_axes_are_right_handed_and_look_along_the_direction() {
    for kind in KINDS {
        for direction in [DIRECTION, Vec3::NEG_Y, Vec3::Y, Vec3::X, Vec3::NEG_Z, Vec3::new(1e-9, -1.0, 0.0)] {
            let fit = fitted(&camera(), direction, &exact(kind));
            let axes = Mat3::from_mat4(fit.light_from_world);
            assert!((axes.determinant() - 1.0).abs() < 1e-6, "{kind:?} {direction}");
            let along = axes * direction.normalize();
            assert!(along.abs_diff_eq(Vec3::NEG_Z, 1e-6), "{kind:?} {direction}: {along}");
            assert!(fit.direction.abs_diff_eq(direction.normalize(), 1e-6));
        }
    }
}

#[test]
fn a_light_straight_down_gives_a_plan_with_minus_z_on_top_in_both_fits() {
    for kind in KINDS {
        let fit = fitted(&camera(), Vec3::NEG_Y, &exact(kind));
        let rotation = Mat3::from_mat4(fit.light_from_world);
        assert!((rotation * Vec3::X).abs_diff_eq(Vec3::X, 1e-7), "{kind:?}");
        assert!((rotation * Vec3::NEG_Z).abs_diff_eq(Vec3::Y, 1e-7), "{kind:?}");
    }
}

#[test]
fn a_light_straight_up_is_fitted() {
    for kind in KINDS {
        let fit = fitted(&camera(), Vec3::Y, &exact(kind));
        for corner in camera().frustum().unwrap().corners {
            assert!(fit.covers(fit.origin + corner.as_dvec3()), "{kind:?}");
        }
    }
}

#[test]
fn xna_roll_keeps_world_up_upward_in_the_map() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::XnaSample));
    let up = Mat3::from_mat4(fit.light_from_world) * Vec3::Y;
    assert!(up.x.abs() < 1e-7 && up.y > 0.0, "{up}");
}

#[test]
fn texture_coordinates_run_right_and_down_with_the_stored_depth() {
    for kind in KINDS {
        for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
            let fit = fitted(&camera(), DIRECTION, &exact(kind).with_depth(depth));
            let uv = fit.corners().map(|c| apply(&fit.uv_from_world, c));
            let (near, far) = if depth == DepthConvention::Reversed { (1.0, 0.0) } else { (0.0, 1.0) };
            let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
            for (i, uv) in uv.into_iter().enumerate() {
                let (u, v) = square[i % 4];
                let expected = Vec3::new(u, v, if i < 4 { near } else { far });
                assert!(uv.abs_diff_eq(expected, 1e-5), "{kind:?} {depth:?}: {uv} for {expected}");
            }
        }
    }
}

#[test]
fn points_nearer_to_the_light_have_the_near_depth() {
    for kind in KINDS {
        for (depth, sign) in [
            (DepthConvention::ZeroToOne, 1.0),
            (DepthConvention::Reversed, -1.0),
            (DepthConvention::NegativeOneToOne, 1.0),
        ] {
            let fit = fitted(&camera(), DIRECTION, &exact(kind).with_depth(depth));
            let here = apply(&fit.clip_from_world, Vec3::ZERO);
            let along = apply(&fit.clip_from_world, DIRECTION);
            assert!((along.z - here.z) * sign > 0.0, "{kind:?} {depth:?}");
        }
    }
}

#[test]
fn camera_clip_space_has_the_frustum_at_its_faces_in_every_depth_range() {
    let frustum = camera().frustum().unwrap();
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
        let matrix = camera().clip_from_world(depth);
        for (i, corner) in frustum.corners.into_iter().enumerate() {
            let clip = matrix.project_point3(corner);
            let (x, y) = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)][i % 4];
            let expected = Vec3::new(x, y, if i < 4 { depth.near() } else { depth.far() });
            assert!(clip.abs_diff_eq(expected, 1e-5), "{depth:?}: {clip} for {expected}");
        }
    }
}

#[test]
fn a_fit_is_measured_in_whole_texels_of_both_axes() {
    let settings = exact(FitKind::FrustumAabb).with_resolution(shadowfit::glam::UVec2::new(1024, 512));
    let fit = fitted(&camera(), DIRECTION, &settings);
    let size = (fit.box_max - fit.box_min).truncate();
    assert!((fit.texel_size * fit.resolution.as_vec2() / size - 1.0).abs().max_element() < 1e-6);
}

proptest! {
    /// Moving the origin rounds one translation to f32: by 2⁻²⁴ of the distance between the origins and of
    /// the box, relative to the box.
    #[test]
    fn another_origin_gives_the_same_clip_position(
        camera in any_camera(), direction in any_direction(), kind in any_kind(),
        (x, y, z) in (double(-100.0, 100.0), double(-100.0, 100.0), double(-100.0, 100.0)),
    ) {
        let fit = fitted(&camera, direction, &exact(kind));
        let shift = DVec3::new(x, y, z);
        let moved = fit.relative_to(fit.origin + shift);
        let size = (fit.box_max - fit.box_min).min_element();
        let reach = fit.corners().map(Vec3::length).into_iter().fold(0.0, f32::max) + shift.length() as f32;
        for corner in fit.corners() {
            let here = apply(&fit.clip_from_world, corner);
            let there = apply(&moved.clip_from_world, (corner.as_dvec3() - shift).as_vec3());
            let error = (here - there).abs().max_element();
            prop_assert!(error <= 16.0 / 16_777_216.0 * (1.0 + reach / size), "{error:e}");
        }
        let away = (moved.light_position() - fit.light_position()).length();
        prop_assert!(away <= 1e-6 * f64::from(reach), "{away:e}");
    }
}
