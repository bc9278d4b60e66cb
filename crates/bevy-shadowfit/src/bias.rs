//! Biases in Bevy's units: a depth in metres, and an offset along the normal in diagonals of a texel, for all
//! cascades of a light.
//!
//! Bevy's shader moves the point before the look-up, by the same distances on every slope. It moves the point
//! along the normal by a number of texels, which shifts every edge by this amount, and toward the light by a
//! length in metres, which shifts no edge but misses casters closer than this.
//!
//! A bias that is too small for the filter darkens lit surfaces a little everywhere, which *wrong %* does not count,
//! since a pixel counts as lit from half of the light on. So biases are judged by three measures. In every fifth
//! frame of fifteen paths through five scenes they are, for wrong %, light error % and FLIP:
//!
//! | bias toward the light, along the normal | `Fit::Calm` | `Fit::Stable` |
//! |---|---|---|
//! | 0.05 m, 0.3 | 0.60, 4.4, 0.053 | 1.5, 7.6, 0.082 |
//! | 0.07 m, 0.5 | 0.76, 2.5, 0.034 | 1.7, 5.2, 0.061 |
//! | 0.07 m, 0.8 (ours) | 1.1, 1.8, 0.027 | 2.4, 3.8, 0.049 |
//! | 0.1 m, 1.0 | 1.4, 1.6, 0.026 | 2.8, 3.3, 0.044 |
//! | 0.02 m, 1.8 (Bevy's defaults) | 2.4, 1.9, 0.031 | 4.0, 3.4, 0.047 |
//!
//! Our shader for windows adds a bias by slope ([`WINDOWS_SLOPE_BIAS`]), which shifts no edge either:
//!
//! | texels by slope, up to a tangent of | toward the light, along the normal | `Fit::Windows` |
//! |---|---|---|
//! | none | 0.05 m, 0.3 | 0.33, 2.9, 0.038 |
//! | 1.5, 4 | 0.05 m, 0.15 | 0.27, 1.0, 0.017 |
//! | 2, 4 | 0.05 m, 0.15 | 0.29, 0.85, 0.015 |
//! | 2.5, 4 | 0.05 m, 0.15 | 0.32, 0.81, 0.014 |
//! | 2, 3 (ours), in every frame | 0.02 m, 0.2 | 0.25, 0.88, 0.017 |
//!
//! In the built-in courtyard, whose texels are finer, 0.05 m gives 0.88% wrong pixels and 0.02 m 0.64%.

use bevy::light::DirectionalLight;

/// Bias toward the light that the shader of [`Fit::Windows`](crate::Fit::Windows) adds, in texels times the tangent of the
/// angle between the surface's normal and the light: about the reach of Bevy's default filter.
pub const WINDOWS_SLOPE_BIAS: f32 = 2.0;
/// Greatest tangent in [`WINDOWS_SLOPE_BIAS`], so that surfaces at grazing light keep their shadows.
pub const WINDOWS_MAX_TANGENT: f32 = 3.0;

/// Biases of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Biases {
    /// Offset toward the light, in metres.
    pub(crate) depth: f32,
    /// Offset along the normal, in diagonals of a texel.
    pub(crate) normal: f32,
}

impl Biases {
    /// Biases of cascades that Bevy's own shader reads, for filters with the radius of Bevy's default filter.
    pub(crate) const OF_CASCADES: Self = Self { depth: 0.07, normal: 0.8 };
    /// Biases of windows, in addition to [`WINDOWS_SLOPE_BIAS`].
    pub(crate) const OF_WINDOWS: Self = Self { depth: 0.02, normal: 0.2 };

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
