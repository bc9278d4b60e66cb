//! Errors of a texture that the engine passes in for its shadow maps.

use core::fmt;

/// The reason why a texture cannot hold the maps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MapTextureError {
    /// The texture is not two-dimensional.
    Dimension(wgpu::TextureDimension),
    /// The texture's format differs from the maps' format.
    Format {
        /// Format of the texture.
        texture: wgpu::TextureFormat,
        /// Format of the maps.
        maps: wgpu::TextureFormat,
    },
    /// The texture is larger or smaller than the maps.
    Size {
        /// Width and height of the texture, in texels.
        texture: [u32; 2],
        /// Width and height of the maps, in texels.
        maps: [u32; 2],
    },
    /// The texture ends before the last map.
    Layers {
        /// Number of layers of the texture.
        texture: u32,
        /// Layer of the first map.
        base_layer: u32,
        /// Number of maps.
        maps: u32,
    },
    /// The texture has several samples per texel.
    Samples(u32),
    /// The texture lacks usages.
    Usages {
        /// Missing usages.
        missing: wgpu::TextureUsages,
    },
    /// The first map is in a layer other than 0. OpenGL's shaders read textures only from layer 0 on.
    BaseLayer(u32),
    /// OpenGL does not treat a texture with this number of layers as an array, but as a plain texture or a
    /// cube.
    NoArray(u32),
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
            Self::Samples(samples) => write!(f, "it has {samples} samples per texel: maps have 1"),
            Self::Usages { missing } => write!(f, "it lacks the usage {missing:?}"),
            Self::BaseLayer(layer) => {
                write!(f, "its first map is in layer {layer}: OpenGL's shaders read textures only from layer 0 on")
            }
            Self::NoArray(layers) => {
                write!(
                    f,
                    "OpenGL treats a texture of {layers} layers as a plain texture or a cube, not an array: add a layer"
                )
            }
        }
    }
}

impl core::error::Error for MapTextureError {}
