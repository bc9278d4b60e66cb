//! A frame of a classic sample: plain data, and the uniform that its shaders read.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera};
use shadowfit_render::shaders;

use super::SampleFormat;

/// A sample's map: its size, its contents and the faces that are drawn into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleMapSettings {
    /// Width and height, in texels.
    pub size: [u32; 2],
    /// Format of the texels.
    pub format: SampleFormat,
    /// Stored depth.
    pub depth: StoredDepth,
    /// Value that the map is cleared to, 0 or 1. 1 is the farthest depth of most samples.
    pub clear: u8,
    /// Faces that are drawn into it.
    pub faces: CasterFaces,
    /// Whether a comparison sampler filters 2 × 2 texels. Other maps are read as their test specifies.
    pub compares_linearly: bool,
}

impl SampleMapSettings {
    /// Returns a map of all faces, with a size in texels and a format, that is cleared to the farthest depth.
    pub const fn new(size: [u32; 2], format: SampleFormat) -> Self {
        Self { size, format, depth: StoredDepth::Plain, clear: 1, faces: CasterFaces::All, compares_linearly: false }
    }
}

/// Depth that a map stores, from a caster's depth after the division by w.
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
    /// All faces.
    #[default]
    All,
    /// Faces toward the light.
    Front,
    /// Faces away from the light.
    Back,
}

/// A sample's light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleLight {
    /// Matrix to the clip space (depth 0 to 1) of the light's image from positions relative to the **camera's
    /// eye**.
    pub clip_from_world: Mat4,
    /// Position or direction of the light.
    pub place: LightPlace,
    /// Image that the light projects.
    pub image: LightImage,
}

/// Position or direction of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPlace {
    /// Infinitely far, in this unit direction (toward the light, world axes).
    Toward(Vec3),
    /// At a position in world space.
    At(DVec3),
}

/// Image that a lamp projects, if its test reads one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum LightImage {
    /// White everywhere. The square's corners are visible.
    #[default]
    Square,
    /// A round beam with a soft rim.
    Round,
    /// Two beams side by side, like headlights.
    Headlights,
}

/// Access of a shadow test to the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapRead {
    /// No access.
    Nothing,
    /// Stored depths.
    Stored,
    /// Comparisons by the sampler. The map must be [`SampleFormat::Depth32`].
    Compared,
}

/// Shadow test of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowTest {
    /// Name, the key of cached pipelines.
    pub name: &'static str,
    /// WGSL with `fn light_share(point: Point) -> f32`.
    pub wgsl: &'static str,
    /// Numbers for the WGSL, as `sample.test`.
    pub numbers: [f32; 4],
    /// Further numbers for the WGSL, as `sample.further`.
    pub further: [f32; 4],
    /// Access to the map.
    pub reads: MapRead,
    /// Reach of the test in the map, in texels from the point to the centre of a texel.
    pub reach: f32,
}

/// Shading of a sample's surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shading {
    /// Name, the key of cached pipelines.
    pub name: &'static str,
    /// Pieces of WGSL, the last one with `fn colour(point: Point, share: f32) -> vec3<f32>`.
    pub wgsl: &'static [&'static str],
    /// Numbers for the WGSL, the first two of `sample.shading`.
    pub numbers: [f32; 2],
    /// Whether the shading reads the map itself.
    pub reads_map: bool,
}

impl ShadowTest {
    /// A test that lights all points.
    pub const OFF: Self =
        Self { reads: MapRead::Nothing, ..Self::nearest("off", include_str!("test_none.wgsl"), [0.0; 4]) };

    /// Returns a test that reads the nearest texel.
    pub const fn nearest(name: &'static str, wgsl: &'static str, numbers: [f32; 4]) -> Self {
        Self { name, wgsl, numbers, further: [0.0; 4], reads: MapRead::Stored, reach: 0.5 }
    }
}

impl Shading {
    /// Returns a shading from pieces of WGSL.
    pub const fn new(name: &'static str, wgsl: &'static [&'static str], numbers: [f32; 2]) -> Self {
        Self { name, wgsl, numbers, reads_map: false }
    }

    /// Returns modern lighting: linear, with the reflectance and the tone curve of the other scenes. `light`
    /// is the irradiance of the light, `ambient` the irradiance of sky and ground.
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
    /// Shadow test.
    pub test: ShadowTest,
    /// Shading of surfaces.
    pub shading: Shading,
    /// Background colour, as display values.
    pub background: [u8; 3],
    /// Whether the picture also shows back faces.
    pub double_sided: bool,
}

/// Additional contents of a frame.
#[derive(Clone, Copy, Default)]
pub struct FrameExtras<'a> {
    /// Draws the background, in place of the background colour.
    pub behind: Option<&'a dyn Fn(&mut wgpu::RenderPass<'_>)>,
    /// Whether each node of the scene casts. All cast if `None`.
    pub casts: Option<&'a [bool]>,
    /// Rectangle of the map's inset: left, top, width and height, in pixels.
    pub inset: Option<[u32; 4]>,
}

/// Uniform of a sample's shaders: `Sample` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SampleUniform {
    /// Matrix to clip space (reversed depth) from positions relative to the eye.
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
    /// Pads the struct to a multiple of 16 bytes.
    pub padding: [f32; 2],
}

impl SampleUniform {
    /// Creates the uniform of a frame.
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
