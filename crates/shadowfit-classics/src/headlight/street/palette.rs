//! The street's materials.

use glam::Vec3;
use shadowfit_scene::parts::matt;
use shadowfit_scene::{Material, Texture, Wrap};

/// A material, by its index in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Paint {
    /// Index 0, and so the default material too.
    Strip,
    LampPost,
    Body,
    Glass,
    Rubber,
    Chrome,
    TailLight,
}

impl From<Paint> for usize {
    fn from(paint: Paint) -> Self {
        paint as Self
    }
}

/// Colour of the lamp posts, in values of the display.
const BROWN: [f32; 3] = [0.25, 0.21, 0.20];

/// All materials, indexed by [`Paint`].
pub(super) fn materials() -> Vec<Material> {
    let mut strip = matt("strip", [1.0; 3], 0.9);
    strip.base_color_texture =
        Some(Texture { image: 0, wrap: [Wrap::Mirror; 2], nearest: false, uv_from_texcoord: [Vec3::X, Vec3::Y] });
    vec![
        strip,
        matt("lamp post", BROWN.map(linear), 0.6),
        matt("body", [0.04, 0.155, 0.31], 0.35),
        matt("glass", [0.014, 0.019, 0.026], 0.15),
        matt("rubber", [0.022, 0.022, 0.024], 0.8),
        matt("chrome", [0.60, 0.60, 0.56], 0.3),
        matt("tail light", [0.58, 0.03, 0.018], 0.3),
    ]
}

/// Linear value of a value of the display, by the sRGB curve.
fn linear(value: f32) -> f32 {
    ((value + 0.055) / 1.055).powf(2.4)
}
