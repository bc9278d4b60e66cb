//! Under a spot light's least biases planes do not shadow themselves, and under slightly smaller biases they
//! do.
//!
//! The map is simulated in f64: a texel stores the depth of the plane at its centre, and the filter reads the
//! texels of its definition. [`crate::spot_bias`] adds the effects of f32 and hardware.

use proptest::prelude::*;
use shadowfit::DepthConvention;
use shadowfit::bias::{FilterRadius, MIN_COSINE};
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec2, Vec3};
use shadowfit::settings::MapFormat;
use shadowfit::spot::{SpotBias, SpotFit, SpotLight};
use shadowfit::spot::{depth_gradient, normal_offset, on_hardware, receiver_plane_depth};

use crate::filters::{Filter, LookUp, filters};
use crate::spot::{DEPTHS, lamp};
use crate::support::{cases, double};

/// A plane in the light space of a map.
struct Plane<'a> {
    fit: &'a SpotFit,
    world_normal: Vec3,
    /// Unit normal toward the light. `height` is the light's distance from the plane.
    normal: DVec3,
    height: f64,
    /// Position of its middle, in texels from the axis.
    middle: DVec2,
}

/// Returns a world position in f64.
fn world(fit: &SpotFit, light: DVec3) -> DVec3 {
    let rows = fit.light_from_world.as_dmat4().transpose();
    fit.position
        + rows.x_axis.truncate() * light.x
        + rows.y_axis.truncate() * light.y
        + rows.z_axis.truncate() * light.z
}

impl<'a> Plane<'a> {
    /// Creates the plane through a position in the map (-1..1 across it) at a distance. Its normal is tilted
    /// by `theta` from the direction to the light toward an azimuth.
    fn new(fit: &'a SpotFit, place: DVec2, distance: f64, theta: f64, azimuth: f64) -> Self {
        let middle = place * fit.resolution.as_dvec2() * 0.5;
        let through = (middle * fit.texel_size.as_dvec2()).extend(-1.0) * distance;
        let to_light = -through.normalize();
        let across = to_light.any_orthonormal_vector();
        let lean = across * azimuth.cos() + to_light.cross(across) * azimuth.sin();
        let world_normal = (world(fit, to_light * theta.cos() + lean * theta.sin()) - fit.position).as_vec3();
        // The plane is defined by the rounded normal.
        let normal = fit.light_from_world.as_dmat4().transform_vector3(world_normal.as_dvec3()).normalize();
        Self { fit, world_normal, normal, height: -normal.dot(through), middle }
    }

    /// Returns 1 / d along a ray through the map, at a position in texels from the axis; 0 or less if the ray
    /// misses the plane.
    fn nearness(&self, at: DVec2) -> f64 {
        let ray = (at * self.fit.texel_size.as_dvec2()).extend(-1.0);
        -self.normal.dot(ray) / self.height
    }

    /// Returns the plane's point in light space at a position in the map, if there is one within 1000 m.
    fn point(&self, at: DVec2) -> Option<DVec3> {
        let nearness = self.nearness(at);
        (nearness > 1e-3).then(|| (at * self.fit.texel_size.as_dvec2()).extend(-1.0) / nearness)
    }

    /// Returns whether a point in light space, moved toward the light by a stored depth, finds a texel in the
    /// filter's footprint that is nearer to the light by more than rounding.
    fn shadows(&self, filter: &Filter, lifted: DVec3, depth: f64) -> bool {
        let nearness = -1.0 / lifted.z;
        let at = lifted.truncate() * nearness / self.fit.texel_size.as_dvec2();
        let nearest = filter.texels(at).map(|centre| self.nearness(centre)).fold(f64::NEG_INFINITY, f64::max);
        let scale = scale(self.fit);
        // Offsets and depths are f32: one step of them, relative to the least distinguishable 1/d.
        let rounding = 1e-6 * (nearest - nearness).abs() + 1e-12 * nearness;
        scale * (nearest - nearness - rounding) > depth
    }

