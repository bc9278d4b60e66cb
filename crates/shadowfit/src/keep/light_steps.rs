//! Light steps: the direction of a slowly moving sun is held, then steps.
//!
//! Every change of the light's direction turns the map's texels in the world, so shadow edges crawl all day.
//! Held directions keep them still between steps. The steps are too small to notice, or are cross-faded over
//! two maps.
//!
//! # Movement of a map when the light turns
//!
//! Let the light turn by δ, and let the map turn with it about its centre by a small rotation ω. A point at
//! (a, b) across the light and at c along it, from that centre, moves across the light by
//!
//! ```text
//!   ω × p  =  (ω_y c - ω_z b,  ω_z a - ω_x c)        tilt: |(ω_x, ω_y)| = δ, roll: ω_z
//! ```
//!
//! - Roll moves the map's edge, R / 2 texels from its centre, by `ω_z · R / 2` texels. While the light comes
//!   from above the horizon, the shortest-arc axes of every fit except XNA's roll by δ · tan(β/2), where β is
//!   the angle from straight down. This is at most δ, so roll moves the edge by at most **δ · R / 2**.
//! - Tilt moves points at half the depth range D along the light by `δ · D / (2 · texel)`.
//!
//! [`LightSteps::extent`] is R, or R + D / texel to include the tilt ([`LightSteps::extent_of`]). The
//! direction is held until δ · extent / 2 exceeds the set number of texels. Look-at axes (XNA's) roll faster
//! near the vertical. Fits that turn about the light (oriented ones) move by more than this bound.

use glam::Vec3;

use crate::base::{FitError, checks};
use crate::light::is_same_direction;
use crate::projection::LightProjection;

/// Settings of a held light: when it steps, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct LightSteps {
    /// Greatest movement at the map's edge while the light is held, in texels. At 0 the light follows every
    /// change that is more than rounding. Default: 1.
    pub texels: f32,
    /// Extent of the map that the movement is computed from, in texels: its width, or [`Self::extent_of`].
    /// Default: 2048.
    pub extent: f32,
    /// Duration of the cross-fade from the old direction to the new one, in seconds. 0 steps at once. No
    /// other step begins during a fade, so two maps are enough. A light that keeps moving lags by this time.
    /// Default: 0.
    pub fade: f32,
}

impl Default for LightSteps {
    fn default() -> Self {
        Self { texels: 1.0, extent: 2048.0, fade: 0.0 }
    }
}

impl LightSteps {
    /// Sets [`texels`](Self::texels).
    #[must_use]
    pub const fn with_texels(mut self, texels: f32) -> Self {
        self.texels = texels;
        self
    }

    /// Sets [`extent`](Self::extent).
    #[must_use]
    pub const fn with_extent(mut self, extent: f32) -> Self {
        self.extent = extent;
        self
    }

    /// Sets [`fade`](Self::fade).
    #[must_use]
    pub const fn with_fade(mut self, fade: f32) -> Self {
        self.fade = fade;
        self
    }

    /// Returns the extent of a fit, in texels, at which no point of its box moves farther than predicted
    /// along either axis of the map. It is the sum of the longer side and the depth range, divided by the
    /// shorter side of a texel.
    pub fn extent_of(fit: &LightProjection) -> f32 {
        let (texel, resolution) = (fit.texel_size, fit.resolution.as_vec2());
        let side = (texel.x * resolution.x).max(texel.y * resolution.y);
        (side + fit.depth_range) / texel.x.min(texel.y)
    }

    /// Returns the angle that the light may turn before it steps, in radians: 2 · texels / extent.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for any of the settings.
    pub fn angle(&self) -> Result<f64, FitError> {
        let texels = checks::within("the light step's texels", f64::from(self.texels), 0.0, checks::MAX_LENGTH)?;
        let extent = checks::within("the light step's extent", f64::from(self.extent), 1.0, checks::MAX_LENGTH)?;
        checks::within("the light step's fade", f64::from(self.fade), 0.0, checks::MAX_LENGTH)?;
        Ok(2.0 * texels / extent)
    }
}

