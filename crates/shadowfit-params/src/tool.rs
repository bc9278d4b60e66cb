//! Settings of tools that tune shadows: the sun as angles, lens and flying speed, what is drawn.
//!
//! An engine needs none of this: it has a sun and a camera of its own. The tuning panel, the viewer
//! and saved files edit a [`Settings`], whose first part is a [`Technique`].

use glam::Vec3;
use shadowfit::Technique;

use crate::Inputs;

/// The sun.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LightSettings {
    /// Hour of the day by the sun, within [`DAY`], whose sun is used instead of the two angles; `None`
    /// for these. Default: `None`.
    pub hour: Option<f32>,
    /// Number of the file's directional light, counted from 1, whose direction the tool keeps in the two angles;
    /// `None` for angles that a person sets. A light that the file lacks counts as `None`. Default: `None`.
    pub file: Option<u32>,
    /// Compass angle of the point that the light comes from, in radians from +z toward +x. Default:
    /// 0.6.
    pub azimuth: f32,
    /// Angle of the sun above the horizon, in radians. Default: 0.75.
    pub elevation: f32,
    /// Whether the sun moves: over the day where there is an hour, else around the vertical. Default:
    /// no.
    pub animate: bool,
    /// Speed at which it moves, in radians a second. Default: 0.1.
    pub animate_speed: f32,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self { hour: None, file: None, azimuth: 0.6, elevation: 0.75, animate: false, animate_speed: 0.1 }
    }
}

/// Hours at which the sun rises and sets: an equinox.
pub const DAY: (f32, f32) = (6.0, 18.0);

/// Latitude of the day's sun, in radians: 40° north, so that noon is 50° high.
const LATITUDE: f64 = 40.0 * core::f64::consts::PI / 180.0;

/// Angle that the sun turns in an hour, in radians.
const TURN_IN_AN_HOUR: f64 = core::f64::consts::PI / 12.0;

/// Least and greatest flying speed, in metres a second: for models below a millimetre and for lands of some 1000 km.
pub const FLYING_SPEEDS: (f32, f32) = (1e-5, 1e6);

/// Least and greatest height of an orthographic picture, in metres.
pub const HEIGHTS: (f32, f32) = (1e-4, 1e5);

/// Lens and speed of the free-flying camera. Its position is not a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSettings {
    /// Number of the file's camera, counted from 1, that the tool follows; `None` for a camera that a person flies. A
    /// camera that the file lacks counts as `None`. Default: `None`.
    pub file: Option<u32>,
    /// Vertical field of view, in radians. Default: π/4.
    pub fov_y: f32,
    /// Height of the picture of an orthographic lens, in metres, used instead of the field of view; `None` for a
    /// perspective. Within [`HEIGHTS`]. Default: `None`.
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

/// What a picture shows of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ViewMode {
    /// The shaded scene with the shadows of the maps.
    #[default]
    Final,
    /// The shaded scene with the shadows that rays find.
    Truth,
    /// The final picture in grey, and each wrong pixel in the
    /// [colour of its class](crate::figures::ERROR_COLORS).
    Error,
    /// Screen pixels per texel along the worse axis, as
    /// [colours](crate::figures::pixels_per_texel_color).
    PixelsPerTexel,
    /// The map that each point reads, in its [tint](crate::figures::MAP_TINTS).
    Maps,
    /// The texels of the maps, drawn on the surfaces that read them.
    TexelGrid,
    /// The scene as the light sees it, with the demand grid and the outlines of the maps over it.
    Demand,
    /// All maps side by side, with what was kept in them, what was drawn anew and what moves.
    Updates,
    /// The camera from outside, with its frustum, the boxes of the maps, and what casts into them.
    Outside,
    /// The scene in grey, with the pixels whose edges were traced, and those that were left to the filter, in
    /// [colours](crate::figures::EDGE_COLORS).
    Traced,
}

impl ViewMode {
    /// All of them, in the order that they are shown.
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

    /// Whether it shows what the camera sees, and not the maps, or the scene from elsewhere.
    pub const fn shows_camera(self) -> bool {
        !matches!(self, Self::Demand | Self::Updates | Self::Outside)
    }

    /// What its colours stand for, in the order that a legend explains them; empty for natural colours.
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

    /// Whether it takes compute shaders, which WebGL2 lacks.
    pub const fn needs_compute(self) -> bool {
        self.is_judged() || matches!(self, Self::Traced)
    }

    /// Whether rays are needed to show it.
    pub const fn is_judged(self) -> bool {
        matches!(self, Self::Truth | Self::Error)
    }
}

/// What the colours of a view stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewColors {
    /// The [classes](crate::figures::ERROR_COLORS) of wrong pixels.
    Classes,
    /// [Pixels per texel](crate::figures::pixels_per_texel_color) of what is seen.
    PixelsPerTexel,
    /// The [maps](crate::figures::MAP_TINTS).
    Maps,
    /// [Pixels per texel](crate::figures::pixels_per_texel_color) of what the picture asks the maps for.
    Demand,
    /// Texels of the maps that were kept, those drawn anew, and what moves.
    Updates,
    /// Pixels that were traced, and those that were [left to the filter](crate::figures::EDGE_COLORS).
    Traced,
}

/// Which shadow maps are shown in a corner of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum InsetMaps {
    /// None.
    Off,
    /// The one of [`ViewSettings::inset_map`].
    #[default]
    One,
    /// All, one above the other.
    All,
}

