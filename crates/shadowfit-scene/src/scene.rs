//! The data of a scene on the CPU: what import and the built-in scenes produce, and what renderers
//! and ray tracers read. Right-handed, y up, metres, radians, column vectors.

use glam::{Mat4, Quat, Vec2, Vec3, Vec4};

/// A whole scene: flat arrays that refer to each other by index.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name for titles and reports: the file's stem, or the built-in scene's name.
    pub name: String,
    /// Nodes, every parent before its children.
    pub nodes: Vec<Node>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Materials; never empty, index 0 is the default material.
    pub materials: Vec<Material>,
    /// Images that the materials' textures use.
    pub images: Vec<Image>,
    /// Skins.
    pub skins: Vec<Skin>,
    /// Animations.
    pub animations: Vec<Animation>,
    /// Cameras that the file brings.
    pub cameras: Vec<SceneCamera>,
    /// Directional light that the file brings: the first one found.
    pub sun: Option<Sun>,
    /// Node whose descendants are what the eye should be on, if the scene has such a thing.
    pub subject: Option<usize>,
    /// What import skipped, replaced or repaired, for people.
    pub notes: Vec<String>,
}

/// A node of the transform tree.
#[derive(Clone, Debug, Default)]
pub struct Node {
    /// Name, possibly empty.
    pub name: String,
    /// Index of the parent, always smaller than the node's own.
    pub parent: Option<usize>,
    /// Transform at rest, relative to the parent.
    pub rest: Transform,
    /// Mesh drawn here.
    pub mesh: Option<usize>,
    /// Skin that deforms the mesh.
    pub skin: Option<usize>,
    /// Morph weights at rest; empty means the mesh's own.
    pub morph_weights: Vec<f32>,
}

/// Translation, rotation and scale; a node given as a matrix keeps it as `matrix` instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Translation, in metres.
    pub translation: Vec3,
    /// Rotation.
    pub rotation: Quat,
    /// Scale; negative values mirror.
    pub scale: Vec3,
    /// Replaces the other three where the file gives a matrix.
    pub matrix: Option<Mat4>,
}

impl Default for Transform {
    fn default() -> Self {
        Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE, matrix: None }
    }
}

/// A mesh: primitives that share a node.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name, possibly empty.
    pub name: String,
    /// Primitives, each with one material.
    pub primitives: Vec<Primitive>,
    /// Morph weights at rest.
    pub morph_weights: Vec<f32>,
}

/// Indexed triangles with one material. All vertex arrays have the length of `positions` or are
/// empty where said so.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Positions, in metres in the mesh's space.
    pub positions: Vec<Vec3>,
    /// Unit normals; computed flat where the file has none.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the bitangent's sign in w; empty unless the material has a normal map.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates (set 0), before the material's `uv_from_texcoord`; (0, 0) where absent.
    pub uvs: Vec<Vec2>,
    /// Linear vertex colours; empty where absent.
    pub colors: Vec<Vec4>,
    /// Indices, three a triangle, all smaller than `positions.len()`.
    pub indices: Vec<u32>,
    /// Joint indices into the skin, with the four greatest weights, normalised; empty if unskinned.
    pub joints: Vec<[u16; 4]>,
    /// Weights that belong to `joints`; empty if unskinned.
    pub weights: Vec<Vec4>,
    /// Morph targets.
    pub morphs: Vec<MorphTarget>,
}

/// Displacements of one morph target, as long as the primitive's positions.
#[derive(Clone, Debug, Default)]
pub struct MorphTarget {
    /// Added to the positions, times the weight.
    pub positions: Vec<Vec3>,
    /// Added to the normals, times the weight; empty where absent.
    pub normals: Vec<Vec3>,
}

/// How alpha is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Fragments with alpha below the cutoff are absent.
    Mask {
        /// Cutoff, 0..=1.
        cutoff: f32,
    },
    /// Blended over what lies behind; casts nothing.
    Blend,
}

