//! The data of one pixel: it equals a probe of the whole picture there, and the depths that a map holds, in
//! every format and wherever the map is stored. Also, a kept map changes only in the rectangles that a frame
//! reports as drawn.

use glam::{DVec3, UVec2};
use shadowfit::scroll::TexelRect;
use shadowfit::settings::{FilterKind, MapFormat};
use shadowfit::{FittedMap, PerspectiveCamera, Technique};
use shadowfit_render::{Gpu, PixelFacts, PixelQuery, TexelBlock, UpdateKind};
use shadowfit_scene::builtin::default_scene;
use shadowfit_testing::read_back;
use shadowfit_wgpu::ShadowMap;

use super::pictures::{Pictures, SIZE, Seen, Stage, random};

/// Width and height of the maps, in texels. In smaller maps a full redraw would be cheaper than strips.
const SIDE: u32 = 512;

fn technique(format: MapFormat) -> Technique {
    Technique::default().with_count(1).with_resolution(SIDE, SIDE).with_format(format).with_filter(FilterKind::Point)
}

/// Returns the bytes of each layer of a map's texture.
fn layers(gpu: &Gpu, map: &ShadowMap) -> Vec<Vec<u8>> {
    let texture = map.view().texture();
    let bytes = read_back::bytes(&gpu.device, &gpu.queue, texture);
    bytes.chunks(bytes.len() / texture.depth_or_array_layers() as usize).map(<[u8]>::to_vec).collect()
}

/// Decodes a depth from the bytes of a format.
fn depth(format: MapFormat, bytes: &[u8]) -> f32 {
    match (format, bytes) {
        (MapFormat::R8Grey, [byte]) => f32::from(*byte) / 255.0,
        (MapFormat::Depth16Unorm, [low, high]) => f32::from(u16::from_le_bytes([*low, *high])) / 65535.0,
        (MapFormat::R16Float, [low, high]) => {
            let bits = u16::from_le_bytes([*low, *high]);
            let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
            if exponent == 0 { mantissa * 2.0_f32.powi(-24) } else { (1024.0 + mantissa) * 2.0_f32.powi(exponent - 25) }
        }
        (_, [a, b, c, d]) => f32::from_le_bytes([*a, *b, *c, *d]),
        _ => panic!("{} bytes of {format:?}", bytes.len()),
    }
}

#[test]
fn a_pixel_has_the_facts_that_a_probe_of_the_whole_picture_has_there() {
    let Stage { mut pictures, seen } = Stage::new(&technique(MapFormat::Depth32Float), 1);
    let whole = pictures.probe(&seen.frame());
    let mut surfaces = 0;
    for pixel in random(20, SIZE[0] * SIZE[1]) {
        let query = PixelQuery { size: SIZE, pixel: [pixel % SIZE[0], pixel / SIZE[0]], texels: None };
        let facts = pictures.pixel(&seen.frame(), &query);
        assert_eq!(facts, PixelFacts { query, seen: whole.pixels[pixel as usize], depths: Vec::new() });
        surfaces += usize::from(facts.seen.is_some());
    }
    assert!(surfaces > 10, "{surfaces}");
    // Beyond the picture the nearest pixel is used, and a missing map has no depths.
    let texels = Some(TexelBlock { map: 7, texel: [0, 0], radius: 2 });
    let facts = pictures.pixel(&seen.frame(), &PixelQuery { size: SIZE, pixel: [9999, 9999], texels });
    assert_eq!((facts.seen, facts.depths), (*whole.pixels.last().expect("pixels"), Vec::new()));
}

