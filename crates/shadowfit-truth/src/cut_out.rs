//! Triangles with holes, as plain data that the CPU and the GPU evaluate alike.
//!
//! A triangle is opaque where base alpha × vertex alpha × image alpha reaches a cutoff. Elsewhere it is a
//! hole. The image is sampled at its finest mip level, bilinearly or at the nearest texel.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{Vec2, Vec3};
pub use shadowfit_rays::{CutMaterial, Wrap};

/// Limit of texel coordinates, which are clamped to ± this value before they are wrapped. Whole numbers of
/// this size and their neighbours fit into i32, and f32 has no fractions there.
pub(crate) const MAX_TEXEL: f32 = 1_073_741_824.0;

/// The alpha of an image, at least one texel. Clones share it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AlphaImage {
    width: u32,
    height: u32,
    alpha: Arc<[u8]>,
}

impl AlphaImage {
    /// Creates an image from its alpha in rows from the top, 255 opaque. `None` if `alpha` is empty or does
    /// not have `width * height` elements, or if a side is longer than 2^24 texels.
    pub fn new(width: u32, height: u32, alpha: Vec<u8>) -> Option<Self> {
        shadowfit_rays::AlphaImage::new(width, height, &alpha).ok()?;
        Some(Self { width, height, alpha: alpha.into() })
    }

    /// Returns width and height, in texels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Returns the alpha in rows from the top, 255 opaque.
    pub fn alpha(&self) -> &[u8] {
        &self.alpha
    }

    fn at(&self, x: i32, y: i32) -> f32 {
        f32::from(self.alpha[y as usize * self.width as usize + x as usize]) / 255.0
    }
}

/// A triangle with holes. Its image is an index into [`CutOuts::images`]. If the image is missing or the
/// index is out of range, the image's alpha counts as 1.
pub type CutOut = shadowfit_rays::CutOut<u32>;

/// The triangles with holes of a scene, and their images.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutOuts {
    /// Index into `all` by triangle.
    indices: HashMap<u32, u32>,
    all: Vec<CutOut>,
    images: Vec<AlphaImage>,
}

impl CutOuts {
    /// Collects cut-outs, each with the tracer's index of its triangle. If a triangle occurs several times,
    /// the last cut-out counts.
    pub fn new(images: Vec<AlphaImage>, cut_outs: impl IntoIterator<Item = (u32, CutOut)>) -> Self {
        let mut made = Self { images, ..Self::default() };
        for (triangle, cut_out) in cut_outs {
            made.indices.insert(triangle, made.all.len() as u32);
            made.all.push(cut_out);
        }
        made
    }

    /// Returns whether no triangle has holes.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Returns all cut-outs, in the order of construction.
    pub fn cut_outs(&self) -> &[CutOut] {
        &self.all
    }

    /// Returns the images.
    pub fn images(&self) -> &[AlphaImage] {
        &self.images
    }

    /// Returns the index into [`Self::cut_outs`] of a triangle's cut-out.
    pub fn index_of(&self, triangle: u32) -> Option<u32> {
        self.indices.get(&triangle).copied()
    }

    /// Returns whether a triangle is opaque at a point, given by the weights of its second and third corner.
    /// Triangles without a cut-out are opaque everywhere.
    pub fn is_opaque(&self, triangle: u32, [second, third]: [f32; 2]) -> bool {
        let Some(index) = self.index_of(triangle) else { return true };
        let cut_out = &self.all[index as usize];
        let weights = Vec3::new(1.0 - second - third, second, third);
        let [a, b, c] = cut_out.uvs;
        let uv = a * weights.x + b * weights.y + c * weights.z;
        let vertex_alpha = Vec3::from(cut_out.alphas).dot(weights);
        let material = &cut_out.material;
        let image = material.image.and_then(|image| self.images.get(image as usize));
        let image_alpha = image.map_or(1.0, |image| sample(image, material, uv));
        material.base_alpha * vertex_alpha * image_alpha >= material.cutoff
    }
}

