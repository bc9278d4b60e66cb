//! Under the automatic biases planes do not shadow themselves, and under half of them they do.
//!
//! The map is simulated: a texel stores the depth of the plane at its centre, and the filter reads the texels
//! of its definition.

use shadowfit::bias::{FilterRadius, depth_gradient, normal_offset, receiver_plane_depth};
use shadowfit::glam::{DVec2, DVec3, DVec4, Vec2, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{DepthConvention, LightProjection};

use crate::filters::{Filter, LookUp, filters};
use crate::support::{DIRECTION, camera, exact, fitted};

/// A plane through the light space's origin, given by its normal.
struct Plane {
    normal: DVec3,
    world_normal: Vec3,
}

impl Plane {
    /// Creates the plane with a slope of `theta` that falls toward `azimuth` in the map's axes.
    fn new(fit: &LightProjection, theta: f64, azimuth: f64) -> Self {
        let light = DVec3::new(theta.sin() * azimuth.cos(), theta.sin() * azimuth.sin(), theta.cos());
        let m = fit.light_from_world.as_dmat4();
        let axes = [m.x_axis, m.y_axis, m.z_axis].map(DVec4::truncate);
        let world_normal = DVec3::from_array(axes.map(|axis| axis.dot(light))).as_vec3();
        // The plane is defined by the rounded normal.
        let unit = world_normal.as_dvec3().normalize();
        Self { normal: axes[0] * unit.x + axes[1] * unit.y + axes[2] * unit.z, world_normal }
    }

    fn height(&self, at: DVec2) -> f64 {
        -self.normal.truncate().dot(at) / self.normal.z
    }
}

/// Returns 200 slopes up to 89°, with azimuths spread by the golden angle.
fn slopes() -> impl Iterator<Item = (f64, f64)> {
    (0..200).map(|i| ((89.0 * f64::from(i) / 199.0).to_radians(), f64::from(i) * 2.399_963))
}

/// Returns positions spread over some texels by the R2 sequence (M. Roberts, 2018).
fn positions() -> impl Iterator<Item = DVec2> {
    (1..=200).map(|i| DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i))
}

/// Returns fits with square, uneven and very uneven texels.
fn fits() -> impl Iterator<Item = LightProjection> {
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    [Vec2::splat(0.25), Vec2::new(0.4, 0.15), Vec2::new(0.01, 0.12)]
        .into_iter()
        .map(move |texel_size| LightProjection { texel_size, ..fit })
}

/// Returns whether a point of the plane, moved to `lifted` in light space, finds a texel in the filter's
/// footprint that is nearer to the light by more than rounding.
fn is_shadowed(plane: &Plane, filter: &Filter, texel: DVec2, lifted: DVec3) -> bool {
    let heights = filter.texels(lifted.truncate() / texel).map(|centre| plane.height(centre * texel));
    // The offset itself is f32, and rounding along the light grows with the slope.
    let rounding = 1e-5 * texel.max_element() / plane.normal.z;
    heights.fold(f64::NEG_INFINITY, f64::max) > lifted.z + rounding
}

/// Returns the share of the positions that shadow themselves when they are lifted by `offset` along the
/// normal and by `depth` toward the light, both in metres.
fn acne(plane: &Plane, filter: &Filter, texel: DVec2, offset: f64, depth: f64) -> f64 {
    let shadowed = positions().filter(|position| {
        let at = *position * texel;
        let lifted = at.extend(plane.height(at)) + plane.normal * offset + DVec3::Z * depth;
        is_shadowed(plane, filter, texel, lifted)
    });
    shadowed.count() as f64 / positions().count() as f64
}

/// Runs a proof for every fit and filter, and every second slope.
fn every_case(prove: impl Fn(&LightProjection, &Filter, &Plane, &str)) {
    for fit in fits() {
        for filter in filters() {
            for (theta, azimuth) in slopes().step_by(2) {
                let place = format!(
                    "{}, texel {}, {:.1} degrees at {azimuth:.1}",
                    filter.name,
                    fit.texel_size,
                    theta.to_degrees()
                );
                prove(&fit, &filter, &Plane::new(&fit, theta, azimuth), &place);
            }
        }
    }
}

