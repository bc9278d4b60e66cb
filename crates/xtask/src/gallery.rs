//! `cargo xtask gallery`: renders the pictures that the README and the docs show, on the software driver, so that they
//! change with the code and not with the machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use anyhow::{Context, Result};
use image::RgbImage;
use image::imageops::{self, FilterType};

use crate::process;
use crate::run;
use crate::setup::{self, Purpose};

/// Where the docs keep their pictures, relative to the workspace's folder.
const IMAGES: &str = "docs/images";

/// Size of a picture of the docs in pixels: half of full HD each way, wide enough to see single shadow texels.
const SIZE: &str = "960x540";

/// The view that errors are shown in, relative to the workspace's folder.
const ERROR_VIEW: &str = "docs/report.toml";

/// Techniques whose errors are shown.
const WRONG: [&str; 2] = ["xna-1", "windows-4"];

/// The walk that shadows are compared on, relative to the workspace's folder.
const WALK: &str = "docs/walk.toml";

/// Techniques whose shadows are compared, and how their pictures are named.
const COMPARED: [(&str, &str); 3] = [("docs/bevy.toml", "bevy"), ("stable-4", "stable-4"), ("windows-4", "windows-4")];

/// Techniques whose edges are compared from frame to frame: a tight fit that is not held, and windows.
const EDGES: [&str; 2] = ["histogram-4", "windows-4"];

/// Frames of the walk that edges are shown in: the last ones, when windows have settled.
const EDGE_FRAMES: [&str; 5] = ["path-16", "path-18", "path-20", "path-22", "path-24"];

/// Maps and filter of those edges: coarse and plain, so that each texel shows.
const EDGE_MAPS: [&str; 4] = ["--resolution", "512", "--filter", "point"];

/// A part of a picture: its left and upper side, width and height, in pixels.
type Part = [u32; 4];

/// The lattice's shadow, and how many times it is enlarged to be as large as the docs' pictures.
const SHADOW: (Part, u32) = ([446, 206, 192, 108], 5);

/// The corner of that shadow, and how many times it is enlarged for five of it to be as wide.
const CORNER: (Part, u32) = ([458, 246, 47, 47], 4);

/// Between pictures of a strip, in pixels.
const GAP: u32 = 5;

/// Renders the docs' pictures.
///
/// # Errors
/// When the viewer or the report cannot be built, or ends with an error.
pub(crate) fn gallery() -> Result<()> {
    let machine = setup::prepare(Purpose::Pictures)?;
    let images = process::root().join(IMAGES);
    process::run(run::viewer(&machine).arg("--headless").arg(&images).args(["--size", SIZE, "--software"]))?;
    errors(&images)?;
    shadows(&images)?;
    edges(&images)?;
    run::say_where(&images);
    Ok(())
}

/// The errors and the texels of techniques in one view, as the report marks them.
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

/// The same shadow by several techniques, enlarged.
fn shadows(images: &Path) -> Result<()> {
    let techniques = COMPARED.map(|(technique, _)| technique);
    let pictures = report("shadows", WALK, &techniques, &["path-24"], &[])?;
    for (place, (_, name)) in COMPARED.iter().enumerate() {
        let whole = open(&pictures.join(format!("{place}-{name}-path-24-picture.png")))?;
        save(&enlarged(&whole, SHADOW), &images.join(format!("shadow-{name}.png")))?;
    }
    Ok(())
}

/// The same edge in some frames of the walk, side by side, by several techniques.
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

/// Runs the report on the built-in scene and returns the folder of its pictures. Frames are named as their files are.
fn report(name: &str, path: &str, techniques: &[&str], frames: &[&str], more: &[&str]) -> Result<PathBuf> {
    let out = process::root().join("target/gallery-report").join(name);
    let mut report = process::cargo("run");
    report.args([
        "--release",
        "--quiet",
        "--example",
        "report",
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

/// A part of a picture, its pixels as squares.
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
