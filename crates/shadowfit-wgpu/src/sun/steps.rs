//! Light steps of a sun: the direction that its maps are fitted to in each frame, and the fade from one set
//! of maps to the next. These decisions need no GPU.
//!
//! ```text
//!   held ──▶ drawing: a map of the new direction in each frame; the old maps are read
//!     ▲         │
//!     └───── fading: both are read, the old ones with less and less of a share
//! ```

use shadowfit::FitError;
use shadowfit::glam::Vec3;
use shadowfit::light_steps::{self, LightStepState};

/// **Light steps** of a moving sun, which hold its maps still in between. See
/// [`SunShadows::set_light_steps`](crate::SunShadows::set_light_steps).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSteps {
    /// Greatest movement of a map's edge in one step, in texels, as in [`light_steps::LightSteps::texels`].
    /// The sun steps when it has turned by 2 · texels / width of the map in texels, in radians. 0 follows
    /// every change. Default: 1, which is 0.056° for maps of 2048² texels.
    pub texels: f32,
    /// Number of frames of the cross-fade from the old maps to the new ones. 0 steps at once, without a
    /// second set of maps. 1 switches within one frame to maps that were drawn one by one in the frames
    /// before. Default: 0.
    pub fade: u32,
}

impl Default for LightSteps {
    fn default() -> Self {
        Self { texels: light_steps::LightSteps::default().texels, fade: 0 }
    }
}

impl LightSteps {
    /// Returns these steps with another [`texels`](Self::texels).
    #[must_use]
    pub const fn with_texels(mut self, texels: f32) -> Self {
        self.texels = texels;
        self
    }

    /// Returns these steps with another [`fade`](Self::fade).
    #[must_use]
    pub const fn with_fade(mut self, frames: u32) -> Self {
        self.fade = frames;
        self
    }

    /// Returns the settings of the core, for maps of this width in texels. The core does not fade: this
    /// module counts the frames.
    fn core(self, side: u32) -> light_steps::LightSteps {
        light_steps::LightSteps::default().with_texels(self.texels).with_extent(side as f32)
    }

    /// Refuses invalid numbers.
    pub(super) fn check(self) -> Result<(), FitError> {
        self.core(1).angle().map(|_| ())
    }
}

/// Greatest distance between two unit directions that a step bridges: 2°. A sun farther from its maps was
/// moved elsewhere. A fade would show both shadows side by side, and the visible demand under one light
/// hardly helps the other.
const JUMP: f32 = 0.035;

/// State of a sun with light steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepState {
    pub(super) settings: LightSteps,
    /// Newest held direction.
    light: LightStepState,
    stage: Stage,
    /// Whether the next frame takes the newest direction at once.
    is_cut: bool,
}

/// Stage of a light step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Stage {
    /// One set of maps.
    #[default]
    Held,
    /// The maps of the next direction are drawn, `drawn` of them so far. `now` is the direction of the maps
    /// that shaders read.
    Drawing { now: Vec3, drawn: usize },
    /// The maps of the direction `before` fade out. The others have this share.
    Fading { before: Vec3, frame: u32, share: f32 },
}

/// Light directions of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// Direction of the maps that shaders read, a unit vector. During a fade, the direction of the set that
    /// fades in.
    pub(super) now: Vec3,
    /// Direction of the other set, if there is one: the next direction or the previous one.
    pub(super) other: Option<Vec3>,
    /// Whether another set begins in this frame.
    pub(super) begins: bool,
    /// Whether the two sets are swapped in this frame.
    pub(super) swaps: bool,
}

impl StepState {
    pub(super) fn new(settings: LightSteps) -> Self {
        Self { settings, light: LightStepState::default(), stage: Stage::Held, is_cut: false }
    }

    /// Returns this state with other settings.
    pub(super) fn with_settings(self, settings: LightSteps) -> Self {
        Self { settings, ..self }
    }

    /// Returns the stage.
    pub(super) fn stage(&self) -> Stage {
        self.stage
    }

    /// Returns whether the maps of the newest direction are being drawn and not read yet.
    pub(super) fn is_drawing(&self) -> bool {
        matches!(self.stage, Stage::Drawing { .. })
    }

    /// Returns the newest direction of maps, a unit vector.
    pub(super) fn newest(&self) -> Option<Vec3> {
        self.light.held
    }

    /// Ends a step: the next frame has one set of maps, for the direction that is newest then.
    pub(super) fn cut(&mut self) {
        (self.stage, self.is_cut) = (Stage::Held, true);
    }

    /// Forgets the light.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.settings);
    }

    /// Advances to a frame whose light travels in `direction`, of any length. `side` is the width of the
    /// maps, in texels. `kept` is the number of maps that are drawn one by one because they can be kept. It
    /// is 0 if all maps are redrawn in each frame.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::BadDirection`] for the direction. The state does not change
    /// then.
    pub(super) fn next(&mut self, direction: Vec3, side: u32, kept: usize) -> Result<Step, FitError> {
        let core = self.settings.core(side);
        let new = LightStepState::default().update(direction, &core, 0.0)?.direction;
        let is_jump = self.light.held.is_some_and(|held| (held - new).length() > JUMP);
        let fades = self.settings.fade > 0 && !is_jump && !self.is_cut;
        if is_jump {
            self.light.reset();
        }
        self.is_cut = false;
        if !fades {
            self.stage = Stage::Held;
        }
        Ok(match self.stage {
            Stage::Held => self.hold(new, &core, fades.then_some(kept))?,
            Stage::Drawing { now, drawn } if drawn < kept => {
                self.stage = Stage::Drawing { now, drawn: drawn + 1 };
                self.step(now, false)
            }
            Stage::Drawing { now, .. } => self.fade(now, 1),
            Stage::Fading { before, frame, .. } => Step { swaps: false, ..self.fade(before, frame + 1) },
        })
    }

    /// Computes the next frame of a held sun. If the next step fades, `fading` is the number of maps that are
    /// drawn one by one.
    fn hold(&mut self, new: Vec3, core: &light_steps::LightSteps, fading: Option<usize>) -> Result<Step, FitError> {
        let held = self.light.held;
        let next = self.light.update(new, core, 0.0)?.direction;
        Ok(match held.filter(|held| *held != next).zip(fading) {
            None => self.step(next, false),
            Some((now, 0)) => Step { begins: true, ..self.fade(now, 1) },
            Some((now, _)) => {
                self.stage = Stage::Drawing { now, drawn: 1 };
                self.step(now, true)
            }
        })
    }

    /// Computes a frame of the fade from a direction to the newest one. The last frame has only the newest
    /// one.
    fn fade(&mut self, before: Vec3, frame: u32) -> Step {
        let share = frame as f32 / self.settings.fade as f32;
        self.stage = if share < 1.0 { Stage::Fading { before, frame, share } } else { Stage::Held };
        Step { swaps: true, ..self.step(self.light.held.unwrap_or(before), false) }
    }

    /// Returns the light of a frame whose shaders read the maps of `now`.
    fn step(&self, now: Vec3, begins: bool) -> Step {
        let other = match self.stage {
            Stage::Held => None,
            Stage::Drawing { .. } => self.light.held,
            Stage::Fading { before, .. } => Some(before),
        };
        Step { now, other, begins, swaps: false }
    }
}

#[cfg(test)]
#[path = "steps/tests.rs"]
mod tests;
