//! The courtyard's materials.

use super::textures::{BLOCKS_METRES, LATTICE_METRES, PAVING_METRES, Picture};
use crate::Material;
use crate::parts::{WHITE, Wear, matt, numbered, perforated, tiled};

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Stone = matt("stone", [0.56, 0.49, 0.40], 0.9),
        Paving = tiled(matt("paving", WHITE, 0.85), Picture::Paving.into(), [PAVING_METRES; 2]),
        Marble = matt("marble", [0.74, 0.70, 0.62], 0.55),
        Plaster = tiled(matt("plaster", WHITE, 0.95), Picture::Blocks.into(), [BLOCKS_METRES; 2]),
        Roof = matt("roof tile", [0.50, 0.17, 0.085], 0.8),
        Timber = matt("timber", [0.24, 0.125, 0.06], 0.75),
        Iron = Material { metallic: 0.6, ..matt("iron", [0.045, 0.05, 0.055], 0.5) },
        Lattice = lattice(),
        Cypress = matt("cypress", [0.045, 0.105, 0.04], 0.95),
        Bark = matt("bark", [0.14, 0.085, 0.05], 0.95),
        Bronze = Wear::all().swap_remove(0),
        Clay = matt("clay", [0.55, 0.24, 0.12], 0.7),
    }
}

/// Returns the material of the lattice: slats with holes between them.
fn lattice() -> Material {
    let slats = matt("lattice", [0.30, 0.16, 0.075], 0.75);
    perforated(tiled(slats, Picture::Lattice.into(), [LATTICE_METRES; 2]))
}

/// Returns all materials: first [`Paint`], then the figure's materials except its bronze, which [`Paint`]
/// already contains.
pub(super) fn materials() -> Vec<Material> {
    let figure = Wear::all().into_iter().skip(1);
    Paint::all().into_iter().chain(figure).collect()
}

/// Returns the index of a material of the figure. The figure's first material is bronze, which is in
/// [`Paint`].
pub(super) fn worn(wear: usize) -> usize {
    if wear == 0 { Paint::Bronze.into() } else { usize::from(Paint::Clay) + wear }
}
