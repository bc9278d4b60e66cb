//! What a frame of a classic sample shows: plain data, and the uniform that its shaders read.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera};
use shadowfit_render::shaders;

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

impl SampleMapSettings {
    /// A map of all faces, of a size in texels and a format, that is cleared to the farthest depth.
    pub const fn new(size: [u32; 2], format: SampleFormat) -> Self {
        Self { size, format, depth: StoredDepth::Plain, clear: 1, faces: CasterFaces::All, compares_linearly: false }
    }
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

/// What a shadow test reads of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapRead {
    /// Nothing.
    Nothing,
    /// Stored depths.
    Stored,
    /// Comparisons by the sampler, for which the map has to be [`SampleFormat::Depth32`].
    Compared,
}

/// How a sample tells light from shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowTest {
    /// Its name, by which pipelines are kept.
    pub name: &'static str,
    /// WGSL with `fn light_share(point: Point) -> f32`.
    pub wgsl: &'static str,
    /// What the WGSL reads as `sample.test`.
    pub numbers: [f32; 4],
    /// What it reads besides, as `sample.further`.
    pub further: [f32; 4],
    /// What it reads of the map.
    pub reads: MapRead,
    /// How far it reads, in texels to the centre of a texel.
    pub reach: f32,
}

/// How a sample's surfaces are coloured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading {
    /// Its name, by which pipelines are kept.
    pub name: &'static str,
    /// Pieces of WGSL, the last one with `fn colour(point: Point, share: f32) -> vec3<f32>`.
    pub wgsl: &'static [&'static str],
    /// What the WGSL reads as the first two of `sample.shading`.
    pub numbers: [f32; 2],
    /// Whether it reads the map itself.
    pub reads_map: bool,
}

impl ShadowTest {
    /// Everything is lit.
    pub const OFF: Self =
        Self { reads: MapRead::Nothing, ..Self::nearest("off", include_str!("test_none.wgsl"), [0.0; 4]) };

    /// A test of the nearest texel.
    pub const fn nearest(name: &'static str, wgsl: &'static str, numbers: [f32; 4]) -> Self {
        Self { name, wgsl, numbers, further: [0.0; 4], reads: MapRead::Stored, reach: 0.5 }
    }
}

impl Shading {
    /// A shading of one piece of WGSL.
    pub const fn new(name: &'static str, wgsl: &'static [&'static str], numbers: [f32; 2]) -> Self {
        Self { name, wgsl, numbers, reads_map: false }
    }

    /// Modern lighting: linear, with the reflectance and the tone curve of the other scenes, for an irradiance of the light
    /// and one of sky and ground.
    pub const fn modern(light: f32, ambient: f32) -> Self {
        const PIECES: [&str; 4] =
            [shaders::POWERS, shaders::TONE_MAP, shaders::REFLECTANCE, include_str!("shade_modern.wgsl")];
        Self::new("modern", &PIECES, [light, ambient])
    }
}

/// Cornflower blue, the background of several sources, as display values.
pub const CORNFLOWER: [u8; 3] = [100, 149, 237];

/// A frame of a sample.
#[derive(Clone, Copy, Debug)]
pub struct SampleFrame {
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
    /// Whether back faces are drawn in the picture, too.
    pub double_sided: bool,
}

/// What a frame shows besides.
#[derive(Clone, Copy, Default)]
pub struct FrameExtras<'a> {
    /// Draws what is seen behind everything, in place of the background.
    pub behind: Option<&'a dyn Fn(&mut wgpu::RenderPass<'_>)>,
    /// Whether each node of the scene casts; all do where there is none.
    pub casts: Option<&'a [bool]>,
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
    /// Further numbers of the test.
    pub further: [f32; 4],
    /// Numbers of the shading.
    pub shading: [f32; 4],
    /// Width and height of the map, in texels.
    pub map_size: [f32; 2],
    /// Keeps the struct a multiple of 16 bytes.
    pub padding: [f32; 2],
}

impl SampleUniform {
    /// The uniform of a frame.
    pub fn new(frame: &SampleFrame) -> Self {
        let light = match frame.light.place {
            LightPlace::Toward(direction) => direction.extend(0.0),
            LightPlace::At(position) => (position - frame.camera.eye).as_vec3().extend(1.0),
        };
        Self {
            clip_from_world: frame.camera.clip_from_world(DepthConvention::Reversed).to_cols_array_2d(),
            light_from_world: frame.light.clip_from_world.to_cols_array_2d(),
            light: light.to_array(),
            test: frame.test.numbers,
            further: frame.test.further,
            shading: [frame.shading.numbers[0], frame.shading.numbers[1], 0.0, 0.0],
            map_size: frame.map.size.map(|side| side as f32),
            padding: [0.0; 2],
        }
    }
}
