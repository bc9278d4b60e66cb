//! Maps that wrap around in their layers: each point gets the same factor as without the offset.

use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{FilterKind, MapFormat, SoftRadius, Softness};
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection};
use shadowfit_testing::filter_step;
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError};

use super::engine::Engine;
use super::engine::points::Point;
use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, ROW};

/// Texel offsets of the map: beside, above, and both, far inside and at the last texel.
const OFFSETS: [[u32; 2]; 4] = [[100, 0], [0, 37], [200, 131], [1, ROW - 1]];

/// Returns squares of three texels over the whole map, at two heights.
fn casters(fit: &LightProjection) -> Vec<Vec3> {
    let corners = fit.corners();
    let (right, down) = ((corners[1] - corners[0]) / ROW as f32, (corners[3] - corners[0]) / ROW as f32);
    let square = |(x, y): (u32, u32)| {
        let height = if (x + y) % 2 == 0 { 0.3 } else { 0.6 };
        let start = corners[0] + (corners[4] - corners[0]) * height;
        let at = |dx: u32, dy: u32| start + right * (x + dx) as f32 + down * (y + dy) as f32;
        [at(0, 0), at(3, 0), at(3, 3), at(0, 0), at(3, 3), at(0, 3)]
    };
    let all = (0..ROW).step_by(4).flat_map(|y| (0..ROW).step_by(4).map(move |x| (x, y)));
    all.filter(|(x, y)| (x * 7 + y * 13) % 5 < 2).flat_map(square).collect()
}

/// Returns points all over the map below the squares, up to its borders.
fn points(fit: &LightProjection) -> Vec<Point> {
    let corners = fit.corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    let share = |step: u16| (f32::from(step) / 99.0).clamp(1e-6, 1.0 - 1e-6);
    let point = |i: u16| {
        let position = corners[0] + right * share(i % 100) + down * share(i / 100) + away * 0.9;
        Point { position: position.to_array(), normal: [0.0, 1.0, 0.0] }
    };
    (0..10_000).map(point).collect()
}

/// Returns a map of a whole layer with a texel offset.
fn harness<'a>(gpu: &'a Engine, map: &ShadowMapDescriptor, texel_offset: [u32; 2]) -> Harness<'a> {
    let fit = box_fit(map.depth);
    let maps = [FittedMap { texel_offset: texel_offset.into(), ..FittedMap::new(fit, Bias::default()) }];
    Harness::with_maps(gpu, map, &MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z), &maps, &[casters(&fit)])
}

/// Compares maps with and without offsets, in two formats. Every filter and every format is tested with every
/// offset.
fn assert_same(kinds: [(MapFormat, DepthConvention); 2]) {
    for (number, (format, depth)) in kinds.into_iter().enumerate() {
        for (turn, filter) in FilterKind::ALL.into_iter().enumerate() {
            let (resolution, maps) = ([ROW; 2], 1);
            let softness = Softness::default().with_radius(SoftRadius::Metres(0.2));
            let map = ShadowMapDescriptor { resolution, maps, format, filter, depth, softness, ..Default::default() };
            let half = (number + turn) % 2 * 2;
            let offsets = &OFFSETS[half..half + 2];
            assert_same_factors(&map, offsets);
            // The filter does not change the texels, and two filters cover all offsets.
            if turn < 2 {
                assert_same_texels(&map, offsets);
            }
        }
    }
}

/// Share of points with a sample that takes another weight: each of 25 samples in two axes, whose position of
/// 2⁻¹⁷ of a texel crosses one of the borders between weights, which are 2⁻⁸ apart.
const STEPPED: f32 = 25.0 * 2.0 / 512.0;

/// Returns whether the sampler compares four depths and blends the results, which it does only with depth
/// textures.
fn filters_linearly(map: &ShadowMapDescriptor) -> bool {
    map.format.is_depth()
}