/// State of a held light, as plain data. The default state holds no direction.
///
/// ```
/// use shadowfit::glam::Vec3;
/// use shadowfit::light_steps::{LightSteps, LightStepState};
///
/// let settings = LightSteps::default().with_texels(2.0).with_fade(0.5);
/// let mut sun = LightStepState::default();
/// let mut directions = 0;
/// let mut last = None;
/// for frame in 0..600 {
///     let angle = frame as f32 * 1e-5; // radians
///     let step = sun.update(Vec3::new(angle.sin(), -1.0, 0.3), &settings, 1.0 / 60.0)?;
///     // Fit and shade with step.direction. If there is a step.previous, use both, mixed by step.blend.
///     directions += u32::from(last != Some(step.direction));
///     last = Some(step.direction);
/// }
/// assert!(directions < 8); // instead of 600
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LightStepState {
    /// Held direction of travel of the light, a unit vector in world axes.
    pub held: Option<Vec3>,
    /// Direction that is faded out.
    pub previous: Option<Vec3>,
    /// Weight of the held direction while another is faded out, 0..=1. It is f64, so that short frames add up
    /// in a long fade.
    pub blend: f64,
}

/// Directions to fit and shade with in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LightStep {
    /// Direction of travel of the light to fit to, a unit vector in world axes. Its bits do not change until
    /// it steps.
    pub direction: Vec3,
    /// Direction before the last step, while it is faded out, with unchanged bits.
    pub previous: Option<Vec3>,
    /// Weight of the shadow for [`Self::direction`], 0..=1. The previous direction has the rest. It is 1
    /// without a previous direction.
    pub blend: f32,
}

impl LightStepState {
    /// Returns the directions for the next frame, `seconds` after the last one, of a light that now travels
    /// in `direction` (world axes, any length). The first direction is used unchanged.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::BadDirection`] for the direction (or one put into the state by
    /// hand), and [`FitError::OutOfRange`] for the settings and the time. An error leaves the state
    /// unchanged.
    pub fn update(&mut self, direction: Vec3, settings: &LightSteps, seconds: f32) -> Result<LightStep, FitError> {
        let angle = settings.angle()?;
        let seconds = checks::within("the time of the light's step", f64::from(seconds), 0.0, checks::MAX_LENGTH)?;
        // Rounded before the comparison, so that equal inputs are equal directions.
        let new = checks::unit("the light's direction", direction)?.as_vec3();
        let mut next = self.faded(seconds, settings.fade)?;
        let held = next.held.unwrap_or(new);
        checks::unit("the held direction", held)?;
        if next.held.is_none() {
            next = Self { held: Some(new), ..Self::default() };
        } else if next.previous.is_none()
            && turn(held, new) > angle
            && !is_same_direction(held.as_dvec3(), new.as_dvec3())
        {
            next = Self { held: Some(new), previous: (settings.fade > 0.0).then_some(held), blend: 0.0 };
        }
        *self = next;
        let blend = if next.previous.is_some() { next.blend as f32 } else { 1.0 };
        Ok(LightStep { direction: next.held.unwrap_or(new), previous: next.previous, blend })
    }

    /// Forgets the light, after a jump of the camera or of time. The next direction is used unchanged.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Returns this state with its fade, if one runs, advanced.
    fn faded(&self, seconds: f64, fade: f32) -> Result<Self, FitError> {
        let Some(previous) = self.previous else { return Ok(*self) };
        checks::unit("the direction that is faded out", previous)?;
        let blend = checks::within("the blend of the light's step", self.blend, 0.0, 1.0)?;
        // With a fade time of zero, a running fade ends.
        let blend = if fade > 0.0 { blend + seconds / f64::from(fade) } else { 1.0 };
        Ok(if blend < 1.0 { Self { blend, ..*self } } else { Self { previous: None, blend: 0.0, ..*self } })
    }
}

/// Returns the angle between two directions, in radians. It is exactly 0 between equal ones.
fn turn(held: Vec3, new: Vec3) -> f64 {
    let (held, new) = (held.as_dvec3(), new.as_dvec3());
    libm::atan2(checks::length(held.cross(new)), held.dot(new))
}
