//! Plain settings of a directional shadow and of the tools that tune it.
//!
//! Every field is public, has a default, and (when it is a knob that a person turns) a row in
//! [`crate::params`], from which panels, command lines and saved files are made.

use glam::{UVec2, Vec3};

use crate::{DepthConvention, FitError, checks};

/// Writes one `with_*` method per field of a settings struct.
macro_rules! setters {
    ($settings:ty { $($method:ident $field:ident: $value:ty),+ $(,)? }) => {
        impl $settings {
            $(
                #[doc = concat!("These settings with another [`", stringify!($field), "`](Self::", stringify!($field), ").")]
                #[must_use]
                pub const fn $method(mut self, $field: $value) -> Self {
                    self.$field = $field;
                    self
                }
            )+
        }
    };
}

/// Which rule fits the shadow map to the camera frustum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FitKind {
    /// The XNA Shadow Mapping sample's `CreateLightViewProjectionMatrix` (Microsoft, 2008), exact:
    /// tight across the light, twice the depth that is needed, no caster policy.
    XnaSample,
    /// Axis-aligned box of the camera frustum in the light's axes, with tight depth and the near
    /// plane moved toward the light by [`FitSettings::caster_extension`].
    #[default]
    FrustumAabb,
    /// Least rectangle of the camera frustum as seen from the light, turned about it as
    /// [`FitSettings::rectangle`] says. The tightest without knowledge of the scene.
    Oriented,
    /// Minimal enclosing sphere of the camera frustum, on a grid of whole texels that is fixed to
    /// the world: neither moving nor turning the camera makes shadows crawl.
    Sphere,
    /// Least rectangle of what the camera can see of the receivers' boxes, turned as
    /// [`FitSettings::rectangle`] says. Without boxes it is [`Self::Oriented`].
    Focused,
}

/// How [`FitKind::Oriented`] and [`FitKind::Focused`] lay a rectangle around what they cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RectangleKind {
    /// Along the light's own axes, never turned.
    AxisAligned,
    /// Of least area.
    #[default]
    MinimumArea,
    /// With the least longer side, made square: equal texels both ways on a square map.
    MinimumSquare,
}

/// Where the near plane stands, so that casters between the light and the receivers are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CasterPolicy {
    /// At what is covered: casters before it are lost, as in the sample.
    None,
    /// Moved toward the light by [`FitSettings::caster_extension`].
    #[default]
    Extend,
    /// At the one box around all casters, clipped to the volume that can throw shadows into view.
    SceneBounds,
    /// At the first caster that can throw a shadow into view: each box is clipped to that volume.
    List,
    /// At what is covered, with the pipeline's depth clamp holding casters before it
    /// ("pancaking"). Culling still uses the unclamped volume, and filters that need the distance
    /// to the caster cannot have it.
    DepthClamp,
}

/// How the light's view-projection is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct FitSettings {
    /// The rule of the fit.
    pub kind: FitKind,
    /// Rectangle of the fits that may turn.
    pub rectangle: RectangleKind,
    /// Shadows end at this view depth, in metres; the camera's far plane when that is nearer.
    pub max_distance: f32,
    /// Enlarges the light's box on all six sides, in metres: the sample's own imperfect cure for
    /// clipped casters.
    pub margin: f32,
    /// Free texels between what is covered and the map's border, for the filter: its
    /// [reach](crate::bias::reach) and the normal offset. [`FitKind::XnaSample`] ignores it.
    pub kernel_margin: f32,
    /// What places the near plane. [`FitKind::XnaSample`] ignores it: the sample has none.
    pub casters: CasterPolicy,
    /// How far [`CasterPolicy::Extend`] moves the near plane toward the light, in metres.
    pub caster_extension: f32,
    /// Direction in world axes that is up, which a vertical light's axes follow: any length.
    pub up: Vec3,
    /// Width and height of the map, in texels.
    pub resolution: UVec2,
    /// Depth convention of the fitted clip space.
    pub depth: DepthConvention,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            kind: FitKind::FrustumAabb,
            max_distance: 40.0,
            rectangle: RectangleKind::MinimumArea,
            margin: 0.0,
            kernel_margin: 0.0,
            casters: CasterPolicy::Extend,
            caster_extension: 50.0,
            up: Vec3::Y,
            resolution: UVec2::splat(2048),
            depth: DepthConvention::ZeroToOne,
        }
    }
}

/// Most maps that share a view.
pub const MAX_CASCADES: usize = 8;

