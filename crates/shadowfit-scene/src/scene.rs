//! The data of a scene. Import and the built-in scenes create it, renderers and ray tracers read it.
//! Right-handed, y up, metres, radians, column vectors.

use std::ops::{Deref, DerefMut};
use std::path::Path;
use std::sync::Arc;

use glam::{DMat4, DQuat, DVec3, Mat4, Quat, Vec2, Vec3, Vec4};

/// A whole scene: flat arrays that refer to each other by index.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name for titles and reports: the file's stem, or the built-in scene's name.
    pub name: String,
    /// Nodes, every parent before its children.
    pub nodes: Vec<Node>,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Materials. Never empty: index 0 is the default material.
    pub materials: Vec<Material>,
    /// Images that the materials' textures use.
    pub images: Vec<Image>,
    /// Skins.
    pub skins: Vec<Skin>,
    /// Animations.
    pub animations: Vec<Animation>,
    /// Cameras, in the order of their nodes.
    pub cameras: Vec<SceneCamera>,
    /// Directional lights of the file, in the order of their nodes. Empty for built-in scenes.
    pub suns: Vec<SceneSun>,
    /// Origin of the scene's world coordinates in the file's coordinates, in metres. It is zero unless most
    /// of the file's triangles lie far from the file's origin, where `f32` positions are coarse.
    pub origin: DVec3,
    /// Whether blended surfaces cast shadows.
    pub blended_casters: BlendedCasters,
    /// Strongest of [`Scene::suns`] at rest, or the built-in scene's own sun. `None` if no directional light
    /// shines.
    pub sun: Option<Sun>,
    /// Index of the node that cameras should look at, with its descendants, if the scene has one.
    pub subject: Option<usize>,
    /// Readable sentences about elements that import skipped, replaced or repaired.
    pub notes: Vec<String>,
}

impl Scene {
    /// Returns the notes as lines for a terminal, `warning: FILE: NOTE`. Each is a single line. `file` is the
    /// file that the scene was loaded from.
    pub fn warnings(&self, file: &Path) -> impl Iterator<Item = String> {
        self.notes
            .iter()
            .map(move |note| format!("warning: {}: {}", file.display(), note.replace(char::is_control, " ")))
    }
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
    /// Index into [`Scene::meshes`] of the mesh drawn here.
    pub mesh: Option<usize>,
    /// Index into [`Scene::skins`] of the skin that deforms the mesh.
    pub skin: Option<usize>,
    /// Morph weights at rest. If empty, the mesh's weights are used.
    pub morph_weights: Vec<f32>,
}

/// A transform from a node's space to its parent's: translation, rotation and scale, or a matrix. It is
/// `f64`, so that nested transforms of georeferenced files, with translations of millions of metres, are
/// exact to less than a millimetre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Translation, in metres.
    pub translation: DVec3,
    /// Rotation.
    pub rotation: DQuat,
    /// Scale. Negative values mirror.
    pub scale: DVec3,
    /// Matrix that replaces the other three, if the file contains one.
    pub matrix: Option<DMat4>,
}

impl Default for Transform {
    fn default() -> Self {
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE, matrix: None }
    }
}

impl Transform {
    /// Creates a transform without a matrix from `f32` values.
    pub fn new(translation: Vec3, rotation: Quat, scale: Vec3) -> Self {
        let (translation, rotation, scale) = (translation.as_dvec3(), rotation.as_dquat(), scale.as_dvec3());
        Self { translation, rotation, scale, matrix: None }
    }

    /// Returns the matrix from this node's space to its parent's.
    pub fn matrix(&self) -> DMat4 {
        self.matrix
            .unwrap_or_else(|| DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation))
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

impl Mesh {
    /// Returns the number of morph weights of nodes with this mesh.
    pub(crate) fn targets(&self) -> usize {
        self.primitives.iter().map(|primitive| primitive.morphs.len()).max().unwrap_or(0)
    }
}

/// Triangles with one material. It dereferences to its [`Geometry`].
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Vertices and indices. Primitives that differ only in their materials share them. A write copies them
    /// first.
    pub geometry: Arc<Geometry>,
}

