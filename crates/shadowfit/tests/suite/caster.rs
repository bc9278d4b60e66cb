//! The caster volume culls nothing that the map can store.

use proptest::prelude::*;
use shadowfit::FitKind;
use shadowfit::glam::{DVec3, Vec3};

use crate::support::{DIRECTION, KINDS, any_camera, any_direction, any_kind, camera, exact, fitted, float};

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

    /// Planes bound the same set as `covers`, away from its 1e-6 slack.
    #[test]
    fn a_point_is_inside_all_planes_where_it_is_covered(
        direction in any_direction(), kind in any_kind(),
        (x, y, z) in (float(-100.0, 100.0), float(-100.0, 100.0), float(-100.0, 100.0)),
    ) {
        let fit = fitted(&camera(), direction, &exact(kind));
        let point = Vec3::new(x, y, z);
        let least = fit.caster_volume().planes.iter().map(|p| p.truncate().dot(point) + p.w).fold(f32::MAX, f32::min);
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
        for plane in volume.planes {
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
    // The least distance at which a large cube, wholly beyond the corner along its diagonal,
    // shares no point with the volume, but is behind none of its planes.
    let cube = k[0] + outward * 1.0 + outward.signum() * large;
    assert!(volume.intersects_aabb(cube - large, cube + large));
    assert!(!fit.covers(fit.origin + DVec3::from(cube - outward.signum() * large)));
}
