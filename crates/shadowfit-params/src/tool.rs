//! Settings of tools for tuning shadows: the sun as angles, lens and flying speed, and the displayed picture.
//!
//! An engine needs none of this, since it has its own sun and camera. The tuning panel, the viewer and saved
//! files edit a [`Settings`], whose first part is a [`Technique`].

use glam::Vec3;
use shadowfit::Technique;

use crate::Inputs;

/// The sun.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LightSettings {
    /// Hour of the day, within [`DAY`], which places the sun instead of the two angles. Default: `None`,
    /// which uses the angles.
    pub hour: Option<f32>,
    /// Number of the file's directional light, counted from 1, whose direction the tool keeps in the two
    /// angles; `None` if a person sets the angles. A light that the file lacks counts as `None`. Default:
    /// `None`.
    pub file: Option<u32>,
    /// Compass angle of the sun, in radians from +z toward +x. Default: 0.6.
    pub azimuth: f32,
    /// Angle of the sun above the horizon, in radians. Default: 0.75.
    pub elevation: f32,
    /// Whether the sun moves: through the day if there is an hour, else around the vertical axis. Default:
    /// no.
    pub animate: bool,
    /// Speed of the sun, in radians a second. Default: 0.1.
    pub animate_speed: f32,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self { hour: None, file: None, azimuth: 0.6, elevation: 0.75, animate: false, animate_speed: 0.1 }
    }
}

/// Hours of sunrise and sunset at an equinox.
pub const DAY: (f32, f32) = (6.0, 18.0);

/// Latitude of the day's sun, in radians: 40° north, so that the sun is 50° high at noon.
const LATITUDE: f64 = 40.0 * core::f64::consts::PI / 180.0;

/// Angle that the sun turns in an hour, in radians.
const TURN_IN_AN_HOUR: f64 = core::f64::consts::PI / 12.0;

/// Least and greatest flying speed, in metres a second: for models below a millimetre and terrains of some
/// 1000 km.
pub const FLYING_SPEEDS: (f32, f32) = (1e-5, 1e6);

/// Least and greatest height of an orthographic picture, in metres.
pub const HEIGHTS: (f32, f32) = (1e-4, 1e5);

/// Lens and speed of the free-flying camera. Its position is not a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSettings {
    /// Number of the file's camera that the tool follows, counted from 1; `None` if a person flies the
    /// camera. A camera that the file lacks counts as `None`. Default: `None`.
    pub file: Option<u32>,
    /// Vertical field of view, in radians. Default: π/4.
    pub fov_y: f32,
    /// Height of the picture of an orthographic lens, in metres, within [`HEIGHTS`], which replaces the field
    /// of view. Default: `None`, a perspective lens.
    pub height: Option<f32>,
    /// Distance of the near plane, in metres. Default: 0.1.
    pub near: f32,
    /// Distance of the far plane, in metres. Default: 200.
    pub far: f32,
    /// Flying speed, in metres a second, within [`FLYING_SPEEDS`]. Default: 5.
    pub speed: f32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self { file: None, fov_y: core::f32::consts::FRAC_PI_4, height: None, near: 0.1, far: 200.0, speed: 5.0 }
    }
}

/// The displayed picture of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ViewMode {
    /// The shaded scene with the shadows of the maps.
    #[default]
    Final,
    /// The shaded scene with ray-traced shadows.
    Truth,
    /// The final picture in grey, with each wrong pixel in the [colour of its
    /// class](crate::figures::ERROR_COLORS).
    Error,
    /// Screen pixels per texel along the worse axis, as
    /// [colours](crate::figures::pixels_per_texel_color).
    PixelsPerTexel,
    /// The map that each point reads, in its [tint](crate::figures::MAP_TINTS).
    Maps,
    /// The texels of the maps, drawn on the surfaces that read them.
    TexelGrid,
    /// The scene from the light's direction, with the demand grid and the outlines of the maps.
    Demand,
    /// All maps side by side, with kept texels, redrawn texels and moving casters.
    Updates,
    /// The camera from outside, with its frustum, the boxes of the maps, and their casters.
    Outside,
    /// The scene in grey. [Colours](crate::figures::EDGE_COLORS) show the pixels near edges that were traced,
    /// and the pixels that were left to the filter.
    Traced,
}

impl ViewMode {
    /// All views, in display order.
    pub const ALL: [Self; 10] = [
        Self::Final,
        Self::Truth,
        Self::Error,
        Self::PixelsPerTexel,
        Self::Maps,
        Self::TexelGrid,
        Self::Demand,
        Self::Updates,
        Self::Outside,
        Self::Traced,
    ];