impl Deref for Primitive {
    type Target = Geometry;

    fn deref(&self) -> &Geometry {
        &self.geometry
    }
}

impl DerefMut for Primitive {
    fn deref_mut(&mut self) -> &mut Geometry {
        Arc::make_mut(&mut self.geometry)
    }
}

impl From<Geometry> for Primitive {
    /// Creates a primitive with the default material.
    fn from(geometry: Geometry) -> Self {
        Self { material: 0, geometry: Arc::new(geometry) }
    }
}

/// Indexed triangles. Each vertex array has the length of `positions`, or is empty if its field allows that.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Positions, in metres in the mesh's space.
    pub positions: Vec<Vec3>,
    /// Unit normals. Import computes flat ones if the file has none.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the bitangent's sign in w. Empty unless the material has a normal map.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates (set 0), before the material's `uv_from_texcoord`. Empty means (0, 0) everywhere.
    pub uvs: Vec<Vec2>,
    /// Linear vertex colours. Empty if absent.
    pub colors: Vec<Vec4>,
    /// Vertex indices, three for each triangle, counter-clockwise seen from outside, all less than `positions.len()`.
    pub indices: Vec<u32>,
    /// Indices into [`Skin::joints`]: the four joints with the greatest weights at each vertex. Empty if
    /// unskinned.
    pub joints: Vec<[u16; 4]>,
    /// Weights of `joints`, with the sum 1 at each vertex. Empty if unskinned.
    pub weights: Vec<Vec4>,
    /// Morph targets.
    pub morphs: Vec<MorphTarget>,
}

/// Displacements of one morph target, one for each vertex of the primitive.
#[derive(Clone, Debug, Default)]
pub struct MorphTarget {
    /// Displacements of the positions at weight 1, in metres.
    pub positions: Vec<Vec3>,
    /// Changes of the normals at weight 1. Empty if absent.
    pub normals: Vec<Vec3>,
}

/// Use of a material's alpha.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// The surface has a hole where alpha is below the cutoff. Alpha that equals the cutoff is opaque.
    Mask {
        /// Cutoff, 0..=1.
        cutoff: f32,
    },
    /// The surface is blended over the surfaces behind it. [`Scene::blended_casters`] decides whether it
    /// casts.
    Blend,
}

/// Whether blended surfaces cast shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BlendedCasters {
    /// They cast where their alpha (material, texture and vertex colour) is at least 0.5, like cut-outs.
    #[default]
    WhereOpaque,
    /// They cast nothing.
    Never,
}

/// How a primitive casts shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Casting {
    /// It casts nothing.
    Nothing,
    /// All of it casts.
    Whole,
    /// It casts where its alpha (material, texture and vertex colour) is at least this.
    CutOut(f32),
}

/// Least alpha at which blended surfaces cast.
const BLENDED_CUTOFF: f32 = 0.5;

/// Shortfall of alpha that still counts as equal to a cutoff: half of the distance between a cutoff of 0.5
/// and the nearest 8-bit alpha below it. On every device, rounding in texture filters, interpolation and
/// products is smaller. So a surface of uniform alpha gets no stripes, and pictures, shadow maps and rays
/// agree.
const ALPHA_TOLERANCE: f32 = 0.25 / 255.0;

impl AlphaMode {
    /// Returns the least alpha that is opaque where a surface is cut out: in pictures and shadows of masked
    /// materials, and in shadows of blended ones. It is the cutoff minus a tolerance for rounding, at most
    /// half of the cutoff. Returns `None` for opaque materials.
    pub fn least_opaque(self) -> Option<f32> {
        match self {
            Self::Opaque => None,
            // Alpha 0 stays below every cutoff except 0.
            Self::Mask { cutoff } => Some((cutoff - ALPHA_TOLERANCE).max(cutoff * 0.5)),
            Self::Blend => Some(BLENDED_CUTOFF - ALPHA_TOLERANCE),
        }
    }
}

