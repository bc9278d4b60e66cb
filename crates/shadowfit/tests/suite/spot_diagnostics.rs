//! A spot light's figures, against numbers worked out by hand and against what the matrices do.

use proptest::prelude::*;
use shadowfit::DepthConvention::{self, Reversed, ZeroToOne};
use shadowfit::bias::Reach;
use shadowfit::diagnostics::{Coverage, DepthStorage};
use shadowfit::glam::{DMat2, DVec2, DVec3, Mat4, UVec2, Vec2, Vec3};
use shadowfit::spot::diagnostics::{acne_margin, coverage, depth_step, pixels_per_texel, texel_size};
use shadowfit::{PerspectiveCamera, SpotBias, SpotFit, SpotLight};

use crate::spot::{DEPTHS, in_window, lamp};
use crate::support::{double, float};

/// A lamp at the origin that shines along -z through a window of 2 m × 2 m at 1 m, with 200 × 100 texels.
fn plain(depth: DepthConvention) -> SpotFit {
    let lamp = SpotLight {
        position: DVec3::ZERO,
        direction: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: std::f32::consts::FRAC_PI_2,
        aspect: 1.0,
        near: 1.0,
        far: 100.0,
    };
    lamp.fit(UVec2::new(200, 100), depth).unwrap()
}

/// A camera in the lamp's place with the same window.
fn camera_at(eye: DVec3) -> PerspectiveCamera {
    PerspectiveCamera {
        eye,
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: std::f32::consts::FRAC_PI_2,
        aspect: 1.0,
        near: 0.1,
        far: 500.0,
    }
}

#[test]
fn a_texel_grows_with_the_distance_along_the_axis() {
    let fit = plain(ZeroToOne);
    // 2 m / 200 and 2 m / 100 at 1 m; ten times that at 10 m, also far off the axis.
    for point in [DVec3::new(0.0, 0.0, -10.0), DVec3::new(9.0, -9.0, -10.0)] {
        let size = texel_size(&fit, point).unwrap().unwrap();
        assert!(size.abs_diff_eq(Vec2::new(0.1, 0.2), 1e-6), "{size}");
    }
    for behind in [DVec3::ZERO, DVec3::Z, DVec3::X] {
        assert_eq!(texel_size(&fit, behind), Ok(None));
    }
}

#[test]
fn a_headlamp_has_the_same_pixels_per_texel_at_every_distance_and_slope() {
    let fit = plain(ZeroToOne);
    let camera = camera_at(DVec3::ZERO).clip_from_world(Reversed);
    for (point, normal) in [
        (Vec3::new(0.0, 0.0, -5.0), Vec3::Z),
        (Vec3::new(3.0, 2.0, -8.0), Vec3::new(0.3, -0.4, 0.8)),
        (Vec3::new(-30.0, 40.0, -50.0), Vec3::new(0.0, -1.0, 0.1)),
    ] {
        let figure = pixels_per_texel(&fit, &camera, UVec2::new(800, 600), point, normal).unwrap().unwrap();
        // 800 / 200 pixels along u, 600 / 100 along v.
        assert!((figure.worse_axis - 6.0).abs() < 1e-3 && (figure.area - 24.0).abs() < 1e-2, "{point}: {figure:?}");
    }
}

#[test]
fn a_lamp_seen_from_afar_has_pixels_per_texel_by_both_distances() {
    // A floor point 4 m below the lamp, which shines down; the camera looks level along -z, 10 m behind it and at
    // floor + 1 m. Texel on the floor: 8 m / 400 = 0.02 m. Across, a pixel at 10 m is 20 m / 1000: one pixel a texel.
    // Along the view the floor is foreshortened by 1 m / 10 m.
    let lamp = SpotLight {
        position: DVec3::new(0.0, 4.0, 0.0),
        direction: Vec3::NEG_Y,
        fov_y: std::f32::consts::FRAC_PI_2,
        aspect: 1.0,
        ..lamp()
    };
    let fit = lamp.fit(UVec2::splat(400), ZeroToOne).unwrap();
    let camera = camera_at(DVec3::new(0.0, 1.0, 10.0));
    let fit = fit.relative_to(camera.eye);
    let figure = pixels_per_texel(
        &fit,
        &camera.clip_from_world(ZeroToOne),
        UVec2::splat(1000),
        Vec3::new(0.0, -1.0, -10.0),
        Vec3::Y,
    );
    let figure = figure.unwrap().unwrap();
    assert!((figure.worse_axis - 1.0).abs() < 1e-3 && (figure.area - 0.1).abs() < 1e-3, "{figure:?}");
}

