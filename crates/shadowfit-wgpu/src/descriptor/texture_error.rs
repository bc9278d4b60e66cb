//! Why a texture of the engine cannot hold shadow maps.

use core::fmt;

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
    /// OpenGL has a texture of so many layers, which is given, that is no array: of a single one, or a cube.
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
            Self::Samples(samples) => write!(f, "it has {samples} samples a texel: maps have 1"),
            Self::Usages { missing } => write!(f, "it lacks the usage {missing:?}"),
            Self::BaseLayer(layer) => {
                write!(f, "its first map is in layer {layer}: OpenGL's shaders read textures from layer 0 on only")
            }
            Self::NoArray(layers) => {
                write!(
                    f,
                    "on OpenGL one of {layers} layers is no array, but a plain texture or a cube: give it one more"
                )
            }
        }
    }
}

impl core::error::Error for MapTextureError {}
