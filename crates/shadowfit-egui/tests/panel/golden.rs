//! Golden pictures of the panel, drawn by the software adapter on any machine.
//!
//! A missing golden fails. `SHADOWFIT_UPDATE_GOLDENS=1` or `cargo xtask golden` writes them. A failure leaves
//! `NAME.actual.png` and `NAME.diff.png` beside `NAME.png`.

use std::path::{Path, PathBuf};

use egui::{Theme, Vec2};
use egui_kittest::{Harness, SnapshotOptions, try_image_snapshot_options};
use image::RgbaImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use shadowfit_egui::PANEL_WIDTH;

use crate::card;
use crate::host::{Host, builder};
use crate::renderer::SoftwareRenderer;
use crate::states::{busy, play, session};

/// Greatest size of a golden, in bytes.
const MAX_BYTES: u64 = 128 * 1024;

/// Height of the pictures, in points.
const HEIGHT: f32 = 900.0;

/// Every golden.
const NAMES: [&str; 6] = ["dark", "light", "dark-busy", "light-plots", "dark-twice", "dark-sample"];

/// Least colour distance, weighted for the eye, of a different pixel, and the greatest number of different
/// pixels. The same driver draws the same bits, but another version may round the edges of glyphs
/// differently. A control that moves by a point changes many more pixels.
const DIFFERENT: f32 = 0.6;
const DIFFERENT_PIXELS: usize = 60;

/// Makes a harness that draws.
fn drawn(host: Host, theme: Theme) -> Harness<'static, Host> {
    drawn_at(host, theme, HEIGHT, 1.0)
}

fn drawn_at(host: Host, theme: Theme, height: f32, scale: f32) -> Harness<'static, Host> {
    builder(Vec2::new(PANEL_WIDTH, height), theme, scale)
        .renderer(SoftwareRenderer::new())
        .with_render_cursor(false)
        .build_ui_state(|ui, host: &mut Host| host.show(ui), host)
}

#[test]
fn the_panel_at_rest_is_as_it_was() {
    check("dark", &mut drawn(session(), Theme::Dark));
    check("light", &mut drawn(session(), Theme::Light));
}

#[test]
fn an_artefact_two_techniques_and_a_search_are_as_they_were() {
    check("dark-busy", &mut drawn(busy(), Theme::Dark));
}

#[test]
fn the_card_of_a_sample_is_as_it_was() {
    check("dark-sample", &mut drawn(card::session(), Theme::Dark));
}

#[test]
fn the_panel_on_a_screen_of_twice_the_pixels_is_as_it_was() {
    check("dark-twice", &mut drawn_at(busy(), Theme::Dark, 0.5 * HEIGHT, 2.0));
}

#[test]
fn the_plots_are_as_they_were() {
    let mut harness = drawn(session(), Theme::Light);
    play(&mut harness);
    check("light-plots", &mut harness);
}

#[test]
fn the_folder_holds_exactly_these_goldens_and_each_is_small() {
    if updates() {
        println!("SKIPPED: other tests are writing the goldens now; run the tests again without updating");
        return;
    }
    let entries = std::fs::read_dir(folder()).unwrap_or_else(|error| panic!("{}: {error}", folder().display()));
    let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let mut present: Vec<String> = names.filter(|name| name.matches('.').count() == 1).collect();
    present.sort();
    let mut expected = NAMES.map(|name| format!("{name}.png"));
    expected.sort();
    assert_eq!(present, expected, "goldens in {}; `cargo xtask golden` writes missing ones", folder().display());
    for name in expected {
        let path = folder().join(name);
        let bytes = std::fs::metadata(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).len();
        assert!(bytes <= MAX_BYTES, "{} has {bytes} bytes", path.display());
    }
}

#[test]
fn the_golden_comparison_sees_what_is_missing_and_what_moved() {
    let picture = RgbaImage::from_fn(64, 64, |x, y| image::Rgba([(x * 3) as u8, (y * 3) as u8, 90, 255]));
    let folder = std::env::temp_dir().join("shadowfit-panel-goldens");
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let compare = |picture: &RgbaImage, name: &str| try_image_snapshot_options(picture, name, &options(&folder));
    assert!(compare(&picture, "missing").is_err());
    picture.save(folder.join("there.png")).expect("a picture");
    assert!(compare(&picture, "there").is_ok());
    let moved = image::imageops::crop_imm(&picture, 8, 0, 56, 64).to_image();
    let mut other = picture.clone();
    image::imageops::replace(&mut other, &moved, 0, 0);
    assert!(compare(&other, "there").is_err());
}

/// Returns whether this run writes the goldens.
fn updates() -> bool {
    std::env::var_os("SHADOWFIT_UPDATE_GOLDENS").is_some_and(|value| value != "0")
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn options(folder: &Path) -> SnapshotOptions {
    SnapshotOptions::new().output_path(folder).threshold(DIFFERENT).max_failed_pixels(DIFFERENT_PIXELS)
}

/// Saves a picture with the best compression, without its opacity.
fn save(picture: &RgbaImage, path: &Path) {
    let file = std::fs::File::create(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive);
    let rgb = image::DynamicImage::ImageRgba8(picture.clone()).to_rgb8();
    rgb.write_with_encoder(encoder).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// Draws the panel and compares it with its golden, or writes the golden.
fn check(name: &str, harness: &mut Harness<'_, Host>) {
    assert!(NAMES.contains(&name), "{name} is missing in the list of goldens");
    harness.run();
    let picture = harness.render().unwrap_or_else(|error| panic!("{name}: {error}"));
    if updates() {
        std::fs::create_dir_all(folder()).expect("the folder of the goldens");
        save(&picture, &folder().join(name).with_extension("png"));
    } else if let Err(reason) = try_image_snapshot_options(&picture, name, &options(&folder())) {
        // Named like all other goldens of the workspace. Absent if the picture could not be written.
        let _ = std::fs::rename(folder().join(format!("{name}.new.png")), folder().join(format!("{name}.actual.png")));
        panic!("{reason}\n`cargo xtask golden` writes the goldens; look at the pictures before committing them");
    }
}
