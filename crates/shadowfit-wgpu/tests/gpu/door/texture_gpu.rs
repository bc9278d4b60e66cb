//! Maps in textures that the engine owns: the same images as with internal textures, two suns in one array,
//! and textures that cannot hold the maps.

use shadowfit::Technique;
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit_testing::TestGpu;
use shadowfit_wgpu::{
    Casters, LightSteps, MapTexture, MapTextureError, ShadowMapDescriptor, ShadowMapError, SunFrame, SunShadows,
    SunShadowsDescriptor, SunShadowsError,
};

use super::ground::{BOXES, EYE, MOON, Painter, Quiet, SUN, camera, frame_of};
use super::{IN_MOON_SHADOW, IN_SUN_SHADOW, LIT, technique};
use crate::engine::{ClearedDepth, Engine, cleared};

/// Initial depth of all layers.
const FILLED: f32 = 0.25;

/// Creates a texture for the maps of a technique, with another number of layers, and with changes.
fn texture(
    device: &Engine,
    technique: &Technique,
    layers: u32,
    change: impl FnOnce(&mut wgpu::TextureDescriptor<'static>),
) -> wgpu::Texture {
    let mut descriptor = ShadowMapDescriptor::from(technique).texture();
    descriptor.size.depth_or_array_layers = layers;
    change(&mut descriptor);
    device.device.create_texture(&descriptor)
}

fn sun_in(device: &Engine, technique: &Technique, first_binding: u32, texture: &MapTexture) -> SunShadows {
    if texture.base_layer > 0 {
        device.require_base_layers();
    }
    let descriptor = SunShadowsDescriptor { first_binding, ..in_texture(technique, texture) };
    SunShadows::new(&device.device, &device.queue, &descriptor).expect("maps in a texture")
}

/// Returns the description of maps in a texture, with bindings from 0 on.
fn in_texture(technique: &Technique, texture: &MapTexture) -> SunShadowsDescriptor {
    SunShadowsDescriptor { texture: Some(texture.clone()), ..(*technique).into() }
}

/// Updates suns with a frame in which the post moves.
fn update(device: &Engine, suns: &mut [(&mut SunShadows, shadowfit::glam::Vec3)], step: u16) -> [shadowfit::Aabb; 3] {
    let mut boxes = BOXES;
    boxes[2].min.z += 0.3 * f32::from(step);
    boxes[2].max.z += 0.3 * f32::from(step);
    let views = [camera(EYE).frustum().expect("a camera")];
    for (sun, direction) in suns {
        let frame = frame_of(&views, *direction, &boxes);
        let casters = Casters { moves: &[false, false, true], ..frame.casters };
        sun.update(&device.queue, &SunFrame { casters, ..frame }).expect("a good frame");
    }
    boxes
}

#[test]
fn gpu_maps_in_a_texture_of_the_engine_s_give_the_picture_of_internal_ones() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    for format in [MapFormat::Depth32Float, MapFormat::Depth16Unorm, MapFormat::R32Float, MapFormat::Rgba8Packed] {
        let technique = technique().with_format(format);
        let texture = texture(&device, &technique, 7, |_| ());
        let mut own = sun_in(&device, &technique, 0, &MapTexture { texture: texture.clone(), base_layer: 2 });
        assert_eq!(own.map().view().texture(), &texture);
        let mut internal = SunShadows::new(&device.device, &device.queue, &technique.into()).expect("maps");
        assert!(internal.map().texture().is_none());
        let painter = Painter::new(&device, &[(&own, "shadowfit")]);
        for step in 0..3 {
            let boxes = update(&device, &mut [(&mut own, SUN), (&mut internal, SUN)], step);
            let [own, internal] = [&own, &internal].map(|sun| painter.draw(&device, &[(sun, &boxes)]));
            assert_eq!([own.at(IN_SUN_SHADOW)[0], own.at(LIT)[0]], [0, 255], "{format:?}");
            assert_eq!(own, internal, "{format:?}, frame {step}");
        }
    }
    quiet.assert("maps in textures");
}

