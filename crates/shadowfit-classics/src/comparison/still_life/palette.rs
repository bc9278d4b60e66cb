//! The still life's materials.

use shadowfit_scene::parts::{matt, tiled};
use shadowfit_scene::{Material, Wrap};

use super::textures::{FLOOR_METRES, PLASTER_METRES, Picture, SQUARES_METRES, STONE_METRES};

/// A material, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Paint {
    /// Index 0, and so the default material too.
    Plaster,
    Floor,
    Skirting,
    Stone,
    Marble,
    Terracotta,
    Bronze,
    Ball,
    Squares,
    Frame,
    Ivory,
    Ebony,
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
        mirrored(tiled(matt("plaster", white, 0.95), image(Picture::Plaster), [PLASTER_METRES; 2])),
        mirrored(tiled(matt("floor", white, 0.55), image(Picture::Floor), [FLOOR_METRES; 2])),
        matt("skirting", [0.52, 0.46, 0.36], 0.6),
        mirrored(tiled(matt("stone", white, 0.9), image(Picture::Stone), [STONE_METRES; 2])),
        matt("marble", [0.78, 0.75, 0.68], 0.45),
        matt("terracotta", [0.46, 0.17, 0.075], 0.7),
        matt("brass", [0.60, 0.38, 0.11], 0.4),
        matt("ball", [0.055, 0.20, 0.25], 0.3),
        tiled(matt("squares", white, 0.5), image(Picture::Squares), [SQUARES_METRES; 2]),
        matt("frame", [0.115, 0.045, 0.02], 0.5),
        matt("ivory", [0.80, 0.70, 0.50], 0.4),
        matt("ebony", [0.085, 0.045, 0.028], 0.35),
    ]
}

/// `material` with an image that repeats mirrored, so that it need not join at its edges.
fn mirrored(mut material: Material) -> Material {
    if let Some(texture) = &mut material.base_color_texture {
        texture.wrap = [Wrap::Mirror; 2];
    }
    material
}
