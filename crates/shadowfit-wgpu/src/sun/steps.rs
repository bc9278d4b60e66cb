//! Light steps of a sun: which direction its maps are made for in each frame, and when one set of maps goes over into
//! the next. Decided without a GPU.
//!
//! ```text
//!   held ──▶ drawing: a map of the new direction in each frame; the old maps are read
//!     ▲         │
//!     └───── fading: both are read, the old ones with less and less of a share
//! ```

use shadowfit::FitError;
use shadowfit::glam::Vec3;
use shadowfit::light_steps::{self, LightStepState};

/// How the maps of a moving sun are held still: its **light steps**. See
/// [`SunShadows::set_light_steps`](crate::SunShadows::set_light_steps).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSteps {
    /// Greatest movement of a map's edge for which the direction is held, in texels, as
    /// [`light_steps::LightSteps::texels`]: the sun steps when it has turned by 2 · texels / side of the map. 0 follows
    /// every change. Default: 1, which is 0.056° with maps of 2048² texels.
    pub texels: f32,
    /// Frames of the cross-fade from the old maps to the new ones. 0 steps at once, and needs no second set of maps; 1
    /// changes from one frame to the next, to maps that were drawn one by one in the frames before. Default: 0.
    pub fade: u32,
}

impl Default for LightSteps {
    fn default() -> Self {
        Self { texels: light_steps::LightSteps::default().texels, fade: 0 }
    }
}

impl LightSteps {
    /// These steps with another [`texels`](Self::texels).
    #[must_use]
    pub const fn with_texels(mut self, texels: f32) -> Self {
        self.texels = texels;
        self
    }

    /// These steps with another [`fade`](Self::fade).
    #[must_use]
    pub const fn with_fade(mut self, frames: u32) -> Self {
        self.fade = frames;
        self
    }

    /// The settings of the core, for maps of a width in texels. Fades are counted here.
    fn core(self, side: u32) -> light_steps::LightSteps {
        light_steps::LightSteps::default().with_texels(self.texels).with_extent(side as f32)
    }

    /// Refuses numbers that make no sense.
    pub(super) fn check(self) -> Result<(), FitError> {
        self.core(1).angle().map(|_| ())
    }
}

/// Length of the difference of two unit directions that no step bridges, 2°: a sun that is so far from its maps was set
/// elsewhere, and both shadows would be seen side by side. What a frame showed under one light hardly serves the other.
const JUMP: f32 = 0.035;

/// The state of a sun that steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepState {
    pub(super) settings: LightSteps,
    /// The newest direction that is held.
    light: LightStepState,
    stage: Stage,
    /// Whether the next frame takes what is new at once.
    is_cut: bool,
}

/// The sets of maps that there are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Stage {
    /// One set.
    #[default]
    Held,
    /// The maps of the next direction are drawn, this many by now; `now` is that of the maps that are read.
    Drawing { now: Vec3, drawn: usize },
    /// The maps of the direction `before` are faded out; the others have this share.
    Fading { before: Vec3, frame: u32, share: f32 },
}

/// A frame's light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    /// The direction of the maps that are read, a unit vector: of those that are faded in, where two sets are.
    pub(super) now: Vec3,
    /// That of the other set, if there is one: the next direction, or the one before.
    pub(super) other: Option<Vec3>,
    /// Whether another set is begun in this frame.
    pub(super) begins: bool,
    /// Whether the two change places in this frame.
    pub(super) swaps: bool,
}

impl StepState {
    pub(super) fn new(settings: LightSteps) -> Self {
        Self { settings, light: LightStepState::default(), stage: Stage::Held, is_cut: false }
    }

    /// The state with other settings.
    pub(super) fn with_settings(self, settings: LightSteps) -> Self {
        Self { settings, ..self }
    }

    /// The sets of maps that there are.
    pub(super) fn stage(&self) -> Stage {
        self.stage
    }

    /// Whether the maps of the newest direction are drawn and not read yet.
    pub(super) fn is_drawing(&self) -> bool {
        matches!(self.stage, Stage::Drawing { .. })
    }

    /// The newest direction of maps, a unit vector.
    pub(super) fn newest(&self) -> Option<Vec3> {
        self.light.held
    }

    /// Ends a step: the next frame has one set of maps, for what is the newest direction then.
    pub(super) fn cut(&mut self) {
        (self.stage, self.is_cut) = (Stage::Held, true);
    }

    /// Forgets the light.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.settings);
    }

    /// Goes on to a frame whose light travels in `direction`, of any length. `side`: that of the maps, in texels.
    /// `kept`: how many maps are drawn one by one, since they can be kept; 0 where all are redrawn in each frame anyway.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::BadDirection`] for the direction; the state stays as it was.
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

    /// The next frame of a sun that is held. `fading`: if the next step fades, the number of maps that are drawn one by one.
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

    /// A frame of the fade from a direction to the newest one. In the last one there is only the latter.
    fn fade(&mut self, before: Vec3, frame: u32) -> Step {
        let share = frame as f32 / self.settings.fade as f32;
        self.stage = if share < 1.0 { Stage::Fading { before, frame, share } } else { Stage::Held };
        Step { swaps: true, ..self.step(self.light.held.unwrap_or(before), false) }
    }

    /// The light of a frame whose maps are read by `now`.
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
