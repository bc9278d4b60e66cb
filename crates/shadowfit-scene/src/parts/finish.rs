//! Short constructors of materials for the palettes of the scenes.

use glam::Vec3;

use crate::{AlphaMode, Material, Texture, Wrap};

/// Alpha below which a cut-out has a hole: half, so that filtered outlines keep their size.
const CUTOFF: f32 = 0.5;

/// Base colour that leaves a material's image unchanged.
pub const WHITE: [f32; 3] = [1.0; 3];

/// Returns a non-metallic material of a linear colour.
pub fn matt(name: &str, [r, g, b]: [f32; 3], roughness: f32) -> Material {
    Material { name: name.to_owned(), base_color: glam::Vec4::new(r, g, b, 1.0), roughness, ..Material::default() }
}

/// Adds an image to `material` that spans `metres` of texture coordinate along u and v, and repeats.
pub fn tiled(mut material: Material, image: usize, metres: [f32; 2]) -> Material {
    material.base_color_texture = Some(texture(image, metres, Wrap::Repeat));
    material
}

/// Adds an image to `material` that repeats mirrored along u, for surfaces that close on themselves.
pub fn wrapped(mut material: Material, image: usize, metres: [f32; 2]) -> Material {
    material.base_color_texture = Some(texture(image, metres, Wrap::Mirror));
    material
}

/// Turns `material` into a two-sided sheet, cut out by the alpha of an image that spans texture coordinates
/// 0..1.
pub fn cut_out(mut material: Material, image: usize) -> Material {
    material.base_color_texture = Some(texture(image, [1.0; 2], Wrap::Clamp));
    perforated(material)
}

/// Turns `material` into a two-sided sheet with holes where the alpha of its image is low.
pub fn perforated(material: Material) -> Material {
    Material { alpha: AlphaMode::Mask { cutoff: CUTOFF }, double_sided: true, ..material }
}

fn texture(image: usize, [across, along]: [f32; 2], wrap: Wrap) -> Texture {
    Texture {
        image,
        wrap: [wrap, if wrap == Wrap::Mirror { Wrap::Repeat } else { wrap }],
        nearest: false,
        uv_from_texcoord: [Vec3::new(1.0 / across, 0.0, 0.0), Vec3::new(0.0, 1.0 / along, 0.0)],
    }
}
