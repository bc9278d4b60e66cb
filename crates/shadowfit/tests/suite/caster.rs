//! The volume of all points that a map can store, and the tests of single shapes against it.

use proptest::prelude::*;
use shadowfit::culling::OrientedBox;
use shadowfit::glam::{DVec3, Mat3, Mat4, Vec3, Vec4};
use shadowfit::settings::{CasterPolicy, FitKind};
use shadowfit::{Aabb, CasterVolume};

use crate::support::{DIRECTION, KINDS, any_camera, any_direction, any_kind, camera, double, exact, fitted, float};

proptest! {
    #[test]
    fn a_box_around_any_covered_point_is_kept(
        camera in any_camera(), direction in any_direction(), kind in any_kind(),
        (a, b, c) in (float(0.0, 1.0), float(0.0, 1.0), float(0.0, 1.0)), half in float(0.0, 2.0),
    ) {
        let fit = fitted(&camera, direction, &exact(kind));
        let k = fit.corners();
        let point = k[0] + (k[1] - k[0]) * a + (k[3] - k[0]) * b + (k[4] - k[0]) * c;
        prop_assert!(fit.caster_volume().intersects_aabb(point - half, point + half));
    }

    /// Rounding is on the safe side even at the very border, and far from the planes' origin.
    #[test]
    fn the_corners_of_a_map_are_inside_wherever_the_origin_is(
        camera in any_camera(), direction in any_direction(), kind in any_kind(),
        (x, y, z) in (double(-1e5, 1e5), double(-1e5, 1e5), double(-1e5, 1e5)),
    ) {
        let fit = fitted(&camera, direction, &exact(kind));
        let volume = fit.caster_volume();
        for origin in [fit.origin, fit.origin + DVec3::new(x, y, z)] {
            let moved = volume.relative_to(origin);
            for corner in fit.corners() {
                let corner = (fit.origin - origin + corner.as_dvec3()).as_vec3();
                prop_assert!(moved.intersects_aabb(corner, corner), "{} relative to {}", corner, origin);
                prop_assert!(moved.intersects_sphere(corner, 0.0));
                let flat = OrientedBox { centre: corner, ..OrientedBox::default() };
                prop_assert!(moved.intersects_obb(&flat));
            }
        }
    }

    /// The planes bound the same set as `covers`, up to its tolerance of 1e-6.
    #[test]
    fn a_point_is_inside_all_planes_where_it_is_covered(
        direction in any_direction(), kind in any_kind(),
        (x, y, z) in (float(-100.0, 100.0), float(-100.0, 100.0), float(-100.0, 100.0)),
    ) {
        let fit = fitted(&camera(), direction, &exact(kind));
        let point = Vec3::new(x, y, z);
        let least = fit.caster_volume().active_planes().iter().map(|p| p.truncate().dot(point) + p.w).fold(f32::MAX, f32::min);
        prop_assume!(least.abs() > 1e-3);
        prop_assert_eq!(least > 0.0, fit.covers(fit.origin + point.as_dvec3()));
    }
}

#[test]
fn boxes_beyond_each_side_are_culled() {
    for kind in KINDS {
        let fit = fitted(&camera(), DIRECTION, &exact(kind));
        let centre = fit.corners().into_iter().sum::<Vec3>() / 8.0;
        let volume = fit.caster_volume();
        for plane in volume.active_planes() {
            let n = plane.truncate();
            let distance = n.dot(centre) + plane.w;
            let on_plane = centre - n * distance;
            // A box of half size 1 reaches at most √3 along any normal.
            let outside = on_plane - n * 1.8;
            assert!(!volume.intersects_aabb(outside - 1.0, outside + 1.0), "{kind:?} {plane}");
            assert!(volume.intersects_aabb(on_plane - 1.0, on_plane + 1.0), "{kind:?} {plane}");
        }
    }
}

#[test]
fn bounds_that_are_nan_are_kept() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    assert!(fit.caster_volume().intersects_aabb(Vec3::NAN, Vec3::NAN));
}

#[test]
fn a_box_outside_past_an_edge_is_the_known_false_positive() {
    // Light along the diagonal, so that the volume's edges are oblique to the box.
    let fit = fitted(&camera(), Vec3::new(1.0, -1.0, 1.0), &exact(FitKind::FrustumAabb));
    let k = fit.corners();
    let centre = k.into_iter().sum::<Vec3>() / 8.0;
    let outward = (k[0] - centre).normalize();
    let large = 500.0;
    let volume = fit.caster_volume();
    // The least distance at which a large cube beyond the corner, along its diagonal, has no point in the
    // volume but is not behind any of its planes.
    let cube = k[0] + outward * 1.0 + outward.signum() * large;
    assert!(volume.intersects_aabb(cube - large, cube + large));
    assert!(!fit.covers(fit.origin + DVec3::from(cube - outward.signum() * large)));
}

