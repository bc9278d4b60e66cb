//! Description of shadow maps: size, count, format, filter, selection and depth convention.

mod error;
mod limits;
mod texture_error;

use shadowfit::selection::MapReading;
use shadowfit::settings::{CasterPolicy, Edges, FilterKind, MAX_MAPS, MapFormat, MapSelection, Softness};
use shadowfit::{DepthConvention, Technique};

pub use error::ShadowMapError;
pub use limits::RESOLUTIONS;
pub use texture_error::MapTextureError;

/// Size, number, format and filter of a [`ShadowMap`](crate::ShadowMap), and how points select a map.
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
    /// Width of the soft filters.
    pub softness: Softness,
    /// View depths, in metres, where shadows begin to fade and where they end. A technique fades its shadows
    /// over the last share [`Technique::fade`] of its shadow distance. At a share s of the way from the first
    /// depth to the second, shadows are blended with light by s² (3 - 2 s). Points beyond are lit. Both
    /// depths are `f32::MAX` for shadows that end with their maps.
    pub fade: [f32; 2],
    /// How a point selects a map. With selection by view depth, the blend of two maps begins at
    /// [`DepthRange::covered_from`](shadowfit::selection::DepthRange::covered_from).
    pub selection: MapSelection,
    /// Whether an edge pass traces rays where the texels of a map disagree. This changes neither the maps nor
    /// the WGSL of the look-up.
    pub edges: Edges,
    /// Depth convention of the fits: 0..1, plain or reversed. wgpu has no -1..1.
    pub depth: DepthConvention,
    /// Whether casters in front of the near plane are kept, flattened onto it ("pancaking"). Fits with
    /// [`CasterPolicy::DepthClamp`] require it. On devices without [`wgpu::Features::DEPTH_CLIP_CONTROL`] the
    /// engine's fragment shaders must clamp:
    /// [`ShadowMap::clamps_in_fragment`](crate::ShadowMap::clamps_in_fragment).
    pub depth_clamp: bool,
    /// Whether there is a second set of layers, and a look-up that fades from one set of maps to the other.
    /// [`SunShadows`](crate::SunShadows) ignores this field and follows its [light
    /// steps](crate::SunShadows::set_light_steps). A [`ShadowMap`](crate::ShadowMap) alone leaves the second
    /// set empty. Default: `false`.
    pub cross_fades: bool,
    /// First binding of the bind groups of casters and receivers. Their other bindings follow it. Several
    /// suns with different first bindings can share a bind group:
    /// [`ShadowMap::receiver_entries`](crate::ShadowMap::receiver_entries). Default: 0.
    pub first_binding: u32,
}

impl Default for ShadowMapDescriptor {
    /// Returns the maps of the recommended technique: four maps of 2048² texels.
    fn default() -> Self {
        Self::from(&Technique::default())
    }
}

impl From<&Technique> for ShadowMapDescriptor {
    /// Returns the description of the technique's maps.
    fn from(technique: &Technique) -> Self {
        Self {
            resolution: technique.fit.resolution.to_array(),
            maps: technique.maps.count(),
            format: technique.format,
            filter: technique.filter,
            softness: technique.softness,
            fade: technique.fade_depths(),
            selection: technique.maps.selection(),
            edges: technique.edges,
            depth: technique.fit.depth,
            depth_clamp: technique.fit.casters == CasterPolicy::DepthClamp && !technique.maps.are_exact(),
            cross_fades: false,
            first_binding: 0,
        }
    }
}

impl ShadowMapDescriptor {
    /// Returns how points read the maps.
    pub const fn reading(&self) -> MapReading {
        let Self { selection: choice, filter, softness, .. } = *self;
        MapReading { selection: choice, filter, softness }
    }

    /// Usages that the texture of the maps requires.
    pub(crate) const USAGES: wgpu::TextureUsages =
        wgpu::TextureUsages::RENDER_ATTACHMENT.union(wgpu::TextureUsages::TEXTURE_BINDING);

    /// Returns the description of the maps' texture, for engines that create it themselves
    /// ([`MapTexture`](crate::MapTexture)). It has one layer per map, or two if the maps cross-fade, and the
    /// required usages. The engine's texture may have more layers, usages and mip levels.
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

    /// Returns the number of layers of the texture that shaders read.
    pub(crate) const fn layers(&self) -> u32 {
        if self.cross_fades { 2 * self.maps } else { self.maps }
    }

    /// Refuses a descriptor that is invalid or that this device does not support.
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
        // NaN has no order, and the difference of infinities is NaN.
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

    /// Refuses filters that need the distances of casters if depth clamp loses them or shaders cannot read
    /// them.
    fn check_distances(&self, backend: wgpu::Backend) -> Result<(), ShadowMapError> {
        if self.edges.need_distances(self.filter) && self.depth_clamp {
            return Err(ShadowMapError::SoftDepthClamp(self.filter));
        }
        if self.filter == FilterKind::Pcss && self.format.is_depth() && backend == wgpu::Backend::Gl {
            return Err(ShadowMapError::PcssDepthLoads(self.format));
        }
        Ok(())
    }

    /// Returns the format of the texture that shaders read.
    pub(crate) fn texture_format(&self) -> wgpu::TextureFormat {
        match self.format {
            MapFormat::Depth32Float => wgpu::TextureFormat::Depth32Float,
            MapFormat::Depth24Unorm => wgpu::TextureFormat::Depth24Plus,
            MapFormat::Depth16Unorm => wgpu::TextureFormat::Depth16Unorm,
            MapFormat::R32Float => wgpu::TextureFormat::R32Float,
            MapFormat::R16Float => wgpu::TextureFormat::R16Float,
            MapFormat::Rgba8Packed => wgpu::TextureFormat::Rgba8Unorm,
            MapFormat::R8Grey => wgpu::TextureFormat::R8Unorm,
        }
    }

    /// Returns the format of the depth attachment: the map itself, or the depth buffer that belongs to a
    /// colour map.
    pub(crate) fn depth_format(&self) -> wgpu::TextureFormat {
        if self.format.is_depth() { self.texture_format() } else { wgpu::TextureFormat::Depth32Float }
    }

    /// Returns the colour that stores a depth of 0 or 1 in a colour format.
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
        assert_eq!(ShadowMapDescriptor::from(&technique.with_fade(0.0)).fade, [80.0; 2], "an end without a fade");
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
        let error = pcss.check_distances(wgpu::Backend::Gl).expect_err("OpenGL cannot load depths");
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