/// A metallic-roughness material.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name, possibly empty.
    pub name: String,
    /// Linear base colour and alpha.
    pub base_color: Vec4,
    /// Multiplied with `base_color`; sRGB encoded image.
    pub base_color_texture: Option<Texture>,
    /// Tangent-space normal map; linear image.
    pub normal_texture: Option<Texture>,
    /// Scale of the normal map's x and y.
    pub normal_scale: f32,
    /// Metalness, 0..=1.
    pub metallic: f32,
    /// Roughness, 0..=1.
    pub roughness: f32,
    /// Linear emitted radiance.
    pub emissive: Vec3,
    /// How alpha is read.
    pub alpha: AlphaMode,
    /// Whether back faces are drawn.
    pub double_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            metallic: 0.0,
            roughness: 0.8,
            emissive: Vec3::ZERO,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}

/// A use of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index into [`Scene::images`].
    pub image: usize,
    /// Wrap mode along u and v.
    pub wrap: [Wrap; 2],
    /// Whether magnification is nearest instead of linear.
    pub nearest: bool,
    /// Rows of the 2×3 matrix of `KHR_texture_transform`: `uv = rows * (u, v, 1)`.
    pub uv_from_texcoord: [Vec3; 2],
}

/// Wrap mode of a texture axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Repeats.
    #[default]
    Repeat,
    /// Repeats mirrored.
    Mirror,
    /// Clamps to the edge.
    Clamp,
}

/// An 8-bit RGBA image, rows from the top.
#[derive(Clone, Debug, Default)]
pub struct Image {
    /// Name for messages.
    pub name: String,
    /// Width, in pixels, at least 1.
    pub width: u32,
    /// Height, in pixels, at least 1.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub rgba: Vec<u8>,
}

/// Joints that deform a mesh.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Nodes that serve as joints.
    pub joints: Vec<usize>,
    /// One matrix a joint: joint space from mesh space at bind time.
    pub joint_from_mesh: Vec<Mat4>,
}

/// A camera that the file brings.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    /// Name, possibly empty.
    pub name: String,
    /// Node that carries it: looks along its -z, y up.
    pub node: usize,
    /// Lens.
    pub lens: Lens,
}

/// Lens of a [`SceneCamera`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Perspective.
    Perspective {
        /// Vertical field of view, in radians.
        fov_y: f32,
        /// Near distance, in metres.
        near: f32,
        /// Far distance, in metres; `None` is infinite.
        far: Option<f32>,
    },
    /// Orthographic.
    Orthographic {
        /// Half of the height, in metres.
        half_height: f32,
        /// Near distance, in metres.
        near: f32,
        /// Far distance, in metres.
        far: f32,
    },
}

/// A directional light that the file brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit direction of travel of the light, in world space at rest.
    pub direction: Vec3,
    /// Linear colour.
    pub color: Vec3,
    /// Illuminance, in lux.
    pub intensity: f32,
}

/// A clip of keyframes.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name, possibly empty.
    pub name: String,
    /// Length, in seconds; it plays in a loop.
    pub duration: f32,
    /// Channels.
    pub channels: Vec<Channel>,
}

/// Keyframes of one property of one node.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Node that moves.
    pub node: usize,
    /// Times, in seconds, ascending.
    pub times: Vec<f32>,
    /// Interpolation between them.
    pub interpolation: Interpolation,
    /// Values.
    pub values: ChannelValues,
}

/// Interpolation between keyframes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Linear, spherical for rotations.
    #[default]
    Linear,
    /// Holds the earlier value.
    Step,
    /// Cubic Hermite: three values a key (in-tangent, value, out-tangent).
    CubicSpline,
}

/// Values of a [`Channel`], one a key (three for cubic splines).
#[derive(Clone, Debug)]
pub enum ChannelValues {
    /// Translations, in metres.
    Translation(Vec<Vec3>),
    /// Rotations.
    Rotation(Vec<Quat>),
    /// Scales.
    Scale(Vec<Vec3>),
    /// Morph weights, all of a key together.
    MorphWeights(Vec<f32>),
}
