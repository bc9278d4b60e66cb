//! Images of small files: selection among a texture's images, including WebP, and replacement of unusable
//! ones.

use std::io::Cursor;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use image::{ImageFormat, RgbaImage};
use shadowfit_scene::{Image, Scene, SceneError};

use crate::assets;
use crate::build::{Build, TRIANGLE, refusal, write};

/// Members of a texture with a WebP image and another one for readers that do not know the extension.
const WEBP_AND_FALLBACK: &str = r#""source":1,"extensions":{"EXT_texture_webp":{"source":0}}"#;

/// Members of a texture with a WebP image only.
const WEBP_ALONE: &str = r#""extensions":{"EXT_texture_webp":{"source":0}}"#;

/// Encodes two half-transparent pixels of these colours without loss.
fn encoded(format: ImageFormat, colors: [[u8; 4]; 2]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let pixels = RgbaImage::from_raw(2, 1, colors.concat()).unwrap();
    pixels.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

const RED_GREEN: [[u8; 4]; 2] = [[255, 0, 0, 128], [0, 255, 0, 255]];
const BLUE: [[u8; 4]; 2] = [[0, 0, 255, 255]; 2];

fn data_uri(bytes: &[u8], kind: &str) -> String {
    format!(r#"{{"uri":"data:image/{kind};base64,{}"}}"#, BASE64_STANDARD.encode(bytes))
}

fn webp() -> String {
    data_uri(&encoded(ImageFormat::WebP, RED_GREEN), "webp")
}

fn damaged_webp() -> String {
    let bytes = encoded(ImageFormat::WebP, RED_GREEN);
    data_uri(&bytes[..bytes.len() - 6], "webp")
}

/// Completes a file with a triangle whose base colour texture has these members.
fn textured(mut build: Build, texture: &str, images: &[String], more: &str) -> Build {
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    build.one_primitive(&format!(r#"{{"material":0,"attributes":{{"POSITION":{positions}}}}}"#));
    let images = images.join(",");
    build.members(&format!(
        r#""materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
        "textures":[{{{texture}}}],"images":[{images}]{more}"#
    ));
    build
}

fn load(texture: &str, images: &[String]) -> Result<Scene, SceneError> {
    textured(Build::default(), texture, images, "").load("images")
}

/// Returns the image of the triangle's base colour.
fn base_color(scene: &Scene) -> &Image {
    &scene.images[scene.materials[1].base_color_texture.unwrap().image]
}

/// Returns the notes about images and textures.
fn image_notes(scene: &Scene) -> Vec<&str> {
    let is_of_image = |note: &&str| note.starts_with("images") || note.starts_with("textures");
    scene.notes.iter().map(String::as_str).filter(is_of_image).collect()
}

fn assert_placeholder(scene: &Scene) {
    let image = base_color(scene);
    assert_eq!((image.width, image.height, &image.rgba[..]), (1, 1, &[255; 4][..]));
}

#[test]
fn webp_images_are_read_from_buffer_views_data_uris_and_files_of_any_name() {
    let bytes = encoded(ImageFormat::WebP, RED_GREEN);
    write("images", "red.webp", &bytes);
    write("images", "red.png", &bytes);
    let mut build = Build::default();
    let view = build.view(&bytes);
    let from_view = textured(build, WEBP_ALONE, &[format!(r#"{{"bufferView":{view},"mimeType":"image/webp"}}"#)], "");
    let scenes = [
        from_view.load("images"),
        load(WEBP_ALONE, &[webp()]),
        load(WEBP_ALONE, &[r#"{"uri":"red.webp"}"#.to_owned()]),
        load(WEBP_ALONE, &[r#"{"uri":"red.png"}"#.to_owned()]),
        // The specification forbids WebP without the extension, but the reader accepts it.
        load(r#""source":0"#, &[webp()]),
    ];
    for scene in scenes.map(Result::unwrap) {
        assert_eq!(image_notes(&scene), [""; 0]);
        assert_eq!(base_color(&scene).rgba, RED_GREEN.concat());
        assert_eq!((base_color(&scene).width, scene.images.len()), (2, 1));
    }
}

#[test]
fn a_file_may_use_or_require_the_webp_extension() {
    for declared in [r#","extensionsUsed":["EXT_texture_webp"]"#, r#","extensionsRequired":["EXT_texture_webp"]"#] {
        let scene = textured(Build::default(), WEBP_ALONE, &[webp()], declared).load("declared").unwrap();
        assert_eq!(base_color(&scene).rgba, RED_GREEN.concat());
        assert!(!scene.notes.iter().any(|note| note.contains("extension")), "{:?}", scene.notes);
    }
}

#[test]
fn the_webp_image_of_a_texture_is_taken_and_the_other_one_where_it_cannot_be_used() {
    let blue = data_uri(&encoded(ImageFormat::Png, BLUE), "png");
    let scene = load(WEBP_AND_FALLBACK, &[webp(), blue.clone()]).unwrap();
    assert_eq!((base_color(&scene).rgba.clone(), scene.images.len()), (RED_GREEN.concat(), 1));

    let missing = r#"{"uri":"missing.webp"}"#.to_owned();
    for unusable in [damaged_webp(), missing] {
        let scene = load(WEBP_AND_FALLBACK, &[unusable.clone(), blue.clone()]).unwrap();
        assert_eq!((base_color(&scene).rgba.clone(), scene.images.len()), (BLUE.concat(), 1));
        let notes = image_notes(&scene);
        assert!(notes.len() == 1 && notes[0].starts_with("images[0]: replaced by images[1]: "), "{notes:?}");

        let scene = load(WEBP_AND_FALLBACK, &[unusable, r#"{"uri":"missing.png"}"#.to_owned()]).unwrap();
        assert_placeholder(&scene);
        let notes = image_notes(&scene);
        assert!(notes.len() == 2 && notes[1].starts_with("images[1]: replaced by a placeholder: "), "{notes:?}");
    }
}

#[test]
fn webp_images_cut_short_at_any_length_are_replaced_with_a_note() {
    let bytes = encoded(ImageFormat::WebP, RED_GREEN);
    for length in 0..bytes.len() - 4 {
        let scene = load(WEBP_ALONE, &[data_uri(&bytes[..length], "webp")]).unwrap();
        assert_placeholder(&scene);
        let notes = image_notes(&scene);
        assert!(notes.len() == 1 && notes[0].starts_with("images[0]: replaced by a placeholder: "), "{notes:?}");
    }
}

#[test]
fn a_webp_image_that_claims_more_pixels_than_the_limit_is_replaced_before_they_are_allocated() {
    // Width and height minus one, in 14 bits each.
    let side = 16_383_u32 - 1;
    let size = side | (side << 14);
    let bytes = [b"RIFF\x12\0\0\0WEBPVP8L\x05\0\0\0\x2f".as_slice(), &size.to_le_bytes(), b"\0"].concat();
    let scene = load(WEBP_ALONE, &[data_uri(&bytes, "webp")]).unwrap();
    assert_placeholder(&scene);
    let notes = image_notes(&scene);
    assert!(notes.len() == 1 && notes[0].contains("exceeds limit"), "{notes:?}");
}

#[test]
fn textures_without_an_image_get_a_placeholder_and_those_with_one_that_is_not_there_are_refused() {
    for texture in ["", r#""extensions":{"EXT_texture_webp":{}}"#, r#""extensions":{"EXT_texture_webp":[]}"#] {
        let scene = load(texture, &[]).unwrap();
        assert_placeholder(&scene);
        assert_eq!(image_notes(&scene), ["textures[0]: replaced by a placeholder: it has no PNG, JPEG or WebP image"]);
    }
    let extension = |source: &str| format!(r#""source":0,"extensions":{{"EXT_texture_webp":{{"source":{source}}}}}"#);
    for (texture, reason) in [
        (r#""source":1"#.to_owned(), "textures[0]: there is no image 1"),
        (extension("7"), "textures[0]: there is no image 7"),
        (extension("-1"), "EXT_texture_webp.source: -1 is not the index of an image"),
        (extension("\"0\""), "EXT_texture_webp.source: \"0\" is not the index of an image"),
    ] {
        let message = refusal(load(&texture, &[webp()]));
        assert!(message.contains(reason), "{message}");
    }
}

#[test]
fn a_webp_image_of_the_khronos_validator_is_red() {
    let Some(folder) = assets::folder() else { return };
    let file = folder.join("hostile_shared/validator/ext__EXT_texture_webp__data__image__valid.gltf");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let from = text.find("data:image/webp").unwrap();
    let uri = text[from..].split('"').next().unwrap();
    let scene = load(WEBP_ALONE, &[format!(r#"{{"uri":"{uri}"}}"#)]).unwrap();
    let image = base_color(&scene);
    assert!(image.width > 1 && image.rgba.chunks_exact(4).all(|pixel| pixel == [255, 0, 0, 255]), "{:?}", scene.notes);
}
