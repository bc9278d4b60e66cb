//! The plain's materials.

use super::textures::Picture;
use crate::Material;
use crate::parts::{WHITE, cut_out, matt, numbered, tiled, wrapped};

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Stone = tiled(matt("field stone", [0.86, 0.83, 0.76], 0.95), Picture::Stone.into(), [0.9; 2]),
        Slab = tiled(matt("slab", [0.62, 0.57, 0.49], 0.9), Picture::Stone.into(), [0.7; 2]),
        Land = tiled(matt("land", WHITE, 1.0), Picture::Land.into(), [super::textures::LAND_METRES; 2]),
        Masonry = tiled(matt("masonry", [1.0, 0.90, 0.74], 0.95), Picture::Masonry.into(), [2.4; 2]),
        White = tiled(matt("whitewash", [1.0, 0.98, 0.93], 0.95), Picture::Stone.into(), [3.0; 2]),
        Timber = matt("timber", [0.20, 0.11, 0.055], 0.8),
        Weathered = matt("weathered wood", [0.36, 0.30, 0.23], 0.9),
        Canvas = matt("canvas", [0.80, 0.74, 0.60], 0.9),
        Thatch = tiled(matt("thatch", [0.66, 0.50, 0.26], 1.0), Picture::Land.into(), [1.2; 2]),
        Roof = matt("roof tile", [0.45, 0.15, 0.08], 0.85),
        Dark = matt("opening", [0.03, 0.027, 0.025], 0.9),
        Straw = tiled(matt("straw", [0.92, 0.70, 0.32], 1.0), Picture::Land.into(), [1.6; 2]),
        Foliage = matt("foliage", [0.13, 0.20, 0.06], 1.0),
        Wool = matt("wool", [0.80, 0.76, 0.68], 1.0),
        Face = matt("sheep's face", [0.05, 0.042, 0.038], 0.8),
        Bark = wrapped(matt("bark", [0.75, 0.72, 0.68], 0.95), Picture::Bark.into(), [0.5, 1.2]),
        Leaves = cut_out(matt("leaves", [1.05, 1.0, 0.9], 0.8), Picture::Twig.into()),
        Grass = cut_out(matt("grass", WHITE, 0.9), Picture::Grass.into()),
    }
}
