//! PNG encoding.

use std::io::Cursor;

use anyhow::Result;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, RgbaImage};

/// Encodes a picture as a small PNG, since reports are stored and sent.
pub(crate) fn png(picture: &RgbaImage) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive);
    DynamicImage::ImageRgba8(picture.clone()).to_rgb8().write_with_encoder(encoder)?;
    Ok(bytes.into_inner())
}