#[test]
fn gpu_a_sun_that_steps_fades_within_a_texture_of_the_engine_s_if_it_has_room_for_both_sets() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let technique = technique();
    let steps = Some(LightSteps { texels: 3.0, fade: 4 });
    let small = MapTexture { texture: texture(&device, &technique, 6, |_| ()), base_layer: 1 };
    let mut refused = sun_in(&device, &technique, 0, &small);
    let error = refused.set_light_steps(steps).expect_err("the texture has too few layers for a second set");
    let layers = MapTextureError::Layers { texture: 6, base_layer: 1, maps: 8 };
    assert!(matches!(&error, SunShadowsError::Map(ShadowMapError::Texture(why)) if *why == layers), "{error:?}");
    assert_eq!(refused.light_steps(), None);

    let large = MapTexture { texture: texture(&device, &technique, 9, |_| ()), base_layer: 1 };
    let mut own = sun_in(&device, &technique, 0, &large);
    let mut internal = SunShadows::new(&device.device, &device.queue, &technique.into()).expect("maps");
    for sun in [&mut own, &mut internal] {
        sun.set_light_steps(steps).expect("the texture has enough layers");
    }
    assert_eq!(own.map().texture(), Some(&large));
    let painter = Painter::new(&device, &[(&own, "shadowfit")]);
    for step in 0..16_u16 {
        // The sun steps in the fourth frame.
        let turned = shadowfit::glam::Vec3::X * if step < 3 { 0.0 } else { 0.03 };
        let boxes = update(&device, &mut [(&mut own, SUN + turned), (&mut internal, SUN + turned)], step % 4);
        let [own, internal] = [&own, &internal].map(|sun| painter.draw(&device, &[(sun, &boxes)]));
        assert_eq!(own, internal, "frame {step}");
    }
    quiet.assert("steps in a texture");
}

/// Clears all layers of a texture to [`FILLED`].
fn fill(device: &Engine, texture: &wgpu::Texture) {
    let mut encoder = device.encoder();
    for layer in 0..texture.depth_or_array_layers() {
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        drop(cleared(&mut encoder, &[], Some(ClearedDepth { view: &view, value: FILLED })));
    }
    device.submit(encoder);
}

/// Returns the depths of each layer.
fn layers(device: &Engine, texture: &wgpu::Texture) -> Vec<Vec<f32>> {
    let texels: Vec<f32> = device.texels(texture);
    texels.chunks((texture.width() * texture.height()) as usize).map(<[f32]>::to_vec).collect()
}