    /// Returns whether the view shows the scene from the camera, and not the maps or the scene from
    /// elsewhere.
    pub const fn shows_camera(self) -> bool {
        !matches!(self, Self::Demand | Self::Updates | Self::Outside)
    }

    /// Returns the meanings of the view's colours, in the order of the legend; empty for natural colours.
    pub const fn colors(self) -> &'static [ViewColors] {
        match self {
            Self::Error => &[ViewColors::Classes],
            Self::PixelsPerTexel => &[ViewColors::PixelsPerTexel],
            Self::Maps => &[ViewColors::Maps],
            Self::Demand => &[ViewColors::Demand, ViewColors::Maps],
            Self::Updates => &[ViewColors::Updates],
            Self::Traced => &[ViewColors::Traced],
            _ => &[],
        }
    }

    /// Returns whether the view needs compute shaders, which WebGL2 lacks.
    pub const fn needs_compute(self) -> bool {
        self.is_judged() || matches!(self, Self::Traced)
    }

    /// Returns whether the view needs rays.
    pub const fn is_judged(self) -> bool {
        matches!(self, Self::Truth | Self::Error)
    }
}

/// Meaning of the colours of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewColors {
    /// The [classes](crate::figures::ERROR_COLORS) of wrong pixels.
    Classes,
    /// [Pixels per texel](crate::figures::pixels_per_texel_color) of the visible points.
    PixelsPerTexel,
    /// The [maps](crate::figures::MAP_TINTS).
    Maps,
    /// [Pixels per texel](crate::figures::pixels_per_texel_color) that the picture needs of the maps.
    Demand,
    /// Kept texels, redrawn texels and moving casters.
    Updates,
    /// Traced pixels, and pixels that were [left to the filter](crate::figures::EDGE_COLORS).
    Traced,
}

/// Shadow maps in a corner of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum InsetMaps {
    /// None.
    Off,
    /// The map of [`ViewSettings::inset_map`].
    #[default]
    One,
    /// All, one above the other.
    All,
}

/// Marks of wrong pixels in views of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ErrorMarks {
    /// No marks.
    #[default]
    Off,
    /// Outlines around areas of wrong pixels in the colour of their class.
    Outline,
    /// Blinking pixels in the colour of their class.
    Blink,
}

/// Views and overlays of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent switch of the panel")]
pub struct ViewSettings {
    /// The displayed picture. Default: the final picture.
    pub mode: ViewMode,
    /// Whether all pictures are judged against rays, and not only for views that show the result. Default:
    /// yes.
    pub judge: bool,
    /// Marks of wrong pixels. Default: off.
    pub marks: ErrorMarks,
    /// Whether shadows are drawn at all. Default: yes.
    pub shadows: bool,
    /// Whether blended surfaces cast shadows where their alpha is at least 0.5. Default: yes.
    pub blended_cast: bool,
    /// Shadow maps in a corner. Default: one.
    pub inset: InsetMaps,
    /// Number of the map in the inset, 1..=8 from the nearest, clamped to the number of maps. Default: 1.
    pub inset_map: u32,
    /// Stored depths that insets show as black and as white, 0..=1. Default: `None`, the depth range of the
    /// scene.
    pub inset_depths: Option<[f32; 2]>,
    /// Distance above the surface at which the shadow rays of the judge and of exact edges start, in metres.
    /// Default: `None`, a distance that suits the scene's size.
    pub ray_offset: Option<f32>,
    /// Whether the view from outside is shown beside the picture. Default: no.
    pub outside_beside: bool,
    /// Whether the current fit is kept while the camera flies on. Default: no.
    pub freeze_fit: bool,
    /// Whether the scene's animation plays. Default: yes.
    pub play: bool,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self {
            mode: ViewMode::Final,
            judge: true,
            marks: ErrorMarks::Off,
            shadows: true,
            blended_cast: true,
            inset: InsetMaps::One,
            inset_map: 1,
            inset_depths: None,
            ray_offset: None,
            outside_beside: false,
            freeze_fit: false,
            play: true,
        }
    }
}

/// All settings that the tuning panel edits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// All settings that decide how shadows look.
    pub technique: Technique,
    /// Inputs of the technique's fits.
    pub inputs: Inputs,
    /// The sun.
    pub light: LightSettings,
    /// Lens and speed of the camera.
    pub camera: CameraSettings,
    /// The displayed picture.
    pub view: ViewSettings,
}

