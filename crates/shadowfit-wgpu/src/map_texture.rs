//! Textures that the engine made and owns, in which maps lie: a frame graph's, or one that two suns share.

use core::fmt;

use crate::{ShadowMapDescriptor, ShadowMapError};

/// Layers of a texture that hold shadow maps: as many as there are maps, from one on.
#[derive(Clone, Debug, PartialEq)]
pub struct MapTexture {
    /// The texture, as [`ShadowMapDescriptor::texture`] describes it.
    pub texture: wgpu::Texture,
    /// Layer of the first map. OpenGL has none but 0. Layers of another sun are not to overlap.
    pub base_layer: u32,
}

/// Why a texture cannot hold maps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MapTextureError {
    /// It has another dimension than two.
    Dimension(wgpu::TextureDimension),
    /// It has another format than the maps.
    Format {
        /// The texture's.
        texture: wgpu::TextureFormat,
        /// That of the maps.
        maps: wgpu::TextureFormat,
    },
    /// It is larger or smaller than the maps.
    Size {
        /// Its width and height, in texels.
        texture: [u32; 2],
        /// Those of the maps.
        maps: [u32; 2],
    },
    /// It ends before the last map.
    Layers {
        /// Number of its layers.
        texture: u32,
        /// Layer of the first map.
        base_layer: u32,
        /// Number of maps.
        maps: u32,
    },
    /// It has several samples a texel.
    Samples(u32),
    /// It lacks usages.
    Usages {
        /// Those that are missing.
        missing: wgpu::TextureUsages,
    },
    /// OpenGL's shaders read textures from their first layer on only.
    BaseLayer(u32),
}

impl MapTexture {
    /// A view of the first mip level of some maps.
    pub(crate) fn view(&self, dimension: wgpu::TextureViewDimension, first: u32, count: u32) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some("shadowfit map"),
            dimension: Some(dimension),
            mip_level_count: Some(1),
            base_array_layer: self.base_layer + first,
            array_layer_count: Some(count),
            ..Default::default()
        })
    }

    /// Refuses a texture that cannot hold the maps of a descriptor.
    pub(crate) fn check(&self, device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        let is_gl = device.adapter_info().backend == wgpu::Backend::Gl;
        self.mismatch(descriptor, is_gl).map_or(Ok(()), |error| Err(ShadowMapError::Texture(error)))
    }

    /// What is wrong with it.
    fn mismatch(&self, descriptor: &ShadowMapDescriptor, is_gl: bool) -> Option<MapTextureError> {
        let Self { texture, base_layer } = self;
        let (base_layer, needed) = (*base_layer, descriptor.texture());
        let size = [texture.width(), texture.height()];
        let (layers, maps) = (texture.depth_or_array_layers(), descriptor.maps);
        let missing = needed.usage - texture.usage();
        if texture.dimension() != needed.dimension {
            Some(MapTextureError::Dimension(texture.dimension()))
        } else if texture.sample_count() != 1 {
            Some(MapTextureError::Samples(texture.sample_count()))
        } else if texture.format() != needed.format {
            Some(MapTextureError::Format { texture: texture.format(), maps: needed.format })
        } else if size != descriptor.resolution {
            Some(MapTextureError::Size { texture: size, maps: descriptor.resolution })
        } else if base_layer.checked_add(maps).is_none_or(|end| end > layers) {
            Some(MapTextureError::Layers { texture: layers, base_layer, maps })
        } else if !missing.is_empty() {
            Some(MapTextureError::Usages { missing })
        } else {
            (is_gl && base_layer > 0).then_some(MapTextureError::BaseLayer(base_layer))
        }
    }
}

impl fmt::Display for MapTextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dimension(dimension) => write!(f, "it has the dimension {dimension:?}: D2 is needed"),
            Self::Format { texture, maps } => write!(f, "it has the format {texture:?}: the maps need {maps:?}"),
            Self::Size { texture: [width, height], maps: [columns, rows] } => {
                write!(f, "it has {width} × {height} texels: the maps have {columns} × {rows}")
            }
            Self::Layers { texture, base_layer, maps } => {
                write!(f, "it has {texture} layers: {maps} maps from layer {base_layer} on need more")
            }
            Self::Samples(samples) => write!(f, "it has {samples} samples a texel: maps have 1"),
            Self::Usages { missing } => write!(f, "it lacks the usage {missing:?}"),
            Self::BaseLayer(layer) => {
                write!(f, "its first map is in layer {layer}: OpenGL's shaders read textures from layer 0 on only")
            }
        }
    }
}

impl core::error::Error for MapTextureError {}