#[test]
fn gpu_two_suns_of_one_array_leave_each_other_s_layers_and_all_others_alone() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let techniques = [technique().with_format(MapFormat::Depth32Float), technique().with_count(2)];
    let techniques = techniques.map(|technique| technique.with_format(MapFormat::Depth32Float));
    // Layers 0 and 7 belong to no sun.
    let texture = texture(&device, &techniques[0], 8, |descriptor| descriptor.usage |= wgpu::TextureUsages::COPY_SRC);
    fill(&device, &texture);
    let mut sun = sun_in(&device, &techniques[0], 0, &MapTexture { texture: texture.clone(), base_layer: 1 });
    let mut moon = sun_in(&device, &techniques[1], 3, &MapTexture { texture: texture.clone(), base_layer: 5 });
    let both = Painter::new(&device, &[(&sun, "sun"), (&moon, "moon")]);
    let is_filled = |layer: &Vec<f32>| layer.iter().all(|depth| *depth == FILLED);
    let (mut before, mut drawn) = (layers(&device, &texture), 0);
    assert!(before.iter().all(is_filled));
    for step in 0..6 {
        // Update the suns in turn, so that changes can be attributed.
        let is_sun = step % 2 == 0;
        let (shadows, direction, own) = if is_sun { (&mut sun, SUN, 1..5) } else { (&mut moon, MOON, 5..7) };
        let boxes = update(&device, &mut [(shadows, direction)], step);
        let mut encoder = device.encoder();
        let suns: [(&SunShadows, &[_]); 2] = [(&sun, &boxes), (&moon, &boxes)];
        both.draw_one(&device, &mut encoder, &suns, usize::from(!is_sun));
        device.submit(encoder);
        let after = layers(&device, &texture);
        for (layer, (before, after)) in before.iter().zip(&after).enumerate() {
            assert!(own.contains(&layer) || before == after, "step {step} wrote layer {layer}");
        }
        assert!(own.clone().all(|layer| !is_filled(&after[layer])), "step {step} draws into all of its layers");
        drawn += usize::from(own.clone().any(|layer| before[layer] != after[layer]));
        before = after;
    }
    assert_eq!(drawn, 6);
    assert!(is_filled(&before[0]) && is_filled(&before[7]));
    let boxes = update(&device, &mut [(&mut sun, SUN), (&mut moon, MOON)], 6);
    let picture = both.draw(&device, &[(&sun, &boxes), (&moon, &boxes)]);
    let factors = [IN_SUN_SHADOW, IN_MOON_SHADOW, LIT].map(|place| [picture.at(place)[0], picture.at(place)[1]]);
    assert_eq!(factors, [[0, 255], [255, 0], [255, 255]]);
    quiet.assert("two suns in one array");
}

/// Returns textures that cannot hold four maps of 256² texels, the error, and words of the message.
fn unsuited(device: &Engine) -> Vec<(MapTexture, MapTextureError, [&'static str; 2])> {
    let technique = technique();
    let format = ShadowMapDescriptor::from(&technique).texture().format;
    let made = |change: fn(&mut wgpu::TextureDescriptor<'static>)| MapTexture {
        texture: texture(device, &technique, 4, change),
        base_layer: 0,
    };
    let from = |base_layer| MapTexture { texture: texture(device, &technique, 6, |_| ()), base_layer };
    let other = wgpu::TextureFormat::R16Float;
    let layers = |texture, base_layer| MapTextureError::Layers { texture, base_layer, maps: 4 };
    vec![
        (
            made(|texture| {
                (texture.dimension, texture.format) = (wgpu::TextureDimension::D3, wgpu::TextureFormat::R16Float);
            }),
            MapTextureError::Dimension(wgpu::TextureDimension::D3),
            ["D3", "D2"],
        ),
        (
            made(|texture| texture.format = wgpu::TextureFormat::R16Float),
            MapTextureError::Format { texture: other, maps: format },
            ["R16Float", "Depth"],
        ),
        (
            made(|texture| texture.size.height = 512),
            MapTextureError::Size { texture: [256, 512], maps: [256, 256] },
            ["256 × 512", "256 × 256"],
        ),
        (
            made(|texture| (texture.sample_count, texture.size.depth_or_array_layers) = (4, 1)),
            MapTextureError::Samples(4),
            ["4 samples", "maps have 1"],
        ),
        (
            made(|texture| texture.usage = wgpu::TextureUsages::RENDER_ATTACHMENT),
            MapTextureError::Usages { missing: wgpu::TextureUsages::TEXTURE_BINDING },
            ["usage", "TEXTURE_BINDING"],
        ),
        (
            made(|texture| texture.usage = wgpu::TextureUsages::TEXTURE_BINDING),
            MapTextureError::Usages { missing: wgpu::TextureUsages::RENDER_ATTACHMENT },
            ["usage", "RENDER_ATTACHMENT"],
        ),
        (made(|texture| texture.size.depth_or_array_layers = 3), layers(3, 0), ["3 layers", "4 maps from layer 0"]),
        (from(3), layers(6, 3), ["6 layers", "4 maps from layer 3"]),
        (from(u32::MAX), layers(6, u32::MAX), ["6 layers", "4294967295"]),
    ]
}

#[test]
fn gpu_a_texture_that_cannot_hold_the_maps_is_refused_by_name_and_value_and_the_sun_goes_on() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let mut sun = sun_in(
        &device,
        &technique(),
        0,
        &MapTexture { texture: texture(&device, &technique(), 4, |_| ()), base_layer: 0 },
    );
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    for (texture, error, words) in unsuited(&device) {
        let error = ShadowMapError::Texture(error);
        let refused = SunShadows::new(&device.device, &device.queue, &in_texture(&technique(), &texture));
        assert_eq!(refused.expect_err("no maps"), error);
        assert_eq!(sun.set_descriptor(&in_texture(&technique(), &texture)), Err(error.clone()));
        for word in words {
            assert!(error.to_string().contains(word), "{error}: {word}");
        }
        let boxes = update(&device, &mut [(&mut sun, SUN)], 0);
        let picture = painter.draw(&device, &[(&sun, &boxes)]);
        assert_eq!([picture.at(IN_SUN_SHADOW)[0], picture.at(LIT)[0]], [0, 255], "after {error}");
    }
    quiet.assert("textures that are refused");
}