/// Where one map ends and the next begins, in view depth.
///
/// Where the receivers' boxes are known, all schemes but the manual one are spread over their
/// depths in view instead of the whole frustum's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SplitScheme {
    /// Ranges of equal length, over what is in view or between the
    /// [bounds of what is visible](crate::FitInput::depth_bounds) if those are known; so are the next two.
    Uniform,
    /// Ranges of equal ratio, as perspective would have it. Spends most maps close to the eye.
    Logarithmic,
    /// Between both: this share of the logarithmic cuts and the rest of the uniform ones (the
    /// parallel-split scheme), 0..=1.
    Practical(f32),
    /// View depths in metres at which the maps end, ascending; the last map ends with the shadows.
    Manual([f32; MAX_CASCADES - 1]),
    /// The cuts with the least 95% quantile of pixels per texel, by what the receivers' boxes tell
    /// of what is visible.
    #[default]
    FromBoxes,
    /// The same by the histogram of visible depth that the engine hands in; without one as
    /// [`Self::FromBoxes`].
    FromHistogram,
}

/// Whether and how maps are kept from changing while the camera moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Stabilise {
    /// Every frame is fitted anew: the finest texels, and shadow edges that crawl.
    Off,
    /// Extents are rounded up to eighths of an octave and the map moves by whole texels of a grid
    /// that is fixed to the world. With [`FitKind::Sphere`] edges stand perfectly still; other fits
    /// still change when the camera turns.
    #[default]
    Snap,
    /// A map is kept, its angle included, and moved by whole texels while it covers what it must
    /// and wastes no more than [`HoldSettings::waste`]. Made anew, it is large enough for the
    /// movement to come.
    Hysteresis,
}

/// When [`Stabilise::Hysteresis`] keeps a map and how much room a new one gets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct HoldSettings {
    /// Free border of a new map, as a share of its extent.
    pub margin: f32,
    /// A new map also covers what the camera will see if it goes on moving as it did, for as many
    /// frames as make the map at most so many times as wide.
    pub growth: f32,
    /// A map is made anew when its texels are so many times as wide as they had to be; likewise
    /// the cuts.
    pub waste: f32,
    /// Most frames that are looked ahead.
    pub horizon: u32,
}

impl Default for HoldSettings {
    fn default() -> Self {
        Self { margin: 0.02, growth: 1.4, waste: 1.8, horizon: 32 }
    }
}

/// What one of several maps has of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapOverride {
    /// The rule of its fit.
    pub kind: FitKind,
    /// Its width and height, in texels.
    pub resolution: UVec2,
}

/// How several maps share a view.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct CascadeSettings {
    /// The fit of all maps.
    pub fit: FitSettings,
    /// Number of maps, 1..=8.
    pub count: u32,
    /// Where one ends and the next begins.
    pub splits: SplitScheme,
    /// Share of a map's range of view depths that the next map covers too, for a blend between
    /// them, 0..=1.
    pub overlap: f32,
    /// What keeps the maps still.
    pub stabilise: Stabilise,
    /// Details of [`Stabilise::Hysteresis`], and when held cuts are given up.
    pub hold: HoldSettings,
    /// Maps that differ from `fit`, the nearest first.
    pub overrides: [Option<MapOverride>; MAX_CASCADES],
}

impl Default for CascadeSettings {
    fn default() -> Self {
        Self {
            fit: FitSettings { kind: FitKind::Focused, ..FitSettings::default() },
            count: 4,
            splits: SplitScheme::default(),
            overlap: 0.0,
            stabilise: Stabilise::default(),
            hold: HoldSettings::default(),
            overrides: [None; MAX_CASCADES],
        }
    }
}

/// Biases that keep a surface from shadowing itself, in texels of the map.
///
/// They are converted to depth and metres in one place, [`crate::bias`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct BiasSettings {
    /// Depth bias that does not depend on the slope, in texel sizes along the light.
    pub constant: f32,
    /// Depth bias times the tangent of the angle between the surface normal and the light, in
    /// texel sizes.
    pub slope: f32,
    /// Offset of the sampled point along the geometric normal times the sine of that angle, in
    /// texel sizes.
    pub normal_offset: f32,
    /// Receiver-plane bias: each comparison of the filter is made with the depth of the receiver's
    /// own plane where it reads, moved toward the light by the plane's rise over so many texels
    /// (J. Isidoro, "Shadow mapping: GPU-based tips and techniques", 2006). The reach of one
    /// comparison clears a plane: 0.5 for a single texel, 1 for the hardware's 2×2 and all filters
    /// made of it. 0 turns it off.
    pub receiver_plane: f32,
}

