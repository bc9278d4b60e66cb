//! Depth clamp on devices without it: the fragment shaders' maps and pictures are those of devices that have it.

use shadowfit::Slices;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{CasterPolicy, FilterKind, FitKind, MapFormat, MapSettings, Shape};
use shadowfit::{
    Bias, DepthConvention, FitInput, FitState, FittedMap, LightProjection, PerspectiveCamera, Scratch, Technique,
};
use shadowfit_render::{Atmosphere, Frame, Gpu, GpuScene, Renderer, Wanted};
use shadowfit_scene::builtin;
use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor};

use super::exact_counts_gpu::box_fit;
use super::harness::{Harness, ROW};
use crate::support::software_gpu;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// The software adapter, opened without depth clamp.
fn without_clamp() -> Gpu {
    let gpu = software_gpu();
    let features = gpu.device.features() - wgpu::Features::DEPTH_CLIP_CONTROL;
    pollster::block_on(Gpu::of_adapter(gpu.adapter, &Wanted { features, limits: None })).expect("fewer features")
}

fn descriptor(format: MapFormat, depth: DepthConvention) -> ShadowMapDescriptor {
    ShadowMapDescriptor { resolution: [ROW; 2], maps: 1, format, depth, depth_clamp: true, ..Default::default() }
}

/// Triangles all over the map, many of them through the near plane or the far one.
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
    let devices = [software_gpu(), without_clamp()];
    for (format, step) in MapFormat::ALL.into_iter().zip([1e-6, 1.6e-5, 1e-6, 5e-4, 1e-6, 4e-3]) {
        for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
            let (map, fit) = (descriptor(format, depth), box_fit(depth));
            let view = MapView::from_eye(DVec3::ZERO, Vec3::NEG_Z);
            let [clamped, emulated] = devices.each_ref().map(|gpu| {
                let maps = [FittedMap::new(fit, Bias::default())];
                Harness::with_maps(gpu, &map, &view, &maps, &[casters(&fit)]).stored(0)
            });
            let (near, far) = if depth == DepthConvention::Reversed { (1.0, 0.0) } else { (0.0, 1.0) };
            let at_near = clamped.iter().filter(|depth| **depth == near).count();
            let between = clamped.iter().filter(|depth| **depth != near && **depth != far).count();
            assert!(at_near > 1000 && between > 1000, "{at_near} texels at the near plane, {between} beyond");
            let differ = clamped.iter().zip(&emulated).filter(|(a, b)| (*a - *b).abs() > step).count();
            assert!(differ * 10_000 <= clamped.len(), "{format:?} {depth:?}: {differ} texels of {}", clamped.len());
        }
    }
}

#[test]
fn the_fragment_shader_clamps_only_where_the_device_cannot() {
    let map = descriptor(MapFormat::Depth32Float, DepthConvention::ZeroToOne);
    for (gpu, expected) in [(software_gpu(), false), (without_clamp(), true)] {
        let made = |depth_clamp| {
            ShadowMap::new(&gpu.device, &ShadowMapDescriptor { depth_clamp, ..map }).expect("a possible shadow map")
        };
        assert_eq!(made(true).clamps_in_fragment(), expected);
        assert_eq!(made(true).primitive_state().unclipped_depth, !expected);
        assert!(!made(false).clamps_in_fragment() && !made(false).primitive_state().unclipped_depth);
    }
}

/// The courtyard with depth-clamped maps, whose near planes cut through what stands in it.
fn picture(gpu: &Gpu, format: MapFormat) -> Vec<u8> {
    let fit = MapSettings { casters: CasterPolicy::DepthClamp, max_distance: 30.0, ..MapSettings::default() };
    let maps = Slices { count: 2, shape: Shape::new(FitKind::FrustumAabb), ..Slices::default() }.into();
    let technique = Technique { maps, fit, filter: FilterKind::Pcf3x3, format, ..Technique::default() };
    let technique = technique.with_resolution(512, 512);
    let (eye, target) = builtin::default_camera();
    let camera = PerspectiveCamera {
        eye: eye.as_dvec3(),
        forward: (target - eye).normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: SIZE[0] as f32 / SIZE[1] as f32,
        near: 0.1,
        far: 90.0,
    };
    let direction = Vec3::new(0.5, -0.6, -0.4).normalize();
    let views = [camera.frustum().expect("a camera")];
    let mut storage = vec![DVec2::ZERO; Scratch::required(0, 2)];
    let input = FitInput::new(&views, direction);
    let fitted = FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage)).expect("maps");
    let maps: Vec<FittedMap> = fitted.to_vec();
    let mut renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&technique), 1).expect("a renderer");
    let scene = builtin::default_scene();
    let mut gpu_scene = GpuScene::new(gpu, renderer.material_layout(), &scene, &scene.pose(None, 0.0)).expect("memory");
    let target = renderer.target(gpu, SIZE);
    let atmosphere = Atmosphere::default();
    renderer.draw(gpu, &mut gpu_scene, &Frame::new(&camera, direction, &maps, &atmosphere), &target).expect("a frame");
    target.read(gpu).expect("pixels")
}

#[test]
fn the_courtyard_looks_the_same_without_depth_clamp() {
    let devices = [software_gpu(), without_clamp()];
    for format in [MapFormat::Depth32Float, MapFormat::R32Float] {
        let [clamped, emulated] = devices.each_ref().map(|gpu| picture(gpu, format));
        let pairs = clamped.as_chunks::<4>().0.iter().zip(emulated.as_chunks::<4>().0);
        let differ = pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2)).count();
        let pixels = clamped.len() / 4;
        assert!(differ * 1000 <= pixels, "{format:?}: {differ} of {pixels} pixels");
    }
}
