//! The terrain's materials.

use shadowfit_scene::Material;
use shadowfit_scene::parts::{matt, numbered, tiled};

/// Distance after which the texture of the land repeats, in the terrain's units.
const TILE: f32 = 50.0;

numbered! {
    /// A material, by its index in the scene. The first is also the default material. The sample's light
    /// brightens colours by up to 1.6, in display values, so they are dark enough to keep their hue.
    Paint: Material {
        Land = tiled(matt("grass and earth", [1.0; 3], 1.0), 0, [TILE; 2]),
        Rubber = matt("rubber", [0.022, 0.022, 0.024], 0.95),
        Steel = matt("steel", [0.30, 0.31, 0.33], 0.5),
        Dark = matt("dark steel", [0.055, 0.057, 0.06], 0.6),
        Seat = matt("seat", [0.13, 0.065, 0.03], 0.8),
        Lamp = matt("lamp", [0.95, 0.92, 0.78], 0.3),
        Red = matt("red paint", [0.44, 0.025, 0.015], 0.4),
        Cream = matt("cream paint", [0.44, 0.39, 0.29], 0.5),
        Yellow = matt("yellow paint", [0.58, 0.33, 0.02], 0.45),
        Blue = matt("blue paint", [0.022, 0.085, 0.30], 0.35),
        Pale = matt("pale paint", [0.48, 0.49, 0.49], 0.4),
        Glass = matt("dark glass", [0.018, 0.030, 0.040], 0.1),
        Sand = matt("sand paint", [0.42, 0.305, 0.145], 0.6),
        Tan = matt("tan canvas", [0.30, 0.20, 0.10], 0.9),
    }
}
