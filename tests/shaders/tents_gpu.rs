//! The tents of 3×3 and 5×5 look-ups against their definition, texel by texel, on a map of squares.

use shadowfit::LightFit;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, Point, ROW};
use crate::support::software_gpu;

const NO_BIAS: BiasSettings =
    BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };

/// Whether a texel is covered: squares of 1 to 3 texels in no order.
fn is_covered(x: i32, y: i32) -> bool {
    let cell = (x.div_euclid(3) * 7 + y.div_euclid(3) * 13).rem_euclid(5);
    let inner = x.rem_euclid(3).max(y.rem_euclid(3));
    (20..60).contains(&x) && (20..60).contains(&y) && inner <= cell - 2
}

/// Squares over the covered texels, at the height where nothing else is.
fn casters(fit: &LightFit) -> Vec<Vec3> {
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

/// Share of light by the definition: a tent of `taps` × `taps` bilinear look-ups one texel apart.
fn tent(taps: i32, texel: DVec2) -> f64 {
    let half = taps / 2;
    let mut sum = 0.0;
    let mut weights = 0.0;
    for dy in -half..=half {
        for dx in -half..=half {
            let weight = f64::from((half + 1 - dx.abs()) * (half + 1 - dy.abs()));
            let at = texel + DVec2::new(f64::from(dx), f64::from(dy)) - 0.5;
            let (corner, t) = (at.floor(), at - at.floor());
            let lit = |x: i32, y: i32| f64::from(u8::from(!is_covered(corner.x as i32 + x, corner.y as i32 + y)));
            let row = |y: i32| lit(0, y) * (1.0 - t.x) + lit(1, y) * t.x;
            sum += weight * (row(0) * (1.0 - t.y) + row(1) * t.y);
            weights += weight;
        }
    }
    sum / weights
}

#[test]
fn four_and_nine_look_ups_give_the_sum_of_nine_and_twenty_five() {
    let gpu = software_gpu();
    let fit = box_fit(shadowfit::DepthConvention::ZeroToOne);
    let corners = fit.corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    let texels: Vec<DVec2> = (0..3000)
        .map(|i| DVec2::new(18.0, 18.0) + DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i) % 44.0)
        .collect();
    let points: Vec<Point> = texels
        .iter()
        .map(|texel| {
            let at = texel.as_vec2() / ROW as f32;
            let position = corners[0] + right * at.x + down * at.y + away * 0.9;
            Point { position: position.to_array(), normal: [0.0, 1.0, 0.0] }
        })
        .collect();
    for format in [MapFormat::Depth32Float, MapFormat::R32Float] {
        for (filter, taps) in [(FilterKind::Hardware2x2, 1), (FilterKind::Pcf3x3, 3), (FilterKind::Pcf5x5, 5)] {
            let descriptor =
                ShadowMapDescriptor { resolution: [ROW; 2], filter, format, ..ShadowMapDescriptor::default() };
            let harness = Harness::new(&gpu, &descriptor, DVec3::ZERO, &[fit], &NO_BIAS, &[casters(&fit)]);
            let mut partly = 0;
            for (texel, answer) in texels.iter().zip(harness.ask(0, &points)) {
                let expected = tent(taps, *texel);
                partly += usize::from((0.1..0.9).contains(&expected));
                // Samplers weight in steps of 1/256, in both axes, of each look-up.
                let error = (f64::from(answer.factor) - expected).abs();
                assert!(error < 0.02, "{format:?} {filter:?} at {texel}: {} for {expected}", answer.factor);
            }
            assert!(partly > 300, "{filter:?}: {partly} points at edges");
        }
    }
}