fn assert_same_factors(map: &ShadowMapDescriptor, offsets: &[[u32; 2]]) {
    let gpu = Engine::shared();
    let points = points(&box_fit(map.depth));
    // Weights come from the position in the layer, which f32 rounds to 2⁻¹⁷ of a texel here, in each axis.
    let tolerance = 4e-5;
    // A sampler rounds the position, as Vulkan allows (`subTexelPrecisionBits`): some samples take the next
    // weight in each axis.
    let (weight, share) =
        if filters_linearly(map) { (2.0 * filter_step(&gpu.adapter.get_info()), STEPPED) } else { (0.0, 0.0) };
    let factors = harness(&gpu, map, [0, 0]).turned(&points);
    let shadowed = factors.iter().filter(|factor| **factor < 0.9).count();
    assert!((1000..9900).contains(&shadowed), "{:?}: {shadowed} points in shadow or beside one", map.filter);
    for &texel_offset in offsets {
        let mut stepped = 0;
        for (point, (a, b)) in points.iter().zip(harness(&gpu, map, texel_offset).turned(&points).iter().zip(&factors))
        {
            let (by, name) = ((a - b).abs(), gpu.adapter.get_info().name);
            assert!(by <= tolerance + weight, "{name}: {map:?} at {texel_offset:?}, {point:?}: {a}, not {b}");
            stepped += usize::from(by > tolerance);
        }
        let most = (share * points.len() as f32) as usize;
        assert!(
            stepped <= most,
            "{map:?} at {texel_offset:?}: {stepped} points differ by a weight, allowed are {most}"
        );
    }
}

fn assert_same_texels(map: &ShadowMapDescriptor, offsets: &[[u32; 2]]) {
    let gpu = Engine::shared();
    let stored = harness(&gpu, map, [0, 0]).stored(0);
    for &texel_offset in offsets {
        let shifted = harness(&gpu, map, texel_offset).stored(0);
        let differ = shifted.iter().zip(&stored).filter(|(a, b)| (*a - *b).abs() > 1e-6).count();
        assert_eq!(differ, 0, "{map:?} at {texel_offset:?}: texels of the map are others");
    }
}

#[test]
fn depth_textures_give_the_same_factors_wherever_the_map_begins() {
    assert_same([
        (MapFormat::Depth32Float, DepthConvention::ZeroToOne),
        (MapFormat::Depth16Unorm, DepthConvention::Reversed),
    ]);
}

#[test]
fn float_textures_give_the_same_factors_wherever_the_map_begins() {
    assert_same([(MapFormat::R32Float, DepthConvention::Reversed), (MapFormat::R16Float, DepthConvention::ZeroToOne)]);
}

#[test]
fn byte_textures_give_the_same_factors_wherever_the_map_begins() {
    assert_same([(MapFormat::Rgba8Packed, DepthConvention::ZeroToOne), (MapFormat::R8Grey, DepthConvention::Reversed)]);
}

#[test]
fn a_map_that_does_not_fill_its_layer_or_begins_outside_cannot_wrap_around() {
    let gpu = Engine::shared();
    let map = |resolution| ShadowMapDescriptor { resolution, maps: 2, ..ShadowMapDescriptor::default() };
    let fit = box_fit(DepthConvention::ZeroToOne);
    let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
    for (layer, texel_offset, is_possible) in [
        ([ROW; 2], [255, 255], true),
        ([ROW; 2], [256, 0], false),
        ([ROW; 2], [0, 1000], false),
        ([512, ROW], [1, 0], false),
        ([512, ROW], [0, 0], true),
    ] {
        let mut shadow_map = ShadowMap::new(&gpu.device, &map(layer)).expect("a possible shadow map");
        let wrapped = FittedMap { texel_offset: UVec2::from(texel_offset), ..FittedMap::new(fit, Bias::default()) };
        let prepared = shadow_map.prepare(&gpu.queue, &view, &[FittedMap::new(fit, Bias::default()), wrapped]);
        let refused = Err(ShadowMapError::TexelOffset { index: 1, texel_offset, fit: [ROW; 2], map: layer });
        assert_eq!(prepared, if is_possible { Ok(()) } else { refused }, "{texel_offset:?} in {layer:?}");
    }
}
