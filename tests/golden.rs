//! Golden pictures: the default scene's views at 320×180, and the classic samples in the aspect of their
//! sources. They are always drawn with the software adapter, even if there is a GPU.
//!
//! A missing or mis-sized golden fails. `cargo xtask golden` (`SHADOWFIT_UPDATE_GOLDENS=1`) rewrites them. On
//! a failure, `NAME.actual.png` and `NAME.diff.png` (the amplified difference) are written next to
//! `NAME.png`.

use std::path::{Path, PathBuf};

use image::RgbImage;
use shadowfit::Technique;
use shadowfit::glam::DVec3;
use shadowfit::settings::{FilterKind, MapFormat, SoftRadius};
use shadowfit_classics::{SAMPLES, Sample};
use shadowfit_params::tool::{InsetMaps, ViewMode};
use shadowfit_render::FlyCamera;
use shadowfit_scene::builtin::default_scene;
use shadowfit_testing::golden_gpu;
use shadowfit_viewer::{Artefact, Stage};

use crate::support::workspace;

/// Size of every golden, in pixels.
const SIZE: [u32; 2] = [320, 180];

/// Size limit of a golden, in bytes.
const MAX_BYTES: u64 = 128 * 1024;

/// Samples per pixel, the same number as in the headless mode.
const SAMPLES_PER_PIXEL: u32 = 4;

/// Every golden.
const NAMES: [&str; 20] = [
    "final",
    "inset",
    "outside",
    "acne",
    "acne-fixed",
    "aliasing",
    "aliasing-fixed",
    "hole",
    "hole-fixed",
    "filter-point",
    "filter-hardware-2x2",
    "filter-pcf-3x3",
    "filter-pcf-5x5",
    "filter-pcf-7x7",
    "filter-vogel-8",
    "filter-vogel-16",
    "filter-vogel-32",
    "filter-pcss",
    "format-depth16-unorm",
    "format-r8-grey",
];

/// Angular radius of the sun of the filters' pictures, in radians: 2°, so that soft edges show.
const LARGE_SUN: f32 = 0.035;

/// Width and height of the maps of the filters' pictures, in texels: a texel is a few pixels, so that filters
/// differ.
const COARSE: u32 = 512;

/// Greatest mean difference, in levels of 255 over all channels. The same driver draws the same bits. Another
/// version of it may round a shaded value the other way, which is one level, in some pixels.
const MEAN: f64 = 0.5;

/// Difference in levels from which a pixel counts as different: an edge or texel that moved, not rounding.
const DIFFERENT: u8 = 24;

/// Greatest share of different pixels: along edges, another rounding of coverage moves single pixels. The
/// smallest artefact in a golden covers several times this share.
const DIFFERENT_SHARE: f64 = 0.005;

/// Amplification of the difference picture, which makes a single level visible.
const AMPLIFIED: u8 = 8;

#[test]
fn final_inset_and_outside_view_are_as_they_were() {
    let mut stage = stage();
    stage.settings.view.inset = InsetMaps::Off;
    check(&mut stage, "final");
    stage.settings.view.inset = InsetMaps::One;
    check(&mut stage, "inset");
    stage.settings.view.mode = ViewMode::Outside;
    check(&mut stage, "outside");
}

#[test]
fn acne_and_its_fix_are_as_they_were() {
    check_artefact(Artefact::Acne, ["acne", "acne-fixed"]);
}

#[test]
fn aliasing_and_its_fix_are_as_they_were() {
    check_artefact(Artefact::Aliasing, ["aliasing", "aliasing-fixed"]);
}

#[test]
fn the_hole_and_its_fix_are_as_they_were() {
    check_artefact(Artefact::ClippingHole, ["hole", "hole-fixed"]);
}

#[test]
fn shadows_by_each_filter_are_as_they_were() {
    let mut stage = stage_of_a_long_shadow();
    let names = NAMES.iter().filter(|name| name.starts_with("filter-"));
    let drawn = FilterKind::ALL.into_iter().zip(names).map(|(filter, name)| {
        stage.settings.technique = stage.settings.technique.with_filter(filter);
        check(&mut stage, name);
        name.trim_start_matches("filter-").replace(['-', '_'], "")
    });
    let drawn: Vec<String> = drawn.collect();
    // The names equal the names of all filters, in order.
    assert_eq!(drawn, FilterKind::ALL.map(|filter| format!("{filter:?}").to_lowercase()));
}