#[test]
fn what_light_or_camera_cannot_see_has_no_pixels_per_texel() {
    let fit = plain(ZeroToOne);
    let camera = camera_at(DVec3::ZERO).clip_from_world(ZeroToOne);
    let figure = |point, normal| pixels_per_texel(&fit, &camera, UVec2::splat(100), point, normal).unwrap();
    assert!(figure(Vec3::new(0.0, 0.0, 5.0), Vec3::Z).is_none(), "behind both");
    assert!(figure(Vec3::new(0.0, 0.0, -5.0), Vec3::X).is_none(), "edge-on to the light");
    let other = camera_at(DVec3::new(0.0, 0.0, 20.0)).clip_from_world(ZeroToOne);
    let moved = fit.relative_to(DVec3::new(0.0, 0.0, 20.0));
    let behind = pixels_per_texel(&moved, &other, UVec2::splat(100), Vec3::new(0.0, 0.0, -15.0), Vec3::Z);
    assert_eq!(behind, Ok(None), "before the camera, behind the light");
}

#[test]
fn depth_steps_grow_with_the_square_of_the_distance_and_reversed_floats_keep_them_small() {
    let fit = plain(ZeroToOne);
    // B = 100 / 99. 16 bits at 10 m: x = 10 / (65535 B) = 1.510 65e-4, 10 x / (1 + x) = 0.001 510 4 m.
    let step = depth_step(&fit, DepthStorage::Unorm16, 10.0).unwrap();
    assert!((step - 0.001_510_4).abs() < 1e-7, "{step}");
    let farther = depth_step(&fit, DepthStorage::Unorm16, 100.0).unwrap();
    assert!((farther / step - 100.0).abs() < 0.2, "{farther}");
    // 8 bits at 100 m: x = 100 / (255 B) = 0.388 235, 100 x / (1 + x) = 27.966 m.
    let coarse = depth_step(&fit, DepthStorage::Unorm8, 100.0).unwrap();
    assert!((coarse - 27.966).abs() < 1e-3, "{coarse}");
    let plain_float = depth_step(&fit, DepthStorage::Float32, 90.0).unwrap();
    let reversed = depth_step(&plain(Reversed), DepthStorage::Float32, 90.0).unwrap();
    assert!(reversed * 500.0 < plain_float, "{reversed} and {plain_float}");
}

#[test]
fn coverage_tells_where_a_point_is() {
    let fit = plain(ZeroToOne);
    for (point, expected) in [
        (DVec3::new(0.0, 0.0, -10.0), Coverage::Covered),
        // A texel is 0.1 m wide here; 1.4 of them to the right side are fewer than the 2.5 of the filter's far texel.
        (DVec3::new(9.86, 0.0, -10.0), Coverage::Border),
        (DVec3::new(10.1, 0.0, -10.0), Coverage::Aside),
        (DVec3::new(0.0, -10.1, -10.0), Coverage::Aside),
        (DVec3::new(0.0, 0.0, -0.5), Coverage::BeforeNear),
        (DVec3::new(0.0, 0.0, 10.0), Coverage::BeforeNear),
        (DVec3::ZERO, Coverage::BeforeNear),
        (DVec3::new(0.0, 0.0, -101.0), Coverage::BehindFar),
        (DVec3::new(200.0, 0.0, -101.0), Coverage::Aside),
    ] {
        assert_eq!(coverage(&fit, Reach::taps(2.5), point), Ok(expected), "{point}");
        assert_eq!(fit.covers(point), expected.is_inside(), "{point}");
    }
}

