//! Fits that are defined as minimal, compared with brute-force searches without hulls, calipers or Welzl's
//! construction.

use proptest::prelude::*;
use shadowfit::glam::{DVec2, DVec3, Mat3, UVec2, Vec3};
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, RectangleKind};
use shadowfit::{LightProjection, ViewFrustum};

use crate::scenes::{any_light, any_view, of_camera};
use crate::support::{any_camera, any_direction, cases};

/// Returns the extents of points along a direction of the plane and across it.
fn extents(points: &[DVec2], angle: f64) -> DVec2 {
    let (sin, cos) = angle.sin_cos();
    let (mut min, mut max) = (DVec2::MAX, DVec2::MIN);
    for p in points {
        let q = DVec2::new(p.x * cos + p.y * sin, p.y * cos - p.x * sin);
        (min, max) = (min.min(q), max.max(q));
    }
    max - min
}

/// Returns the least cost of all angles: tried every 0.09°, then ever closer around the best of them.
fn least(points: &[DVec2], cost: impl Fn(DVec2) -> f64) -> f64 {
    let (mut centre, mut best) = (0.0, f64::MAX);
    let mut step = std::f64::consts::FRAC_PI_2 / 1000.0;
    let mut steps = 1000;
    while step > 1e-9 {
        let middle = centre;
        for i in -steps..=steps {
            let angle = middle + step * f64::from(i);
            let found = cost(extents(points, angle));
            if found < best {
                (centre, best) = (angle, found);
            }
        }
        (step, steps) = (step * 0.1, 20);
    }
    best
}

/// Returns the corners in the plane of a fit's own axes.
fn projected(fit: &LightProjection, frustum: &ViewFrustum) -> Vec<DVec2> {
    let axes = Mat3::from_mat4(fit.light_from_world).as_dmat3();
    frustum.corners.iter().map(|corner| (axes * corner.as_dvec3()).truncate()).collect()
}

fn oriented(frustum: &ViewFrustum, direction: Vec3, rectangle: RectangleKind) -> LightProjection {
    let settings = FitSettings::default()
        .with_kind(FitKind::Oriented)
        .with_rectangle(rectangle)
        .with_max_distance(f32::MAX)
        .with_casters(CasterPolicy::None)
        .with_border(0.0)
        .with_resolution(UVec2::splat(64));
    shadowfit::fit(frustum, direction, &settings).unwrap()
}

/// Excess of a fit over the least one by its margin for rounding, 28 · 2⁻²⁴ of the reach on each side. The
/// width of a narrow view seen end-on is 1e-2 of its reach, so that the margin is 3e-4 of its width.
const TOLERANCE: f64 = 1e-3;

fn assert_least_rectangles(frustum: &ViewFrustum, direction: Vec3) {
    let area = |size: DVec2| size.x * size.y;
    let fit = oriented(frustum, direction, RectangleKind::MinimumArea);
    let size = (fit.box_max - fit.box_min).truncate().as_dvec2();
    let best = least(&projected(&fit, frustum), area);
    assert!(area(size) <= best * (1.0 + TOLERANCE) && area(size) >= best, "area {} for {best}", area(size));
    let fit = oriented(frustum, direction, RectangleKind::MinimumSquare);
    let size = (fit.box_max - fit.box_min).truncate().as_dvec2();
    let best = least(&projected(&fit, frustum), DVec2::max_element);
    assert!(size.x <= best * (1.0 + TOLERANCE) && size.x >= best, "side {} for {best}", size.x);
    assert!((size.x - size.y).abs() <= 1e-6 * size.x, "{size} is no square");
}

/// Returns the sphere through up to four points with its centre in their plane, by Cramer's rule.
fn circumsphere(points: &[DVec3]) -> Option<(DVec3, f64)> {
    let a = points[0];
    let d: Vec<DVec3> = points[1..].iter().map(|p| *p - a).collect();
    let offset = match d.as_slice() {
        [] => DVec3::ZERO,
        [b] => *b * 0.5,
        [b, c] => {
            let n = b.cross(*c);
            (n.cross(*b) * c.dot(*c) + c.cross(n) * b.dot(*b)) / (2.0 * n.dot(n))
        }
        [b, c, e] => {
            let numerator = c.cross(*e) * b.dot(*b) + e.cross(*b) * c.dot(*c) + b.cross(*c) * e.dot(*e);
            numerator / (2.0 * b.dot(c.cross(*e)))
        }
        _ => return None,
    };
    let radius = offset.length();
    radius.is_finite().then_some((a + offset, radius))
}

/// Returns the least radius of all spheres through two to four corners that contain the others.
fn least_radius(corners: &[DVec3; 8]) -> f64 {
    let mut best = f64::MAX;
    for set in 1_u32..256 {
        if !(2..=4).contains(&set.count_ones()) {
            continue;
        }
        let support: Vec<DVec3> = (0..8).filter(|i| set & (1 << i) != 0).map(|i| corners[i]).collect();
        if let Some((centre, radius)) = circumsphere(&support) {
            // Nearly flat sets are rounded by up to 1e-9 of their radius.
            let holds = corners.iter().all(|corner| corner.distance(centre) <= radius * (1.0 + 1e-7));
            best = if holds { best.min(radius) } else { best };
        }
    }
    best
}

fn assert_least_sphere(frustum: &ViewFrustum) {
    let corners = frustum.corners.map(Vec3::as_dvec3);
    let (centre, radius) = frustum.enclosing_sphere().unwrap();
    let best = least_radius(&corners);
    assert!((radius / best - 1.0).abs() <= 1e-4, "{radius} for {best}");
    for corner in corners {
        assert!(corner.distance(centre) <= radius * (1.0 + 2e-6), "{corner} is outside of {radius} around {centre}");
    }
}

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn no_angle_gives_a_rectangle_or_square_that_is_less(view in any_view(), direction in any_light()) {
        assert_least_rectangles(&view.frustum(), direction);
    }

    #[test]
    fn no_angle_gives_less_for_a_camera(camera in any_camera(), direction in any_direction()) {
        assert_least_rectangles(&of_camera(&camera).frustum(), direction);
    }

    #[test]
    fn no_sphere_through_corners_is_less(view in any_view(), camera in any_camera()) {
        assert_least_sphere(&view.frustum());
        assert_least_sphere(&camera.frustum().unwrap());
    }
}
