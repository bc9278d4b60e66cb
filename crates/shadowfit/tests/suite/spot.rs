//! Spot lights: conventions, one table each, and the properties of their matrices.

use proptest::prelude::*;
use shadowfit::DepthConvention::{self, NegativeOneToOne, Reversed, ZeroToOne};
use shadowfit::PerspectiveCamera;
use shadowfit::glam::{DQuat, DVec3, Mat4, UVec2, Vec3, Vec4};
use shadowfit::spot::{SpotFit, SpotLight};

use crate::support::{any_direction, double, float};

/// Relative rounding of f32.
pub(crate) const EPSILON: f64 = 1.0 / 16_777_216.0;

pub(crate) const DEPTHS: [DepthConvention; 3] = [ZeroToOne, Reversed, NegativeOneToOne];

/// Returns a plain lamp away from the world's origin.
pub(crate) fn lamp() -> SpotLight {
    SpotLight {
        position: DVec3::new(12.0, 6.0, -40.0),
        direction: Vec3::new(0.3, -0.8, -0.5),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.25,
        far: 60.0,
    }
}

/// Lamps in any orientation, from 6° to 140°, with near/far ratios from 2 to 1000, up to 1 km out.
pub(crate) fn any_lamp() -> impl Strategy<Value = SpotLight> {
    let position = (double(-1e3, 1e3), double(-1e3, 1e3), double(-1e3, 1e3));
    let lens = (float(0.1, 2.4), float(0.5, 2.0), float(-1.5, 1.0), float(0.3, 3.0));
    (position, any_direction(), any_direction(), lens).prop_map(|((x, y, z), direction, up, lens)| {
        let (fov_y, aspect, near, ratio) = lens;
        let near = 10.0_f32.powf(near);
        let far = near * 10.0_f32.powf(ratio);
        SpotLight { position: DVec3::new(x, y, z), direction, up, fov_y, aspect, near, far }
    })
}

pub(crate) fn any_depth() -> impl Strategy<Value = DepthConvention> {
    prop_oneof![Just(ZeroToOne), Just(Reversed), Just(NegativeOneToOne)]
}

fn fitted(lamp: &SpotLight, depth: DepthConvention) -> SpotFit {
    lamp.fit(UVec2::new(1024, 512), depth).unwrap()
}

/// Returns the world position of a point in the light's window: `x` and `y` are -1..1 across it, at a
/// distance along the axis.
pub(crate) fn in_window(lamp: &SpotLight, x: f64, y: f64, distance: f64) -> DVec3 {
    let forward = lamp.direction.as_dvec3().normalize();
    let right = forward.cross(lamp.up.as_dvec3()).normalize();
    let tangent = (f64::from(lamp.fov_y) * 0.5).tan();
    let across = right * (x * tangent * f64::from(lamp.aspect)) + right.cross(forward) * (y * tangent);
    lamp.position + (forward + across) * distance
}

/// Returns the homogeneous position that a shader computes, in f32.
pub(crate) fn homogeneous(matrix: &Mat4, fit: &SpotFit, point: DVec3) -> Vec4 {
    *matrix * (point - fit.origin).as_vec3().extend(1.0)
}

fn divided(matrix: &Mat4, fit: &SpotFit, point: DVec3) -> Vec3 {
    let at = homogeneous(matrix, fit, point);
    at.truncate() / at.w
}

#[test]
fn the_window_fills_clip_space_and_texture_with_v_downward_in_every_depth_range() {
    for depth in DEPTHS {
        let fit = fitted(&lamp(), depth);
        let stored = if depth == Reversed { [1.0, 0.0] } else { [0.0, 1.0] };
        for (x, y) in [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (0.0, 0.0), (0.5, -0.25)] {
            for (distance, clip, stored) in
                [(lamp().near, depth.near(), stored[0]), (lamp().far, depth.far(), stored[1])]
            {
                let point = in_window(&lamp(), x, y, f64::from(distance));
                let at = divided(&fit.clip_from_world, &fit, point);
                let expected = Vec3::new(x as f32, y as f32, clip);
                assert!(at.abs_diff_eq(expected, 1e-5), "{depth:?}: {at} for {expected}");
                let at = divided(&fit.uv_from_world, &fit, point);
                let expected = Vec3::new(x as f32 * 0.5 + 0.5, 0.5 - y as f32 * 0.5, stored);
                assert!(at.abs_diff_eq(expected, 1e-5), "{depth:?}: {at} for {expected}");
            }
        }
    }
}

