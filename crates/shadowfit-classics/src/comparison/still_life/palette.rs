//! The still life's materials.

use shadowfit_scene::parts::{WHITE, matt, numbered, tiled};
use shadowfit_scene::{Material, Wrap};

use super::textures::{FLOOR_METRES, PLASTER_METRES, Picture, SQUARES_METRES, STONE_METRES};

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Plaster = mirrored(tiled(matt("plaster", WHITE, 0.95), Picture::Plaster.into(), [PLASTER_METRES; 2])),
        Floor = mirrored(tiled(matt("floor", WHITE, 0.55), Picture::Floor.into(), [FLOOR_METRES; 2])),
        Skirting = matt("skirting", [0.52, 0.46, 0.36], 0.6),
        Stone = mirrored(tiled(matt("stone", WHITE, 0.9), Picture::Stone.into(), [STONE_METRES; 2])),
        Marble = matt("marble", [0.78, 0.75, 0.68], 0.45),
        Terracotta = matt("terracotta", [0.46, 0.17, 0.075], 0.7),
        Bronze = matt("brass", [0.60, 0.38, 0.11], 0.4),
        Ball = matt("ball", [0.055, 0.20, 0.25], 0.3),
        Squares = tiled(matt("squares", WHITE, 0.5), Picture::Squares.into(), [SQUARES_METRES; 2]),
        Frame = matt("frame", [0.115, 0.045, 0.02], 0.5),
        Ivory = matt("ivory", [0.80, 0.70, 0.50], 0.4),
        Ebony = matt("ebony", [0.085, 0.045, 0.028], 0.35),
    }
}

/// Returns `material` with an image that repeats mirrored, so that its opposite edges need not match.
fn mirrored(mut material: Material) -> Material {
    if let Some(texture) = &mut material.base_color_texture {
        texture.wrap = [Wrap::Mirror; 2];
    }
    material
}
