//! `cargo xtask gallery`: renders the pictures of the README and the docs with the software driver, so that
//! they change with the code and not with the machine.

mod film;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use anyhow::{Context, Result, ensure};
use image::RgbImage;
use image::codecs::png::{self, CompressionType, PngEncoder};
use image::imageops::{self, FilterType};

use crate::machine::Machine;
use crate::process;
use crate::raylib;
use crate::run;
use crate::setup::{self, Purpose};

/// Folder of the docs' pictures, relative to the workspace's folder.
const IMAGES: &str = "docs/images";

/// Size of a picture of the docs, in pixels: half of full HD each way, large enough to show single shadow
/// texels.
const SIZE: &str = "960x540";

/// Script for the pictures of the viewer's tour, relative to the workspace's folder.
const TOUR: &str = "examples/viewer/tour.txt";

/// Size of the viewer's window at the beginning of the tour, in pixels.
const WINDOW: &str = "1280x720";

/// Pictures of the viewer's own set that the docs show.
const SHOWN: [&str; 13] = [
    "final",
    "maps",
    "outside",
    "inset-all",
    "split",
    "acne",
    "acne-marked",
    "acne-fixed",
    "aliasing",
    "aliasing-fixed",
    "hole",
    "hole-marked",
    "hole-fixed",
];

/// Size limit of a picture of the docs, in bytes, since every clone of the repository contains it.
const MOST_BYTES: u64 = 500_000;

/// Greatest number of bits that a colour channel may lose for that: steps of 8 of 255 levels are still hard
/// to see.
const MOST_BITS: u32 = 3;

/// Pages of the classic samples, each named after its sample, relative to the workspace's folder.
const SAMPLE_PAGES: &str = "docs/samples";

/// Folder of the samples' pictures below the folder of the docs' pictures.
const SAMPLE_IMAGES: &str = "samples";

/// Size limit of a sample's picture, in bytes, unless dropping two bits of its colours is not enough. There
/// are many of them.
const MOST_SAMPLE_BYTES: u64 = 200_000;

/// View for the pictures of errors, relative to the workspace's folder.
const ERROR_VIEW: &str = "docs/gallery/error-view.toml";

/// Techniques in the pictures of errors.
const WRONG: [&str; 2] = ["xna-1", "windows-4"];

/// Walk for comparing shadows, relative to the workspace's folder.
const WALK: &str = "docs/gallery/walk.toml";

/// Techniques whose shadows are compared, and the names of their pictures.
const COMPARED: [(&str, &str); 3] =
    [("docs/gallery/bevy.toml", "bevy"), ("stable-4", "stable-4"), ("windows-4", "windows-4")];

/// Filtered and traced edges of coarse maps: the techniques and the names of their pictures. Then the options
/// for coarse maps.
const TRACED: [(&str, &str); 2] = [("windows-4", "filtered"), ("exact-4", "traced")];
const COARSE: [&str; 2] = ["--resolution", "512"];

/// Techniques whose edges are compared from frame to frame: a tight fit that is not held, and windows.
const EDGES: [&str; 2] = ["histogram-4", "windows-4"];

/// Frames of the walk for comparing edges: the last ones, after windows have settled.
const EDGE_FRAMES: [&str; 5] = ["path-16", "path-18", "path-20", "path-22", "path-24"];

/// Options for comparing edges: coarse maps without a filter, so that each texel shows.
const EDGE_MAPS: [&str; 4] = ["--resolution", "512", "--filter", "point"];

/// A part of a picture: left side, upper side, width and height, in pixels.
type Part = [u32; 4];

/// The lattice's shadow, and its magnification to the size of the docs' pictures.
const SHADOW: (Part, u32) = ([446, 206, 192, 108], 5);

/// The corner of that shadow, and the magnification at which five of it have the width of the docs' pictures.
const CORNER: (Part, u32) = ([458, 246, 47, 47], 4);

/// The argument that renders only the film.
const FILM: &str = "film";

/// The argument that renders only the picture of the example with raylib, and the name of this picture.
const RAYLIB: &str = "raylib";

/// The argument that renders only the pictures of the viewer's tour.
const TOUR_ONLY: &str = "tour";

/// Gap between pictures of a strip, in pixels.
const GAP: u32 = 5;

/// Renders the docs' pictures. `only` limits them to some samples, the tour, the film or the example with raylib.
///
/// # Errors
/// If the viewer or the report cannot be built, or ends with an error.
pub(crate) fn gallery(only: &[String]) -> Result<()> {
    let machine = setup::prepare(Purpose::Pictures)?;
    let images = process::root().join(IMAGES);
    let is_wanted = |name: &str| only.iter().any(|wanted| wanted == name);
    if !only.is_empty() {
        sample_pages(&machine, &images.join(SAMPLE_IMAGES), is_wanted)?;
        if is_wanted(TOUR_ONLY) {
            tour(&machine, &images)?;
        }
        if is_wanted(FILM) {
            film::film(&machine, &images)?;
        }
        if is_wanted(RAYLIB) {
            in_raylib(&images)?;
        }
        run::say_where(&images);
        return Ok(());
    }
    tour(&machine, &images)?;
    own_set(&machine, &images)?;
    sample_pages(&machine, &images.join(SAMPLE_IMAGES), |_| true)?;
    errors(&images)?;
    shadows(&images)?;
    edges(&images)?;
    film::film(&machine, &images)?;
    in_raylib(&images)?;
    run::say_where(&images);
    Ok(())
}

