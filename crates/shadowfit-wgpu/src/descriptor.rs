//! The description of shadow maps: size, count, format, filter, choice of the map and depth convention.

mod error;
mod limits;
mod texture_error;

use shadowfit::selection::MapReading;
use shadowfit::settings::{CasterPolicy, Edges, FilterKind, MAX_MAPS, MapFormat, MapSelection, Softness};
use shadowfit::{DepthConvention, Technique};

pub use error::ShadowMapError;
pub use limits::RESOLUTIONS;
pub use texture_error::MapTextureError;

/// Size, number, format and filter of a [`ShadowMap`](crate::ShadowMap), and how points read it.
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
    /// View depth from which on shadows fade, and the one where they have vanished, in metres: of a technique the last
    /// share [`Technique::fade`] of its shadow distance. Between them shadows are mixed with light by s² (3 - 2 s), s
    /// being the share of the way; points beyond are lit. Both are `f32::MAX` for shadows that end with their maps.
    pub fade: [f32; 2],
    /// Which of the maps a point reads. By view depth
    /// [`DepthRange::covered_from`](shadowfit::selection::DepthRange::covered_from) says where maps are blended.
    pub selection: MapSelection,
    /// Whether an edge pass traces rays where the maps are not sure. The maps, their look-up and its WGSL are the same
    /// either way.
    pub edges: Edges,
    /// Depth convention of the fits: 0..1, plain or reversed; wgpu has no -1..1.
    pub depth: DepthConvention,
    /// Whether casters before the near plane are kept, flattened onto it ("pancaking"), as fits with
    /// [`CasterPolicy::DepthClamp`] need it. On devices without [`wgpu::Features::DEPTH_CLIP_CONTROL`] the
    /// engine's fragment shaders do it: [`ShadowMap::clamps_in_fragment`](crate::ShadowMap::clamps_in_fragment).
    pub depth_clamp: bool,
    /// Whether there is a second set of layers, and a look-up that goes over from one set of maps to the other: of a
    /// [`SunShadows`](crate::SunShadows) what its [light steps](crate::SunShadows::set_light_steps) ask for, whatever is
    /// given here. A [`ShadowMap`](crate::ShadowMap) by itself leaves the second set empty. Default: `false`.
    pub cross_fades: bool,
    /// First binding of the bind groups of casters and receivers; the others follow it. With another one for each sun
    /// several suns fit into one bind group: [`ShadowMap::receiver_entries`](crate::ShadowMap::receiver_entries).
    /// Default: 0.
    pub first_binding: u32,
}

impl Default for ShadowMapDescriptor {
    /// The maps of the recommended technique: four of 2048² texels.
    fn default() -> Self {
        Self::from(&Technique::default())
    }
}

impl From<&Technique> for ShadowMapDescriptor {
    /// Layers for the technique's maps.
    fn from(technique: &Technique) -> Self {
        Self {
            resolution: technique.fit.resolution.to_array(),
            maps: technique.maps.count(),
            format: technique.format,
            filter: technique.filter,
            softness: technique.softness,
            fade: fade(technique),
            selection: technique.maps.selection(),
            edges: technique.edges,
            depth: technique.fit.depth,
            depth_clamp: technique.fit.casters == CasterPolicy::DepthClamp && !technique.maps.are_exact(),
            cross_fades: false,
            first_binding: 0,
        }
    }
}

/// View depths between which the shadows of a technique fade.
fn fade(technique: &Technique) -> [f32; 2] {
    let (end, share) = (technique.fit.max_distance, technique.fade);
    if end < f32::MAX { [end * (1.0 - share.clamp(0.0, 1.0)), end] } else { [f32::MAX; 2] }
}

impl ShadowMapDescriptor {
    /// How points read the maps.
    pub const fn reading(&self) -> MapReading {
        let Self { selection: choice, filter, softness, .. } = *self;
        MapReading { selection: choice, filter, softness }
    }

