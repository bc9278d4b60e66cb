//! What a picture with ambient occlusion shows: plain data, and the uniform made of it.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use shadowfit::{DepthConvention, PerspectiveCamera};

/// How occlusion is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OcclusionMethod {
    /// By the angles between a pixel's normal and its neighbours in space.
    #[default]
    Normals,
    /// By depth alone: points of a sphere around each pixel's surface, of which some lie behind what is seen there. It has
    /// two known flaws: half of the sphere lies behind any wall, so that flat faces turn grey; and what is far in front
    /// hides nothing, so that walls have a pale halo around objects. It uses the radius alone, as that of a sphere which
    /// looks as high, and [`OcclusionSettings::blur`] and [`OcclusionSettings::second_radius`].
    DepthOnly,
}

/// How ambient occlusion is computed.
///
/// The defaults are for scenes in metres. They were chosen by runs against ray-traced occlusion (32 rays, distance 1 m,
/// linear fall-off): 81 settings on the built-in arcade, then 27 on arcade and courtyard. A [`Self::second_radius`] of
/// 0.15 comes a little nearer still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionSettings {
    /// Reach of the neighbours: divided by a pixel's view depth, in the scene's units, it is a distance in texture
    /// coordinates, which run from 0 to 1 along each side of the picture.
    pub radius: f32,
    /// Factor on distances before the fall-off 1 / (1 + d), in 1 / the scene's units.
    pub scale: f32,
    /// Cosine between normal and neighbour up to which nothing is hidden, 0 or more.
    pub bias: f32,
    /// Factor on what front faces hide.
    pub intensity: f32,
    /// Whether back faces hide too: what lies behind the nearest surface is seen there.
    pub back_faces: bool,
    /// Whether near pixels take more directions than far ones: six to two instead of four.
    pub level_of_detail: bool,
    /// Whether occlusion is averaged over four pixels each way.
    pub blur: bool,
    /// Radius of a second pass; at each pixel the greater occlusion of both counts.
    pub second_radius: Option<f32>,
    /// How occlusion is found.
    pub method: OcclusionMethod,
}

impl Default for OcclusionSettings {
    fn default() -> Self {
        Self {
            radius: 0.5,
            scale: 2.0,
            bias: 0.1,
            intensity: 3.0,
            back_faces: false,
            level_of_detail: false,
            blur: true,
            second_radius: None,
            method: OcclusionMethod::Normals,
        }
    }
}

impl OcclusionSettings {
    /// Whether a buffer of back faces is read.
    pub(super) fn reads_backs(&self) -> bool {
        self.back_faces && self.method == OcclusionMethod::Normals
    }
}

/// Sun and ambient light: factors on display values, or on linear ones for [`OcclusionView::Modern`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionLight {
    /// Unit direction toward the sun, in world axes.
    pub to_light: Vec3,
    /// Light from everywhere, which occlusion darkens.
    pub ambient: Vec3,
    /// Light that a surface facing the sun gets besides.
    pub diffuse: Vec3,
}

impl OcclusionLight {
    /// A white sun in the given unit direction and a strong ambient light, by which occlusion is easy to see.
    pub fn new(to_light: Vec3) -> Self {
        Self { to_light, ambient: Vec3::splat(0.55), diffuse: Vec3::splat(0.45) }
    }
}

/// What a picture shows of occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OcclusionView {
    /// The scene in display values, without linearisation or tone curve.
    #[default]
    Classic,
    /// The scene in linear light with the tone curve of the shaded pass.
    Modern,
    /// Occlusion alone in grey: white where nothing is hidden.
    Occlusion,
}

/// What a picture shows. There are no shadows in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionFrame {
    /// Sun and ambient light.
    pub light: OcclusionLight,
    /// How occlusion is computed; nothing is hidden where `None`.
    pub settings: Option<OcclusionSettings>,
    /// What is shown.
    pub view: OcclusionView,
    /// Colour behind the scene, in display values.
    pub background: Vec3,
}

/// What the passes of ambient occlusion read: `Occlusion` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OcclusionUniform {
    /// View space from positions relative to the eye.
    pub view_from_world: [[f32; 4]; 4],
    /// Texture coordinates of a view-space point are 0.5 + this * (x, y) / view depth.
    pub uv_from_view: [f32; 2],
    /// Height of a picture at view depth 1.
    pub height: f32,
    /// View depth of the far plane.
    pub far: f32,
    /// [`OcclusionSettings::radius`].
    pub radius: f32,
    /// [`OcclusionSettings::scale`].
    pub scale: f32,
    /// [`OcclusionSettings::bias`].
    pub bias: f32,
    /// [`OcclusionSettings::intensity`].
    pub intensity: f32,
    /// 1 with [`OcclusionSettings::level_of_detail`], else 0.
    pub detail: f32,
    /// Keeps the colours at multiples of 16 bytes.
    pub padding_0: f32,
    /// As above.
    pub padding_1: f32,
    /// As above.
    pub padding_2: f32,
    /// [`OcclusionLight::ambient`].
    pub ambient: [f32; 4],
    /// [`OcclusionLight::diffuse`].
    pub diffuse: [f32; 4],
}

impl OcclusionUniform {
    /// The uniform of a camera, a light, and settings; negative and NaN numbers count as 0.
    pub fn new(camera: &PerspectiveCamera, light: &OcclusionLight, settings: &OcclusionSettings) -> Self {
        let clip_from_view = camera.clip_from_view(DepthConvention::Reversed);
        Self {
            view_from_world: camera.view_from_world().to_cols_array_2d(),
            uv_from_view: [0.5 * clip_from_view.x_axis.x, -0.5 * clip_from_view.y_axis.y],
            height: 2.0 * (camera.fov_y * 0.5).tan(),
            far: camera.far,
            radius: settings.radius.max(0.0),
            scale: settings.scale.max(0.0),
            bias: settings.bias.max(0.0),
            intensity: settings.intensity.max(0.0),
            detail: f32::from(u8::from(settings.level_of_detail)),
            ambient: light.ambient.extend(0.0).to_array(),
            diffuse: light.diffuse.extend(0.0).to_array(),
            ..Self::default()
        }
    }
}
