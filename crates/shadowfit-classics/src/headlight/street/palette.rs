//! The street's materials.

use glam::Vec3;
use shadowfit_scene::parts::{WHITE, matt, numbered};
use shadowfit_scene::{Material, Texture, Wrap};

/// Colour of the lamp posts, in display values.
const BROWN: [f32; 3] = [0.25, 0.21, 0.20];

numbered! {
    /// A material, by its index in the scene. The first is also the default material.
    Paint: Material {
        Strip = strip(),
        LampPost = matt("lamp post", BROWN.map(linear), 0.6),
        Body = matt("body", [0.04, 0.155, 0.31], 0.35),
        Glass = matt("glass", [0.014, 0.019, 0.026], 0.15),
        Rubber = matt("rubber", [0.022, 0.022, 0.024], 0.8),
        Chrome = matt("chrome", [0.60, 0.60, 0.56], 0.3),
        TailLight = matt("tail light", [0.58, 0.03, 0.018], 0.3),
    }
}

/// Returns the linear value of a display value, by the sRGB curve.
fn linear(value: f32) -> f32 {
    ((value + 0.055) / 1.055).powf(2.4)
}

/// Returns the material of the strip, whose image repeats mirrored.
fn strip() -> Material {
    let image = Texture { image: 0, wrap: [Wrap::Mirror; 2], nearest: false, uv_from_texcoord: [Vec3::X, Vec3::Y] };
    Material { base_color_texture: Some(image), ..matt("strip", WHITE, 0.9) }
}
