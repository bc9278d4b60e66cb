//! The automatic bias clears planes, and a smaller one does not.

use proptest::prelude::*;
use shadowfit::bias::{
    ACOS_BIAS_LIMIT, FilterRadius, MIN_COSINE, XNA_DEPTH_BIAS, acos_bias, acos_epsilon, automatic_normal_offset,
    depth_gradient, depth_precision,
};
use shadowfit::diagnostics::DepthStorage;
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, MapFormat, SoftRadius, Softness};
use shadowfit::{Bias, LightProjection};

use crate::filters::{Filter, filters};
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

    /// Returns the unit normal toward the light (+z), and the sine of its angle to z.
    fn normal(&self) -> (DVec3, f64) {
        let normal = (-self.slope).extend(1.0).normalize();
        (normal, normal.truncate().length())
    }

    /// Returns the least clearance, in metres along the light, of a point of the plane that is lifted by
    /// `offset` · sin θ along the normal, above all texel centres of the filter. Negative values are acne.
    fn clearance(&self, at: DVec2, texel: f64, offset: f64, filter: &Filter) -> f64 {
        let (normal, sine) = self.normal();
        let lifted = at.extend(self.height(at)) + normal * (offset * sine);
        let texels = lifted.truncate() / texel;
        filter.texels(texels).map(|c| lifted.z - self.height(c * texel)).fold(f64::INFINITY, f64::min)
    }
}

/// A disc of up to 3.5 texels for the soft filters.
const SOFTNESS: Softness = Softness { radius: SoftRadius::Metres(1.0), floor: 1.0, ceiling: 3.5 };

/// Returns all kinds of filters with their footprints.
fn kinds() -> Vec<(FilterKind, Filter)> {
    FilterKind::ALL.into_iter().map(|kind| (kind, Filter::of_kind(kind, &SOFTNESS))).collect()
}

/// Returns the offset, in square texels' sides, that a plane needs if its slope has this azimuth in the map.
fn plane_normal_offset(reach: f32, azimuth: f32) -> f32 {
    reach * (azimuth.cos().abs() + azimuth.sin().abs())
}

proptest! {
    /// In f64, so 1e-9 of a texel is rounding.
    #[test]
    fn the_plane_offset_clears_a_plane_at_every_azimuth_and_position(
        theta in double(0.0, 1.5), azimuth in double(0.0, 6.3), texel in double(0.01, 10.0), (x, y) in (double(-100.0, 100.0), double(-100.0, 100.0)),
    ) {
        let plane = Plane::new(theta, azimuth);
        for (kind, filter) in kinds() {
            let texels = f64::from(plane_normal_offset(SOFTNESS.filter_radius(kind), azimuth as f32));
            // The offset itself is f32.
            let least = plane.clearance(DVec2::new(x, y), texel, texels * texel * (1.0 + 1e-6), &filter);
            prop_assert!(least >= -1e-9 * texel * plane.slope.length(), "{least:e}");
        }
    }

    #[test]
    fn the_automatic_offset_is_the_plane_offset_at_its_worst(azimuth in float(0.0, 6.3), reach in float(0.1, 4.0)) {
        prop_assert!(plane_normal_offset(reach, azimuth) <= automatic_normal_offset(reach) * (1.0 + 1e-6));
        let worst = plane_normal_offset(reach, std::f32::consts::FRAC_PI_4);
        prop_assert!((worst / automatic_normal_offset(reach) - 1.0).abs() < 1e-6);
    }

    /// The stored and the compared depth of one point pass through different f32 roundings. The constant
    /// covers both.
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
        let allowed = f64::from(Bias::automatic(0.5, DepthStorage::Float32, &fit).unwrap().constant_depth);
        prop_assert!(2.0 * (exact - rounded).abs() <= allowed, "{:e} of {allowed:e}", 2.0 * (exact - rounded).abs());
    }
}

#[test]
fn five_percent_less_than_the_plane_offset_leaves_acne() {
    for (kind, filter) in kinds() {
        for azimuth in [0.0, 0.3, 0.785, 1.2, 2.5, 4.0, 5.5] {
            let plane = Plane::new(1.2, azimuth);
            // A disc reaches equally far at all azimuths. The box of a look-up reaches farther along its
            // diagonals.
            let disc = f64::from(SOFTNESS.filter_radius(kind) - kind.filter_radius());
            let offset = 0.95 * (disc + f64::from(plane_normal_offset(kind.filter_radius(), azimuth as f32)));
            let side = if kind.is_soft() { 30 } else { 100 };
            let worst = (0..side * side)
                .map(|i| DVec2::new(f64::from(i % side), f64::from(i / side)) * (1.01 / f64::from(side)))
                .map(|at| plane.clearance(at, 1.0, offset, &filter))
                .fold(f64::INFINITY, f64::min);
            assert!(worst < 0.0, "{kind:?} at {azimuth}: {worst}");
        }
    }
}

