//! What a frame of a classic sample shows: plain data, and the uniform that its shaders read.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera, SpotBias};

use super::SampleFormat;

/// A sample's map: how large it is, what it stores and which faces are drawn into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleMapSettings {
    /// Width and height, in texels.
    pub size: [u32; 2],
    /// Format of the texels.
    pub format: SampleFormat,
    /// What is stored.
    pub depth: StoredDepth,
    /// Value that the map is cleared to, 0 or 1: the farthest depth of most samples is 1.
    pub clear: u8,
    /// Faces that are drawn into it.
    pub faces: CasterFaces,
    /// Whether a comparison sampler takes 2 × 2 texels. Other maps are read as their test does.
    pub compares_linearly: bool,
}

/// What a map stores of a caster's depth after the division by w.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum StoredDepth {
    /// The depth of each fragment.
    #[default]
    Plain,
    /// One minus the depth, computed at the vertices and interpolated.
    ReversedAtVertices,
}

/// Faces of casters that are drawn into a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum CasterFaces {
    /// All of them.
    #[default]
    All,
    /// Those that face the light.
    Front,
    /// Those that face away from it.
    Back,
}

/// A sample's light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleLight {
    /// Clip space (depth 0 to 1) of the light's image from positions relative to the **camera's eye**.
    pub clip_from_world: Mat4,
    /// Where its light comes from.
    pub place: LightPlace,
    /// The picture that it throws.
    pub image: LightImage,
}

/// Where a light is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPlace {
    /// Infinitely far, in this unit direction (toward the light, world axes).
    Toward(Vec3),
    /// At a position in world space.
    At(DVec3),
}

/// The picture that a lamp throws, where its test reads one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum LightImage {
    /// White all over: the square of the image shows its corners.
    #[default]
    Square,
    /// A round beam with a soft rim.
    Round,
    /// Two beams side by side, as headlights throw.
    Headlights,
}

/// How a sample tells light from shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShadowTest {
    /// Everything is lit.
    Off,
    /// XNA Shadow Mapping: the nearest texel, in shadow where stored < depth - bias.
    Xna {
        /// In units of the stored depth.
        bias: f32,
    },
    /// Headlight street: linear, lit inside the light's image where depth - bias <= stored.
    RealShadow {
        /// In units of the stored depth.
        bias: f32,
    },
    /// A comparison sampler; needs [`SampleFormat::Depth32`].
    Comparison {
        /// Epsilon of the angle's term.
        epsilon: f32,
        /// Whether it moves the compared depth toward the light. The source moves it away, for maps of back faces.
        toward_light: bool,
    },
    /// Terrain: the nearest texel, in shadow where stored - `off_stored` > `from` - depth.
    Terrain {
        /// What is taken from the stored depth.
        off_stored: f32,
        /// What the depth is taken from.
        from: f32,
    },
    /// Ours: the core's bias and a filter of 3 × 3 look-ups of 2 × 2 texels, which reach 2 texels; needs a lamp (a light
    /// with an axis) and [`SampleFormat::Depth32`] that compares linearly.
    Ours {
        /// The core's bias for the lamp's map. Its receiver-plane term is ignored; [`SpotBias::automatic`] leaves it at 0.
        bias: SpotBias,
        /// Whether points outside of the light's image are lit.
        lit_outside: bool,
    },
}

/// How a sample's surfaces are coloured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// XNA Shadow Mapping.
    Xna {
        /// Ambient light, which the texture does not colour.
        ambient: f32,
    },
    /// The map's grey, projected on the scene.
    Projective,
    /// Headlight street.
    Headlight {
        /// Factor of the diffuse light.
        power: f32,
        /// Ambient light.
        ambient: f32,
    },
    /// Depth testing with a comparison sampler.
    Comparison {
        /// Ambient light.
        ambient: f32,
    },
    /// Terrain.
    Terrain {
        /// Factor of N·L.
        diffuse: f32,
        /// Ambient light.
        ambient: f32,
    },
    /// Modern lighting: linear, with the reflectance and the tone curve of the other scenes.
    Modern {
        /// Irradiance of the light.
        light: f32,
        /// Irradiance of sky and ground.
        ambient: f32,
    },
}

