//! Materials of the figure, and the type of its parts.

use super::rig::Joint;
use crate::parts::finish::matt;
use crate::parts::numbered::numbered;
use crate::{Material, Primitive};

/// A mesh of the figure: the joints that carry it, its name, and its primitives with materials of [`Wear`].
pub(super) type Part = (&'static [Joint], &'static str, Vec<Primitive>);

numbered! {
    /// A material of the figure.
    Wear: Material {
        Bronze = Material { metallic: 1.0, ..matt("bronze", [0.72, 0.43, 0.20], 0.32) },
        Skin = matt("skin", [0.78, 0.46, 0.30], 0.5),
        Jacket = matt("jacket", [0.055, 0.20, 0.24], 0.75),
        Trousers = matt("trousers", [0.34, 0.27, 0.19], 0.85),
        Leather = matt("leather", [0.17, 0.07, 0.03], 0.5),
        Sole = matt("sole", [0.035, 0.028, 0.025], 0.8),
        Wool = matt("wool", [0.56, 0.065, 0.035], 0.95),
        Scarf = matt("scarf", [0.80, 0.42, 0.055], 0.9),
        Hair = matt("hair", [0.075, 0.035, 0.018], 0.7),
        EyeWhite = matt("eye white", [0.88, 0.86, 0.82], 0.25),
        Iris = matt("iris", [0.02, 0.015, 0.012], 0.15),
        Lip = matt("lip", [0.62, 0.26, 0.19], 0.5),
    }
}
