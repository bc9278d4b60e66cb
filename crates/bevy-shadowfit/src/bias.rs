//! Biases in Bevy's units: a depth in metres, and an offset along the normal in diagonals of a texel, for all cascades of
//! a light.
//!
//! Bevy's shader moves the point that it looks up, whatever the slope: along the normal by a number of texels, which moves
//! every edge by as much, and toward the light by a fixed length, which moves none. So most of what a plane needs is
//! given as a length. Tried on fifteen paths through five scenes, with the still and the calm fit: 0.05 m and 0.3 have 0.60
//! and 0.91% wrong pixels, 0.05 m and 0.2, 0.1 m and 0.2, 0.1 m and 0.3, 0.03 m and 0.4 have 0.63 to 0.70 and 0.87 to
//! 1.05%, and Bevy's defaults, 0.02 m and 1.8, 2.4 and 2.7%. False shadow, over all frames: 0.0014% with windows, 0.0027%
//! with calm maps, and 0.03% with still ones, whose last texels are the widest; Bevy's cascades and biases have 0.016%.

use bevy::light::DirectionalLight;

/// Biases of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Biases {
    /// Offset toward the light, in metres.
    pub(crate) depth: f32,
    /// Offset along the normal, in diagonals of a texel.
    pub(crate) normal: f32,
}

impl Biases {
    /// Biases for filters of the reach of Bevy's default filter.
    pub(crate) const OURS: Self = Self { depth: 0.05, normal: 0.3 };

    /// Returns the biases of a light.
    pub(crate) fn of(light: &DirectionalLight) -> Self {
        Self { depth: light.shadow_depth_bias, normal: light.shadow_normal_bias }
    }

    /// Sets the biases of a light.
    pub(crate) fn set(self, light: &mut DirectionalLight) {
        light.shadow_depth_bias = self.depth;
        light.shadow_normal_bias = self.normal;
    }
}
