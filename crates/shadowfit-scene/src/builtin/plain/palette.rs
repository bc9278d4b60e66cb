//! The plain's materials.

use super::textures::Picture;
use crate::Material;
use crate::builtin::finish::{cut_out, matt, tiled, wrapped};

/// A material, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Paint {
    /// Index 0, and so the default material too.
    Stone,
    Slab,
    Land,
    Masonry,
    White,
    Timber,
    Weathered,
    Canvas,
    Thatch,
    Roof,
    Dark,
    Straw,
    Foliage,
    Wool,
    Face,
    Bark,
    Leaves,
    Grass,
}

impl From<Paint> for usize {
    fn from(paint: Paint) -> Self {
        paint as Self
    }
}

/// All materials, indexed by [`Paint`].
pub(super) fn materials() -> Vec<Material> {
    let image = |picture: Picture| picture as usize;
    let white = [1.0; 3];
    vec![
        tiled(matt("field stone", [0.86, 0.83, 0.76], 0.95), image(Picture::Stone), [0.9; 2]),
        tiled(matt("slab", [0.62, 0.57, 0.49], 0.9), image(Picture::Stone), [0.7; 2]),
        tiled(matt("land", white, 1.0), image(Picture::Land), [super::textures::LAND_METRES; 2]),
        tiled(matt("masonry", [1.0, 0.90, 0.74], 0.95), image(Picture::Masonry), [2.4; 2]),
        tiled(matt("whitewash", [1.0, 0.98, 0.93], 0.95), image(Picture::Stone), [3.0; 2]),
        matt("timber", [0.20, 0.11, 0.055], 0.8),
        matt("weathered wood", [0.36, 0.30, 0.23], 0.9),
        matt("canvas", [0.80, 0.74, 0.60], 0.9),
        tiled(matt("thatch", [0.66, 0.50, 0.26], 1.0), image(Picture::Land), [1.2; 2]),
        matt("roof tile", [0.45, 0.15, 0.08], 0.85),
        matt("opening", [0.03, 0.027, 0.025], 0.9),
        tiled(matt("straw", [0.92, 0.70, 0.32], 1.0), image(Picture::Land), [1.6; 2]),
        matt("foliage", [0.13, 0.20, 0.06], 1.0),
        matt("wool", [0.80, 0.76, 0.68], 1.0),
        matt("sheep's face", [0.05, 0.042, 0.038], 0.8),
        wrapped(matt("bark", [0.75, 0.72, 0.68], 0.95), image(Picture::Bark), [0.5, 1.2]),
        cut_out(matt("leaves", [1.05, 1.0, 0.9], 0.8), image(Picture::Twig)),
        cut_out(matt("grass", white, 0.9), image(Picture::Grass)),
    ]
}
