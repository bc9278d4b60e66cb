//! The forest's materials.

use super::textures::Picture;
use crate::Material;
use crate::parts::{WHITE, cut_out, matt, numbered, tiled, wrapped};

/// Size of the floor's image in the scene, in metres.
const FLOOR_METRES: f32 = 3.0;
/// Size of the bark images in the scene, around a limb and along it, in metres.
const BARK_METRES: [f32; 2] = [0.55, 1.3];

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Stone = tiled(matt("mossy stone", WHITE, 0.95), Picture::Stone.into(), [1.1; 2]),
        Floor = tiled(matt("forest floor", WHITE, 0.95), Picture::Floor.into(), [FLOOR_METRES; 2]),
        Bark = wrapped(matt("bark", WHITE, 0.95), Picture::Bark.into(), BARK_METRES),
        Birch = wrapped(matt("birch bark", WHITE, 0.8), Picture::Birch.into(), BARK_METRES),
        Leaves = cut_out(matt("leaves", WHITE, 0.75), Picture::Twig.into()),
        BirchLeaves = cut_out(matt("birch leaves", [1.15, 1.0, 0.65], 0.9), Picture::Twig.into()),
        Fern = cut_out(matt("fern", WHITE, 0.7), Picture::Fern.into()),
        Grass = cut_out(matt("grass", WHITE, 0.8), Picture::Grass.into()),
        Cap = matt("mushroom cap", [0.55, 0.06, 0.03], 0.4),
        Stalk = matt("mushroom stalk", [0.75, 0.68, 0.55], 0.8),
    }
}
