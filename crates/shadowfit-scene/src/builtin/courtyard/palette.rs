//! The courtyard's materials.

use glam::{Vec3, Vec4};

use super::textures;
use crate::{AlphaMode, Material, Texture, Wrap};

/// A material, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Paint {
    /// Index 0, and so the default material too.
    Stone,
    Paving,
    Marble,
    Plaster,
    Roof,
    Timber,
    Iron,
    Lattice,
    Cypress,
    Bark,
    Bronze,
    Clay,
    Skin,
    Jacket,
    Trousers,
    Leather,
    Sole,
    Wool,
    Scarf,
    Hair,
    EyeWhite,
    Iris,
    Lip,
}

impl Paint {
    /// Index into the scene's materials.
    pub(super) const fn index(self) -> usize {
        self as usize
    }
}

impl From<Paint> for usize {
    fn from(paint: Paint) -> Self {
        paint.index()
    }
}

/// Name, linear colour, roughness and metalness, in the order of [`Paint`].
const COLORS: [(&str, [f32; 3], f32, f32); 23] = [
    ("stone", [0.56, 0.49, 0.40], 0.9, 0.0),
    ("paving", [1.0, 1.0, 1.0], 0.85, 0.0),
    ("marble", [0.74, 0.70, 0.62], 0.55, 0.0),
    ("plaster", [1.0, 1.0, 1.0], 0.95, 0.0),
    ("roof tile", [0.50, 0.17, 0.085], 0.8, 0.0),
    ("timber", [0.24, 0.125, 0.06], 0.75, 0.0),
    ("iron", [0.045, 0.05, 0.055], 0.5, 0.6),
    ("lattice", [0.30, 0.16, 0.075], 0.75, 0.0),
    ("cypress", [0.045, 0.105, 0.04], 0.95, 0.0),
    ("bark", [0.14, 0.085, 0.05], 0.95, 0.0),
    ("bronze", [0.72, 0.43, 0.20], 0.32, 1.0),
    ("clay", [0.55, 0.24, 0.12], 0.7, 0.0),
    ("skin", [0.78, 0.46, 0.30], 0.5, 0.0),
    ("jacket", [0.055, 0.20, 0.24], 0.75, 0.0),
    ("trousers", [0.34, 0.27, 0.19], 0.85, 0.0),
    ("leather", [0.17, 0.07, 0.03], 0.5, 0.0),
    ("sole", [0.035, 0.028, 0.025], 0.8, 0.0),
    ("wool", [0.56, 0.065, 0.035], 0.95, 0.0),
    ("scarf", [0.80, 0.42, 0.055], 0.9, 0.0),
    ("hair", [0.075, 0.035, 0.018], 0.7, 0.0),
    ("eye white", [0.88, 0.86, 0.82], 0.25, 0.0),
    ("iris", [0.02, 0.015, 0.012], 0.15, 0.0),
    ("lip", [0.62, 0.26, 0.19], 0.5, 0.0),
];

/// All materials, indexed by [`Paint`].
pub(super) fn materials() -> Vec<Material> {
    let plain = |&(name, [r, g, b], roughness, metallic): &(&str, [f32; 3], f32, f32)| Material {
        name: name.to_owned(),
        base_color: Vec4::new(r, g, b, 1.0),
        roughness,
        metallic,
        ..Material::default()
    };
    let mut materials: Vec<Material> = COLORS.iter().map(plain).collect();
    let mut texture = |paint: Paint, image: usize, scale: f32| {
        materials[paint.index()].base_color_texture = Some(scaled(image, scale));
    };
    texture(Paint::Paving, textures::PAVING, 1.0 / textures::PAVING_METRES);
    texture(Paint::Plaster, textures::BLOCKS, 1.0 / textures::BLOCKS_METRES);
    texture(Paint::Lattice, textures::LATTICE, 1.0 / textures::LATTICE_METRES);
    let lattice = &mut materials[Paint::Lattice.index()];
    lattice.alpha = AlphaMode::Mask { cutoff: 0.5 };
    lattice.double_sided = true;
    materials
}

/// An image that repeats every `1 / scale` metres of texture coordinate.
fn scaled(image: usize, scale: f32) -> Texture {
    Texture {
        image,
        wrap: [Wrap::Repeat; 2],
        nearest: false,
        uv_from_texcoord: [Vec3::new(scale, 0.0, 0.0), Vec3::new(0.0, scale, 0.0)],
    }
}
