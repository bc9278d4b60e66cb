//! Images: external, embedded or in a data URI. An unusable image is not an error. The texture gets another
//! image, and a note gives the reason.

use std::borrow::Cow;
use std::collections::HashMap;

use gltf::json::{Root, image as json};

use super::accessor::Reader;
use super::uri::{Folder, MAX_FILE_BYTES, read_uri};
use crate::Image;

/// Greatest width and height, in pixels: every GPU of the last decade supports textures of this size.
pub(super) const MAX_SIDE: u32 = 8192;

/// Greatest size of all images together, in bytes.
const MAX_TOTAL_BYTES: u64 = 1 << 30;

/// Loads each image that a material uses, once.
pub(crate) struct Images<'a> {
    root: &'a Root,
    folder: Folder<'a>,
    decode: DecodeImage<'a>,
    /// For each image of the file that was loaded: its index in the scene, or the reason why it cannot be
    /// used.
    loaded: HashMap<usize, Result<usize, String>>,
    decoded: Vec<Image>,
    placeholder: Option<usize>,
    bytes_left: u64,
}

impl<'a> Images<'a> {
    /// Starts without images.
    pub(crate) fn new(root: &'a Root, folder: Folder<'a>, decode: DecodeImage<'a>) -> Self {
        let (loaded, decoded) = (HashMap::new(), Vec::new());
        Self { root, folder, decode, loaded, decoded, placeholder: None, bytes_left: MAX_TOTAL_BYTES }
    }

    /// Returns the index of an image in the scene, or the reason why it cannot be used.
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

    /// Returns the index of a white image of one pixel, which leaves only the base colour factor.
    pub(crate) fn placeholder(&mut self) -> usize {
        *self.placeholder.get_or_insert_with(|| {
            let name = "placeholder".to_owned();
            self.decoded.push(Image { name, width: 1, height: 1, rgba: vec![255; 4] });
            self.decoded.len() - 1
        })
    }

    /// Returns the images for the scene.
    pub(crate) fn finish(self) -> Vec<Image> {
        self.decoded
    }

    fn try_load(&self, index: usize, reader: &Reader) -> Result<Image, String> {
        let json = self.root.images.get(index).ok_or("there is no such image")?;
        let DecodedImage { width, height, rgba } = (self.decode)(&encoded(json, index, self.folder, reader)?)?;
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(format!("{width}×{height} pixels are more than {MAX_SIDE}×{MAX_SIDE}"));
        }
        let bytes = u64::from(width) * u64::from(height) * 4;
        if bytes > self.bytes_left {
            return Err(format!("the images together exceed {MAX_TOTAL_BYTES} bytes"));
        }
        if rgba.len() as u64 != bytes {
            return Err(format!("{width}×{height} pixels were decoded to {} bytes", rgba.len()));
        }
        Ok(Image { name: name(json, index), width, height, rgba })
    }
}

/// Returns the encoded bytes of an image.
pub(super) fn encoded<'a>(
    json: &json::Image,
    index: usize,
    folder: Folder<'_>,
    reader: &'a Reader,
) -> Result<Cow<'a, [u8]>, String> {
    match (&json.uri, json.buffer_view) {
        (Some(uri), _) => read_uri(folder, uri, MAX_FILE_BYTES).map(Cow::Owned),
        (None, Some(view)) => {
            let bytes = reader.view(view, &format!("images[{index}]"));
            bytes.map(Cow::Borrowed).map_err(|problem| problem.reason().to_owned())
        }
        (None, None) => Err("it has neither a URI nor a buffer view".to_owned()),
    }
}

fn name(json: &json::Image, index: usize) -> String {
    let file = json.uri.as_ref().filter(|uri| !uri.starts_with("data:"));
    json.name.clone().or_else(|| file.cloned()).unwrap_or_else(|| format!("images[{index}]"))
}

/// The pixels of an image.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DecodedImage {
    /// Width, in pixels.
    pub width: u32,
    /// Height, in pixels.
    pub height: u32,
    /// sRGB colour and opacity, not premultiplied, four bytes per pixel, rows from the top.
    pub rgba: Vec<u8>,
}

/// Decoder of an image from its encoded bytes. The error is a readable reason.
pub type DecodeImage<'a> = &'a dyn Fn(&[u8]) -> Result<DecodedImage, String>;
