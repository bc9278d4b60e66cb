//! The arcade's materials.

use super::textures::Picture;
use crate::Material;
use crate::builtin::finish::{cut_out, matt, tiled};

/// A material, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Paint {
    /// Index 0, and so the default material too.
    Stone,
    Tiles,
    Plaster,
    Dado,
    Vault,
    Marble,
    Terracotta,
    Agave,
    Iron,
    Glass,
    Timber,
    Roof,
    Gravel,
    Lawn,
    Hedge,
    Cypress,
    Water,
    Blossom,
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
    let mut iron = matt("iron", [0.035, 0.036, 0.04], 0.5);
    iron.metallic = 0.5;
    vec![
        tiled(matt("stone", [0.98, 0.93, 0.84], 0.9), image(Picture::Stone), [1.2; 2]),
        tiled(matt("floor tiles", white, 0.6), image(Picture::Tiles), [super::textures::TILES_METRES; 2]),
        tiled(matt("plaster", [1.0, 0.80, 0.50], 0.95), image(Picture::Plaster), [2.6; 2]),
        tiled(matt("dado", [0.62, 0.23, 0.13], 0.85), image(Picture::Plaster), [1.7; 2]),
        tiled(matt("vault", [1.0, 0.93, 0.80], 0.95), image(Picture::Plaster), [3.1; 2]),
        matt("marble", [0.82, 0.79, 0.73], 0.45),
        matt("terracotta", [0.52, 0.21, 0.10], 0.75),
        matt("agave", [0.13, 0.28, 0.16], 0.6),
        iron,
        matt("lantern glass", [0.80, 0.60, 0.28], 0.3),
        matt("timber", [0.22, 0.115, 0.055], 0.7),
        tiled(matt("roof tiles", white, 0.85), image(Picture::Roof), [1.0; 2]),
        tiled(matt("gravel", [0.98, 0.88, 0.70], 0.95), image(Picture::Stone), [0.9; 2]),
        tiled(matt("lawn", [0.17, 0.34, 0.055], 0.95), image(Picture::Plaster), [0.35; 2]),
        tiled(matt("hedge", [0.085, 0.20, 0.045], 0.95), image(Picture::Stone), [0.4; 2]),
        matt("cypress", [0.045, 0.105, 0.04], 0.95),
        matt("water", [0.10, 0.20, 0.22], 0.1),
        cut_out(matt("leaves", white, 0.75), image(Picture::Twig)),
    ]
}