impl Scene {
    /// Returns how a primitive of this scene casts shadows. Shadow maps, rays and boxes all use this.
    pub fn casting(&self, primitive: &Primitive) -> Casting {
        let material = &self.materials[primitive.material];
        let Some(least) = material.alpha.least_opaque() else { return Casting::Whole };
        if material.alpha == AlphaMode::Blend {
            // Texture and vertex colours only lower the material's alpha.
            if self.blended_casters == BlendedCasters::Never || material.base_color.w < least {
                return Casting::Nothing;
            }
            if material.base_color_texture.is_none() && primitive.colors.is_empty() {
                return Casting::Whole;
            }
        }
        Casting::CutOut(least)
    }
}

/// A metallic-roughness material.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name, possibly empty.
    pub name: String,
    /// Linear base colour and alpha.
    pub base_color: Vec4,
    /// Image that is multiplied with `base_color`. Its colours are sRGB encoded.
    pub base_color_texture: Option<Texture>,
    /// Tangent-space normal map. Its values are linear.
    pub normal_texture: Option<Texture>,
    /// Factor on the x and y of the normal map.
    pub normal_scale: f32,
    /// Metalness, 0..=1.
    pub metallic: f32,
    /// Roughness, 0..=1.
    pub roughness: f32,
    /// Emitted radiance, linear colour.
    pub emissive: Vec3,
    /// Use of alpha.
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

/// An image and its sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Index into [`Scene::images`].
    pub image: usize,
    /// Wrap mode along u and v.
    pub wrap: [Wrap; 2],
    /// Whether magnification takes the nearest texel instead of interpolating.
    pub nearest: bool,
    /// Rows of the 2×3 matrix of `KHR_texture_transform`, which computes image coordinates from (u, v, 1) of
    /// the vertex.
    pub uv_from_texcoord: [Vec3; 2],
}

impl Texture {
    /// Returns the image coordinates of a mesh's texture coordinates.
    pub fn in_image(&self, uv: Vec2) -> Vec2 {
        let at = uv.extend(1.0);
        Vec2::new(self.uv_from_texcoord[0].dot(at), self.uv_from_texcoord[1].dot(at))
    }
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

/// The joints that deform a mesh.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Indices into [`Scene::nodes`].
    pub joints: Vec<usize>,
    /// For each joint, the matrix from mesh space to joint space in the pose in which the mesh was modelled.
    pub joint_from_mesh: Vec<Mat4>,
}

/// A camera of a scene.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    /// Name, possibly empty.
    pub name: String,
    /// Index of its node. The camera looks along the node's -z, with +y up.
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
        /// Far distance, in metres. `None` is infinite.
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

/// A directional light of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSun {
    /// Name, possibly empty.
    pub name: String,
    /// Index of its node. The light travels along the node's -z.
    pub node: usize,
    /// Linear colour, each component at least 0.
    pub color: Vec3,
    /// Illuminance, in lux, at least 0.
    pub intensity: f32,
}

/// The sun that lights a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit direction of travel of the light, in world space at rest.
    pub direction: Vec3,
    /// Linear colour, each component at least 0.
    pub color: Vec3,
    /// Illuminance, in lux.
    pub intensity: f32,
}

/// Keyframes of any number of nodes, played in a loop.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name, possibly empty.
    pub name: String,
    /// Length of the loop, in seconds.
    pub duration: f32,
    /// Channels.
    pub channels: Vec<Channel>,
}

/// Keyframes of one property of one node.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Index of the node that moves.
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
    /// The value of the earlier key.
    Step,
    /// Cubic Hermite spline: three values for each key (in-tangent, value, out-tangent).
    CubicSpline,
}

/// Values of a [`Channel`], one for each key (three for cubic splines).
#[derive(Clone, Debug)]
pub enum ChannelValues {
    /// Translations, in metres.
    Translation(Vec<Vec3>),
    /// Rotations.
    Rotation(Vec<Quat>),
    /// Scales.
    Scale(Vec<Vec3>),
    /// Morph weights, key after key.
    MorphWeights(Vec<f32>),
}
