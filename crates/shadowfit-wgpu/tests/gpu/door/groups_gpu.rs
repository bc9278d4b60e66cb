//! Look-ups at the engine's own bind groups, in compute shaders, and pipelines that two suns share.

use shadowfit::Technique;
use shadowfit::settings::FilterKind;
use shadowfit_wgpu::{SunShadows, SunShadowsDescriptor};

use super::ground::{BOXES, EYE, FORMAT, MOON, Painter, Picture, Quiet, SIDE, SUN, camera, factors_wgsl, frame_of};
use super::{IN_MOON_SHADOW, IN_SUN_SHADOW, LIT, technique};
use crate::engine::{Engine, dispatch};

/// Lights the ground like a deferred renderer, in a compute shader.
const LIGHT: &str = "
@group(1) @binding(0) var lit: texture_storage_2d<rgba8unorm, write>;
@compute @workgroup_size(8, 8) fn light(@builtin(global_invocation_id) pixel: vec3<u32>) {
    textureStore(lit, pixel.xy, factors(vec2<f32>(pixel.xy) + 0.5));
}
";

fn shadows(device: &Engine, technique: &Technique, first_binding: u32) -> SunShadows {
    device.require_map(&technique.into());
    let descriptor = SunShadowsDescriptor { first_binding, ..(*technique).into() };
    SunShadows::new(&device.device, &device.queue, &descriptor).expect("maps")
}

/// Returns the factors of the sun and of the moon at the three positions.
fn factors(picture: &Picture) -> [[u8; 2]; 3] {
    [IN_SUN_SHADOW, IN_MOON_SHADOW, LIT].map(|place| [picture.at(place)[0], picture.at(place)[1]])
}

/// Lights the ground in a compute shader.
fn computed(device: &Engine, sun: &SunShadows) -> Picture {
    let lit =
        device.texture([SIDE; 2], 1, FORMAT, wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC);
    let layout = device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: FORMAT,
                view_dimension: wgpu::TextureViewDimension::D2,
            },
            count: None,
        }],
    });
    let target = device.group(&layout, [wgpu::BindingResource::TextureView(&lit)]);
    let layout = device.layout(&[Some(sun.map().receiver_layout()), Some(&layout)]);
    let wgsl = factors_wgsl(&[(sun, 0, "shadowfit")]) + LIGHT;
    let pipeline = device.compute_pipeline(Some(&layout), &wgsl, "light");
    let mut encoder = device.encoder();
    dispatch(&mut encoder, &pipeline, &[sun.receiver_group(), &target], [SIDE / 8; 2]);
    Picture::read(device, encoder, &lit)
}

#[test]
fn gpu_a_compute_shader_lights_the_ground_as_a_fragment_shader_does() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let views = [camera(EYE).frustum().expect("a camera")];
    for filter in [FilterKind::Pcf5x5, FilterKind::Vogel8, FilterKind::Pcss] {
        let mut sun = shadows(&device, &technique().with_filter(filter), 0);
        sun.update(&device.queue, &frame_of(&views, SUN, &BOXES)).expect("a good frame");
        let drawn = Painter::new(&device, &[(&sun, "shadowfit")]).draw(&device, &[(&sun, &BOXES)]);
        assert_eq!([drawn.at(IN_SUN_SHADOW)[0], drawn.at(LIT)[0]], [0, 255], "{filter:?}");
        assert_eq!(computed(&device, &sun), drawn, "{filter:?}");
    }
    quiet.assert("compute shaders");
}

#[test]
fn gpu_two_suns_share_one_bind_group_and_keep_their_bindings_with_another_technique() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = shadows(&device, &technique(), 2);
    let mut moon = shadows(&device, &technique().with_count(2), 5);
    assert_eq!(moon.set_technique(&technique().with_count(3).with_filter(FilterKind::Pcf3x3)), Ok(true));
    let entries = [sun.map().receiver_layout_entries(), moon.map().receiver_layout_entries()].concat();
    assert!(entries.iter().map(|entry| entry.binding).eq(2..8));
    let layout =
        device.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let suns = [(&sun, 0, "sun"), (&moon, 0, "moon")];
    let painter = Painter::with_layout(&device, &suns, &device.layout(&[Some(&layout)]));
    let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[sun.map().receiver_entries(), moon.map().receiver_entries()].concat(),
    });
    let views = [camera(EYE).frustum().expect("a camera")];
    for _ in 0..2 {
        sun.update(&device.queue, &frame_of(&views, SUN, &BOXES)).expect("a good frame");
        moon.update(&device.queue, &frame_of(&views, MOON, &BOXES)).expect("a good frame");
        let picture = painter.draw_with(&device, &[(&sun, &BOXES), (&moon, &BOXES)], &[&group]);
        assert_eq!(factors(&picture), [[0, 255], [255, 0], [255, 255]]);
    }
    quiet.assert("one bind group");
}

#[test]
fn gpu_suns_of_one_technique_share_their_pipelines() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = shadows(&device, &technique(), 0);
    let mut moon = shadows(&device, &technique(), 0);
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let views = [camera(EYE).frustum().expect("a camera")];
    sun.update(&device.queue, &frame_of(&views, SUN, &BOXES)).expect("a good frame");
    moon.update(&device.queue, &frame_of(&views, MOON, &BOXES)).expect("a good frame");
    for (sun, [in_sun_shadow, in_moon_shadow]) in [(&sun, [0, 255]), (&moon, [255, 0])] {
        let picture = painter.draw(&device, &[(sun, &BOXES)]);
        assert_eq!(factors(&picture).map(|factors| factors[0]), [in_sun_shadow, in_moon_shadow, 255]);
    }
    quiet.assert("shared pipelines");
}