/// Returns the alpha of an image at texture coordinates, 0..=1.
fn sample(image: &AlphaImage, material: &CutMaterial<u32>, uv: Vec2) -> f32 {
    let size = image.size().map(u32::cast_signed);
    let limit = Vec2::splat(MAX_TEXEL);
    let position = (uv * Vec2::new(size[0] as f32, size[1] as f32) - 0.5).clamp(-limit, limit);
    let (corner, weight) = (position.floor(), position - position.floor());
    let alpha = |right: i32, down: i32| {
        let x = wrapped(corner.x as i32 + right, size[0], material.wrap[0]);
        image.at(x, wrapped(corner.y as i32 + down, size[1], material.wrap[1]))
    };
    if material.nearest {
        return alpha((weight.x >= 0.5).into(), (weight.y >= 0.5).into());
    }
    let row = |down| alpha(0, down) * (1.0 - weight.x) + alpha(1, down) * weight.x;
    row(0) * (1.0 - weight.y) + row(1) * weight.y
}

/// Returns the texel in a row of `size` for an index, which may lie outside of the row.
fn wrapped(index: i32, size: i32, wrap: Wrap) -> i32 {
    match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Clamp => index.clamp(0, size - 1),
        Wrap::Mirror => {
            let folded = index.rem_euclid(size * 2);
            folded.min(size * 2 - 1 - folded)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a triangle over the first half of a row of two texels, the first transparent and the second opaque.
    fn row(wrap: Wrap, nearest: bool) -> (AlphaImage, CutOut) {
        let image = AlphaImage::new(2, 1, vec![0, 255]).expect("two texels");
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
        let material = CutMaterial { image: Some(0), wrap: [wrap; 2], nearest, ..CutMaterial::default() };
        (image, CutOut { uvs, alphas: [1.0; 3], material })
    }

    #[test]
    fn wrapping_repeats_mirrors_and_clamps() {
        let row = |wrap| (-3..6).map(|index| wrapped(index, 3, wrap)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
        assert_eq!(row(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
    }

    #[test]
    fn alpha_is_interpolated_between_texel_centres_or_taken_from_the_nearest() {
        let at = |wrap, nearest, u| {
            let (image, cut_out) = row(wrap, nearest);
            sample(&image, &cut_out.material, Vec2::new(u, 0.5))
        };
        for (u, expected) in [(0.25, 0.0), (0.5, 0.5), (0.75, 1.0), (9.0, 1.0), (-9.0, 0.0)] {
            assert!((at(Wrap::Clamp, false, u) - expected).abs() < 1e-6, "{u}");
        }
        for (u, expected) in [(0.1, 0.0), (0.49, 0.0), (0.51, 1.0), (0.99, 1.0), (1.01, 0.0), (7.6, 1.0)] {
            assert_eq!(at(Wrap::Repeat, true, u), expected, "{u}");
        }
        for u in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
            let alpha = at(Wrap::Mirror, false, u);
            assert!(alpha.is_nan() || alpha <= 1.0, "{u}");
        }
    }

    #[test]
    fn base_vertex_and_image_alpha_are_multiplied_and_reach_the_cutoff() {
        let (image, cut_out) = row(Wrap::Clamp, false);
        let is_opaque = |change: fn(&mut CutOut), weights| {
            let mut cut_out = cut_out;
            change(&mut cut_out);
            CutOuts::new(vec![image.clone()], [(3, cut_out)]).is_opaque(3, weights)
        };
        assert!(!is_opaque(|_| (), [0.2, 0.5]) && is_opaque(|_| (), [0.51, 0.4]));
        assert!(!is_opaque(|cut_out| cut_out.material.base_alpha = 0.4, [0.8, 0.0]));
        // Only the second corner is opaque.
        assert!(!is_opaque(|cut_out| cut_out.alphas = [0.0, 1.0, 0.0], [0.49, 0.5]));
        assert!(is_opaque(|cut_out| cut_out.alphas = [0.0, 1.0, 0.0], [0.8, 0.0]));
        // Without its image the triangle has no holes. Other triangles never have any.
        assert!(is_opaque(|cut_out| cut_out.material.image = Some(9), [0.1, 0.1]));
        assert!(CutOuts::new(vec![image.clone()], [(3, cut_out)]).is_opaque(2, [0.1, 0.1]));
    }

    #[test]
    fn images_without_texels_or_with_too_few_are_refused() {
        assert!(AlphaImage::new(0, 4, Vec::new()).is_none() && AlphaImage::new(2, 2, vec![0; 3]).is_none());
        assert!(AlphaImage::new(1, 2, vec![0; 2]).is_some());
    }
}
