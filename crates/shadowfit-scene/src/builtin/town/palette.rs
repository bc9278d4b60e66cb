//! The town's materials: lime-washed walls in warm colours, pale stone, red tiles, grey slate.

use super::textures::{COBBLE_METRES, Picture};
use crate::Material;
use crate::parts::{WHITE, cut_out, matt, numbered, tiled, wrapped};

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Stone = tiled(matt("sandstone", [0.90, 0.80, 0.64], 0.9), Picture::Masonry.into(), [2.4; 2]),
        Cobble = tiled(matt("cobbles", [0.86, 0.83, 0.79], 0.9), Picture::Cobbles.into(), [COBBLE_METRES; 2]),
        Slab = tiled(matt("pavement", [0.86, 0.82, 0.75], 0.9), Picture::Slabs.into(), [2.0; 2]),
        Granite = matt("granite", [0.42, 0.40, 0.38], 0.85),
        Meadow = tiled(matt("meadow", WHITE, 1.0), Picture::Turf.into(), [3.0; 2]),
        Lawn = tiled(matt("lawn", [0.75, 0.95, 0.6], 1.0), Picture::Turf.into(), [1.6; 2]),
        Cream = tiled(matt("cream wash", [0.93, 0.80, 0.56], 0.95), Picture::Plaster.into(), [3.0; 2]),
        Ochre = tiled(matt("ochre wash", [0.84, 0.55, 0.22], 0.95), Picture::Plaster.into(), [2.7; 2]),
        Umber = tiled(matt("umber wash", [0.36, 0.25, 0.16], 0.95), Picture::Plaster.into(), [2.8; 2]),
        Rose = tiled(matt("rose wash", [0.80, 0.45, 0.35], 0.95), Picture::Plaster.into(), [3.2; 2]),
        Sage = tiled(matt("sage wash", [0.56, 0.62, 0.45], 0.95), Picture::Plaster.into(), [2.9; 2]),
        Sky = tiled(matt("blue wash", [0.52, 0.63, 0.72], 0.95), Picture::Plaster.into(), [3.1; 2]),
        Lime = tiled(matt("lime wash", [0.88, 0.84, 0.76], 0.95), Picture::Plaster.into(), [2.6; 2]),
        Brick = tiled(matt("brick", [0.66, 0.30, 0.20], 0.95), Picture::Masonry.into(), [0.9, 1.0]),
        Trim = tiled(matt("trim", [0.92, 0.86, 0.74], 0.9), Picture::Plaster.into(), [1.0; 2]),
        Timber = matt("timber", [0.15, 0.085, 0.05], 0.85),
        Oak = matt("oak", [0.38, 0.22, 0.11], 0.8),
        Frame = matt("window frame", [0.85, 0.83, 0.78], 0.6),
        Glass = matt("window glass", [0.055, 0.075, 0.095], 0.15),
        Dark = matt("opening", [0.03, 0.027, 0.025], 0.9),
        Green = matt("green paint", [0.10, 0.22, 0.14], 0.6),
        Blue = matt("blue paint", [0.11, 0.22, 0.36], 0.6),
        Oxblood = matt("red paint", [0.36, 0.07, 0.05], 0.6),
        Tile = tiled(matt("red tiles", [0.72, 0.27, 0.135], 0.85), Picture::Roof.into(), [1.0; 2]),
        OldTile = tiled(matt("old tiles", [0.50, 0.235, 0.15], 0.9), Picture::Roof.into(), [1.0; 2]),
        Slate = tiled(matt("slate", [0.20, 0.22, 0.25], 0.7), Picture::Roof.into(), [0.7; 2]),
        Iron = Material { metallic: 0.5, ..matt("iron", [0.035, 0.037, 0.04], 0.5) },
        Gold = Material { metallic: 0.7, ..matt("gilding", [0.80, 0.54, 0.16], 0.35) },
        Lamp = matt("lamp glass", [0.85, 0.76, 0.55], 0.3),
        Stripe = tiled(matt("striped cloth", WHITE, 0.95), Picture::Stripes.into(), [0.6; 2]),
        Canvas = matt("canvas", [0.62, 0.55, 0.42], 0.95),
        Water = matt("water", [0.10, 0.20, 0.22], 0.1),
        Fruit = matt("oranges", [0.84, 0.34, 0.05], 0.6),
        Apple = matt("apples", [0.55, 0.07, 0.05], 0.5),
        Hedge = tiled(matt("far leaves", [0.13, 0.22, 0.06], 1.0), Picture::Turf.into(), [1.3; 2]),
        Bark = wrapped(matt("bark", [0.75, 0.72, 0.68], 0.95), Picture::Bark.into(), [0.5, 1.2]),
        Leaves = cut_out(matt("leaves", WHITE, 0.8), Picture::Twig.into()),
    }
}

impl Paint {
    /// Returns whether the material belongs to round things, which are shaded smooth.
    pub(super) fn is_round(self) -> bool {
        matches!(self, Self::Fruit | Self::Apple | Self::Hedge)
    }

    /// Returns whether the image has rows that must run along the eaves.
    pub(super) fn is_roof(self) -> bool {
        matches!(self, Self::Tile | Self::OldTile | Self::Slate | Self::Stripe)
    }
}