#[test]
fn gpu_a_texture_that_is_destroyed_or_another_device_s_is_refused_in_the_device_s_words() {
    let device = Engine::shared();
    let adapter = device.adapter.clone();
    let other = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()));
    let (other, queue) = other.expect("another device of the adapter");
    let other = Engine::of(TestGpu { adapter, device: other, queue });
    let quiet = Quiet::new(&device);
    let destroyed = texture(&device, &technique(), 4, |_| ());
    destroyed.destroy();
    for texture in [destroyed, texture(&other, &technique(), 4, |_| ())] {
        let texture = MapTexture { texture, base_layer: 0 };
        let refused = SunShadows::new(&device.device, &device.queue, &in_texture(&technique(), &texture));
        let refused = refused.expect_err("no maps");
        assert!(matches!(refused, ShadowMapError::Device(_)), "{refused}");
    }
    quiet.assert("textures of other devices");
}

#[test]
fn gpu_another_technique_stays_in_the_texture_or_moves_to_one_that_holds_it() {
    let device = Engine::shared();
    let quiet = Quiet::new(&device);
    let small = MapTexture { texture: texture(&device, &technique(), 5, |_| ()), base_layer: 1 };
    let mut sun = sun_in(&device, &technique(), 2, &small);
    let wider = technique().with_filter(FilterKind::Pcf3x3);
    assert_eq!(sun.set_technique(&wider), Ok(true));
    assert_eq!(sun.map().texture(), Some(&small));
    // Another map, or larger maps, do not fit.
    let (more, larger) = (wider.with_count(5), wider.with_resolution(512, 512));
    let layers = MapTextureError::Layers { texture: 5, base_layer: 1, maps: 5 };
    assert_eq!(sun.set_technique(&more), Err(ShadowMapError::Texture(layers)));
    let size = MapTextureError::Size { texture: [256; 2], maps: [512; 2] };
    assert_eq!(sun.set_technique(&larger), Err(ShadowMapError::Texture(size)));
    assert_eq!((sun.technique(), sun.map().texture()), (&wider, Some(&small)));
    let large = MapTexture { texture: texture(&device, &larger, 4, |_| ()), base_layer: 0 };
    let moved = SunShadowsDescriptor { first_binding: 2, ..in_texture(&larger, &large) };
    assert_eq!(sun.set_descriptor(&moved), Ok(true));
    assert_eq!((sun.technique(), sun.map().texture()), (&larger, Some(&large)));
    assert_eq!(sun.map().descriptor().first_binding, 2);
    let painter = Painter::new(&device, &[(&sun, "shadowfit")]);
    let boxes = update(&device, &mut [(&mut sun, SUN)], 0);
    let picture = painter.draw(&device, &[(&sun, &boxes)]);
    assert_eq!([picture.at(IN_SUN_SHADOW)[0], picture.at(LIT)[0]], [0, 255]);
    quiet.assert("other techniques in textures");
}