    /// Usages that the texture of the maps needs.
    pub(crate) const USAGES: wgpu::TextureUsages =
        wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);

    /// The texture of the maps, for engines that make it themselves ([`MapTexture`](crate::MapTexture)): as many layers
    /// as there are maps, twice as many where they cross-fade, with the usages that they need. It may have more layers, usages and mip levels.
    pub fn texture(&self) -> wgpu::TextureDescriptor<'static> {
        let [width, height] = self.resolution;
        wgpu::TextureDescriptor {
            label: Some("shadowfit map"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: self.layers() },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.texture_format(),
            usage: Self::USAGES,
            view_formats: &[],
        }
    }

    /// Layers of the texture that shaders read.
    pub(crate) const fn layers(&self) -> u32 {
        if self.cross_fades { 2 * self.maps } else { self.maps }
    }

    /// Refuses a descriptor that is impossible, in general or on this device.
    pub(crate) fn check(&self, device: &wgpu::Device) -> Result<(), ShadowMapError> {
        let device_limit = device.limits().max_texture_dimension_2d;
        let resolution = self.resolution;
        if resolution.iter().any(|side| !RESOLUTIONS.contains(side) || *side > device_limit) {
            return Err(ShadowMapError::Resolution { resolution, device_limit });
        }
        if !(1..=MAX_MAPS as u32).contains(&self.maps) {
            return Err(ShadowMapError::Maps(self.maps));
        }
        if !(0.0..=MapSelection::MAX_BLEND).contains(&self.selection.blend()) {
            return Err(ShadowMapError::Blend(self.selection.blend()));
        }
        if let Edges::Traced { samples } = self.edges
            && !(1..=Edges::MAX_SAMPLES).contains(&samples)
        {
            return Err(ShadowMapError::Samples(samples));
        }
        if self.depth == DepthConvention::NegativeOneToOne {
            return Err(ShadowMapError::Depth(self.depth));
        }
        let [near, far] = self.fade;
        // NaN has no order, and infinity no difference.
        if !(near <= far && near.is_finite() && far.is_finite()) {
            return Err(ShadowMapError::Fade(self.fade));
        }
        let Softness { floor, ceiling, .. } = self.softness;
        if !(0.0..=ceiling).contains(&floor) || !(1.0..=Softness::MAX_RADIUS).contains(&ceiling) {
            return Err(ShadowMapError::Softness { floor, ceiling });
        }
        let tangent = self.softness.tangent();
        if !(0.0..f32::INFINITY).contains(&tangent) {
            return Err(ShadowMapError::SoftRadius(tangent));
        }
        self.check_distances(device.adapter_info().backend)
    }

    /// Refuses filters that need casters' distances where these are lost, or where shaders cannot read them.
    fn check_distances(&self, backend: wgpu::Backend) -> Result<(), ShadowMapError> {
        if self.edges.need_distances(self.filter) && self.depth_clamp {
            return Err(ShadowMapError::SoftDepthClamp(self.filter));
        }
        if self.filter == FilterKind::Pcss && self.format.is_depth() && backend == wgpu::Backend::Gl {
            return Err(ShadowMapError::PcssDepthLoads(self.format));
        }
        Ok(())
    }

    /// Format of the texture that shaders read.
    pub(crate) fn texture_format(&self) -> wgpu::TextureFormat {
        match self.format {
            MapFormat::Depth32Float => wgpu::TextureFormat::Depth32Float,
            MapFormat::Depth16Unorm => wgpu::TextureFormat::Depth16Unorm,
            MapFormat::R32Float => wgpu::TextureFormat::R32Float,
            MapFormat::R16Float => wgpu::TextureFormat::R16Float,
            MapFormat::Rgba8Packed => wgpu::TextureFormat::Rgba8Unorm,
            MapFormat::R8Grey => wgpu::TextureFormat::R8Unorm,
        }
    }

    /// Format of the depth attachment: the map itself, or what lies beside a colour.
    pub(crate) fn depth_format(&self) -> wgpu::TextureFormat {
        if self.format.is_depth() { self.texture_format() } else { wgpu::TextureFormat::Depth32Float }
    }

    /// The colour that stores a depth of 0 or 1 in a colour format.
    pub(crate) fn color_of(&self, depth: f32) -> wgpu::Color {
        if self.format != MapFormat::Rgba8Packed {
            return wgpu::Color { r: depth.into(), g: 0.0, b: 0.0, a: 1.0 };
        }
        let [r, g, b, a] = depth.to_bits().to_le_bytes().map(|byte| f64::from(byte) / 255.0);
        wgpu::Color { r, g, b, a }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shadows_fade_over_the_technique_s_share_of_the_shadow_distance_if_there_is_one() {
        let mut technique = Technique::default().with_fade(0.25);
        technique.fit.max_distance = 80.0;
        assert_eq!(ShadowMapDescriptor::from(&technique).fade, [60.0, 80.0]);
        assert_eq!(ShadowMapDescriptor::from(&technique.with_fade(0.0)).fade, [80.0; 2], "an end, if without a fade");
        technique.fit.max_distance = f32::MAX;
        assert_eq!(ShadowMapDescriptor::from(&technique).fade, [f32::MAX; 2]);
    }

    #[test]
    fn pcss_is_refused_without_the_casters_distances_and_says_what_to_do() {
        let pcss = ShadowMapDescriptor { filter: FilterKind::Pcss, ..ShadowMapDescriptor::default() };
        assert_eq!(pcss.check_distances(wgpu::Backend::Vulkan), Ok(()));
        let clamped = ShadowMapDescriptor { depth_clamp: true, ..pcss };
        let error = clamped.check_distances(wgpu::Backend::Vulkan).expect_err("clamped casters have no distance");
        assert!(error.to_string().contains("caster policy"), "{error}");
        let error = pcss.check_distances(wgpu::Backend::Gl).expect_err("no loads of depth");
        assert!(error.to_string().contains("Depth32Float") && error.to_string().contains("R32Float"), "{error}");
        let color = ShadowMapDescriptor { format: MapFormat::R32Float, ..pcss };
        assert_eq!(color.check_distances(wgpu::Backend::Gl), Ok(()));
    }

    #[test]
    fn traced_soft_edges_are_refused_without_the_casters_distances_and_hard_ones_are_not() {
        let clamped = ShadowMapDescriptor {
            edges: Edges::Traced { samples: 4 },
            depth_clamp: true,
            ..ShadowMapDescriptor::default()
        };
        for filter in FilterKind::ALL {
            let checked = ShadowMapDescriptor { filter, ..clamped }.check_distances(wgpu::Backend::Vulkan);
            assert_eq!(checked.is_err(), filter.is_soft(), "{filter:?}");
            let Err(error) = checked else { continue };
            let text = error.to_string();
            let name = if filter == FilterKind::Pcss { "PCSS".to_owned() } else { format!("{filter:?}") };
            let is_named = text.contains(&name) && text.contains("caster policy");
            let says_traced = text.contains("traced") != (filter == FilterKind::Pcss);
            assert!(is_named && says_traced, "{text}");
        }
        let filtered = ShadowMapDescriptor { edges: Edges::Filtered, filter: FilterKind::Vogel16, ..clamped };
        assert_eq!(filtered.check_distances(wgpu::Backend::Vulkan), Ok(()));
    }
}
