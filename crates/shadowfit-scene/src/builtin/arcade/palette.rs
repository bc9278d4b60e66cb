//! The arcade's materials.

use super::textures::Picture;
use crate::Material;
use crate::parts::{WHITE, cut_out, matt, numbered, tiled};

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Stone = tiled(matt("stone", [0.98, 0.93, 0.84], 0.9), Picture::Stone.into(), [1.2; 2]),
        Tiles = tiled(matt("floor tiles", WHITE, 0.6), Picture::Tiles.into(), [super::textures::TILES_METRES; 2]),
        Plaster = tiled(matt("plaster", [1.0, 0.80, 0.50], 0.95), Picture::Plaster.into(), [2.6; 2]),
        Dado = tiled(matt("dado", [0.62, 0.23, 0.13], 0.85), Picture::Plaster.into(), [1.7; 2]),
        Vault = tiled(matt("vault", [1.0, 0.93, 0.80], 0.95), Picture::Plaster.into(), [3.1; 2]),
        Marble = matt("marble", [0.82, 0.79, 0.73], 0.45),
        Terracotta = matt("terracotta", [0.52, 0.21, 0.10], 0.75),
        Agave = matt("agave", [0.13, 0.28, 0.16], 0.6),
        Iron = Material { metallic: 0.5, ..matt("iron", [0.035, 0.036, 0.04], 0.5) },
        Glass = matt("lantern glass", [0.80, 0.60, 0.28], 0.3),
        Timber = matt("timber", [0.22, 0.115, 0.055], 0.7),
        Roof = tiled(matt("roof tiles", WHITE, 0.85), Picture::Roof.into(), [1.0; 2]),
        Gravel = tiled(matt("gravel", [0.98, 0.88, 0.70], 0.95), Picture::Stone.into(), [0.9; 2]),
        Lawn = tiled(matt("lawn", [0.17, 0.34, 0.055], 0.95), Picture::Plaster.into(), [0.35; 2]),
        Hedge = tiled(matt("hedge", [0.085, 0.20, 0.045], 0.95), Picture::Stone.into(), [0.4; 2]),
        Cypress = matt("cypress", [0.045, 0.105, 0.04], 0.95),
        Water = matt("water", [0.10, 0.20, 0.22], 0.1),
        Blossom = cut_out(matt("leaves", WHITE, 0.75), Picture::Twig.into()),
    }
}
