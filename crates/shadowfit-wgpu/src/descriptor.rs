//! What a shadow map is made of: size, count, format, filter and depth convention.

use shadowfit::settings::{FilterKind, MapFormat, Settings};
use shadowfit::{CasterPolicy, DepthConvention, FitKind};

use crate::ShadowMapError;

/// Most maps (array layers) that one [`ShadowMap`] holds.
pub const MAX_MAPS: usize = 8;

/// Widths and heights that a map may have, in texels.
pub const RESOLUTIONS: core::ops::RangeInclusive<u32> = 256..=8192;

/// What a [`ShadowMap`] is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowMapDescriptor {
    /// Width and height of each map, in texels, within [`RESOLUTIONS`].
    pub resolution: [u32; 2],
    /// Number of maps, 1..=[`MAX_MAPS`].
    pub maps: u32,
    /// Storage of the depths.
    pub format: MapFormat,
    /// Filter of the look-up.
    pub filter: FilterKind,
    /// Depth convention of the fits: 0..1, plain or reversed; wgpu has no -1..1.
    pub depth: DepthConvention,
    /// Whether casters before the near plane are kept, flattened onto it ("pancaking"), as fits with
    /// [`CasterPolicy::DepthClamp`] need it. The device needs
    /// [`wgpu::Features::DEPTH_CLIP_CONTROL`].
    pub depth_clamp: bool,
}

impl Default for ShadowMapDescriptor {
    fn default() -> Self {
        Self {
            resolution: [2048; 2],
            maps: 1,
            format: MapFormat::Depth32Float,
            filter: FilterKind::default(),
            depth: DepthConvention::ZeroToOne,
            depth_clamp: false,
        }
    }
}

impl From<&Settings> for ShadowMapDescriptor {
    /// One map that the settings' fits match.
    fn from(settings: &Settings) -> Self {
        Self {
            resolution: settings.fit.resolution.to_array(),
            maps: 1,
            format: settings.format,
            filter: settings.filter,
            depth: settings.fit.depth,
            // The XNA sample's fit has no caster policy.
            depth_clamp: settings.fit.casters == CasterPolicy::DepthClamp && settings.fit.kind != FitKind::XnaSample,
        }
    }
}

impl ShadowMapDescriptor {
    /// Refuses what the device cannot have.
    pub(crate) fn check(&self, device: &wgpu::Device) -> Result<(), ShadowMapError> {
        let device_limit = device.limits().max_texture_dimension_2d;
        let resolution = self.resolution;
        if resolution.iter().any(|side| !RESOLUTIONS.contains(side) || *side > device_limit) {
            return Err(ShadowMapError::Resolution { resolution, device_limit });
        }
        if !(1..=MAX_MAPS as u32).contains(&self.maps) {
            return Err(ShadowMapError::Maps(self.maps));
        }
        if self.depth == DepthConvention::NegativeOneToOne {
            return Err(ShadowMapError::Depth(self.depth));
        }
        if self.depth_clamp && !device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL) {
            return Err(ShadowMapError::DepthClamp);
        }
        Ok(())
    }
}
