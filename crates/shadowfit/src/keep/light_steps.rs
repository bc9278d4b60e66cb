//! Light steps: a sun that moves slowly is held still, then steps.
//!
//! Every change of the light's direction turns the map's texels in the world, so shadow edges
//! crawl all day. Held directions keep them still between steps that are too small to notice, or
//! that are cross-faded over two maps.
//!
//! # How far a turn moves the map
//!
//! Let the light turn by δ, and with it the map about its centre by a small rotation ω. A point at
//! (a, b) across the light and at c along it, from that centre, moves across the light by
//!
//! ```text
//!   ω × p  =  (ω_y c - ω_z b,  ω_z a - ω_x c)        tilt: |(ω_x, ω_y)| = δ, roll: ω_z
//! ```
//!
//! - Roll moves the map's edge, half of R texels from its centre, by `ω_z · R / 2` texels. The
//!   shortest-arc axes of every fit but XNA's roll by at most δ while the light comes from above
//!   the horizon (δ · tan(β/2), β the angle from straight down), so that is **δ · R / 2** at most.
//! - Tilt moves what is half the depth range D away along the light by `δ · D / (2 · texel)`.
//!
//! [`LightSteps::extent`] is R, or with the tilt R + D / texel
//! ([`LightSteps::extent_of`]): the direction is held until δ · extent / 2 exceeds the set
//! number of texels. Look-at axes (XNA's) roll faster near the vertical, and fits that turn about
//! the light (oriented ones) move by more than this says.

use glam::Vec3;

use crate::base::{FitError, checks};
use crate::light::is_same_direction;
use crate::projection::LightProjection;

/// When a held light steps, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct LightSteps {
    /// Greatest movement at the map's edge for which the light is still held, in texels. 0 follows
    /// every change that is more than rounding. Default: 1.
    pub texels: f32,
    /// Extent of the map by which that movement is computed, in texels: its width, or
    /// [`Self::extent_of`]. Default: 2048.
    pub extent: f32,
    /// Time of the cross-fade from the old direction to the new one, in seconds. 0 steps at once.
    /// While a fade runs no other step begins, so that two maps are enough: a light that moves on
    /// lags by this time. Default: 0.
    pub fade: f32,
}

impl Default for LightSteps {
    fn default() -> Self {
        Self { texels: 1.0, extent: 2048.0, fade: 0.0 }
    }
}

impl LightSteps {
    /// These settings with another [`texels`](Self::texels).
    #[must_use]
    pub const fn with_texels(mut self, texels: f32) -> Self {
        self.texels = texels;
        self
    }

    /// These settings with another [`extent`](Self::extent).
    #[must_use]
    pub const fn with_extent(mut self, extent: f32) -> Self {
        self.extent = extent;
        self
    }

    /// These settings with another [`fade`](Self::fade).
    #[must_use]
    pub const fn with_fade(mut self, fade: f32) -> Self {
        self.fade = fade;
        self
    }

    /// Extent of a fit for which no point of its box moves farther than predicted, along either
    /// axis of the map, in texels: its longer side and its depth range together, by the shorter
    /// side of a texel.
    pub fn extent_of(fit: &LightProjection) -> f32 {
        let (texel, resolution) = (fit.texel_size, fit.resolution.as_vec2());
        let side = (texel.x * resolution.x).max(texel.y * resolution.y);
        (side + fit.depth_range) / texel.x.min(texel.y)
    }

    /// Angle that the light may turn by before it steps, in radians: 2 · texels / extent.
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

/// State of a held light, as plain data. By default it has seen no light yet.
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
///     // Fit and shade with step.direction; where there is a step.previous, with both, by step.blend.
///     directions += u32::from(last != Some(step.direction));
///     last = Some(step.direction);
/// }
/// assert!(directions < 8); // instead of 600
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LightStepState {
    /// The light's direction of travel that is held, a unit vector in world axes.
    pub held: Option<Vec3>,
    /// The direction that is faded out.
    pub previous: Option<Vec3>,
    /// Weight of the held direction while another is faded out, 0..=1; f64, so that short frames
    /// add up in a long fade.
    pub blend: f64,
}

/// Directions to fit and shade with in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LightStep {
    /// The light's direction of travel to fit to, a unit vector in world axes: the same bits until
    /// it steps.
    pub direction: Vec3,
    /// The direction before the last step, while it is faded out: the same bits as it had then.
    pub previous: Option<Vec3>,
    /// Weight of [`Self::direction`]'s shadow, 0..=1; the previous one has the rest. 1 without a
    /// previous one.
    pub blend: f32,
}

impl LightStepState {
    /// The directions for the next frame, `seconds` after the last one, of a light that now
    /// travels in `direction` (world axes, any length). The first direction is taken as it is.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::BadDirection`] for the direction (or one put into
    /// the state by hand), [`FitError::OutOfRange`] for the settings and the time; the state is
    /// left as it was.
    pub fn update(&mut self, direction: Vec3, settings: &LightSteps, seconds: f32) -> Result<LightStep, FitError> {
        let angle = settings.angle()?;
        let seconds = checks::within("the time of the light's step", f64::from(seconds), 0.0, checks::MAX_LENGTH)?;
        // Rounded before it is compared, so that the same input is the same direction.
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

    /// Forgets the light, for a jump of the camera or of time: the next direction is taken as it
    /// is.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// This state with its fade, if one runs, moved on.
    fn faded(&self, seconds: f64, fade: f32) -> Result<Self, FitError> {
        let Some(previous) = self.previous else { return Ok(*self) };
        checks::unit("the direction that is faded out", previous)?;
        let blend = checks::within("the blend of the light's step", self.blend, 0.0, 1.0)?;
        // With a fade time of zero, a running fade ends.
        let blend = if fade > 0.0 { blend + seconds / f64::from(fade) } else { 1.0 };
        Ok(if blend < 1.0 { Self { blend, ..*self } } else { Self { previous: None, blend: 0.0, ..*self } })
    }
}

/// Angle between two directions, in radians; exactly 0 between equal ones.
fn turn(held: Vec3, new: Vec3) -> f64 {
    let (held, new) = (held.as_dvec3(), new.as_dvec3());
    libm::atan2(checks::length(held.cross(new)), held.dot(new))
}