/// A frame of a sample.
#[derive(Clone, Copy, Debug)]
pub struct SampleFrame<'a> {
    /// Eye and lens.
    pub camera: PerspectiveCamera,
    /// Light.
    pub light: SampleLight,
    /// Its map.
    pub map: SampleMapSettings,
    /// How light is told from shadow.
    pub test: ShadowTest,
    /// How surfaces are coloured.
    pub shading: Shading,
    /// Colour behind everything, as display values.
    pub background: [u8; 3],
    /// Whether each node of the scene casts; all do where there is none.
    pub casts: Option<&'a [bool]>,
    /// Whether back faces are drawn in the picture, too.
    pub double_sided: bool,
    /// Where the map is shown: left, top, width and height, in pixels.
    pub inset: Option<[u32; 4]>,
}

/// What a sample's shaders read: `Sample` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SampleUniform {
    /// Clip space (reversed depth) from positions relative to the eye.
    pub clip_from_world: [[f32; 4]; 4],
    /// [`SampleLight::clip_from_world`].
    pub light_from_world: [[f32; 4]; 4],
    /// Direction toward the light and 0, or its position relative to the eye and 1.
    pub light: [f32; 4],
    /// Numbers of the test.
    pub test: [f32; 4],
    /// Numbers of the shading.
    pub shading: [f32; 4],
    /// Width and height of the map, in texels.
    pub map_size: [f32; 2],
    /// Numbers of our test's lift along the normal.
    pub lift: [f32; 2],
}

impl SampleUniform {
    /// The uniform of a frame.
    pub fn new(frame: &SampleFrame<'_>) -> Self {
        let light = match frame.light.place {
            LightPlace::Toward(direction) => direction.extend(0.0),
            LightPlace::At(position) => (position - frame.camera.eye).as_vec3().extend(1.0),
        };
        Self {
            clip_from_world: frame.camera.clip_from_world(DepthConvention::Reversed).to_cols_array_2d(),
            light_from_world: frame.light.clip_from_world.to_cols_array_2d(),
            light: light.to_array(),
            test: frame.test.numbers(),
            shading: frame.shading.numbers(),
            map_size: frame.map.size.map(|side| side as f32),
            lift: frame.test.lift(),
        }
    }
}

impl ShadowTest {
    fn numbers(self) -> [f32; 4] {
        match self {
            Self::Off => [0.0; 4],
            Self::Xna { bias } | Self::RealShadow { bias } => [bias, 0.0, 0.0, 0.0],
            Self::Comparison { epsilon, toward_light } => [epsilon, if toward_light { -1.0 } else { 1.0 }, 0.0, 0.0],
            Self::Terrain { off_stored, from } => [off_stored, from, 0.0, 0.0],
            Self::Ours { bias, lit_outside } => {
                let SpotBias { constant_depth, distance_depth, slope_depth, .. } = bias;
                [constant_depth, distance_depth, slope_depth, if lit_outside { 1.0 } else { 0.0 }]
            }
        }
    }

    fn lift(self) -> [f32; 2] {
        match self {
            Self::Ours { bias, .. } => [bias.normal_offset, bias.constant_offset],
            _ => [0.0; 2],
        }
    }
}

impl Shading {
    fn numbers(self) -> [f32; 4] {
        let [x, y] = match self {
            Self::Projective => [0.0; 2],
            Self::Xna { ambient } | Self::Comparison { ambient } => [ambient, 0.0],
            Self::Headlight { power, ambient } => [power, ambient],
            Self::Terrain { diffuse, ambient } => [diffuse, ambient],
            Self::Modern { light, ambient } => [light, ambient],
        };
        [x, y, 0.0, 0.0]
    }
}
