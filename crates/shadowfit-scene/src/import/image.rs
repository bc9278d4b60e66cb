//! Images: PNG, JPEG and WebP, external, embedded or in a data URI. An image that cannot be used is not
//! an error: the texture gets another image, and a note says why.

use std::collections::HashMap;
use std::io::Cursor;

use gltf::json::{Root, image as json};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::accessor::Reader;
use super::container::MAX_FILE_BYTES;
use super::uri::{Folder, read_uri};
use crate::Image;

/// Greatest width and height, in pixels: the texture size that every GPU of the last decade has.
const MAX_SIDE: u32 = 8192;

/// Greatest size of one decoded image, in bytes: `MAX_SIDE` squared with four 16-bit channels.
const MAX_DECODED_BYTES: u64 = 1 << 29;

/// Greatest size of all images together, in bytes.
const MAX_TOTAL_BYTES: u64 = 1 << 30;

/// Loads each image at most once, and only those that a material uses.
pub(crate) struct Images<'a> {
    root: &'a Root,
    folder: Folder<'a>,
    /// By index in the file: index in the scene, or why it cannot be used.
    loaded: HashMap<usize, Result<usize, String>>,
    decoded: Vec<Image>,
    placeholder: Option<usize>,
    bytes_left: u64,
}

impl<'a> Images<'a> {
    /// Loads nothing yet.
    pub(crate) fn new(root: &'a Root, folder: Folder<'a>) -> Self {
        let (loaded, decoded) = (HashMap::new(), Vec::new());
        Self { root, folder, loaded, decoded, placeholder: None, bytes_left: MAX_TOTAL_BYTES }
    }

    /// Index of an image in the scene, or why it cannot be used.
    pub(crate) fn load(&mut self, index: usize, reader: &Reader) -> Result<usize, String> {
        if let Some(loaded) = self.loaded.get(&index) {
            return loaded.clone();
        }
        let loaded = self.try_load(index, reader).map(|image| {
            self.bytes_left -= image.rgba.len() as u64;
            self.decoded.push(image);
            self.decoded.len() - 1
        });
        self.loaded.insert(index, loaded.clone());
        loaded
    }

    /// Index of a white image of one pixel: the base colour factor alone remains.
    pub(crate) fn placeholder(&mut self) -> usize {
        *self.placeholder.get_or_insert_with(|| {
            let name = "placeholder".to_owned();
            self.decoded.push(Image { name, width: 1, height: 1, rgba: vec![255; 4] });
            self.decoded.len() - 1
        })
    }

    /// The images for the scene.
    pub(crate) fn finish(self) -> Vec<Image> {
        self.decoded
    }

    fn try_load(&self, index: usize, reader: &Reader) -> Result<Image, String> {
        let json = self.root.images.get(index).ok_or("there is no such image")?;
        let element = format!("images[{index}]");
        let (width, height, rgba) = match (&json.uri, json.buffer_view) {
            (Some(uri), _) => {
                let bytes = read_uri(self.folder, uri, MAX_FILE_BYTES)?;
                decode(&bytes, self.bytes_left)?
            }
            (None, Some(view)) => {
                let bytes = reader.view(view, &element).map_err(|problem| problem.reason().to_owned())?;
                decode(bytes, self.bytes_left)?
            }
            (None, None) => return Err("it has neither a URI nor a buffer view".to_owned()),
        };
        Ok(Image { name: name(json, index), width, height, rgba })
    }
}

fn name(json: &json::Image, index: usize) -> String {
    let file = json.uri.as_ref().filter(|uri| !uri.starts_with("data:"));
    json.name.clone().or_else(|| file.cloned()).unwrap_or_else(|| format!("images[{index}]"))
}

/// Width, height and RGBA of an encoded image, whose format its first bytes tell; dimensions are checked before pixels
/// are allocated.
fn decode(bytes: &[u8], bytes_left: u64) -> Result<(u32, u32, Vec<u8>), String> {
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
    if u64::from(width) * u64::from(height) * 4 > bytes_left {
        return Err(format!("the images together exceed {MAX_TOTAL_BYTES} bytes"));
    }
    let image = DynamicImage::from_decoder(decoder).map_err(|error| error.to_string())?;
    Ok((width, height, image.into_rgba8().into_raw()))
}
