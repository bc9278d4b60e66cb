//! The shadow fits of other engines, written in Rust from their sources, so that anyone can compare with them on any
//! frame.
//!
//! | engine | source |
//! |---|---|
//! | Bevy | `build_directional_light_cascades` of `bevy_light` 0.20.1 |
//! | three.js `CSM` | `examples/jsm/csm/CSM.js` of three 0.187 |
//! | three.js `SunLight` | `examples/jsm/lights/SunLightShadow.js` of three 0.187 |
//! | Babylon.js | `CascadedShadowGenerator` of `@babylonjs/core` 9.35 |
//!
//! All have their default settings, and maps of the same resolution. A test compares them with numbers from the engines'
//! own code. Blending between cascades is left out: each point reads one map.

mod babylon;
mod bevy;
mod slice;
#[cfg(test)]
mod tests;
mod three_csm;
mod three_sun_light;

use crate::peers::{FitMap, Frame, Scene};

/// An engine's shadow fit.
#[derive(Clone, Copy, Debug)]
pub struct Engine {
    /// Name in tables and of fit files.
    pub name: &'static str,
    /// Its maps, in a sentence.
    pub what: &'static str,
    /// Number of its maps.
    pub maps: u32,
    /// Whether its maps have reversed depth: 1 nearest to the light.
    pub is_reversed: bool,
    /// Whether its renderer clamps depth, so that casters before a map's near plane still cast shadows.
    pub depth_clamp: bool,
    fit: fn(&Frame, &Scene, u32) -> Vec<FitMap>,
}

/// The engines, by name.
pub const ENGINES: [Engine; 5] = [
    Engine {
        name: "babylon-stable",
        what: "Babylon.js with `stabilizeCascades`: 4 spheres around slices of the view",
        maps: 4,
        is_reversed: false,
        depth_clamp: true,
        fit: babylon::stable,
    },
    Engine {
        name: "babylon-tight",
        what: "Babylon.js as it comes: 4 boxes around slices of the view",
        maps: 4,
        is_reversed: false,
        depth_clamp: true,
        fit: babylon::tight,
    },
    Engine {
        name: "bevy",
        what: "Bevy as it comes: 4 cascades, the first one up to 10 m",
        maps: 4,
        is_reversed: true,
        depth_clamp: true,
        fit: bevy::fit,
    },
    Engine {
        name: "three-csm",
        what: "three.js CSM with 4 cascades: squares around slices of the view",
        maps: 4,
        is_reversed: false,
        depth_clamp: false,
        fit: three_csm::fit,
    },
    Engine {
        name: "three-sunlight",
        what: "three.js SunLight: 2 spheres around slices of the view",
        maps: 2,
        is_reversed: false,
        depth_clamp: false,
        fit: three_sun_light::fit,
    },
];

impl Engine {
    /// Returns the engine of a name.
    pub fn find(name: &str) -> Option<Self> {
        ENGINES.into_iter().find(|engine| engine.name == name)
    }

    /// Fits the maps of a frame, `resolution` texels a side. `scene` gives the bounds of the casters.
    pub fn fit(&self, frame: &Frame, scene: &Scene, resolution: u32) -> Vec<FitMap> {
        (self.fit)(frame, scene, resolution)
    }
}

/// Greatest difference of two maps' matrix elements, relative where they exceed 1: one and a half texels of 1/1024 of a
/// map's half side. The engines compute in f32 and round to whole texels, so that a tie may go the other way.
const SAME_MAP: f64 = 1.5 / 1024.0;

/// Returns whether a map of an engine's own code is the map of our version, to the rounding of f32.
pub fn is_same_map(real: &FitMap, ours: &FitMap) -> bool {
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_MAP * a.abs().max(1.0);
    real.resolution == ours.resolution && real.view_proj.iter().zip(&ours.view_proj).all(is_near)
}