#[test]
fn shadows_in_coarse_formats_are_as_they_were() {
    let mut stage = stage_of_a_long_shadow();
    for (format, name) in [(MapFormat::Depth16Unorm, "format-depth16-unorm"), (MapFormat::R8Grey, "format-r8-grey")] {
        stage.settings.technique = stage.settings.technique.with_format(format);
        check(&mut stage, name);
    }
}

#[test]
fn every_classic_sample_is_as_it_was() {
    for sample in &SAMPLES {
        let mut stage = Stage::new(golden_gpu(), sample.scene(), SAMPLES_PER_PIXEL).expect("the sample's scene");
        stage.wait_for_rays();
        stage.set_sample(sample, None);
        check_sized(&mut stage, &sample_golden(sample), sample_size(sample));
    }
}

#[test]
fn the_folder_holds_exactly_these_goldens_and_each_is_small() {
    if updates() {
        println!("SKIPPED: other tests are writing the goldens now; run the tests again without updating");
        return;
    }
    let mut present: Vec<String> = crate::support::files_below(&folder())
        .iter()
        .map(|path| path.file_name().expect("a file's name").to_string_lossy().into_owned())
        .filter(|name| !name.ends_with(".actual.png") && !name.ends_with(".diff.png"))
        .collect();
    present.sort();
    let mut expected: Vec<String> = NAMES.iter().map(|name| format!("{name}.png")).collect();
    expected.extend(SAMPLES.iter().map(|sample| format!("{}.png", sample_golden(sample))));
    expected.sort();
    assert_eq!(present, expected, "goldens in {}; `cargo xtask golden` writes missing ones", folder().display());
    for name in expected {
        let path = folder().join(name);
        let bytes = std::fs::metadata(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).len();
        assert!(bytes <= MAX_BYTES, "{} has {bytes} bytes", path.display());
        let size = image::image_dimensions(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let sample = SAMPLES.iter().find(|sample| path.ends_with(format!("{}.png", sample_golden(sample))));
        assert_eq!(size, sample.map_or(SIZE, sample_size).into(), "{}", path.display());
    }
}

#[test]
fn the_comparison_sees_a_missing_shadow_and_forgives_rounding() {
    let plain = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| image::Rgb([(x % 200) as u8, (y % 200) as u8, 90]));
    let mut rounded = plain.clone();
    rounded.pixels_mut().step_by(2).for_each(|pixel| pixel.0[1] += 1);
    assert_eq!(Difference::between(&plain, &rounded).verdict(), Ok(()));
    let mut changed = plain.clone();
    // One pixel more than the allowed share.
    let allowed = (f64::from(SIZE[0] * SIZE[1]) * DIFFERENT_SHARE) as usize;
    changed.pixels_mut().take(allowed + 1).for_each(|pixel| pixel.0[2] += DIFFERENT);
    assert!(Difference::between(&plain, &changed).verdict().is_err());
    let mut darker = plain.clone();
    darker.pixels_mut().for_each(|pixel| pixel.0[2] -= 2);
    assert!(Difference::between(&plain, &darker).verdict().is_err());
}

fn stage() -> Stage {
    let mut stage =
        Stage::new(golden_gpu(), default_scene(), SAMPLES_PER_PIXEL).expect("the default scene can be shown");
    stage.settings.view.play = false;
    stage.set_home();
    stage
}

/// Returns a stage with the figure's shadow on the floor, from its feet, where edges are hard, to its head,
/// and behind it the shadow of the upper half of a pole of seven metres. The sun is large enough for soft
/// edges, and the maps are coarse enough that filters differ.
fn stage_of_a_long_shadow() -> Stage {
    let mut stage = stage();
    stage.settings.view.inset = InsetMaps::Off;
    stage.settings.camera.fov_y = 0.36;
    stage.camera = FlyCamera::look_at(DVec3::new(-3.2, 2.4, 1.6), DVec3::new(-0.62, 0.1, -0.72));
    let technique = Technique::default().with_resolution(COARSE, COARSE);
    let softness = technique.softness.with_radius(SoftRadius::SunAngle(LARGE_SUN));
    stage.settings.technique = technique.with_softness(softness);
    stage
}

