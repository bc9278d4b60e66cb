//! What a shadow map is made of: size, count, format, filter, choice of the map and depth convention.

use shadowfit::glam::UVec2;
use shadowfit::settings::{CasterPolicy, FilterKind, FitKind, MAX_BLEND, MAX_MAPS, MapChoice, MapFormat, Softness};
use shadowfit::{DepthConvention, Technique};

use crate::ShadowMapError;

/// Widths and heights that a map may have, in texels.
pub const RESOLUTIONS: core::ops::RangeInclusive<u32> = 256..=8192;

/// What a [`ShadowMap`](crate::ShadowMap) is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowMapDescriptor {
    /// Width and height of each map, in texels, within [`RESOLUTIONS`].
    pub resolution: [u32; 2],
    /// Number of maps, 1..=[`MAX_MAPS`].
    pub maps: u32,
    /// Storage of the depths.
    pub format: MapFormat,
    /// Filter of the look-up.
    pub filter: FilterKind,
    /// Width of the filters that are soft.
    pub softness: Softness,
    /// Which of the maps a point reads.
    pub choice: MapChoice,
    /// Texels over which a map that is read by coverage is blended into the next coarser one, inward from the filter's
    /// reach to its border, 0..=[`MAX_BLEND`]; 0 for none. By view depth [`MapFit::blend_near`](crate::MapFit::blend_near)
    /// says where maps are blended.
    pub blend: f32,
    /// Depth convention of the fits: 0..1, plain or reversed; wgpu has no -1..1.
    pub depth: DepthConvention,
    /// Whether casters before the near plane are kept, flattened onto it ("pancaking"), as fits with
    /// [`CasterPolicy::DepthClamp`] need it. The device needs
    /// [`wgpu::Features::DEPTH_CLIP_CONTROL`].
    pub depth_clamp: bool,
}

impl Default for ShadowMapDescriptor {
    /// What the recommended technique draws: four maps of 2048² texels.
    fn default() -> Self {
        Self::from(&Technique::default())
    }
}

impl From<&Technique> for ShadowMapDescriptor {
    /// Layers for the technique's maps, as wide and as high as the largest of them.
    fn from(technique: &Technique) -> Self {
        let sizes = (0..technique.count as usize).map(|map| technique.resolution_of(map));
        Self {
            resolution: sizes.fold(technique.fit.resolution, UVec2::max).to_array(),
            maps: technique.count,
            format: technique.format,
            filter: technique.filter,
            softness: technique.softness,
            choice: technique.map_choice(),
            blend: technique.blend,
            depth: technique.fit.depth,
            // The XNA sample's fit has no caster policy.
            depth_clamp: technique.fit.casters == CasterPolicy::DepthClamp && technique.fit.kind != FitKind::XnaSample,
        }
    }
}

impl ShadowMapDescriptor {
    /// Refuses a descriptor that the device does not support.
    pub(crate) fn check(&self, device: &wgpu::Device) -> Result<(), ShadowMapError> {
        let device_limit = device.limits().max_texture_dimension_2d;
        let resolution = self.resolution;
        if resolution.iter().any(|side| !RESOLUTIONS.contains(side) || *side > device_limit) {
            return Err(ShadowMapError::Resolution { resolution, device_limit });
        }
        if !(1..=MAX_MAPS as u32).contains(&self.maps) {
            return Err(ShadowMapError::Maps(self.maps));
        }
        if !(0.0..=MAX_BLEND).contains(&self.blend) {
            return Err(ShadowMapError::Blend(self.blend));
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