#[test]
fn the_sign_of_up_says_what_is_on_top_of_the_map() {
    for sign in [1.0, -1.0] {
        let lamp = SpotLight { up: Vec3::Y * sign, ..lamp() };
        let fit = fitted(&lamp, ZeroToOne);
        let up = fit.light_from_world.transform_vector3(Vec3::Y);
        assert!(up.x.abs() < 1e-7 && up.y * sign > 0.0, "{up}");
    }
}

#[test]
fn a_vertical_light_has_minus_z_on_top_when_it_shines_down() {
    for (direction, up, top) in [
        (Vec3::NEG_Y, Vec3::Y, Some(Vec3::NEG_Z)),
        (Vec3::new(1e-8, -2.0, 0.0), Vec3::Y, Some(Vec3::NEG_Z)),
        (Vec3::Y, Vec3::Y, None),
        (Vec3::Z, Vec3::Z, None),
        (DIAGONAL, DIAGONAL, None),
    ] {
        let lamp = SpotLight { direction, up, ..lamp() };
        let fit = fitted(&lamp, ZeroToOne);
        if let Some(top) = top {
            let top = fit.light_from_world.transform_vector3(top);
            assert!(top.abs_diff_eq(Vec3::Y, 1e-6), "{direction}: {top}");
        }
        let along = fit.light_from_world.transform_vector3(direction.normalize());
        assert!(along.abs_diff_eq(Vec3::NEG_Z, 1e-6), "{direction}: {along}");
        let frustum = lamp.frustum().unwrap();
        let corner = divided(&fit.clip_from_world, &fit, frustum.origin + frustum.corners[0].as_dvec3());
        assert!(corner.abs_diff_eq(Vec3::new(-1.0, 1.0, 0.0), 1e-4), "{direction}: {corner}");
    }
}

const DIAGONAL: Vec3 = Vec3::new(0.3, -0.4, 0.5);

#[test]
fn a_light_toward_a_target_has_it_in_the_middle_of_its_map() {
    let (position, target) = (DVec3::new(-18.0, 5.0, -2.0), DVec3::new(-2.0, 3.0, -10.0));
    let lamp = SpotLight::toward(position, target, std::f32::consts::FRAC_PI_2, 1.0, 5.0, 100.0);
    let fit = fitted(&lamp, ZeroToOne);
    let at = divided(&fit.uv_from_world, &fit, target);
    assert!((at - Vec3::new(0.5, 0.5, at.z)).abs().max_element() < 1e-6, "{at}");
    // d = √(16² + 2² + 8²) = √324 = 18; (18 - 5) / 18 · 100 / 95 = 0.760 23.
    assert!((at.z - 0.760_234).abs() < 1e-6 && (homogeneous(&fit.uv_from_world, &fit, target).w - 18.0).abs() < 1e-5);
}

#[test]
fn points_beside_and_behind_the_light_have_a_w_that_is_not_positive() {
    let fit = fitted(&lamp(), ZeroToOne);
    let across = fit.direction.any_orthonormal_vector();
    for (point, is_zero) in [(Vec3::ZERO, true), (-fit.direction * 3.0, false), (across * 5.0, true)] {
        let w = (fit.uv_from_world * point.extend(1.0)).w;
        assert!(if is_zero { w.abs() < 1e-5 } else { w < -2.9 }, "{point}: {w}");
    }
}