#[test]
fn empty_boxes_and_spheres_touch_nothing_and_nan_touches_everything() {
    let everywhere = CasterVolume::everywhere(DVec3::ZERO);
    let nowhere = CasterVolume::nowhere(DVec3::ZERO);
    assert!(!everywhere.intersects_aabb(Vec3::ONE, Vec3::new(2.0, 2.0, 0.9)));
    assert!(!everywhere.intersects_aabb(Aabb::EMPTY.min, Aabb::EMPTY.max));
    assert!(!everywhere.intersects_sphere(Vec3::ZERO, -1.0));
    let box_with_nan = OrientedBox { centre: Vec3::ZERO, half_axes: [Vec3::X, Vec3::NAN, Vec3::Z] };
    for volume in [everywhere, nowhere, fitted(&camera(), DIRECTION, &exact(FitKind::Sphere)).caster_volume()] {
        assert!(volume.intersects_aabb(Vec3::ZERO, Vec3::new(1.0, f32::NAN, 1.0)));
        assert!(volume.intersects_sphere(Vec3::ZERO, f32::NAN));
        assert!(volume.intersects_obb(&box_with_nan));
    }
    assert!(everywhere.intersects_aabb(Vec3::ZERO, Vec3::ZERO));
    assert!(!nowhere.intersects_aabb(Vec3::ZERO, Vec3::ZERO));
}

#[test]
fn with_depth_clamp_a_map_holds_casters_before_its_near_plane_too() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let corners = fit.corners();
    let before = (corners[0] + corners[2]) * 0.5 - fit.direction * 1000.0;
    assert!(!CasterVolume::of_map(&fit, CasterPolicy::PerObject).intersects_sphere(before, 1.0));
    let clamped = CasterVolume::of_map(&fit, CasterPolicy::DepthClamp);
    assert!(clamped.intersects_sphere(before, 1.0));
    assert_eq!(clamped.cut_at_near_plane(&fit), CasterVolume::of_map(&fit, CasterPolicy::None));
    assert_eq!(fit.caster_volume(), CasterVolume::of_map(&fit, CasterPolicy::None));
}

#[test]
fn planes_past_the_count_hold_everything_and_a_full_volume_takes_no_more() {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let mut volume = fit.caster_volume();
    assert_eq!(volume.count, 6);
    assert!(volume.planes[6..].iter().all(|plane| *plane == Vec4::W));
    volume.count = u32::MAX;
    assert_eq!(volume.active_planes().len(), CasterVolume::MAX_PLANES);
    assert_eq!(volume.cut_at_near_plane(&fit), volume);
}

proptest! {
    /// A sphere lies in its box, and a box in the box around it: if the smaller shape is kept, so is the
    /// larger one. The larger one is enlarged by the rounding of its own corners.
    #[test]
    fn tests_of_spheres_and_oriented_boxes_agree_with_those_of_the_boxes_around_them(
        kind in any_kind(), direction in any_direction(), axis in any_direction(), turn in float(0.0, 3.0),
        (x, y, z) in (float(-150.0, 150.0), float(-150.0, 150.0), float(-150.0, 150.0)), half in float(0.0, 40.0),
        (a, b, c) in (float(0.0, 1.0), float(0.0, 1.0), float(0.0, 1.0)),
    ) {
        let volume = fitted(&camera(), direction, &exact(kind)).caster_volume();
        let (centre, half) = (Vec3::new(x, y, z), half * Vec3::new(a, b, c));
        let rounding = 1e-4;
        let placed = Mat4::from_translation(centre) * Mat4::from_mat3(Mat3::from_axis_angle(axis.normalize(), turn));
        let (local, larger) = (Aabb::new(-half, half), Aabb::new(-half - rounding, half + rounding));
        let turned = OrientedBox::from_local(&placed, &local);
        let around = turned.half_axes.into_iter().map(Vec3::abs).sum::<Vec3>() + rounding;
        let radius = half.min_element();
        if volume.intersects_obb(&turned) {
            prop_assert!(volume.intersects_aabb(centre - around, centre + around));
        }
        if volume.intersects_sphere(centre, radius) {
            prop_assert!(volume.intersects_obb(&OrientedBox::from_local(&placed, &larger)));
        }
        let straight = OrientedBox::from_local(&Mat4::from_translation(centre), &local);
        if volume.intersects_obb(&straight) {
            prop_assert!(volume.intersects_aabb(centre + larger.min, centre + larger.max));
        }
        if volume.intersects_aabb(centre - half, centre + half) {
            let larger = OrientedBox::from_local(&Mat4::from_translation(centre), &larger);
            prop_assert!(volume.intersects_obb(&larger));
        }
    }

    /// Moving by whole metres and back shifts planes only by the rounding of their distance.
    #[test]
    fn a_moved_volume_is_the_same_one(
        kind in any_kind(), direction in any_direction(), (x, y, z) in (-1000..1000_i32, -1000..1000_i32, -1000..1000_i32),
        (a, b, c) in (float(-100.0, 100.0), float(-100.0, 100.0), float(-100.0, 100.0)), radius in float(0.0, 20.0),
    ) {
        let volume = fitted(&camera(), direction, &exact(kind)).caster_volume();
        let offset = DVec3::new(x.into(), y.into(), z.into());
        let moved = volume.relative_to(volume.origin + offset);
        prop_assert_eq!(volume.relative_to(volume.origin), volume);
        let centre = Vec3::new(a, b, c);
        // Rounding of both tests, of the planes' move, and of the moved centre: 1e-6 of 2,000 m each.
        let tolerance = 0.01;
        let centre_moved = (centre.as_dvec3() - offset).as_vec3();
        if volume.intersects_sphere(centre, radius) {
            prop_assert!(moved.intersects_sphere(centre_moved, radius + tolerance));
        }
        if moved.intersects_sphere(centre_moved, radius) {
            prop_assert!(volume.intersects_sphere(centre, radius + tolerance));
        }
    }
}
