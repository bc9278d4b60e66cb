//! The figures that a tool shows live: plain numbers, filled by whoever measured them.

use crate::volume::Constraint;

/// Live figures of one frame. `None` means not measured, never zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Figures {
    /// What set the planes -x, +x, -y, +y, far and near of the map's box, see
    /// [`LightFit::set_by`](crate::LightFit::set_by).
    pub set_by: Option<[Constraint; 6]>,
    /// Whether no receiver is in view, see [`LightFit::is_empty`](crate::LightFit::is_empty).
    pub is_empty: Option<bool>,
    /// Size of one shadow texel across the light, in metres, along u and v.
    pub texel_size: Option<[f32; 2]>,
    /// Extent of the map along the light, in metres.
    pub depth_range: Option<f32>,
    /// Smallest depth difference that the map's format resolves at its far end, in metres.
    pub depth_step: Option<f32>,
    /// Screen pixels per shadow texel along the worse axis at the picture's centre.
    pub pixels_per_texel: Option<f32>,
    /// Time of a whole frame, in milliseconds.
    pub frame_ms: Option<f32>,
    /// GPU time of the shadow pass, in milliseconds.
    pub shadow_pass_ms: Option<f32>,
    /// GPU time of the scene pass, in milliseconds.
    pub scene_pass_ms: Option<f32>,
    /// Draw calls of the shadow pass.
    pub shadow_draws: Option<u32>,
    /// Triangles drawn into the shadow map.
    pub shadow_triangles: Option<u64>,
}