#[test]
fn the_margin_of_the_automatic_bias_is_never_negative_and_that_of_none_is_the_need() {
    for depth in DEPTHS {
        let fit = plain(depth);
        for (x, y, z) in [(0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0.0, -0.9, 0.3), (0.7, 0.7, 0.1)] {
            let (normal, point) = (Vec3::new(x, y, z), DVec3::new(1.0, 2.0, -20.0));
            let margin = |bias: &SpotBias| {
                acne_margin(&fit, bias, Reach::kernel(3), DepthStorage::Float32, point, normal).unwrap().unwrap()
            };
            let automatic = SpotBias::automatic(Reach::kernel(3), DepthStorage::Float32, &fit).unwrap();
            // No less than what is needed, to the rounding of f32.
            assert!(margin(&automatic).texels >= -1e-6, "{depth:?} {normal}: {:?}", margin(&automatic));
            let plane = SpotBias::automatic_receiver_plane(Reach::kernel(3), DepthStorage::Float32, &fit).unwrap();
            assert!(margin(&plane).texels >= -1e-6, "{depth:?} {normal}: {:?}", margin(&plane));
            // Two texels of 0.2 m and 0.4 m, the sizes at 20 m.
            let unit = normal.normalize().abs();
            let needed = 2.0 * (0.2 * unit.x + 0.4 * unit.y);
            let none = margin(&SpotBias::default());
            assert!((none.metres + needed).abs() < 0.02 + 0.01 * needed, "{depth:?} {normal}: {none:?} for {needed}");
            assert!((none.texels / none.metres * 0.4 - 1.0).abs() < 1e-5);
        }
        let outside = DVec3::new(0.0, 30.0, -20.0);
        let automatic = SpotBias::default();
        assert_eq!(acne_margin(&fit, &automatic, 1.0, DepthStorage::Float32, outside, Vec3::Z), Ok(None));
    }
}

proptest! {
    /// The Jacobian against finite differences, in f64, of both matrices.
    #[test]
    fn pixels_per_texel_are_how_far_pixels_move_when_texels_do(
        (x, y, distance) in (double(-0.9, 0.9), double(-0.9, 0.9), double(2.0, 50.0)),
        (a, b) in (float(-1.5, 1.5), float(-1.5, 1.5)),
        (right, back) in (double(-5.0, 5.0), double(1.0, 20.0)),
    ) {
        let fit = lamp().fit(UVec2::new(512, 300), ZeroToOne).unwrap();
        let point = in_window(&lamp(), x, y, distance);
        let (u, v) = fit.direction.any_orthonormal_pair();
        let normal = (u * a + v * b - fit.direction).normalize();
        let forward = (normal * -0.6 + u * 0.3).normalize();
        let eye = point - forward.as_dvec3() * back + v.as_dvec3() * (right * 0.05 * back);
        let camera = PerspectiveCamera { eye, forward, up: v, ..camera_at(eye) };
        let fit = fit.relative_to(eye);
        let matrix = camera.clip_from_world(ZeroToOne);
        let relative = point - eye;
        let figure = pixels_per_texel(&fit, &matrix, UVec2::new(640, 480), relative.as_vec3(), normal).unwrap();
        prop_assume!(normal.dot((fit.position - point).as_vec3().normalize()).abs() > 0.05);
        let figure = figure.unwrap();
        let seen = |matrix: &Mat4, size: DVec2, p: DVec3| {
            let clip = matrix.as_dmat4() * p.extend(1.0);
            clip.truncate().truncate() / clip.w * 0.5 * size
        };
        // The tangents of the normal as rounded.
        let n = normal.as_dvec3().normalize();
        let (t, s) = n.any_orthonormal_pair();
        let step = 1e-5 * distance;
        let moved = |matrix: &_, size: DVec2| {
            let along = |d: DVec3| seen(matrix, size, relative + d * step) - seen(matrix, size, relative - d * step);
            DMat2::from_cols(along(t), along(s)) * (0.5 / step)
        };
        let texel = moved(&fit.clip_from_world, DVec2::new(512.0, 300.0));
        let jacobian = moved(&matrix, DVec2::new(640.0, 480.0)) * texel.inverse();
        let length = |i| (jacobian * DVec2::from_angle(f64::from(i) * 0.000_873)).length();
        let longest = (0..3600).map(length).fold(0.0, f64::max);
        prop_assert!((f64::from(figure.worse_axis) / longest - 1.0).abs() < 1e-3, "{figure:?} for {longest}");
        prop_assert!((f64::from(figure.area) / jacobian.determinant().abs() - 1.0).abs() < 1e-3, "{figure:?}");
    }

    /// One step of the format nearer the stored depth is a step less, in every convention.
    #[test]
    fn a_depth_step_nearer_the_light_changes_the_stored_depth_by_one_step(
        distance in float(1.0, 100.0), i in 0..3_usize,
    ) {
        let fit = plain(DEPTHS[i]);
        let metres = f64::from(depth_step(&fit, DepthStorage::Unorm16, distance).unwrap());
        let d = f64::from(distance);
        let change = (fit.depth_at(d) - fit.depth_at(d - metres)).abs() * 65_535.0;
        prop_assert!((change - 1.0).abs() < 1e-5, "{change}");
    }
}
