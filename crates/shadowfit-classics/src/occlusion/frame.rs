//! A picture with ambient occlusion: plain data, and the uniform of its shaders.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use shadowfit::{DepthConvention, PerspectiveCamera};

/// Method of computing occlusion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OcclusionMethod {
    /// By the angles between a pixel's normal and its neighbours in space.
    #[default]
    Normals,
    /// By depth alone: the share of points of a sphere around each pixel's surface that lie behind visible
    /// surfaces. It has two known flaws. Half of the sphere lies behind any wall, so flat faces turn grey.
    /// Surfaces far in front do not occlude, so walls have a pale halo around objects. It uses only the
    /// radius (of a sphere that appears equally high), [`OcclusionSettings::blur`] and
    /// [`OcclusionSettings::second_radius`].
    DepthOnly,
}

/// Settings of ambient occlusion.
///
/// The defaults are for scenes in metres. They were chosen by comparison with ray-traced occlusion (32 rays,
/// distance 1 m, linear fall-off): 81 settings on the built-in arcade, then 27 on arcade and courtyard. A
/// [`Self::second_radius`] of 0.15 is slightly closer to the rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionSettings {
    /// Reach of the neighbours in the scene's units. Divided by a pixel's view depth, it is a distance in
    /// texture coordinates, 0 to 1 along each side of the picture.
    pub radius: f32,
    /// Factor on distances before the fall-off 1 / (1 + d), in 1 / the scene's units.
    pub scale: f32,
    /// Cosine between normal and neighbour below which a neighbour does not occlude, 0 or more.
    pub bias: f32,
    /// Factor on the occlusion by front faces.
    pub intensity: f32,
    /// Whether back faces also occlude. They represent surfaces behind the nearest one.
    pub back_faces: bool,
    /// Whether near pixels use more directions than far ones: six to two instead of four.
    pub level_of_detail: bool,
    /// Whether occlusion is averaged over four pixels each way.
    pub blur: bool,
    /// Radius of a second pass. At each pixel the greater occlusion of both counts.
    pub second_radius: Option<f32>,
    /// Method of computing occlusion.
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
    /// Returns whether a buffer of back faces is read.
    pub(super) fn reads_backs(&self) -> bool {
        self.back_faces && self.method == OcclusionMethod::Normals
    }
}

/// Sun and ambient light: factors on display values, or on linear ones for [`OcclusionView::Modern`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionLight {
    /// Unit direction toward the sun, in world axes.
    pub to_light: Vec3,
    /// Light from all directions, which occlusion darkens.
    pub ambient: Vec3,
    /// Additional light of a surface that faces the sun.
    pub diffuse: Vec3,
}

impl OcclusionLight {
    /// Returns a white sun in the given unit direction and a strong ambient light, which makes occlusion easy
    /// to see.
    pub fn new(to_light: Vec3) -> Self {
        Self { to_light, ambient: Vec3::splat(0.55), diffuse: Vec3::splat(0.45) }
    }
}

/// Contents of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OcclusionView {
    /// The scene in display values, without linearisation or tone curve.
    #[default]
    Classic,
    /// The scene in linear light with the tone curve of the shaded pass.
    Modern,
    /// Occlusion alone in grey. White is open.
    Occlusion,
}

/// A frame with ambient occlusion. It has no shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionFrame {
    /// Sun and ambient light.
    pub light: OcclusionLight,
    /// Settings of occlusion. Without them, ambient light is not darkened.
    pub settings: Option<OcclusionSettings>,
    /// Contents of the picture.
    pub view: OcclusionView,
    /// Background colour, in display values.
    pub background: Vec3,
}

/// Uniform of the passes of ambient occlusion: `Occlusion` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OcclusionUniform {
    /// Matrix to view space from positions relative to the eye.
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
    /// Pads the colours to multiples of 16 bytes.
    pub padding_0: f32,
    /// Padding.
    pub padding_1: f32,
    /// Padding.
    pub padding_2: f32,
    /// [`OcclusionLight::ambient`].
    pub ambient: [f32; 4],
    /// [`OcclusionLight::diffuse`].
    pub diffuse: [f32; 4],
}

impl OcclusionUniform {
    /// Creates the uniform of a camera, a light and settings. Negative and NaN numbers count as 0.
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
