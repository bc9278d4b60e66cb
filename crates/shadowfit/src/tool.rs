//! Settings of tools that tune shadows: the sun as angles, lens and flying speed, what is drawn.
//!
//! An engine needs none of this: it has a sun and a camera of its own. The tuning panel, the viewer
//! and saved files edit a [`Settings`], whose first part is a [`Technique`].

use glam::Vec3;

use crate::settings::setters;
use crate::{FitError, Technique, checks};

/// The sun.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct LightSettings {
    /// Compass angle of the point that the light comes from, in radians from +z toward +x. Default:
    /// 0.6.
    pub azimuth: f32,
    /// Angle of the sun above the horizon, in radians. Default: 0.75.
    pub elevation: f32,
    /// Whether the sun circles the vertical. Default: no.
    pub animate: bool,
    /// Speed of that circle, in radians a second. Default: 0.1.
    pub animate_speed: f32,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self { azimuth: 0.6, elevation: 0.75, animate: false, animate_speed: 0.1 }
    }
}

/// Least and greatest flying speed, in metres a second: from crawling over a chair to crossing a mountain range.
pub const FLYING_SPEEDS: (f32, f32) = (0.1, 1_000.0);

/// Lens and speed of the free-flying camera. Its position is not a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct CameraSettings {
    /// Vertical field of view, in radians. Default: π/4.
    pub fov_y: f32,
    /// Distance of the near plane, in metres. Default: 0.1.
    pub near: f32,
    /// Distance of the far plane, in metres. Default: 200.
    pub far: f32,
    /// Flying speed, in metres a second, within [`FLYING_SPEEDS`]. Default: 5.
    pub speed: f32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self { fov_y: core::f32::consts::FRAC_PI_4, near: 0.1, far: 200.0, speed: 5.0 }
    }
}

/// What a tool draws over or instead of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent switch of the panel")]
pub struct ViewSettings {
    /// Whether shadows are drawn at all. Default: yes.
    pub shadows: bool,
    /// Shows one of the shadow maps in a corner. Default: yes.
    pub inset: bool,
    /// Number of the map that the inset shows, 1..=8 from the nearest; the last one where there are
    /// fewer. Default: 1.
    pub inset_map: u32,
    /// Tints each point by the map that it reads; see [`MAP_TINTS`](crate::figures::MAP_TINTS).
    /// Default: no.
    pub tint_maps: bool,
    /// Looks at the camera from outside, with its frustum and the boxes of the maps drawn. Default: no.
    pub outside: bool,
    /// Keeps the current fit while the camera flies on. Default: no.
    pub freeze_fit: bool,
    /// Plays the scene's animation. Default: yes.
    pub play: bool,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self {
            shadows: true,
            inset: true,
            inset_map: 1,
            tint_maps: false,
            outside: false,
            freeze_fit: false,
            play: true,
        }
    }
}

/// Everything that the tuning panel edits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Settings {
    /// Everything that decides how shadows look.
    pub technique: Technique,
    /// The sun.
    pub light: LightSettings,
    /// Lens and speed of the camera.
    pub camera: CameraSettings,
    /// What is drawn.
    pub view: ViewSettings,
}

setters!(LightSettings {
    with_azimuth azimuth: f32,
    with_elevation elevation: f32,
    with_animate animate: bool,
    with_animate_speed animate_speed: f32,
});

setters!(CameraSettings {
    with_fov_y fov_y: f32,
    with_near near: f32,
    with_far far: f32,
    with_speed speed: f32,
});

setters!(ViewSettings {
    with_shadows shadows: bool,
    with_inset inset: bool,
    with_inset_map inset_map: u32,
    with_tint_maps tint_maps: bool,
    with_outside outside: bool,
    with_freeze_fit freeze_fit: bool,
    with_play play: bool,
});

setters!(Settings {
    with_technique technique: Technique,
    with_light light: LightSettings,
    with_camera camera: CameraSettings,
    with_view view: ViewSettings,
});

impl ViewSettings {
    /// Index of the map that the inset shows, of a technique with `count` maps.
    pub fn inset_index(&self, count: u32) -> usize {
        self.inset_map.clamp(1, count.max(1)) as usize - 1
    }
}

impl LightSettings {
    /// Unit **direction of travel** of the light in the right-handed, y-up world: away from the
    /// sun, so the negative of the direction toward the light. Angles that are not finite give a
    /// vector that every fit refuses.
    pub fn direction(&self) -> Vec3 {
        let (sin_azimuth, cos_azimuth) = libm::sincos(f64::from(self.azimuth));
        let (sin_elevation, cos_elevation) = libm::sincos(f64::from(self.elevation));
        Vec3::new((-cos_elevation * sin_azimuth) as f32, -sin_elevation as f32, (-cos_elevation * cos_azimuth) as f32)
    }

    /// The settings of a light that travels in `direction` (world axes, any length): azimuth in
    /// -π..=π, elevation in -π/2..=π/2, the rest with default values. A vertical light has azimuth
    /// 0.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::BadDirection`].
    pub fn from_direction(direction: Vec3) -> Result<Self, FitError> {
        // Adding +0 turns the negative zeros of the negation positive, which atan2 tells apart.
        let to_light = -checks::unit("the light's direction", direction)? + 0.0;
        let horizontal = libm::sqrt(to_light.x * to_light.x + to_light.z * to_light.z);
        Ok(Self {
            azimuth: libm::atan2(to_light.x, to_light.z) as f32,
            elevation: libm::atan2(to_light.y, horizontal) as f32,
            ..Self::default()
        })
    }
}