impl Default for BiasSettings {
    /// [`Self::automatic`] for the default filter.
    fn default() -> Self {
        Self::automatic(FilterKind::default())
    }
}

/// How the stored depths are turned into a shadow factor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FilterKind {
    /// One comparison with the nearest texel.
    Point,
    /// Four comparisons, weighted bilinearly (the hardware's 2×2 percentage-closer filter).
    Hardware2x2,
    /// Tent of 3×3 hardware look-ups (16 texels), by four of them.
    Pcf3x3,
    /// Tent of 5×5 hardware look-ups (36 texels), by nine of them.
    #[default]
    Pcf5x5,
}

impl FilterKind {
    /// All filters, the narrowest first.
    pub const ALL: [Self; 4] = [Self::Point, Self::Hardware2x2, Self::Pcf3x3, Self::Pcf5x5];
}

/// Texture format that stores the depths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapFormat {
    /// 32-bit float depth attachment, compared by the sampler.
    #[default]
    Depth32Float,
    /// One 32-bit float colour channel with a depth buffer of its own, compared by hand (the XNA
    /// sample's form).
    R32Float,
}

/// The sun.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct LightSettings {
    /// Compass angle of the point that the light comes from, in radians from +z toward +x.
    pub azimuth: f32,
    /// Angle of the sun above the horizon, in radians.
    pub elevation: f32,
    /// Whether the sun circles the vertical.
    pub animate: bool,
    /// Speed of that circle, in radians a second.
    pub animate_speed: f32,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self { azimuth: 0.6, elevation: 0.75, animate: false, animate_speed: 0.1 }
    }
}

/// Lens and speed of the free-flying camera. Where it stands is not a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct CameraSettings {
    /// Vertical field of view, in radians.
    pub fov_y: f32,
    /// Distance of the near plane, in metres.
    pub near: f32,
    /// Distance of the far plane, in metres.
    pub far: f32,
    /// Flying speed, in metres a second.
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
    /// Whether shadows are drawn at all.
    pub shadows: bool,
    /// Shows the shadow map in a corner.
    pub inset: bool,
    /// Looks at the camera from outside, with its frustum and the light's box drawn.
    pub outside: bool,
    /// Keeps the current fit while the camera flies on.
    pub freeze_fit: bool,
    /// Plays the scene's animation.
    pub play: bool,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self { shadows: true, inset: true, outside: false, freeze_fit: false, play: true }
    }
}

/// Everything that the tuning panel edits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Settings {
    /// How the map is fitted.
    pub fit: FitSettings,
    /// Biases against self-shadowing.
    pub bias: BiasSettings,
    /// Filter of the shadow look-up.
    pub filter: FilterKind,
    /// Storage of the map.
    pub format: MapFormat,
    /// The sun.
    pub light: LightSettings,
    /// Lens and speed of the camera.
    pub camera: CameraSettings,
    /// What is drawn.
    pub view: ViewSettings,
}

setters!(FitSettings {
    with_kind kind: FitKind,
    with_max_distance max_distance: f32,
    with_rectangle rectangle: RectangleKind,
    with_margin margin: f32,
    with_kernel_margin kernel_margin: f32,
    with_casters casters: CasterPolicy,
    with_up up: Vec3,
    with_caster_extension caster_extension: f32,
    with_resolution resolution: UVec2,
    with_depth depth: DepthConvention,
});

setters!(HoldSettings {
    with_margin margin: f32,
    with_growth growth: f32,
    with_waste waste: f32,
    with_horizon horizon: u32,
});

setters!(CascadeSettings {
    with_fit fit: FitSettings,
    with_count count: u32,
    with_splits splits: SplitScheme,
    with_overlap overlap: f32,
    with_stabilise stabilise: Stabilise,
    with_hold hold: HoldSettings,
    with_overrides overrides: [Option<MapOverride>; MAX_CASCADES],
});

setters!(BiasSettings {
    with_constant constant: f32,
    with_slope slope: f32,
    with_normal_offset normal_offset: f32,
    with_receiver_plane receiver_plane: f32,
});

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
    with_outside outside: bool,
    with_freeze_fit freeze_fit: bool,
    with_play play: bool,
});

setters!(Settings {
    with_fit fit: FitSettings,
    with_bias bias: BiasSettings,
    with_filter filter: FilterKind,
    with_format format: MapFormat,
    with_light light: LightSettings,
    with_camera camera: CameraSettings,
    with_view view: ViewSettings,
});

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
    /// -π..=π, elevation in -π/2..=π/2, the rest as by default. A vertical light has azimuth 0.
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
