//! Makes an animated picture from still ones: `film FOLDER MILLISECONDS FILE.webp`. The name of each PNG file
//! in the folder is its start time in milliseconds, and the last one ends at the given time. It is a separate
//! program, so that the other tasks need not build the encoder library.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use image::RgbaImage;
use webp_animation::{Encoder, EncoderOptions, EncodingConfig, EncodingType, LossyEncodingConfig};

/// Quality of lossy regions, of 100: low enough for two megabytes, high enough for small text and thin
/// stripes.
const QUALITY: f32 = 66.0;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (Some(folder), Some(end), Some(film)) = (arguments.next(), arguments.next(), arguments.next()) else {
        anyhow::bail!("film FOLDER MILLISECONDS FILE.webp");
    };
    let end: i32 = end.parse().with_context(|| format!("{end}: not a number of milliseconds"))?;
    let frames = frames(Path::new(&folder))?;
    let (_, first) = frames.first().with_context(|| format!("{folder}: no frames"))?;
    let size = open(first)?.dimensions();
    let mut encoder = Encoder::new_with_options(size, options())?;
    for (start, file) in &frames {
        let frame = open(file)?;
        ensure!(frame.dimensions() == size, "{}: another size than the first frame", file.display());
        encoder.add_frame(&frame, *start)?;
    }
    let data = encoder.finalize(end)?;
    fs::write(&film, &data[..]).with_context(|| format!("{film}: cannot be written"))
}

/// Returns the frames of a folder in order, each with its start time in milliseconds.
fn frames(folder: &Path) -> Result<Vec<(i32, PathBuf)>> {
    let mut frames = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("{}: cannot be read", folder.display()))? {
        let file = entry?.path();
        let start = file.file_stem().and_then(|stem| stem.to_str()).and_then(|stem| stem.parse().ok());
        frames.push((start.with_context(|| format!("{}: not named by its time", file.display()))?, file));
    }
    frames.sort_unstable();
    Ok(frames)
}

/// Returns the encoding options: lossy, except where lossless is smaller, such as plain text.
fn options() -> EncoderOptions {
    let lossy = LossyEncodingConfig { use_sharp_yuv: true, ..LossyEncodingConfig::default() };
    let encoding_type = EncodingType::Lossy(lossy);
    let encoding = EncodingConfig { encoding_type, quality: QUALITY, method: 6 };
    EncoderOptions { allow_mixed: true, minimize_size: true, encoding_config: Some(encoding), ..Default::default() }
}

fn open(file: &Path) -> Result<RgbaImage> {
    Ok(image::open(file).with_context(|| format!("{}: cannot be read", file.display()))?.into_rgba8())
}