/// Renders all pictures of the viewer's tour that its script saves.
fn tour(machine: &Machine, images: &Path) -> Result<()> {
    let folder = empty_folder("tour")?;
    let mut viewer = run::viewer(machine);
    viewer.arg("--headless").arg(&folder).arg("--script").arg(process::root().join(TOUR));
    process::run(viewer.args(["--size", WINDOW, "--software"]))?;
    for entry in fs::read_dir(&folder).with_context(|| format!("{}: cannot be read", folder.display()))? {
        let file = entry?.path();
        if file.extension().is_some_and(|extension| extension == "png") {
            publish(&file, &images.join(file.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}

/// Renders the pictures of the viewer's own set that the docs show.
fn own_set(machine: &Machine, images: &Path) -> Result<()> {
    let folder = empty_folder("set")?;
    let mut viewer = run::viewer(machine);
    viewer.arg("--headless").arg(&folder).arg("courtyard");
    process::run(viewer.args(["--size", SIZE, "--software"]))?;
    for name in SHOWN {
        let file = format!("{name}.png");
        publish(&folder.join(&file), &images.join(&file))?;
    }
    Ok(())
}

/// Renders the classic samples, and publishes the pictures that their pages show.
fn sample_pages(machine: &Machine, images: &Path, is_wanted: impl Fn(&str) -> bool) -> Result<()> {
    let pages = process::root().join(SAMPLE_PAGES);
    fs::create_dir_all(images).with_context(|| format!("{}: cannot be made", images.display()))?;
    for entry in fs::read_dir(&pages).with_context(|| format!("{}: cannot be read", pages.display()))? {
        let page = entry?.path();
        let text = fs::read_to_string(&page).with_context(|| format!("{}: cannot be read", page.display()))?;
        let shown: BTreeSet<&str> = sample_pictures(&text).collect();
        let Some(sample) = page.file_stem().and_then(|stem| stem.to_str()).filter(|_| !shown.is_empty()) else {
            continue;
        };
        if !is_wanted(sample) {
            continue;
        }
        let folder = empty_folder(sample)?;
        let mut viewer = run::viewer(machine);
        viewer.args(["--sample", sample, "--headless"]).arg(&folder);
        process::run(viewer.arg("--software"))?;
        for file in shown {
            publish_within(&folder.join(file), &images.join(file), MOST_SAMPLE_BYTES, 2)?;
        }
    }
    Ok(())
}

/// Returns the files of samples' pictures that a page shows.
fn sample_pictures(page: &str) -> impl Iterator<Item = &str> {
    let links = page.split("images/samples/").skip(1).filter_map(|rest| rest.split_once(')'));
    links.map(|(file, _)| file)
}

/// Creates an empty folder below `target`, for pictures that are selected or changed before publishing.
fn empty_folder(name: &str) -> Result<PathBuf> {
    let folder = process::root().join("target/gallery").join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("{}: cannot be removed", folder.display()))?;
    }
    fs::create_dir_all(&folder).with_context(|| format!("{}: cannot be made", folder.display()))?;
    Ok(folder)
}

/// Copies a picture to the docs. While it is too large, drops the lowest bits of its colours, which compress
/// worst and are least visible.
fn publish(from: &Path, to: &Path) -> Result<()> {
    publish_within(from, to, MOST_BYTES, MOST_BITS)?;
    ensure!(bytes(to)? <= MOST_BYTES, "{}: more than {MOST_BYTES} bytes; make it smaller", to.display());
    Ok(())
}

/// Copies a picture, dropping at most `most_bits` bits even if it stays too large.
fn publish_within(from: &Path, to: &Path, most_bytes: u64, most_bits: u32) -> Result<()> {
    fs::copy(from, to).with_context(|| format!("{}: cannot be copied", from.display()))?;
    for bits in 1..=most_bits {
        if bytes(to)? <= most_bytes {
            return Ok(());
        }
        let mut picture = open(from)?;
        for value in picture.iter_mut() {
            *value &= u8::MAX << bits;
        }
        save_small(&picture, to)?;
    }
    Ok(())
}

fn bytes(file: &Path) -> Result<u64> {
    let data = fs::metadata(file).with_context(|| format!("{}: cannot be read", file.display()))?;
    Ok(data.len())
}

/// Saves a picture with the strongest compression.
fn save_small(picture: &RgbImage, file: &Path) -> Result<()> {
    let written = fs::File::create(file).with_context(|| format!("{}: cannot be made", file.display()))?;
    let encoder = PngEncoder::new_with_quality(written, CompressionType::Best, png::FilterType::Adaptive);
    picture.write_with_encoder(encoder).with_context(|| format!("{}: cannot be written", file.display()))
}

/// Renders the errors and the texels of techniques in one view, as the report marks them.
fn errors(images: &Path) -> Result<()> {
    let pictures = report("errors", ERROR_VIEW, &WRONG, &["path-0"], &[])?;
    for (place, technique) in WRONG.iter().enumerate() {
        for (kind, name) in [("overlay", "errors"), ("heat", "heat")] {
            let from = pictures.join(format!("{place}-{technique}-path-0-{kind}.png"));
            let to = images.join(format!("{name}-{technique}.png"));
            fs::copy(&from, &to).with_context(|| format!("{}: cannot be copied", from.display()))?;
        }
    }
    Ok(())
}

/// Renders the same shadow with several techniques, enlarged.
fn shadows(images: &Path) -> Result<()> {
    let techniques = COMPARED.map(|(technique, _)| technique);
    let pictures = report("shadows", WALK, &techniques, &["path-24"], &[])?;
    for (place, (_, name)) in COMPARED.iter().enumerate() {
        let whole = open(&pictures.join(format!("{place}-{name}-path-24-picture.png")))?;
        save(&enlarged(&whole, SHADOW), &images.join(format!("shadow-{name}.png")))?;
    }
    traced(images)
}

/// Renders the same shadow of coarse maps, filtered and traced, enlarged.
fn traced(images: &Path) -> Result<()> {
    let pictures = report("traced", WALK, &TRACED.map(|(technique, _)| technique), &["path-24"], &COARSE)?;
    for (place, (technique, name)) in TRACED.iter().enumerate() {
        let whole = open(&pictures.join(format!("{place}-{technique}-path-24-picture.png")))?;
        save(&enlarged(&whole, SHADOW), &images.join(format!("shadow-{name}.png")))?;
    }
    Ok(())
}

/// Renders the same edge in some frames of the walk, side by side, with several techniques.
fn edges(images: &Path) -> Result<()> {
    let pictures = report("edges", WALK, &EDGES, &EDGE_FRAMES, &EDGE_MAPS)?;
    for (place, technique) in EDGES.iter().enumerate() {
        let ([_, _, width, height], by) = CORNER;
        let (width, height) = (width * by, height * by);
        let count = EDGE_FRAMES.len() as u32;
        let white = image::Rgb([255; 3]);
        let mut strip = RgbImage::from_pixel(width * count + GAP * (count - 1), height, white);
        for (i, frame) in (0..).zip(EDGE_FRAMES) {
            let whole = open(&pictures.join(format!("{place}-{technique}-{frame}-picture.png")))?;
            imageops::replace(&mut strip, &enlarged(&whole, CORNER), i64::from((width + GAP) * i), 0);
        }
        save(&strip, &images.join(format!("edge-{technique}.png")))?;
    }
    Ok(())
}

/// Runs the report on the built-in scene. Returns the folder of its pictures. Frames have the names of their
/// files.
fn report(name: &str, path: &str, techniques: &[&str], frames: &[&str], more: &[&str]) -> Result<PathBuf> {
    let out = process::root().join("target/gallery-report").join(name);
    let mut report = process::cargo("run");
    report.args([
        "--release",
        "--quiet",
        "--package",
        "shadowfit-report",
        "--",
        "courtyard",
        "--software",
        "--no-crawl",
        "--size",
        SIZE,
    ]);
    report.arg("--path").arg(process::root().join(path)).arg("-o").arg(&out).args(more);
    for technique in techniques {
        report.args(["--technique", technique]);
    }
    for frame in frames {
        report.args(["--picture", &frame.replace('-', "/")]);
    }
    process::run(report.stdout(Stdio::null()))?;
    Ok(out.join("pictures"))
}

/// Renders the example in C with raylib.
fn in_raylib(images: &Path) -> Result<()> {
    let Some(file) = raylib::picture()? else { return Ok(()) };
    publish_within(&file, &images.join(RAYLIB).with_extension("png"), MOST_SAMPLE_BYTES, 2)
}

/// Returns a part of a picture, enlarged with square pixels.
fn enlarged(whole: &RgbImage, ([x, y, width, height], by): (Part, u32)) -> RgbImage {
    let part = imageops::crop_imm(whole, x, y, width, height).to_image();
    imageops::resize(&part, width * by, height * by, FilterType::Nearest)
}

fn open(file: &Path) -> Result<RgbImage> {
    Ok(image::open(file).with_context(|| format!("{}: cannot be read", file.display()))?.into_rgb8())
}

fn save(picture: &RgbImage, file: &Path) -> Result<()> {
    picture.save(file).with_context(|| format!("{}: cannot be written", file.display()))
}