    /// Returns the share of positions that shadow themselves. `bias` returns the lift (metres along the
    /// normal) and the depth at a world position.
    fn acne(&self, filter: &Filter, bias: impl Fn(DVec3) -> (f64, f64)) -> f64 {
        let (mut count, mut shadowed) = (0, 0);
        for at in positions().map(|at| self.middle + at) {
            let Some(point) = self.point(at) else { continue };
            let (offset, depth) = bias(world(self.fit, point));
            count += 1;
            shadowed += u32::from(self.shadows(filter, point + self.normal * offset, depth));
        }
        f64::from(shadowed) / f64::from(count.max(1))
    }

    /// Returns the sine of the angle between the normal and the light's axis.
    fn sine(&self) -> f64 {
        self.normal.truncate().length()
    }
}

/// Returns B, in metres: the stored depth changes by B / d² per metre.
fn scale(fit: &SpotFit) -> f64 {
    let (near, far) = (f64::from(fit.near), f64::from(fit.far));
    near * far / (far - near)
}

/// Returns positions spread over some texels by the R2 sequence (M. Roberts, 2018).
fn positions() -> impl Iterator<Item = DVec2> {
    (1..=200).map(|i| (DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i)).fract() * 3.0 - 1.5)
}

/// Returns maps with fine, coarse, and uneven texels.
fn maps() -> Vec<SpotFit> {
    [(0.9, UVec2::splat(1024)), (1.6, UVec2::splat(64)), (2.0, UVec2::new(512, 96))]
        .into_iter()
        .map(|(fov_y, resolution)| SpotLight { fov_y, ..lamp() }.fit(resolution, DepthConvention::ZeroToOne).unwrap())
        .collect()
}

/// Runs a proof for every map and filter, and 60 slopes up to 88° from the light all over the map.
fn every_case(prove: impl Fn(&SpotFit, &Filter, &Plane, &str)) {
    for fit in maps() {
        for filter in filters() {
            for i in 0..60 {
                let turn = f64::from(i);
                let theta = (88.0 * turn / 59.0).to_radians();
                let place = (DVec2::new(0.754_877_666, 0.569_840_291) * turn).fract() * 1.8 - 0.9;
                let plane = Plane::new(&fit, place, 0.5 + turn * 0.5, theta, turn * 2.399_963);
                let name = format!(
                    "{}, texel {}, {:.1} degrees at {place:.1}",
                    filter.name,
                    fit.texel_size,
                    theta.to_degrees()
                );
                prove(&fit, &filter, &plane, &name);
            }
        }
    }
}

/// Sine of the smallest angle to the axis at which half of a bias must show acne.
const STEEP: f64 = 0.17;

fn least(plane: &Plane, filter: &Filter, point: DVec3) -> f64 {
    f64::from(normal_offset(plane.fit, filter.reach, point, plane.world_normal).unwrap())
}

#[test]
fn the_normal_offset_of_a_plane_clears_it_and_half_of_it_does_not() {
    every_case(|_, filter, plane, name| {
        assert_eq!(plane.acne(filter, |p| (least(plane, filter, p), 0.0)), 0.0, "{name}");
        if plane.sine() > STEEP {
            let half = plane.acne(filter, |p| (0.5 * least(plane, filter, p), 0.0));
            assert!(half >= 0.05, "{name}: half of the bias leaves {half}");
        }
    });
}

#[test]
fn the_receiver_plane_depth_clears_a_plane_and_half_of_it_does_not() {
    every_case(|fit, filter, plane, name| {
        // If the cosine between light and plane is below the least cosine, a depth bias guarantees nothing.
        let depth = |p: DVec3| {
            let is_lit = plane.height >= f64::from(MIN_COSINE) * (p - fit.position).length();
            let needed = receiver_plane_depth(fit, filter.reach, p, plane.world_normal).unwrap();
            if is_lit { f64::from(needed) } else { f64::INFINITY }
        };
        assert_eq!(plane.acne(filter, |p| (0.0, depth(p))), 0.0, "{name}");
        if plane.sine() > STEEP {
            let half = plane.acne(filter, |p| (0.0, 0.5 * depth(p)));
            assert!(half >= 0.05, "{name}: half of the bias leaves {half}");
        }
    });
}

