//! Biases in Bevy's units: a depth in metres, and an offset along the normal in texels, for all cascades of a light.

use bevy::light::ShadowFilteringMethod;

/// The least biases that clear the maps of a light of acne, for the filters of its views: depth in metres, normal offset
/// in texels.
pub(crate) fn automatic(filters: impl Iterator<Item = ShadowFilteringMethod>) -> [f32; 2] {
    let normal = filters.map(normal_bias).fold(0.0, f32::max);
    [0.05, normal]
}

fn normal_bias(filter: ShadowFilteringMethod) -> f32 {
    match filter {
        ShadowFilteringMethod::Hardware2x2 => 0.3,
        ShadowFilteringMethod::Gaussian | ShadowFilteringMethod::Temporal => 0.3,
    }
}
