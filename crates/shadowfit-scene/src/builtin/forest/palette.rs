//! The forest's materials.

use super::textures::Picture;
use crate::Material;
use crate::builtin::finish::{cut_out, matt, tiled, wrapped};

/// A material, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Paint {
    /// Index 0, and so the default material too.
    Stone,
    Floor,
    Bark,
    Birch,
    Leaves,
    BirchLeaves,
    Fern,
    Grass,
    Cap,
    Stalk,
}

impl From<Paint> for usize {
    fn from(paint: Paint) -> Self {
        paint as Self
    }
}

/// Metres that the image of the floor spans.
const FLOOR_METRES: f32 = 3.0;
/// Metres that the images of bark span around a limb and along it.
const BARK_METRES: [f32; 2] = [0.55, 1.3];

/// All materials, indexed by [`Paint`].
pub(super) fn materials() -> Vec<Material> {
    let image = |picture: Picture| picture as usize;
    let white = [1.0; 3];
    vec![
        tiled(matt("mossy stone", white, 0.95), image(Picture::Stone), [1.1; 2]),
        tiled(matt("forest floor", white, 0.95), image(Picture::Floor), [FLOOR_METRES; 2]),
        wrapped(matt("bark", white, 0.95), image(Picture::Bark), BARK_METRES),
        wrapped(matt("birch bark", white, 0.8), image(Picture::Birch), BARK_METRES),
        cut_out(matt("leaves", white, 0.75), image(Picture::Twig)),
        cut_out(matt("birch leaves", [1.15, 1.0, 0.65], 0.9), image(Picture::Twig)),
        cut_out(matt("fern", white, 0.7), image(Picture::Fern)),
        cut_out(matt("grass", white, 0.8), image(Picture::Grass)),
        matt("mushroom cap", [0.55, 0.06, 0.03], 0.4),
        matt("mushroom stalk", [0.75, 0.68, 0.55], 0.8),
    ]
}