/// Cosine of the smallest slope at which half of a bias must show acne.
const STEEP: f64 = 0.984_807_8;

#[test]
fn the_normal_offset_of_a_plane_clears_it_and_half_of_it_does_not() {
    every_case(|fit, filter, plane, place| {
        let texel = fit.texel_size.as_dvec2();
        let offset = f64::from(normal_offset(fit, filter.reach, plane.world_normal).unwrap());
        assert_eq!(acne(plane, filter, texel, offset, 0.0), 0.0, "{place}");
        if plane.normal.z < STEEP {
            let half = acne(plane, filter, texel, 0.5 * offset, 0.0);
            assert!(half >= 0.05, "{place}: half of the bias leaves {half}");
        }
    });
}

#[test]
fn the_receiver_plane_depth_clears_a_plane_and_half_of_it_does_not() {
    every_case(|fit, filter, plane, place| {
        let texel = fit.texel_size.as_dvec2();
        let depth = f64::from(receiver_plane_depth(fit, filter.reach, plane.world_normal).unwrap() * fit.depth_range);
        assert_eq!(acne(plane, filter, texel, 0.0, depth), 0.0, "{place}");
        if plane.normal.z < STEEP {
            let half = acne(plane, filter, texel, 0.0, 0.5 * depth);
            assert!(half >= 0.05, "{place}: half of the bias leaves {half}");
        }
    });
}

/// The reach is at most 5% too large: with 95% of it, some position of many shadows itself on some slope.
#[test]
fn five_percent_less_than_the_reach_leaves_acne_for_every_filter() {
    for fit in fits() {
        for filter in filters() {
            let texel = fit.texel_size.as_dvec2();
            let left = slopes().filter(|(theta, azimuth)| {
                let plane = Plane::new(&fit, *theta, *azimuth);
                let offset = f64::from(normal_offset(&fit, filter.reach, plane.world_normal).unwrap());
                acne(&plane, &filter, texel, 0.95 * offset, 0.0) > 0.0
            });
            assert!(left.count() > 0, "{}, texel {}", filter.name, fit.texel_size);
        }
    }
}

#[test]
fn the_depth_gradient_is_that_of_the_plane_in_every_depth_convention() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
        for fit in fits().map(|fit| LightProjection { depth, ..fit }) {
            for (theta, azimuth) in slopes() {
                let plane = Plane::new(&fit, theta, azimuth);
                let gradient = depth_gradient(&fit, plane.world_normal).unwrap().as_dvec2();
                // v runs against y; the stored depth falls with height, or rises when reversed.
                let sign = if depth == DepthConvention::Reversed { 1.0 } else { -1.0 };
                let texel = fit.texel_size.as_dvec2();
                let rise = |step: DVec2| sign * plane.height(step * texel) / f64::from(fit.depth_range);
                let expected = DVec2::new(rise(DVec2::X), rise(DVec2::NEG_Y));
                let error = (gradient - expected).abs().max_element();
                assert!(error <= 1e-6 * expected.abs().max_element(), "{gradient} for {expected}");
            }
        }
    }
}

#[test]
fn with_the_gradient_at_each_look_up_only_the_reach_of_one_is_left() {
    every_case(|fit, filter, plane, place| {
        let (texel, range) = (fit.texel_size.as_dvec2(), f64::from(fit.depth_range));
        let gradient = depth_gradient(fit, plane.world_normal).unwrap().as_dvec2() * DVec2::new(1.0, -1.0);
        let one = match filter.look_up {
            LookUp::Nearest => FilterRadius::POINT,
            LookUp::Bilinear => FilterRadius::HARDWARE_2X2,
        };
        let bias = f64::from(receiver_plane_depth(fit, one, plane.world_normal).unwrap());
        for at in positions().take(20) {
            for offset in &filter.offsets {
                let compared = -plane.height(at * texel) / range + gradient.dot(*offset) - bias;
                for centre in filter.look_up.texels(at + *offset) {
                    let stored = -plane.height(centre * texel) / range;
                    // Eight texels of f32 gradient, rounded.
                    let rounding = 1e-5 * texel.max_element() / plane.normal.z / range;
                    assert!(stored >= compared - rounding, "{place}: {stored} before {compared}");
                }
            }
        }
    });
}
