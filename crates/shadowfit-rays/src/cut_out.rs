//! Triangles with holes, as plain data.
//!
//! A triangle is opaque where the product of base alpha, vertex alpha and image alpha reaches a cutoff, and
//! has holes elsewhere. The image is sampled at its finest level, by bilinear interpolation or at the nearest
//! texel.

use glam::Vec2;

use crate::error::RayError;
use crate::records::CutOutRecord;

/// Continuation of an image beyond its edges along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat = 0,
    /// The texels at the edge continue.
    Clamp = 1,
    /// The image repeats, with every second copy mirrored.
    Mirror = 2,
}

/// An image of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageId {
    /// Index of its first word in the words of all images.
    pub(crate) first: u32,
    pub(crate) generation: u32,
}

/// The alpha of an image, borrowed from the caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlphaImage<'a> {
    width: u32,
    height: u32,
    alpha: &'a [u8],
}

/// Longest side of an image, in texels. `f32` holds all whole numbers up to this one.
const MAX_SIDE: u32 = 1 << 24;

impl<'a> AlphaImage<'a> {
    /// Returns an image from its alpha in rows from the top, with 255 for opaque.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::Image`] if `alpha` is empty or does not have `width * height` elements, or if a
    /// side is longer than 2^24 texels.
    pub fn new(width: u32, height: u32, alpha: &'a [u8]) -> Result<Self, RayError> {
        let texels = u64::from(width) * u64::from(height);
        let fits = texels > 0 && texels == alpha.len() as u64 && width.max(height) <= MAX_SIDE;
        let bytes = alpha.len();
        fits.then_some(Self { width, height, alpha }).ok_or(RayError::Image { width, height, bytes })
    }

    /// Returns width and height, in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Returns the alpha in rows from the top, with 255 for opaque.
    pub fn alpha(&self) -> &'a [u8] {
        self.alpha
    }

    /// Returns width, height, and the alpha with four texels per word, the first one in the lowest byte.
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

/// Parameters for the alpha of triangles with holes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutMaterial<Image = ImageId> {
    /// The image, for a scene on the GPU from `RayScene::add_image`. `None` is opaque.
    pub image: Option<Image>,
    /// Continuation of the image across and down.
    pub wrap: [Wrap; 2],
    /// Whether to sample the nearest texel instead of interpolating between four.
    pub nearest: bool,
    /// Factor of the alpha, 0..=1, for the whole material.
    pub base_alpha: f32,
    /// Least alpha that counts as opaque.
    pub cutoff: f32,
}

impl<Image> Default for CutMaterial<Image> {
    /// No image, opaque. The cutoff 0.5 is glTF's default.
    fn default() -> Self {
        Self { image: None, wrap: Default::default(), nearest: false, base_alpha: 1.0, cutoff: 0.5 }
    }
}

/// A triangle with holes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOut<Image = ImageId> {
    /// Texture coordinates of the corners, 0..=1 over the image from its top left, after any texture
    /// transform.
    pub uvs: [Vec2; 3],
    /// Alpha of the corners, 0..=1.
    pub alphas: [f32; 3],
    /// Parameters that triangles of a material share.
    pub material: CutMaterial<Image>,
}

impl<Image> CutOut<Image> {
    /// Returns the same cut-out with another identifier for its image. `None` removes the image.
    pub fn map_image<Other>(self, name: impl FnOnce(Image) -> Option<Other>) -> CutOut<Other> {
        let Self { uvs, alphas, material } = self;
        let CutMaterial { image, wrap, nearest, base_alpha, cutoff } = material;
        let material = CutMaterial { image: image.and_then(name), wrap, nearest, base_alpha, cutoff };
        CutOut { uvs, alphas, material }
    }
}

impl CutOut {
    /// Returns the record for the shaders.
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