#[test]
fn a_texel_at_one_metre_is_the_window_there_divided_by_the_resolution() {
    // tan 45° = 1: the window is 4 m × 2 m at 1 m.
    let lamp = SpotLight { fov_y: std::f32::consts::FRAC_PI_2, aspect: 2.0, ..lamp() };
    let fit = lamp.fit(UVec2::new(1000, 400), ZeroToOne).unwrap();
    assert!((fit.texel_size.x - 0.004).abs() < 1e-9 && (fit.texel_size.y - 0.005).abs() < 1e-9, "{}", fit.texel_size);
}

#[test]
fn depth_at_a_distance_is_what_the_matrix_stores_there() {
    // z = far (d - near) / (d (far - near)): 60 · 1.75 / (2 · 59.75) = 0.878 661.
    assert!((fitted(&lamp(), ZeroToOne).depth_at(2.0) - 0.878_661).abs() < 1e-6);
    assert!((fitted(&lamp(), Reversed).depth_at(2.0) - 0.121_339).abs() < 1e-6);
    for depth in DEPTHS {
        let fit = fitted(&lamp(), depth);
        for distance in [0.25, 0.3, 1.0, 7.0, 30.0, 60.0] {
            let stored = f64::from(divided(&fit.uv_from_world, &fit, in_window(&lamp(), 0.3, 0.6, distance)).z);
            assert!((stored - fit.depth_at(distance)).abs() < 1e-5, "{depth:?} at {distance}: {stored}");
        }
    }
}

#[test]
fn casters_are_kept_in_the_frustum_and_culled_before_behind_and_beside_it() {
    let fit = fitted(&lamp(), ZeroToOne);
    let volume = fit.caster_volume();
    assert_eq!((volume.origin, volume.count), (lamp().position, 6));
    let moved = volume.relative_to(DVec3::new(300.0, -20.0, 45.0));
    for (x, y, distance, is_kept) in [
        (0.0, 0.0, 10.0, true),
        (0.99, -0.99, 10.0, true),
        (-0.99, 0.99, 59.0, true),
        (0.0, 0.0, 0.2, false),
        (0.0, 0.0, 61.0, false),
        (0.0, 0.0, -10.0, false),
        (1.02, 0.0, 20.0, false),
        (-1.02, 0.0, 20.0, false),
        (0.0, 1.02, 20.0, false),
        (0.0, -1.02, 20.0, false),
    ] {
        let point = in_window(&lamp(), x, y, distance);
        for volume in [volume, moved] {
            let kept = volume.intersects_sphere((point - volume.origin).as_vec3(), 0.01);
            assert_eq!(kept, is_kept, "({x}, {y}) at {distance}");
        }
        assert_eq!(fit.covers(point), is_kept, "({x}, {y}) at {distance}");
    }
}

