//! Decodes PNG, JPEG and WebP. Web pages use the browser's decoders instead.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::image::{DecodedImage, MAX_SIDE};

/// Greatest size of one decoded image, in bytes: `MAX_SIDE` squared with four 16-bit channels.
const MAX_DECODED_BYTES: u64 = 1 << 29;

/// Decodes a PNG, JPEG or WebP image. Its first bytes determine the format. Dimensions are checked before
/// pixels are allocated.
///
/// # Errors
///
/// A readable reason if the image has another format, is broken, or is larger than 8192 pixels a side.
pub fn decode_image(bytes: &[u8]) -> Result<DecodedImage, String> {
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) => format,
        Ok(other) => return Err(format!("{other:?} is not supported, only PNG, JPEG and WebP are")),
        Err(_) => return Err("it is not PNG, JPEG or WebP".to_owned()),
    };
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_DECODED_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|error| error.to_string())?;
    let (width, height) = decoder.dimensions();
    if width > MAX_SIDE || height > MAX_SIDE || decoder.total_bytes() > MAX_DECODED_BYTES {
        return Err(format!("{width}×{height} pixels are more than {MAX_SIDE}×{MAX_SIDE}"));
    }
    let image = DynamicImage::from_decoder(decoder).map_err(|error| error.to_string())?;
    Ok(DecodedImage { width, height, rgba: image.into_rgba8().into_raw() })
}