/// How wrong pixels are marked in views of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ErrorMarks {
    /// Not at all.
    #[default]
    Off,
    /// Areas of wrong pixels are outlined in the colour of their class.
    Outline,
    /// Wrong pixels blink in the colour of their class.
    Blink,
}

/// What a tool draws over or instead of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent switch of the panel")]
pub struct ViewSettings {
    /// What the picture shows. Default: the final picture.
    pub mode: ViewMode,
    /// Whether pictures are judged against rays all the time, and not only where the view shows it. Default:
    /// yes.
    pub judge: bool,
    /// How wrong pixels are marked. Default: not at all.
    pub marks: ErrorMarks,
    /// Whether shadows are drawn at all. Default: yes.
    pub shadows: bool,
    /// Whether blended surfaces cast shadows where their alpha is at least 0.5. Default: yes.
    pub blended_cast: bool,
    /// Which of the shadow maps are shown in a corner. Default: one.
    pub inset: InsetMaps,
    /// Number of the map that the inset shows, 1..=8 from the nearest; the last one where there are
    /// fewer. Default: 1.
    pub inset_map: u32,
    /// Stored depths that insets show as black and as white, 0..=1; `None` for the range in which the
    /// scene lies. Default: `None`.
    pub inset_depths: Option<[f32; 2]>,
    /// Distance above the surface at which the shadow rays of judge and exact edges start, in metres; `None` for one that
    /// suits the scene's size. Default: `None`.
    pub ray_offset: Option<f32>,
    /// Whether the view from outside is shown beside the picture as well. Default: no.
    pub outside_beside: bool,
    /// Keeps the current fit while the camera flies on. Default: no.
    pub freeze_fit: bool,
    /// Plays the scene's animation. Default: yes.
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

/// Everything that the tuning panel edits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// Everything that decides how shadows look.
    pub technique: Technique,
    /// What its fits are given.
    pub inputs: Inputs,
    /// The sun.
    pub light: LightSettings,
    /// Lens and speed of the camera.
    pub camera: CameraSettings,
    /// What is drawn.
    pub view: ViewSettings,
}

impl Settings {
    /// These settings with another technique.
    #[must_use]
    pub const fn with_technique(mut self, technique: Technique) -> Self {
        self.technique = technique;
        self
    }
}

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
        if let Some(hour) = self.hour {
            return sun_at(hour);
        }
        let (sin_azimuth, cos_azimuth) = libm::sincos(f64::from(self.azimuth));
        let (sin_elevation, cos_elevation) = libm::sincos(f64::from(self.elevation));
        Vec3::new((-cos_elevation * sin_azimuth) as f32, -sin_elevation as f32, (-cos_elevation * cos_azimuth) as f32)
    }

    /// The same sun by its angles, without an hour: what a tool shows beside the hour.
    #[must_use]
    pub fn by_angles(&self) -> Self {
        match (self.hour, Self::from_direction(self.direction())) {
            (Some(_), Some(light)) => Self { azimuth: light.azimuth, elevation: light.elevation, hour: None, ..*self },
            _ => Self { hour: None, ..*self },
        }
    }

    /// Sets the angles of a light that travels in `direction` (world axes, any length). One that is zero or not finite
    /// changes nothing.
    pub fn point_along(&mut self, direction: Vec3) {
        if let Some(light) = Self::from_direction(direction) {
            (self.azimuth, self.elevation) = (light.azimuth, light.elevation);
        }
    }

    /// Moves an animated sun on by `seconds`: over the day and from its evening to its morning where there
    /// is an hour, else around the vertical, away from the file's light. A sun that is not animated stays.
    pub fn advance(&mut self, seconds: f32) {
        use core::f32::consts::{PI, TAU};
        if !self.animate {
            return;
        }
        let turned = self.animate_speed * seconds;
        if let Some(hour) = &mut self.hour {
            let next = *hour - DAY.0 + turned / TURN_IN_AN_HOUR as f32;
            *hour = DAY.0 + next.rem_euclid(DAY.1 - DAY.0);
        } else {
            self.file = None;
            self.azimuth = (self.azimuth + turned + PI).rem_euclid(TAU) - PI;
        }
    }

    /// The settings of a light that travels in `direction` (world axes, any length): azimuth in
    /// -π..=π, elevation in -π/2..=π/2, the rest with default values. A vertical light has azimuth
    /// 0. `None` for a direction that is zero or not finite.
    pub fn from_direction(direction: Vec3) -> Option<Self> {
        let direction = direction.as_dvec3();
        let length = direction.length();
        if !length.is_finite() || length == 0.0 {
            return None;
        }
        // Adding +0 turns the negative zeros of the negation positive, which atan2 tells apart.
        let to_light = -(direction / length) + 0.0;
        let horizontal = (to_light.x * to_light.x + to_light.z * to_light.z).sqrt();
        Some(Self {
            azimuth: libm::atan2(to_light.x, to_light.z) as f32,
            elevation: libm::atan2(to_light.y, horizontal) as f32,
            ..Self::default()
        })
    }
}

/// Direction of travel of the day's light at an hour: from the east, +x, over the south, +z, to the west.
fn sun_at(hour: f32) -> Vec3 {
    let (sin, cos) = libm::sincos((f64::from(hour) - 12.0) * TURN_IN_AN_HOUR);
    let (sin_latitude, cos_latitude) = libm::sincos(LATITUDE);
    Vec3::new(sin as f32, (-cos_latitude * cos) as f32, (-sin_latitude * cos) as f32)
}