/// The bound is at most 5% too large: with 95% of it, some position of many shadows itself on some slope, for
/// every filter and map.
#[test]
fn five_percent_less_than_the_least_offset_leaves_acne_for_every_filter() {
    for fit in maps() {
        for filter in filters() {
            let left = (0..60).filter(|i| {
                let turn = f64::from(*i);
                let plane = Plane::new(&fit, DVec2::new(0.3, -0.5), 4.0, 0.3 + turn * 0.018, turn * 2.399_963);
                plane.acne(&filter, |p| (0.95 * least(&plane, &filter, p), 0.0)) > 0.0
            });
            assert!(left.count() > 0, "{}, texel {}", filter.name, fit.texel_size);
        }
    }
}

#[test]
fn the_depth_gradient_is_exact_over_many_texels_in_every_depth_convention() {
    for depth in DEPTHS {
        let fit = lamp().fit(UVec2::new(512, 400), depth).unwrap();
        for i in 0..40 {
            let turn = f64::from(i);
            let plane = Plane::new(&fit, DVec2::new(0.3, -0.6), 7.0, turn * 0.035, turn * 2.399_963);
            let point = world(&fit, plane.point(plane.middle).unwrap());
            let gradient = depth_gradient(&fit, point, plane.world_normal).unwrap().as_dvec2();
            // v runs against y; the stored depth falls as 1/d grows, or rises when reversed.
            let sign = if depth == DepthConvention::Reversed { 1.0 } else { -1.0 };
            let change =
                |step: DVec2| sign * scale(&fit) * (plane.nearness(plane.middle + step) - plane.nearness(plane.middle));
            let expected = DVec2::new(change(DVec2::X * 9.0), change(DVec2::NEG_Y * 9.0)) / 9.0;
            let error = (gradient - expected).abs().max_element();
            assert!(error <= 1e-6 * expected.abs().max_element(), "{depth:?}: {gradient} for {expected}");
        }
    }
}

#[test]
fn with_the_gradient_at_each_look_up_only_the_reach_of_one_is_left() {
    every_case(|fit, filter, plane, name| {
        let point = world(fit, plane.point(plane.middle).unwrap());
        let gradient = depth_gradient(fit, point, plane.world_normal).unwrap().as_dvec2() * DVec2::new(1.0, -1.0);
        let one = match filter.look_up {
            LookUp::Nearest => FilterRadius::POINT,
            LookUp::Bilinear => FilterRadius::HARDWARE_2X2,
        };
        let bias = f64::from(receiver_plane_depth(fit, one, point, plane.world_normal).unwrap());
        for at in positions().take(20).map(|at| plane.middle + at) {
            for offset in &filter.offsets {
                let compared = -scale(fit) * plane.nearness(at) + gradient.dot(*offset) - bias;
                for centre in filter.look_up.texels(at + *offset) {
                    let stored = -scale(fit) * plane.nearness(centre);
                    // Eight texels of f32 gradient, rounded.
                    let rounding = 1e-5 * (gradient.abs().element_sum() + bias);
                    assert!(stored >= compared - rounding, "{name}: {stored} before {compared}");
                }
            }
        }
    });
}

#[test]
fn a_plane_square_to_the_axis_needs_no_bias_however_obliquely_it_is_lit() {
    let fit = lamp().fit(UVec2::splat(512), DepthConvention::ZeroToOne).unwrap();
    // 45° off the axis and more, in the window's corner.
    let point = world(&fit, DVec3::new(7.5, 4.6, -10.0));
    let needed = normal_offset(&fit, 3.0, point, fit.direction).unwrap();
    assert!(needed <= 3.0 * 2e-7 * fit.texel_size.max_element() * 10.0, "{needed}");
}

