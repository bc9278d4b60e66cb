//! The automatic bias clears planes, and no less would.

use proptest::prelude::*;
use shadowfit::bias::{automatic_normal_offset, plane_normal_offset, reach};
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::{Bias, BiasSettings, FilterKind, FitKind, LightFit};

use crate::support::{DIRECTION, any_camera, any_direction, any_kind, apply, camera, double, exact, fitted, float};

/// A plane z = slope · (x, y) in light space, metres, and its geometry.
struct Plane {
    slope: DVec2,
}

impl Plane {
    fn new(theta: f64, azimuth: f64) -> Self {
        Self { slope: DVec2::new(azimuth.cos(), azimuth.sin()) * theta.tan() }
    }

    fn height(&self, at: DVec2) -> f64 {
        self.slope.dot(at)
    }

    /// Unit normal toward the light (+z), and the sine of its angle to z.
    fn normal(&self) -> (DVec3, f64) {
        let normal = (-self.slope).extend(1.0).normalize();
        (normal, normal.truncate().length())
    }

    /// Least clearance, in metres along the light, of a point of the plane that is lifted by
    /// `offset` · sin θ along the normal, above all texel centres of the filter; negative is acne.
    fn clearance(&self, at: DVec2, texel: f64, offset: f64, filter: FilterKind) -> f64 {
        let (normal, sine) = self.normal();
        let lifted = at.extend(self.height(at)) + normal * (offset * sine);
        let texels = lifted.truncate() / texel;
        let centres: &[DVec2] = match filter {
            FilterKind::Point => &[texels.floor() + 0.5],
            FilterKind::Hardware2x2 => {
                let first = (texels - 0.5).floor() + 0.5;
                &[first, first + DVec2::X, first + DVec2::Y, first + 1.0]
            }
        };
        centres.iter().map(|c| lifted.z - self.height(*c * texel)).fold(f64::INFINITY, f64::min)
    }
}

const FILTERS: [FilterKind; 2] = [FilterKind::Point, FilterKind::Hardware2x2];

proptest! {
    /// In f64, so 1e-9 of a texel is rounding.
    #[test]
    fn the_plane_offset_clears_a_plane_at_every_azimuth_and_position(
        theta in double(0.0, 1.5), azimuth in double(0.0, 6.3), texel in double(0.01, 10.0), (x, y) in (double(-100.0, 100.0), double(-100.0, 100.0)),
    ) {
        let plane = Plane::new(theta, azimuth);
        for filter in FILTERS {
            let texels = f64::from(plane_normal_offset(reach(filter), azimuth as f32));
            // The offset itself is f32.
            let least = plane.clearance(DVec2::new(x, y), texel, texels * texel * (1.0 + 1e-6), filter);
            prop_assert!(least >= -1e-9 * texel * plane.slope.length(), "{least:e}");
        }
    }

    #[test]
    fn the_automatic_offset_is_the_plane_offset_at_its_worst(azimuth in float(0.0, 6.3), reach in float(0.1, 4.0)) {
        prop_assert!(plane_normal_offset(reach, azimuth) <= automatic_normal_offset(reach) * (1.0 + 1e-6));
        let worst = plane_normal_offset(reach, std::f32::consts::FRAC_PI_4);
        prop_assert!((worst / automatic_normal_offset(reach) - 1.0).abs() < 1e-6);
    }

    /// The stored and the compared depth of one point pass through different f32 roundings; the
    /// constant covers both.
    #[test]
    fn the_precision_constant_covers_f32_rounding_of_both_depths(
        camera in any_camera(), direction in any_direction(), kind in any_kind(),
        (a, b, c) in (float(0.0, 1.0), float(0.0, 1.0), float(0.0, 1.0)),
    ) {
        let fit = fitted(&camera, direction, &exact(kind));
        let corners = fit.corners();
        let point = corners[0] + (corners[1] - corners[0]) * a + (corners[3] - corners[0]) * b + (corners[4] - corners[0]) * c;
        let exact = (fit.uv_from_world.as_dmat4() * point.as_dvec3().extend(1.0)).z;
        let rounded = f64::from(apply(&fit.uv_from_world, point).z);
        let allowed = f64::from(Bias::automatic(0.5, &fit).constant_depth);
        prop_assert!(2.0 * (exact - rounded).abs() <= allowed, "{:e} of {allowed:e}", 2.0 * (exact - rounded).abs());
    }
}

#[test]
fn five_percent_less_than_the_plane_offset_leaves_acne() {
    for filter in FILTERS {
        for azimuth in [0.0, 0.3, 0.785, 1.2, 2.5, 4.0, 5.5] {
            let plane = Plane::new(1.2, azimuth);
            let offset = 0.95 * f64::from(plane_normal_offset(reach(filter), azimuth as f32));
            let worst = (0..10_000)
                .map(|i| DVec2::new(f64::from(i % 100), f64::from(i / 100)) * 0.0101)
                .map(|at| plane.clearance(at, 1.0, offset, filter))
                .fold(f64::INFINITY, f64::min);
            assert!(worst < 0.0, "{filter:?} at {azimuth}: {worst}");
        }
    }
}

#[test]
fn texels_become_depth_and_metres_by_the_longer_side() {
    let settings = exact(FitKind::FrustumAabb).with_resolution(UVec2::new(512, 2048));
    let fit: LightFit = fitted(&camera(), DIRECTION, &settings);
    let texel = fit.texel_size.max_element();
    assert!(fit.texel_size.min_element() < texel);
    let bias = Bias::from_texels(&BiasSettings { constant: 0.5, slope: 2.0, normal_offset: 3.0 }, &fit);
    assert_eq!(bias.constant_depth, 0.5 * texel / fit.depth_range);
    assert_eq!(bias.slope_depth, 2.0 * texel / fit.depth_range);
    assert_eq!(bias.normal_offset, 3.0 * texel);
    // A depth bias is as many metres along the light as it is texels.
    let lifted = -fit.direction * (0.5 * texel);
    let moved = apply(&fit.uv_from_world, Vec3::ZERO).z - apply(&fit.uv_from_world, lifted).z;
    assert!((moved / bias.constant_depth - 1.0).abs() < 1e-2, "{moved} for {}", bias.constant_depth);
}

#[test]
fn automatic_settings_follow_the_filter_s_reach() {
    for (filter, e) in [(FilterKind::Point, 0.5), (FilterKind::Hardware2x2, 1.0)] {
        let settings = BiasSettings::automatic(filter);
        assert_eq!(settings.normal_offset, std::f32::consts::SQRT_2 * e);
        assert_eq!(settings.slope, 0.0);
        // The constant covers the precision of an ordinary fit.
        let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb).with_caster_extension(1000.0));
        let (settings, exact) = (Bias::from_texels(&settings, &fit), Bias::automatic(e, &fit));
        assert!(settings.constant_depth >= exact.constant_depth);
        assert_eq!(settings.normal_offset, exact.normal_offset);
    }
}