#[test]
fn texels_become_depth_and_metres_by_the_longer_side() {
    let settings = exact(FitKind::FrustumAabb).with_resolution(UVec2::new(512, 2048));
    let fit: LightProjection = fitted(&camera(), DIRECTION, &settings);
    let texel = fit.texel_size.max_element();
    assert!(fit.texel_size.min_element() < texel);
    let settings =
        BiasSettings { constant: 0.5, slope: 2.0, normal_offset: 3.0, receiver_plane: 0.7, depth_steps: 2.0 };
    for format in [MapFormat::R32Float, MapFormat::Rgba8Packed] {
        assert_eq!(
            Bias::from_texels(&settings, format, &fit),
            Bias::from_texels(&settings, MapFormat::default(), &fit)
        );
    }
    let bias = Bias::from_texels(&settings.with_depth_steps(0.0), MapFormat::default(), &fit);
    assert_eq!(bias.constant_depth, 0.5 * texel / fit.depth_range);
    assert_eq!(bias.slope_depth, 2.0 * texel / fit.depth_range);
    assert_eq!(bias.normal_offset, 3.0 * texel);
    assert_eq!(bias.receiver_plane, 0.7);
    // A depth bias is a distance along the light, in texels.
    let lifted = -fit.direction * (0.5 * texel);
    let moved = apply(&fit.uv_from_world, Vec3::ZERO).z - apply(&fit.uv_from_world, lifted).z;
    assert!((moved / bias.constant_depth - 1.0).abs() < 1e-2, "{moved} for {}", bias.constant_depth);
}

#[test]
fn automatic_settings_follow_the_filter_s_reach() {
    let softness = Softness::default().with_ceiling(8.0);
    for (filter, e) in FilterKind::ALL.into_iter().zip([0.5, 1.0, 2.0, 3.0, 4.0, 9.0, 9.0, 9.0, 9.0]) {
        let offset = BiasSettings::automatic_normal_offset(filter, &softness);
        assert_eq!((offset.normal_offset, offset.receiver_plane), (std::f32::consts::SQRT_2 * e, 0.0));
        let settings = BiasSettings::automatic(filter);
        // For any filter, only the reach of a single comparison remains to be cleared.
        assert_eq!(settings.receiver_plane, if filter == FilterKind::Point { 0.5 } else { 1.0 } + 1.0 / 256.0);
        assert_eq!((settings.slope, settings.normal_offset, settings.constant), (0.0, 0.0, offset.constant));
        // The constant and one step of the format cover the precision of an ordinary fit.
        let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb).with_caster_extension(1000.0));
        for format in MapFormat::ALL {
            let settings = Bias::from_texels(&settings, format, &fit);
            let least = Bias::automatic(filter, format, &fit).unwrap().constant_depth;
            assert!(settings.constant_depth >= least, "{filter:?} {format:?}: {settings:?} {least}");
        }
    }
}

#[test]
fn the_automatic_bias_is_the_worst_azimuth_s_on_hardware() {
    let settings = exact(FitKind::FrustumAabb).with_resolution(UVec2::new(512, 2048));
    let fit: LightProjection = fitted(&camera(), DIRECTION, &settings);
    let reach = FilterRadius::kernel(3);
    let bias = Bias::automatic(reach, DepthStorage::Unorm16, &fit).unwrap();
    let needed = f64::from(reach.on_hardware(&fit).taps) * fit.texel_size.as_dvec2().length();
    assert!((f64::from(bias.normal_offset) / needed - 1.0).abs() < 1e-6, "{bias:?} for {needed}");
    // Less than 1% of it is for the hardware. Less than half a step of the constant is for f32 rounding.
    assert!(needed < 1.01 * 2.0 * fit.texel_size.as_dvec2().length());
    assert!(bias.constant_depth > 1.0 / 65_535.0 && bias.constant_depth < 1.5 / 65_535.0, "{bias:?}");
    let plane = Bias::automatic_receiver_plane(reach, DepthStorage::Float32, &fit).unwrap();
    assert_eq!(plane.receiver_plane, reach.on_hardware(&fit).taps);
    assert_eq!(plane.constant_depth, depth_precision(&fit, DepthStorage::Float32));
}

