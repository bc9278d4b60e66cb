//! Depths come back from packed colours bit for bit, through a real pass and a real shader.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit::{DepthConvention, FittedMap};
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor, ShadowMapError, WgslOptions, caster_wgsl, stored_wgsl};

use super::engine::casters::look_up_wgsl;
use super::engine::picture::{READ_BACK, WHOLE, draw_whole};
use super::engine::{Engine, Pipeline};
use super::exact_counts_gpu::box_fit;

/// Width and height of the map: a million texels.
const SIDE: u32 = 1024;
/// Bits of the float 1.
const ONE: u32 = 0x3f80_0000;
/// Bits of the smallest number that is not denormal.
const NORMAL: u32 = 0x0080_0000;

/// Writes a different depth to each texel, the last of them 1.
const WRITE: &str = "
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    return shadowfit_caster_color(bitcast<f32>(bits_of(u32(pixel.y) * SIDE + u32(pixel.x))));
}
";

/// Reads the depths as bits, in two halves that f32 can hold.
const READ: &str = "
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    let bits = bitcast<u32>(shadowfit_stored(0, vec2<i32>(pixel.xy)));
    return vec4<f32>(f32(bits & 0xffffu), f32(bits >> 16u), 0.0, 0.0);
}
";

/// Returns the bits of the depth with this index. The 2²⁰ numbers are spread from 0 to 1, and the last one is
/// 1.
fn bits_of(index: u32) -> u32 {
    if index == SIDE * SIDE - 1 { ONE } else { index * 1015 }
}

const BITS_OF: &str = "
fn bits_of(index: u32) -> u32 {
    return select(index * 1015u, 0x3f800000u, index == SIDE * SIDE - 1u);
}
";

fn pipeline(
    gpu: &Engine,
    wgsl: &str,
    layout: &wgpu::BindGroupLayout,
    depth: Option<wgpu::DepthStencilState>,
    target: wgpu::ColorTargetState,
) -> wgpu::RenderPipeline {
    let wgsl = [WHOLE, &wgsl.replace("SIDE", &format!("{SIDE}u"))].concat();
    let (layout, targets) = (gpu.layout(&[Some(layout)]), [Some(target)]);
    Pipeline { layout: Some(&layout), targets: &targets, depth, ..Pipeline::new(&wgsl) }.make(gpu)
}

/// Returns the bits that a shader reads in each texel.
fn read_bits(gpu: &Engine, map: &ShadowMap) -> Vec<u32> {
    let format = wgpu::TextureFormat::Rgba32Float;
    let target = gpu.texture(map.descriptor().resolution, 1, format, READ_BACK);
    let options = WgslOptions::group(0);
    let wgsl = look_up_wgsl(map.descriptor(), &options)
        + &stored_wgsl(map.descriptor(), &options, gpu.adapter.get_info().backend)
        + READ;
    let pipeline = pipeline(gpu, &wgsl, map.receiver_layout(), None, format.into());
    let mut encoder = gpu.encoder();
    draw_whole(&mut encoder, &pipeline, &[map.receiver_group()], &target);
    gpu.submit(encoder);
    let halves: Vec<[f32; 4]> = gpu.texels(target.texture());
    halves.iter().map(|[low, high, ..]| *low as u32 | (*high as u32) << 16).collect()
}

#[test]
fn a_million_packed_depths_come_back_bit_for_bit_and_denormals_as_they_are_or_as_zero() {
    let gpu = Engine::shared();
    let fit = box_fit(DepthConvention::ZeroToOne);
    let (format, filter) = (MapFormat::Rgba8Packed, FilterKind::Point);
    let descriptor = ShadowMapDescriptor { resolution: [SIDE; 2], maps: 1, format, filter, ..Default::default() };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).expect("a possible shadow map");
    let whole = shadowfit::LightProjection { resolution: [SIDE; 2].into(), ..fit };
    let maps = [FittedMap::new(whole, shadowfit::Bias::default())];
    map.prepare(&gpu.queue, &MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z), &maps).expect("a good map");
    let source = [&caster_wgsl(&descriptor, &WgslOptions::group(0)), BITS_OF, WRITE].concat();
    let target = map.color_target().expect("a colour format");
    let write = pipeline(&gpu, &source, map.caster_layout(), Some(map.depth_stencil_state()), target);
    let mut encoder = gpu.encoder();
    map.render(&mut encoder, 0, |pass, _, _| {
        pass.set_pipeline(&write);
        pass.draw(0..3, 0..1);
    });
    gpu.submit(encoder);
    let (mut exact, mut flushed) = (0, 0);
    for (index, bits) in (0..).zip(read_bits(&gpu, &map)) {
        let written = bits_of(index);
        let is_flushed = written < NORMAL && bits == 0;
        assert!(bits == written || is_flushed, "{written:#x} came back as {bits:#x}");
        exact += usize::from(bits == written);
        flushed += usize::from(is_flushed && written != 0);
    }
    println!("{exact} depths came back exactly, {flushed} denormal ones as zero");
    assert!(exact > 1_000_000, "{exact}");
}

#[test]
fn an_empty_map_is_far_in_every_format_and_depth() {
    let gpu = Engine::shared();
    for format in MapFormat::ALL {
        for (depth, far) in [(DepthConvention::ZeroToOne, ONE), (DepthConvention::Reversed, 0)] {
            let descriptor = ShadowMapDescriptor { resolution: [256; 2], maps: 1, format, depth, ..Default::default() };
            let mut map = ShadowMap::new(&gpu.device, &descriptor).expect("a possible shadow map");
            let maps = [FittedMap::new(box_fit(depth), shadowfit::Bias::default())];
            map.prepare(&gpu.queue, &MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z), &maps).expect("a good map");
            let mut encoder = gpu.encoder();
            map.render(&mut encoder, 0, |_, _, _| {});
            gpu.submit(encoder);
            assert!(read_bits(&gpu, &map).iter().all(|bits| *bits == far), "{format:?} {depth:?}");
        }
    }
}

#[test]
fn settings_of_filters_that_make_no_picture_are_refused_with_their_numbers() {
    let gpu = Engine::shared();
    let made = |descriptor: ShadowMapDescriptor| ShadowMap::new(&gpu.device, &descriptor).map(|_| ());
    let plain = ShadowMapDescriptor { resolution: [256; 2], ..ShadowMapDescriptor::default() };
    let clamped = ShadowMapDescriptor { filter: FilterKind::Pcss, depth_clamp: true, ..plain };
    assert_eq!(made(clamped), Err(ShadowMapError::SoftDepthClamp(FilterKind::Pcss)));
    for fade in [[5.0, 4.0], [f32::NAN, 4.0], [0.0, f32::INFINITY]] {
        let error = made(ShadowMapDescriptor { fade, ..plain }).expect_err("no fade");
        assert!(error.to_string().contains(&format!("{} m", fade[0])), "{error}");
    }
    for (floor, ceiling) in [(-1.0, 16.0), (17.0, 16.0), (0.0, 65.0), (0.0, 0.5), (f32::NAN, 16.0), (1.0, f32::NAN)] {
        let softness = plain.softness.with_floor(floor).with_ceiling(ceiling);
        let error = made(ShadowMapDescriptor { softness, ..plain }).expect_err("no radii");
        assert!(matches!(error, ShadowMapError::Softness { .. }), "{floor}, {ceiling}: {error}");
        assert!(error.to_string().contains(&format!("{floor} to {ceiling} texels")), "{error}");
    }
}
