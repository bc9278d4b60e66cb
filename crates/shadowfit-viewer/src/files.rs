//! Writing pictures so that nothing half-written is left behind.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use anyhow::{Context, Result};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

/// Writes sRGB pixels (four bytes each, rows from the top) as an opaque PNG: to a file beside the
/// target first, which then takes its name.
pub(crate) fn write_png(path: &Path, size: [u32; 2], rgba: &[u8]) -> Result<()> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let image = image::RgbImage::from_raw(size[0], size[1], rgb).context("a picture with a wrong number of bytes")?;
    let unfinished = path.with_extension("png.part");
    let written = encode(&image, &unfinished).and_then(|()| Ok(std::fs::rename(&unfinished, path)?));
    if written.is_err() {
        // The first error is the one worth telling.
        let _ = std::fs::remove_file(&unfinished);
    }
    written.with_context(|| format!("cannot write {}", path.display()))
}

/// Encodes as small as the format allows: pictures are written rarely and kept long.
fn encode(image: &image::RgbImage, path: &Path) -> Result<()> {
    let file = BufWriter::new(File::create(path)?);
    let encoder = PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive);
    image.write_with_encoder(encoder)?;
    Ok(())
}