proptest! {
    /// Lens and axes are equal to the camera's, each rounded from f64 by one step.
    #[test]
    fn a_camera_in_the_light_s_place_has_the_same_matrices(lamp in any_lamp(), depth in any_depth()) {
        let camera = PerspectiveCamera {
            eye: lamp.position, forward: lamp.direction, up: lamp.up,
            fov_y: lamp.fov_y, aspect: lamp.aspect, near: lamp.near, far: lamp.far,
        };
        prop_assume!(camera.frustum().is_ok());
        prop_assert_eq!(lamp.camera(), camera);
        prop_assert_eq!(lamp.frustum(), camera.frustum());
        let fit = fitted(&lamp, depth);
        for (ours, theirs) in [
            (fit.light_from_world, camera.view_from_world()),
            (fit.clip_from_light, camera.clip_from_view(depth)),
            (fit.clip_from_world, camera.clip_from_world(depth)),
        ] {
            for (a, b) in ours.to_cols_array().into_iter().zip(theirs.to_cols_array()) {
                prop_assert!((a - b).abs() <= 2e-7 * (1.0 + a.abs()), "{a} for {b}");
            }
        }
    }

    /// Axes, scales and products are rounded once each: six steps of the terms, of which w is one part.
    #[test]
    fn the_map_is_the_same_when_nothing_is_rounded(
        lamp in any_lamp(), depth in any_depth(),
        (x, y, share) in (double(-1.0, 1.0), double(-1.0, 1.0), double(0.0, 1.0)),
    ) {
        prop_assume!(lamp.direction.cross(lamp.up).length() > 0.1);
        let fit = fitted(&lamp, depth);
        let (near, far) = (f64::from(lamp.near), f64::from(lamp.far));
        let distance = near + (far - near) * share;
        let point = in_window(&lamp, x, y, distance) - lamp.position;
        let uv = fit.uv_from_world.as_dmat4() * point.extend(1.0);
        let plain = far * (distance - near) / (distance * (far - near));
        let stored = if depth == Reversed { 1.0 - plain } else { plain };
        let expected = DVec3::new(0.5 + 0.5 * x, 0.5 - 0.5 * y, stored);
        // Across the map, a turn of the axes by one step counts relative to the window; along it, relative to
        // the depth's own factor.
        let tangent = (f64::from(lamp.fov_y) * 0.5).tan() * f64::from(lamp.aspect).min(1.0);
        let stretch = point.length() / distance;
        let factor = far / (far - near);
        let bound = DVec3::new(1.0 + 1.0 / tangent, 1.0 + 1.0 / tangent, 2.0 * factor) * (stretch * 6.0 * EPSILON);
        let error = (uv.truncate() / uv.w - expected).abs();
        prop_assert!(error.cmple(bound).all(), "{error} of {bound}");
        prop_assert!((uv.w / distance - 1.0).abs() <= 4.0 * EPSILON * stretch, "{}", uv.w);
    }

    /// Moving the origin rounds one translation to f32: 2⁻²⁴ of the distance, relative to the distance along
    /// the axis.
    #[test]
    fn another_origin_gives_the_same_position_in_the_map(
        lamp in any_lamp(), depth in any_depth(), (away, metres) in (any_direction(), double(0.0, 100.0)),
        (x, y, share) in (double(-1.0, 1.0), double(-1.0, 1.0), double(0.0, 1.0)),
    ) {
        prop_assume!(lamp.direction.cross(lamp.up).length() > 0.1);
        let fit = fitted(&lamp, depth);
        let moved = fit.relative_to(lamp.position + away.as_dvec3() * metres);
        prop_assert_eq!(moved.relative_to(lamp.position), fit);
        let (near, far) = (f64::from(lamp.near), f64::from(lamp.far));
        let distance = near + (far - near) * share;
        let point = in_window(&lamp, x, y, distance);
        let error = (divided(&fit.uv_from_world, &fit, point) - divided(&moved.uv_from_world, &moved, point)).abs();
        let reach = metres + (point - lamp.position).length();
        let tangent = (f64::from(lamp.fov_y) * 0.5).tan() * f64::from(lamp.aspect).min(1.0);
        let bound = 16.0 * EPSILON * reach / distance * (1.0 + 1.0 / tangent + far / (far - near));
        prop_assert!(f64::from(error.max_element()) <= bound, "{error} of {bound:e}");
        let world = moved.world_matrices();
        prop_assert_eq!(world.clip_from_world, fit.relative_to(DVec3::ZERO).clip_from_world);
        prop_assert_eq!(world.clip_from_light, fit.clip_from_light);
    }

    /// A power of two scales without rounding.
    #[test]
    fn another_unit_of_length_changes_no_place_in_the_map(
        lamp in any_lamp(), depth in any_depth(), power in -8..8_i32,
    ) {
        let scale = 2.0_f32.powi(power);
        let scaled = SpotLight {
            position: lamp.position * f64::from(scale), near: lamp.near * scale, far: lamp.far * scale, ..lamp
        };
        let (fit, other) = (fitted(&lamp, depth), fitted(&scaled, depth));
        prop_assert_eq!(fit.light_from_world, other.light_from_world);
        prop_assert_eq!(fit.texel_size, other.texel_size);
        let point = fit.direction * lamp.far * 0.3;
        let (here, there) = (fit.uv_from_world * point.extend(1.0), other.uv_from_world * (point * scale).extend(1.0));
        prop_assert_eq!(here * scale, there);
    }

    /// The axes of the moved light are rounded again: by a step of f32 in each, relative to the window.
    #[test]
    fn a_rigid_motion_of_light_and_point_changes_no_place_in_the_map(
        lamp in any_lamp(), depth in any_depth(),
        (axis, turn, shift) in (any_direction(), double(0.0, 6.3), any_direction()),
        (x, y, share) in (double(-1.0, 1.0), double(-1.0, 1.0), double(0.0, 1.0)),
    ) {
        prop_assume!(lamp.direction.cross(lamp.up).length() > 0.1);
        let rotation = DQuat::from_axis_angle(axis.as_dvec3().normalize(), turn);
        let shift = shift.as_dvec3() * 500.0;
        let turned = |v: Vec3| (rotation * v.as_dvec3()).as_vec3();
        let moved = SpotLight {
            position: rotation * lamp.position + shift, direction: turned(lamp.direction), up: turned(lamp.up), ..lamp
        };
        let (fit, other) = (fitted(&lamp, depth), fitted(&moved, depth));
        let distance = f64::from(lamp.near) * (1.0 - share) + f64::from(lamp.far) * share;
        let point = in_window(&lamp, x, y, distance);
        let here = divided(&fit.uv_from_world, &fit, point);
        let there = divided(&other.uv_from_world, &other, rotation * point + shift);
        let tangent = (f64::from(lamp.fov_y) * 0.5).tan() * f64::from(lamp.aspect).min(1.0);
        let stretch = (point - lamp.position).length() / distance;
        let factor = f64::from(lamp.far / (lamp.far - lamp.near));
        // Directions that are nearly parallel to up turn the roll by ten steps.
        let bound = 64.0 * EPSILON * stretch * stretch * (1.0 + 1.0 / tangent + factor);
        prop_assert!(f64::from((here - there).abs().max_element()) <= bound, "{here} for {there}, {bound:e}");
    }

    #[test]
    fn reversed_depth_is_one_less_the_plain_one_and_changes_nothing_else(
        lamp in any_lamp(), (x, y, share) in (double(-1.0, 1.0), double(-1.0, 1.0), double(0.0, 1.0)),
    ) {
        prop_assume!(lamp.direction.cross(lamp.up).length() > 0.1);
        let [plain, reversed, open_gl] = DEPTHS.map(|depth| fitted(&lamp, depth));
        prop_assert_eq!(plain.light_from_world, reversed.light_from_world);
        prop_assert_eq!(plain.caster_volume(), reversed.caster_volume());
        let distance = f64::from(lamp.near) * (1.0 - share) + f64::from(lamp.far) * share;
        let point = in_window(&lamp, x, y, distance);
        let [plain, reversed, open_gl] = [plain, reversed, open_gl].map(|fit| divided(&fit.uv_from_world, &fit, point));
        prop_assert_eq!(plain.truncate(), reversed.truncate());
        // The plain depth is a difference of terms of this size.
        let stretch = (point - lamp.position).length() / distance;
        let bound = 32.0 * EPSILON as f32 * (lamp.far / (lamp.far - lamp.near)) * (1.0 + stretch as f32);
        prop_assert!((plain.z + reversed.z - 1.0).abs() <= bound, "{} and {}", plain.z, reversed.z);
        prop_assert!((plain.z - open_gl.z).abs() <= bound, "{} and {}", plain.z, open_gl.z);
    }

    #[test]
    fn no_point_that_the_map_covers_is_culled(
        lamp in any_lamp(), away in any_direction(),
        (x, y, share) in (double(-1.0, 1.0), double(-1.0, 1.0), double(0.0, 1.0)),
    ) {
        prop_assume!(lamp.direction.cross(lamp.up).length() > 0.1);
        let fit = fitted(&lamp, ZeroToOne).relative_to(lamp.position + away.as_dvec3() * 30.0);
        let distance = f64::from(lamp.near) * (1.0 - share) + f64::from(lamp.far) * share;
        let point = in_window(&lamp, x, y, distance);
        prop_assert!(fit.covers(point));
        prop_assert!(fit.caster_volume().intersects_sphere((point - fit.origin).as_vec3(), 0.0));
    }
}