impl Settings {
    /// Returns these settings with another technique.
    #[must_use]
    pub const fn with_technique(mut self, technique: Technique) -> Self {
        self.technique = technique;
        self
    }
}

impl ViewSettings {
    /// Returns the index of the map in the inset, for a technique with `count` maps.
    pub fn inset_index(&self, count: u32) -> usize {
        self.inset_map.clamp(1, count.max(1)) as usize - 1
    }
}

impl LightSettings {
    /// Returns the unit **direction of travel** of the light in the right-handed, y-up world: away from the
    /// sun, so the negative of the direction toward the light. Angles that are not finite give a vector that
    /// every fit rejects.
    pub fn direction(&self) -> Vec3 {
        if let Some(hour) = self.hour {
            return sun_at(hour);
        }
        let (sin_azimuth, cos_azimuth) = libm::sincos(f64::from(self.azimuth));
        let (sin_elevation, cos_elevation) = libm::sincos(f64::from(self.elevation));
        Vec3::new((-cos_elevation * sin_azimuth) as f32, -sin_elevation as f32, (-cos_elevation * cos_azimuth) as f32)
    }

    /// Returns the same sun as angles without an hour, for tools that show them beside the hour.
    #[must_use]
    pub fn by_angles(&self) -> Self {
        match (self.hour, Self::from_direction(self.direction())) {
            (Some(_), Some(light)) => Self { azimuth: light.azimuth, elevation: light.elevation, hour: None, ..*self },
            _ => Self { hour: None, ..*self },
        }
    }

    /// Sets the angles from a light that travels in `direction` (world axes, any length). Ignores a direction
    /// that is zero or not finite.
    pub fn point_along(&mut self, direction: Vec3) {
        if let Some(light) = Self::from_direction(direction) {
            (self.azimuth, self.elevation) = (light.azimuth, light.elevation);
        }
    }

    /// Moves an animated sun by `seconds`. With an hour it moves through the day, from evening straight to
    /// morning. Else it turns around the vertical axis, detached from the file's light. Without animation it
    /// does nothing.
    pub fn advance(&mut self, seconds: f32) {
        use core::f32::consts::{PI, TAU};
        if !self.animate {
            return;
        }
        let turned = self.animate_speed * seconds;
        if let Some(hour) = &mut self.hour {
            let next = *hour - DAY.0 + turned / TURN_IN_AN_HOUR as f32;
            *hour = DAY.0 + remainder(next.into(), (DAY.1 - DAY.0).into()) as f32;
        } else {
            self.file = None;
            self.azimuth = remainder((self.azimuth + turned + PI).into(), TAU.into()) as f32 - PI;
        }
    }

    /// Returns the settings of a light that travels in `direction` (world axes, any length): azimuth in
    /// -π..=π, elevation in -π/2..=π/2, all others at their defaults. A vertical light has azimuth 0. `None`
    /// for a direction that is zero or not finite.
    pub fn from_direction(direction: Vec3) -> Option<Self> {
        let direction = direction.as_dvec3();
        let length = direction.length();
        if !length.is_finite() || length == 0.0 {
            return None;
        }
        // Adding +0 makes the negative zeros of the negation positive, since atan2 distinguishes them.
        let to_light = -(direction / length) + 0.0;
        let horizontal = libm::sqrt(to_light.x * to_light.x + to_light.z * to_light.z);
        Some(Self {
            azimuth: libm::atan2(to_light.x, to_light.z) as f32,
            elevation: libm::atan2(to_light.y, horizontal) as f32,
            ..Self::default()
        })
    }
}

/// Returns the remainder of a division, at least 0 for a positive divisor.
pub(crate) fn remainder(value: f64, divisor: f64) -> f64 {
    let remainder = value % divisor;
    if remainder < 0.0 { remainder + divisor } else { remainder }
}

/// Returns the direction of travel of the day's light at an hour: from the east, +x, through the south, +z,
/// to the west.
fn sun_at(hour: f32) -> Vec3 {
    let (sin, cos) = libm::sincos((f64::from(hour) - 12.0) * TURN_IN_AN_HOUR);
    let (sin_latitude, cos_latitude) = libm::sincos(LATITUDE);
    Vec3::new(sin as f32, (-cos_latitude * cos) as f32, (-sin_latitude * cos) as f32)
}
