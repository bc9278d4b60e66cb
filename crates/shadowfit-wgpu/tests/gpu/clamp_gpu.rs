//! Depth clamp on devices without it: maps clamped by fragment shaders equal the maps of devices with depth
//! clamp.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::MapFormat;
use shadowfit::{Bias, DepthConvention, FittedMap, LightProjection};
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor};

use super::engine::Engine;
use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, ROW};

fn descriptor(format: MapFormat, depth: DepthConvention) -> ShadowMapDescriptor {
    ShadowMapDescriptor { resolution: [ROW; 2], maps: 1, format, depth, depth_clamp: true, ..Default::default() }
}

/// Returns triangles all over the map. Many of them cross the near plane or the far plane.
fn casters(fit: &LightProjection) -> Vec<Vec3> {
    let corners = fit.corners();
    let (right, down, away) = (corners[1] - corners[0], corners[3] - corners[0], corners[4] - corners[0]);
    let share = |i: u16, step: f32| (f32::from(i) * step).fract();
    let corner = |i: u16| {
        let depth = share(i, 0.819_172_5) * 2.4 - 0.7;
        corners[0] + right * share(i, 0.754_877_7) + down * share(i, 0.569_840_3) + away * depth
    };
    (0..60).map(corner).collect()
}

#[test]
fn clamped_maps_are_the_same_texel_for_texel_in_every_format_and_depth() {
    let devices = [Engine::shared(), Engine::without_clamp()];
    for (format, step) in MapFormat::ALL.into_iter().zip([1e-6, 1e-6, 1.6e-5, 1e-6, 5e-4, 1e-6, 4e-3]) {
        for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
            let (map, fit) = (descriptor(format, depth), box_fit(depth));
            let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
            let [clamped, emulated] = devices.each_ref().map(|gpu| {
                let maps = [FittedMap::new(fit, Bias::default())];
                Harness::with_maps(gpu, &map, &view, &maps, &[casters(&fit)]).stored(0)
            });
            let (near, far) = if depth == DepthConvention::Reversed { (1.0, 0.0) } else { (0.0, 1.0) };
            // Where shaders find a stored depth by comparisons, drivers may round the compared number to the
            // format, and may treat the smallest numbers as zero.
            let is_at = |depth: f32, plane: f32| (depth - plane).abs() < step;
            let at_near = clamped.iter().filter(|depth| is_at(**depth, near)).count();
            let between = clamped.iter().filter(|depth| !is_at(**depth, near) && !is_at(**depth, far)).count();
            assert!(at_near > 1000 && between > 1000, "{at_near} texels at the near plane, {between} beyond");
            let differ = clamped.iter().zip(&emulated).filter(|(a, b)| (*a - *b).abs() > step).count();
            assert!(differ * 10_000 <= clamped.len(), "{format:?} {depth:?}: {differ} texels of {}", clamped.len());
        }
    }
}

#[test]
fn the_fragment_shader_clamps_only_where_the_device_cannot() {
    let map = descriptor(MapFormat::Depth32Float, DepthConvention::ZeroToOne);
    for (gpu, expected) in [(Engine::shared(), false), (Engine::without_clamp(), true)] {
        let made = |depth_clamp| {
            ShadowMap::new(&gpu.device, &ShadowMapDescriptor { depth_clamp, ..map }).expect("a possible shadow map")
        };
        assert_eq!(made(true).clamps_in_fragment(), expected);
        assert_eq!(made(true).primitive_state().unclipped_depth, !expected);
        assert!(!made(false).clamps_in_fragment() && !made(false).primitive_state().unclipped_depth);
    }
}