#[test]
fn reaches_are_what_their_filters_read() {
    for filter in filters() {
        let mut greatest = 0.0_f64;
        for i in 0..4000 {
            let at = DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i);
            greatest = filter.texels(at).fold(greatest, |m, centre| m.max((centre - at).abs().max_element()));
        }
        let reach = f64::from(filter.reach.per_axis());
        assert!(greatest <= reach && greatest > 0.97 * reach, "{}: {greatest} of {reach}", filter.name);
    }
    assert_eq!([1, 3, 5, 7].map(|taps| FilterRadius::kernel(taps).per_axis()), [1.0, 2.0, 3.0, 4.0]);
    let tents = [3, 5, 7].map(FilterRadius::kernel);
    let of_kinds = [FilterRadius::POINT, FilterRadius::HARDWARE_2X2]
        .into_iter()
        .chain(tents)
        .chain([FilterRadius::HARDWARE_2X2; 4]);
    assert_eq!(FilterKind::ALL.map(FilterRadius::from).to_vec(), of_kinds.collect::<Vec<_>>());
}

#[test]
fn a_bias_on_a_plane_is_the_sum_of_its_forms() {
    let fit: LightProjection = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let bias = Bias { constant_depth: 0.001, slope_depth: 0.002, normal_offset: 0.3, receiver_plane: 1.5 };
    let to_light = -fit.direction;
    let across = to_light.any_orthonormal_vector();
    for degrees in [0.0_f32, 20.0, 60.0, 85.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let normal = to_light * cosine + across * sine;
        let on_plane = bias.on_plane(&fit, normal).unwrap();
        assert!((on_plane.offset - 0.3 * sine).abs() < 1e-6, "{degrees}: {on_plane:?}");
        let gradient = depth_gradient(&fit, normal).unwrap().abs();
        let depth = 0.001 + 0.002 * sine / cosine + 1.5 * (gradient.x + gradient.y);
        assert!((on_plane.depth / depth - 1.0).abs() < 1e-4, "{degrees}: {on_plane:?} for {depth}");
        let turned = bias.on_plane(&fit, -normal * 7.0).unwrap();
        assert!((turned.depth / on_plane.depth - 1.0).abs() < 1e-4, "the side and length of a normal do not matter");
    }
    // At grazing light, every part is limited by the least cosine.
    let grazing = bias.on_plane(&fit, across).unwrap();
    assert!(grazing.depth < 0.001 + (0.002 + 1.5) / MIN_COSINE && grazing.depth.is_finite(), "{grazing:?}");
    assert_eq!(Bias::fixed(XNA_DEPTH_BIAS).unwrap(), Bias { constant_depth: 0.001, ..Bias::default() });
    assert_eq!(Bias::fixed(0.001).unwrap(), Bias { constant_depth: 0.001, ..Bias::default() });
}

#[test]
fn epsilon_over_acos_is_largest_head_on_and_least_at_grazing_light() {
    let at = |radians: f32| acos_bias(acos_epsilon(FilterKind::Point), radians.cos()).unwrap();
    assert_eq!(at(0.0), ACOS_BIAS_LIMIT);
    assert!((at(0.1) / 0.01 - 1.0).abs() < 1e-4, "{}", at(0.1));
    assert!((at(std::f32::consts::FRAC_PI_2) - 0.000_637).abs() < 1e-6);
    assert!((0..90).map(|i| (i as f32).to_radians()).all(|a| at(a) >= at(a + 0.01)), "it falls with the angle");
    // Saturated on both sides, and half with linear filtering.
    assert_eq!(acos_bias(0.001, 2.0).unwrap(), ACOS_BIAS_LIMIT);
    assert_eq!(acos_bias(0.001, -0.7).unwrap(), acos_bias(0.001, 0.0).unwrap());
    assert_eq!(acos_epsilon(FilterKind::Hardware2x2), 0.0005);
    assert_eq!(acos_bias(0.0, 1.0).unwrap(), 0.0);
}

/// A negative constant asks for less than the rounding needs, as in a comparison without bias.
#[test]
fn a_negative_constant_stays_as_it_is_on_large_grounds() {
    let settings = BiasSettings { constant: -1.0 / 32.0, ..BiasSettings::automatic(FilterKind::Point) };
    let fit = LightProjection { vertex_distance: 5e4, ..fitted(&camera(), DIRECTION, &exact(FitKind::Focused)) };
    let bias = Bias::from_texels(&BiasSettings { depth_steps: 1.0, ..settings }, MapFormat::Depth32Float, &fit);
    let metres = bias.constant_depth * fit.depth_range;
    let expected = -fit.texel_size.max_element() / 32.0;
    assert!(metres >= expected && metres < expected * 0.5, "{metres} for {expected}");
}
