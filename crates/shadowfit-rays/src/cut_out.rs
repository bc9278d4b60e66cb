//! Triangles with holes, as plain data.
//!
//! A triangle is opaque where base alpha × vertex alpha × image alpha reaches a cutoff; elsewhere it is a hole. The
//! image is sampled at its finest level, by bilinear interpolation or at the nearest texel.

use glam::Vec2;

use crate::error::RayError;
use crate::records::CutOutRecord;

/// How an image continues beyond its edges along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Wrap {
    /// It is repeated.
    #[default]
    Repeat = 0,
    /// The texels at its edge continue.
    Clamp = 1,
    /// It is repeated, and every second copy is mirrored.
    Mirror = 2,
}

/// An image of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageId {
    /// Where it begins among the words of all images.
    pub(crate) first: u32,
    pub(crate) generation: u32,
}

/// The alpha of an image, in bytes that the caller keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlphaImage<'a> {
    width: u32,
    height: u32,
    alpha: &'a [u8],
}

/// Longest side of an image, in texels: `f32` counts them one by one up to here.
const MAX_SIDE: u32 = 1 << 24;

impl<'a> AlphaImage<'a> {
    /// An image from its alpha in rows from the top, 255 opaque.
    ///
    /// # Errors
    ///
    /// [`RayError::Image`] when `alpha` is empty or does not have `width * height` elements, or when a side is longer
    /// than 2^24 texels.
    pub fn new(width: u32, height: u32, alpha: &'a [u8]) -> Result<Self, RayError> {
        let texels = u64::from(width) * u64::from(height);
        let fits = texels > 0 && texels == alpha.len() as u64 && width.max(height) <= MAX_SIDE;
        let bytes = alpha.len();
        fits.then_some(Self { width, height, alpha }).ok_or(RayError::Image { width, height, bytes })
    }

    /// Width and height, in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Alpha in rows from the top, 255 opaque.
    pub fn alpha(&self) -> &'a [u8] {
        self.alpha
    }

    /// Width, height, and the alpha, four texels a word with the first one lowest.
    #[cfg(feature = "gpu")]
    pub(crate) fn words(&self) -> Vec<u32> {
        let word = |texels: &[u8]| {
            let mut bytes = [0; 4];
            bytes[..texels.len()].copy_from_slice(texels);
            u32::from_le_bytes(bytes)
        };
        [self.width, self.height].into_iter().chain(self.alpha.chunks(4).map(word)).collect()
    }
}

/// How the alpha of triangles with holes is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutMaterial<Image = ImageId> {
    /// Its image, for a scene on the GPU from `RayScene::add_image`; `None` is opaque.
    pub image: Option<Image>,
    /// How the image continues across and down.
    pub wrap: [Wrap; 2],
    /// Whether the nearest texel is taken instead of interpolating between four.
    pub nearest: bool,
    /// Alpha that the image's is multiplied by, 0..=1.
    pub base_alpha: f32,
    /// Least alpha that is opaque.
    pub cutoff: f32,
}

impl<Image> Default for CutMaterial<Image> {
    /// No image, opaque; the cutoff 0.5 is glTF's default.
    fn default() -> Self {
        Self { image: None, wrap: Default::default(), nearest: false, base_alpha: 1.0, cutoff: 0.5 }
    }
}

/// A triangle with holes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOut<Image = ImageId> {
    /// Texture coordinates of the corners, 0..=1 over the image from its top left, with any texture transform already
    /// applied.
    pub uvs: [Vec2; 3],
    /// Alpha of the corners, 0..=1.
    pub alphas: [f32; 3],
    /// The rest, which triangles of a material share.
    pub material: CutMaterial<Image>,
}

impl<Image> CutOut<Image> {
    /// Returns the same cut-out with its image named another way. Without an image it has no holes of an image.
    pub fn map_image<Other>(self, name: impl FnOnce(Image) -> Option<Other>) -> CutOut<Other> {
        let Self { uvs, alphas, material } = self;
        let CutMaterial { image, wrap, nearest, base_alpha, cutoff } = material;
        let material = CutMaterial { image: image.and_then(name), wrap, nearest, base_alpha, cutoff };
        CutOut { uvs, alphas, material }
    }
}

impl CutOut {
    /// What the shaders read.
    pub(crate) fn record(&self) -> CutOutRecord {
        let [uv_a, uv_b, uv_c] = self.uvs.map(Into::into);
        let material = &self.material;
        CutOutRecord {
            uv_a,
            uv_b,
            uv_c,
            base_alpha: material.base_alpha,
            cutoff: material.cutoff,
            alphas: self.alphas,
            image: material.image.map_or(0, |image| image.first + 1),
            wrap: material.wrap.map(|wrap| wrap as u32),
            nearest: material.nearest.into(),
            padding: 0,
        }
    }
}
