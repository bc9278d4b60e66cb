//! Maps of a sun in a view, converted to the report's look-up.

use bevy::light::cascade::Cascade;
use bevy::light::{CascadeShadowConfig, DirectionalLight};
use bevy_shadowfit::{WINDOWS_MAX_TANGENT, WINDOWS_SLOPE_BIAS};
use shadowfit::glam::{DMat4, DVec3};
use shadowfit::settings::MapSelection;
use shadowfit_report::contestant::{LookupBlend, LookupFilter, LookupMap, ShadowLookup, SlopeBias};

/// Bias of the plugin's shader for windows.
const SLOPE_BIAS: SlopeBias = SlopeBias { texels: WINDOWS_SLOPE_BIAS as f64, max_tangent: WINDOWS_MAX_TANGENT as f64 };

/// Cascades, bounds and biases of a light in a view.
#[derive(Clone)]
pub(crate) struct SunMaps {
    pub(crate) cascades: Vec<Cascade>,
    pub(crate) config: CascadeShadowConfig,
    /// Bias toward the light, in metres.
    pub(crate) depth_bias: f32,
    /// Bias along the normal, in diagonals of a texel.
    pub(crate) normal_bias: f32,
}

impl SunMaps {
    /// Copies the maps of a light.
    pub(crate) fn new(cascades: &[Cascade], config: &CascadeShadowConfig, light: &DirectionalLight) -> Self {
        Self {
            cascades: cascades.to_vec(),
            config: config.clone(),
            depth_bias: light.shadow_depth_bias,
            normal_bias: light.shadow_normal_bias,
        }
    }

    /// Returns the look-up of Bevy's shader (`shadows.wesl` and `shadow_sampling.wesl` of `bevy_pbr` 0.20).
    /// For windows it is the look-up that the plugin adds (`windows.wesl`). Maps have a width of `size`
    /// texels.
    pub(crate) fn lookup(&self, size: u32, filter: LookupFilter, to_light: DVec3) -> ShadowLookup {
        let CascadeShadowConfig { bounds, overlap_proportion, .. } = &self.config;
        let map = |(cascade, bound): (&Cascade, &f32)| LookupMap {
            clip_from_world: DMat4::from_cols_array(&cascade.clip_from_world.to_cols_array().map(f64::from)),
            texel: cascade.texel_size.into(),
            bound: (*bound).into(),
        };
        // All windows end at the shadow distance, and the finest comes first.
        let has_windows = bounds.len() > 1 && bounds.iter().all(|bound| *bound == bounds[0]);
        ShadowLookup {
            maps: self.cascades.iter().zip(bounds).map(map).collect(),
            size,
            blend: if has_windows {
                LookupBlend::Coverage {
                    reach: filter.filter_radius().into(),
                    blend: MapSelection::DEFAULT_BLEND.into(),
                }
            } else {
                LookupBlend::ViewDepth { overlap: (*overlap_proportion).into() }
            },
            depth_bias: self.depth_bias.into(),
            normal_bias: self.normal_bias.into(),
            slope_bias: if has_windows { SLOPE_BIAS } else { SlopeBias::default() },
            to_light,
            filter,
        }
    }
}
