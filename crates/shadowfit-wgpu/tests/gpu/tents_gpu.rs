//! Tent filters and discs equal their definitions, texel by texel, on a map of squares.

use shadowfit::LightProjection;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat, SoftRadius, Softness};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::engine::Engine;
use super::engine::points::Point;
use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, ROW};

const NO_BIAS: BiasSettings =
    BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };

/// Returns whether a texel is covered: squares of 1 to 3 texels without a regular order.
fn is_covered(x: i32, y: i32) -> bool {
    let cell = (x.div_euclid(3) * 7 + y.div_euclid(3) * 13).rem_euclid(5);
    let inner = x.rem_euclid(3).max(y.rem_euclid(3));
    (20..60).contains(&x) && (20..60).contains(&y) && inner <= cell - 2
}

/// Returns squares over the covered texels, at a height without other casters.
fn casters(fit: &LightProjection) -> Vec<Vec3> {
    let corners = fit.corners();
    let (right, down) = ((corners[1] - corners[0]) / ROW as f32, (corners[3] - corners[0]) / ROW as f32);
    let start = corners[0] + (corners[4] - corners[0]) * 0.3;
    let square = |x: i32, y: i32| {
        let at = |dx: i32, dy: i32| start + right * (x + dx) as f32 + down * (y + dy) as f32;
        [at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)]
    };
    let all = (20..60).flat_map(|y| (20..60).map(move |x| (x, y))).filter(|(x, y)| is_covered(*x, *y));
    all.flat_map(|(x, y)| square(x, y)).collect()
}

/// Returns the result of a bilinear look-up at a position in texels.
fn look_up(texel: DVec2) -> f64 {
    let at = texel - 0.5;
    let (corner, t) = (at.floor(), at - at.floor());
    let lit = |x: i32, y: i32| f64::from(u8::from(!is_covered(corner.x as i32 + x, corner.y as i32 + y)));
    let row = |y: i32| lit(0, y) * (1.0 - t.x) + lit(1, y) * t.x;
    row(0) * (1.0 - t.y) + row(1) * t.y
}

/// Returns the share of light by the definition: a tent of `taps` × `taps` look-ups one texel apart.
fn tent(taps: i32, texel: DVec2) -> f64 {
    let half = taps / 2;
    let mut sum = 0.0;
    let mut weights = 0.0;
    for dy in -half..=half {
        for dx in -half..=half {
            let weight = f64::from((half + 1 - dx.abs()) * (half + 1 - dy.abs()));
            sum += weight * look_up(texel + DVec2::new(f64::from(dx), f64::from(dy)));
            weights += weight;
        }
    }
    sum / weights
}

/// Returns the share of light by the definition: `taps` look-ups over an ellipse, each rotated from the
/// previous one by the golden angle, at radii that give each the same area.
fn disc(taps: u32, radii: DVec2, turn: f64, texel: DVec2) -> f64 {
    let golden = core::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let tap = |tap: u32| {
        let radius = ((f64::from(tap) + 0.5) / f64::from(taps)).sqrt();
        look_up(texel + radii * radius * DVec2::from_angle(turn + f64::from(tap) * golden))
    };
    (0..taps).map(tap).sum::<f64>() / f64::from(taps)
}

/// Returns the rotation of a pixel, in radians, by interleaved gradient noise; `None` where rounding may wrap
/// it.
fn turn(index: usize) -> Option<f64> {
    let (x, y) = (index % ROW as usize, index / ROW as usize);
    let inner = (0.067_110_56 * x as f64 + 0.005_837_15 * y as f64).fract();
    (0.001..0.999).contains(&inner).then(|| (52.982_918_9 * inner).fract() * core::f64::consts::TAU)
}

/// Returns positions in texels near many edges.
fn texels() -> Vec<DVec2> {
    let step = DVec2::new(0.754_877_666, 0.569_840_291);
    (0..3000).map(|i| DVec2::splat(18.0) + step * f64::from(i) % 44.0).collect()
}

/// Returns points of the plane below the squares at these positions.
fn points(fit: &LightProjection) -> Vec<Point> {
    let corners = fit.corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    let point = |texel: DVec2| {
        let at = texel.as_vec2() / ROW as f32;
        let position = corners[0] + right * at.x + down * at.y + away * 0.9;
        Point { position: position.to_array(), normal: [0.0, 1.0, 0.0] }
    };
    texels().into_iter().map(point).collect()
}

fn descriptor(format: MapFormat, filter: FilterKind) -> ShadowMapDescriptor {
    let softness = Softness::default().with_radius(SoftRadius::Metres(0.25));
    ShadowMapDescriptor { resolution: [ROW; 2], filter, format, softness, ..ShadowMapDescriptor::default() }
}

#[test]
fn four_nine_and_sixteen_look_ups_give_the_sum_of_nine_twenty_five_and_forty_nine() {
    let gpu = Engine::shared();
    let fit = box_fit(shadowfit::DepthConvention::ZeroToOne);
    let points = points(&fit);
    let tents = [FilterKind::Hardware2x2, FilterKind::Pcf3x3, FilterKind::Pcf5x5, FilterKind::Pcf7x7];
    for format in MapFormat::ALL {
        for (filter, taps) in tents.into_iter().zip([1, 3, 5, 7]) {
            let map = descriptor(format, filter);
            let harness = Harness::new(&gpu, &map, DVec3::ZERO, &[fit], &NO_BIAS, &[casters(&fit)]);
            let mut partly = 0;
            for (texel, answer) in texels().iter().zip(harness.ask(0, &points)) {
                let expected = tent(taps, *texel);
                partly += usize::from((0.1..0.9).contains(&expected));
                // Samplers weight in steps of 1/256, in both axes, for each look-up.
                let error = (f64::from(answer.factor) - expected).abs();
                assert!(error < 0.02, "{format:?} {filter:?} at {texel}: {} for {expected}", answer.factor);
            }
            assert!(partly > 300, "{filter:?}: {partly} points at edges");
        }
    }
}

#[test]
fn discs_have_vogel_s_pattern_turned_by_the_pixel_s_noise() {
    let gpu = Engine::shared();
    let fit = box_fit(shadowfit::DepthConvention::ZeroToOne);
    let points = points(&fit);
    for format in [MapFormat::Depth32Float, MapFormat::R32Float] {
        for (filter, taps) in [(FilterKind::Vogel8, 8), (FilterKind::Vogel16, 16), (FilterKind::Vogel32, 32)] {
            let map = descriptor(format, filter);
            let radii = map.softness.texels(filter, &fit).as_dvec2();
            let harness = Harness::new(&gpu, &map, DVec3::ZERO, &[fit], &NO_BIAS, &[casters(&fit)]);
            let (plain, turned) = (harness.ask(0, &points), harness.turned(&points));
            let mut differ = 0;
            for (index, texel) in texels().into_iter().enumerate() {
                let expected = disc(taps, radii, 0.0, texel);
                let error = (f64::from(plain[index].factor) - expected).abs();
                assert!(error < 0.02, "{format:?} {filter:?} at {texel}: {} for {expected}", plain[index].factor);
                let Some(angle) = turn(index) else { continue };
                let expected = disc(taps, radii, angle, texel);
                let error = (f64::from(turned[index]) - expected).abs();
                assert!(error < 0.02, "{format:?} {filter:?}, turned, at {texel}: {} for {expected}", turned[index]);
                differ += usize::from((turned[index] - plain[index].factor).abs() > 0.03);
            }
            assert!(differ > 200, "{filter:?}: {differ} points differ by the turn");
        }
    }
}