#[test]
fn a_lift_by_hand_clears_a_wall_by_the_texel_at_its_distance() {
    // A window of 2 m × 2 m at 1 m with 200 texels: 0.01 m per texel there, 0.05 m at 5 m. A plane at 60° to
    // the axis that leans along u needs E · t · d · sin 60° / (1 + E t sin 60° cos 60°) for E = 2: 2 · 0.05 ·
    // 0.866 025 / (1 + 0.02 · 0.433 013) = 0.085 859 m.
    let lamp = SpotLight {
        direction: Vec3::NEG_Z,
        position: DVec3::ZERO,
        fov_y: std::f32::consts::FRAC_PI_2,
        aspect: 1.0,
        ..lamp()
    };
    let fit = lamp.fit(UVec2::splat(200), DepthConvention::ZeroToOne).unwrap();
    let normal = Vec3::new(0.866_025_4, 0.0, 0.5);
    let offset = normal_offset(&fit, 2.0, DVec3::new(0.0, 0.0, -5.0), normal).unwrap();
    assert!((offset - 0.085_859).abs() < 1e-6, "{offset}");
    // B = 0.25 · 60 / 59.75 = 0.251 046, c = 5 · 0.5: 2 · B · 0.01 · 0.866 025 / 2.5 = 0.001 739 3.
    let depth = receiver_plane_depth(&fit, 2.0, DVec3::new(0.0, 0.0, -5.0), normal).unwrap();
    assert!((depth - 0.001_739_3).abs() < 1e-7, "{depth}");
}

proptest! {
    #![proptest_config(cases(300))]

    /// For any lens, plane and position, the least offset is enough and the automatic one is enough. The
    /// automatic one is at most √2 times the least offset of its azimuth plus the need of planes that face
    /// away from the axis.
    #[test]
    fn the_automatic_offset_clears_any_plane_and_is_little_more_than_the_least(
        (fov, aspect, texels) in (double(0.1, 2.4), double(0.5, 2.0), 5..12_u32),
        (x, y, distance) in (double(-0.95, 0.95), double(-0.95, 0.95), double(0.3, 50.0)),
        (theta, azimuth) in (double(0.0, 1.5), double(0.0, 6.3)),
    ) {
        let lamp = SpotLight { fov_y: fov as f32, aspect: aspect as f32, ..lamp() };
        let fit = lamp.fit(UVec2::splat(1 << texels), DepthConvention::ZeroToOne).unwrap();
        let plane = Plane::new(&fit, DVec2::new(x, y), distance, theta, azimuth);
        let point = world(&fit, plane.point(plane.middle).unwrap());
        for filter in filters() {
            let Ok(bias) = SpotBias::automatic(filter.reach, MapFormat::Depth32Float, &fit) else {
                prop_assert!(fit.texel_size.max_element() > 0.1, "only maps of few texels are refused");
                continue;
            };
            prop_assert_eq!(plane.acne(&filter, |p| (least(&plane, &filter, p), 0.0)), 0.0);
            let by_slope = SpotBias { constant_offset: 0.0, ..bias };
            let offset = |p| f64::from(by_slope.on_plane(&fit, p, plane.world_normal).unwrap().offset);
            prop_assert_eq!(plane.acne(&filter, |p| (offset(p), 0.0)), 0.0);
            let (given, needed) = (offset(point), least(&plane, &filter, point));
            let widest = f64::from(bias.normal_offset);
            if fit.texel_size.x == fit.texel_size.y && filter.reach.disc == Vec2::ZERO {
                let reach = on_hardware(&fit, filter.reach).unwrap();
                let hardware = f64::from(reach.taps / filter.reach.taps);
                let most = std::f64::consts::SQRT_2 * hardware * (1.0 + widest) * (1.0 + widest);
                prop_assert!(given <= needed * most * 1.000_01 + 1e-9, "{given} for {needed}");
            }
        }
        prop_assert!(f64::from(MIN_COSINE) < theta.cos(), "all of these planes are lit");
    }
}