fn check_artefact(artefact: Artefact, [shown, fixed]: [&str; 2]) {
    let mut stage = stage();
    stage.show_artefact(artefact);
    stage.settings.view.inset = InsetMaps::Off;
    check(&mut stage, shown);
    stage.fix_artefact(artefact);
    stage.settings.view.inset = InsetMaps::Off;
    check(&mut stage, fixed);
}

/// Returns the file name of a sample's golden.
fn sample_golden(sample: &Sample) -> String {
    format!("sample-{}", sample.id)
}

/// Returns the size of a sample's golden, in pixels, with the aspect of its source's window.
fn sample_size(sample: &Sample) -> [u32; 2] {
    let [width, height] = sample.size;
    [(width * SIZE[1]).div_ceil(height), SIZE[1]]
}

/// Returns whether this run writes the goldens.
fn updates() -> bool {
    std::env::var_os("SHADOWFIT_UPDATE_GOLDENS").is_some_and(|value| value != "0")
}

fn folder() -> PathBuf {
    workspace().join("tests/golden")
}

/// Draws the stage and compares it with its golden, or writes the golden.
fn check(stage: &mut Stage, name: &str) {
    assert!(NAMES.contains(&name), "{name} is missing in the list of goldens");
    check_sized(stage, name, SIZE);
}

fn check_sized(stage: &mut Stage, name: &str, size: [u32; 2]) {
    let target = stage.target(size);
    stage.draw(&target);
    assert_eq!(stage.problem(), None, "{name}");
    let rgb: Vec<u8> = target
        .read(stage.gpu())
        .expect("pixels")
        .chunks_exact(4)
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    let actual = RgbImage::from_raw(size[0], size[1], rgb).expect("as many bytes as pixels");
    let golden = folder().join(name).with_extension("png");
    if updates() {
        save(&actual, &golden);
        return;
    }
    if let Err(reason) = compare(&actual, &golden) {
        let beside = golden.with_extension("actual.png");
        save(&actual, &beside);
        panic!("{name}: {reason}; the picture drawn now is {}", beside.display());
    }
}

fn compare(actual: &RgbImage, golden: &Path) -> Result<(), String> {
    let rewrite = "`cargo xtask golden` writes the goldens; look at the pictures before committing them";
    if !golden.is_file() {
        return Err(format!("the golden {} is missing. {rewrite}", golden.display()));
    }
    let expected = image::open(golden).map_err(|error| format!("{}: {error}", golden.display()))?.to_rgb8();
    if expected.dimensions() != actual.dimensions() {
        let (is, must) = (expected.dimensions(), actual.dimensions());
        return Err(format!("the golden {} is {is:?} pixels, not {must:?}. {rewrite}", golden.display()));
    }
    let difference = Difference::between(&expected, actual);
    difference.verdict().map_err(|reason| {
        let beside = golden.with_extension("diff.png");
        save(&difference.picture(), &beside);
        format!("{reason}; the difference, times {AMPLIFIED}, is {}. {rewrite}", beside.display())
    })
}

fn save(picture: &RgbImage, path: &Path) {
    picture.save(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}

/// Absolute difference of two pictures of the same size, per channel.
struct Difference(RgbImage);

impl Difference {
    fn between(a: &RgbImage, b: &RgbImage) -> Self {
        let mut difference = a.clone();
        for (pixel, other) in difference.pixels_mut().zip(b.pixels()) {
            for (channel, other) in pixel.0.iter_mut().zip(other.0) {
                *channel = channel.abs_diff(other);
            }
        }
        Self(difference)
    }

    fn verdict(&self) -> Result<(), String> {
        let channels = self.0.as_raw();
        let mean = channels.iter().map(|channel| f64::from(*channel)).sum::<f64>() / channels.len() as f64;
        let different = self.0.pixels().filter(|pixel| pixel.0.iter().any(|channel| *channel >= DIFFERENT)).count();
        let share = different as f64 / f64::from(self.0.width() * self.0.height());
        if mean <= MEAN && share <= DIFFERENT_SHARE {
            return Ok(());
        }
        Err(format!(
            "mean difference {mean:.3} of 255 (allowed {MEAN}), {:.2}% of pixels differ by {DIFFERENT} or more \
             (allowed {:.2}%)",
            share * 100.0,
            DIFFERENT_SHARE * 100.0
        ))
    }

    fn picture(&self) -> RgbImage {
        let mut picture = self.0.clone();
        picture.iter_mut().for_each(|channel| *channel = channel.saturating_mul(AMPLIFIED));
        picture
    }
}