/// Compares blocks of texels with the content of the layers.
fn assert_depths(pictures: &mut Pictures, seen: &Seen, format: MapFormat) {
    let stored = layers(&pictures.gpu, pictures.renderer.shadow_map());
    let bytes = stored[0].len() / (SIDE * SIDE) as usize;
    for (number, texel, radius) in [(0, [100, 37], 3), (1, [0, 255], 4), (2, [250, 128], 31), (3, [-9, 300], 1)] {
        let map = number % stored.len();
        let texels = Some(TexelBlock { map, texel, radius });
        let facts = pictures.pixel(&seen.frame(), &PixelQuery { size: SIZE, pixel: [80, 45], texels });
        let texel_offset = pictures.renderer.sun().maps()[map].texel_offset;
        let side = radius.cast_signed() * 2 + 1;
        assert_eq!(facts.depths.len(), (side * side) as usize);
        for (index, found) in (0_i32..).zip(&facts.depths) {
            let [x, y] = [index % side, index / side];
            let at = [texel[0] + x - radius.cast_signed(), texel[1] + y - radius.cast_signed()];
            let [u, v] = at.map(|place| place.clamp(0, SIDE.cast_signed() - 1) as u32);
            let place = (((v + texel_offset.y) % SIDE) * SIDE + (u + texel_offset.x) % SIDE) as usize * bytes;
            let expected = depth(format, &stored[map][place..place + bytes]);
            assert!((found - expected).abs() <= 1e-6, "{format:?} {map} {at:?}: {found}, not {expected}");
        }
    }
}

#[test]
fn texels_around_a_pixel_are_those_of_the_map_in_every_format() {
    // WebGPU cannot copy 24-bit depths to a buffer.
    for format in MapFormat::ALL.into_iter().filter(|format| *format != MapFormat::Depth24Unorm) {
        let Stage { mut pictures, seen } = Stage::new(&technique(format), 1);
        pictures.probe(&seen.frame());
        assert_depths(&mut pictures, &seen, format);
    }
}

/// Step of a walking camera, in metres.
const STEP: DVec3 = DVec3::new(0.35, 0.0, -0.25);

#[test]
fn nothing_of_a_kept_map_changes_but_in_the_rectangles_that_were_drawn_and_wrapped_texels_are_found() {
    let technique = Technique::preset("stable-4").expect("a preset").with_resolution(SIDE, SIDE);
    let technique = technique.with_filter(FilterKind::Point);
    let Stage { mut pictures, mut seen } = Stage::new(&technique, 1);
    pictures.renderer.sun_mut().set_caching(true);
    let scene = default_scene();
    let mut before: Option<Vec<Vec<u8>>> = None;
    let (mut met, mut changes) = ([false; 4], 0);
    for frame in 0..6 {
        pictures.scene.set_pose(&pictures.gpu, &scene, &scene.pose(Some(0), frame as f32 * 0.2));
        let step = if frame > 2 { STEP } else { DVec3::ZERO };
        let camera = PerspectiveCamera { eye: seen.camera.eye + step, ..seen.camera };
        seen = Seen::new(&technique, &pictures.scene, camera);
        let statistics = pictures.draw(&seen.frame());
        let updates = pictures.renderer.sun().updates();
        assert_eq!(statistics.shadow_texels, updates.iter().map(|update| update.rect.area()).sum::<u64>());
        let now = layers(&pictures.gpu, pictures.renderer.shadow_map());
        let kept = pictures.renderer.sun();
        for update in &updates {
            met[update.content as usize] = true;
        }
        for (map, (now, before)) in now.iter().zip(before.iter().flatten()).enumerate() {
            assert!(kept.is_cached(map));
            let mut is_drawn = vec![false; (SIDE * SIDE) as usize];
            let rects = updates.iter().filter(|update| update.map == map);
            let parts = rects.flat_map(|update| update.rect.stored(kept.maps()[map].texel_offset, UVec2::splat(SIDE)));
            for TexelRect { min, size } in parts.map(|part| part.stored) {
                for row in min.y..min.y + size.y {
                    is_drawn[(row * SIDE + min.x) as usize..][..size.x as usize].fill(true);
                }
            }
            for (texel, (now, before)) in now.as_chunks::<4>().0.iter().zip(before.as_chunks::<4>().0).enumerate() {
                assert!(now == before || is_drawn[texel], "frame {frame}, map {map}, texel {texel}");
                changes += usize::from(now != before);
            }
        }
        before = Some(now);
    }
    let contents = [UpdateKind::All, UpdateKind::Static, UpdateKind::Mended, UpdateKind::Moving];
    println!("{changes} changes by {contents:?}: {met:?}");
    assert!(met[1] && met[2] && met[3] && changes > 1000, "{met:?}, {changes}");
    let is_wrapped = |map: &FittedMap| map.texel_offset != UVec2::ZERO;
    assert!(pictures.renderer.sun().maps().iter().any(is_wrapped));
    assert_depths(&mut pictures, &seen, MapFormat::Depth32Float);
}
