//! A classic sample on the stage: its values, its controls, and its drawer.

use anyhow::{Context, Result};
use shadowfit::PerspectiveCamera;
use shadowfit_classics::{OptionKind, Sample, SampleDrawer, SampleOutcome, SampleValues, SampleVariant};
use shadowfit_params::tool::ViewMode;
use shadowfit_render::{FlyCamera, FlyInput, Gpu, RenderTarget, camera::TURN_SPEED};

use super::{Stage, compare};

/// The current sample.
#[derive(Debug)]
pub(crate) struct SampleShow {
    pub(crate) sample: &'static Sample,
    pub(crate) variant: Option<&'static SampleVariant>,
    pub(crate) values: SampleValues,
    drawer: SampleDrawer,
    /// Notes about options that could not be drawn as requested.
    message: Option<String>,
    /// Target of the right half.
    beside: Option<RenderTarget>,
}

impl SampleShow {
    /// Draws with another device from now on.
    pub(super) fn move_to(&mut self, gpu: &Gpu, samples: u32) {
        let waits = self.drawer.waits;
        self.drawer = SampleDrawer::new(gpu, samples);
        (self.drawer.waits, self.beside) = (waits, None);
    }

    /// Restores the values of the source, or of the variant.
    pub(super) fn reset(&mut self) {
        self.values =
            SampleValues::of_variant(self.sample, self.variant).unwrap_or_else(|_| SampleValues::new(self.sample));
    }
}

impl Stage {
    /// Shows a sample or one of its variants. The current scene must be the sample's scene.
    pub fn set_sample(&mut self, sample: &'static Sample, variant: Option<&'static SampleVariant>) {
        let values = SampleValues::of_variant(sample, variant).unwrap_or_else(|_| SampleValues::new(sample));
        let (camera, lens) = sample.camera();
        self.settings.camera = lens;
        self.settings.view.play = false;
        if let Some(light) = shadowfit_params::tool::LightSettings::from_direction(sample.direction) {
            self.settings.light = light;
        }
        self.settings.technique = sample.technique(&values);
        (self.settings.view.mode, self.settings.view.shadows) = view(sample, &values);
        let mut drawer = match self.sample.take() {
            Some(show) => show.drawer,
            None => SampleDrawer::new(&self.gpu, self.samples),
        };
        drawer.waits = self.side.live.waits;
        self.home = (self.settings, camera);
        let eye = variant.and_then(|variant| variant.view).map_or(camera, |(eye, forward)| look(eye, forward));
        self.set_camera(eye);
        self.sample = Some(SampleShow { sample, variant, values, drawer, message: None, beside: None });
    }

    /// Returns the current sample, if there is one.
    pub(crate) fn sample(&self) -> Option<&SampleShow> {
        self.sample.as_ref()
    }

    /// Sets the values of the current sample.
    pub(crate) fn set_sample_values(&mut self, values: SampleValues) {
        let Some(show) = &mut self.sample else { return };
        let technique = show.sample.technique(&values);
        if technique != show.sample.technique(&show.values) {
            self.settings.technique = technique;
        }
        let view = view(show.sample, &values);
        if view != self::view(show.sample, &show.values) {
            (self.settings.view.mode, self.settings.view.shadows) = view;
        }
        show.values = values;
    }

    /// Sets an option of the current sample by its index.
    pub(crate) fn set_sample_option(&mut self, option: usize, value: f32) {
        if let Some(mut values) = self.sample.as_ref().map(|show| show.values.clone()) {
            values.set(option, value);
            self.set_sample_values(values);
        }
    }

    /// Sets an option of the current sample by name and text.
    ///
    /// # Errors
    ///
    /// If there is no sample, or it lacks the option or value.
    pub fn set_sample_text(&mut self, option: &str, text: &str) -> Result<()> {
        let show = self.sample.as_ref().context("no sample is shown")?;
        let mut values = show.values.clone();
        values.set_from_str(option, text)?;
        self.set_sample_values(values);
        Ok(())
    }

    /// Returns whether R has a special view in the current sample.
    pub(crate) fn has_sample_reset(&self) -> bool {
        self.sample_reset().is_some()
    }

    /// Returns whether a sample's own renderer draws the picture. Technique and views do not apply to it.
    pub(crate) fn draws_sample(&self) -> bool {
        self.sample.as_ref().is_some_and(|show| !show.sample.is_technique(&show.values))
    }

    /// Returns names of both halves of the picture, if a sample shows something else in the right one.
    pub(crate) fn sample_halves(&self) -> Option<[String; 2]> {
        let show = self.sample.as_ref()?;
        show.values.beside()?;
        let label = show.values.iter().find(|(option, _)| option.id == "beside").map(|(option, value)| {
            let OptionKind::Choice(choices) = option.kind else { return "" };
            choices.get(value as usize).map_or("", |(_, label)| label)
        });
        let left = show.variant.map_or(show.sample.title, |variant| variant.label);
        Some([left.to_owned(), label.unwrap_or_default().to_owned()])
    }

    /// Returns the notes of the sample.
    pub(super) fn sample_message(&self) -> Option<&str> {
        self.sample.as_ref().and_then(|show| show.message.as_deref())
    }

    /// Draws the current sample, and the right half beside it, into a target.
    pub(super) fn draw_sample(&mut self, target: &RenderTarget) {
        let Some(mut show) = self.sample.take() else { return };
        show.message = None;
        let values = show.values.clone();
        self.draw_values(&mut show, &values, target);
        if let Some(other) = values.beside() {
            let kept = show.beside.take().filter(|beside| beside.size == target.size);
            let beside = kept.unwrap_or_else(|| self.target(target.size));
            self.draw_values(&mut show, &other, &beside);
            target.copy_part(&self.gpu, &beside, compare::right_part(self.split, target.size));
            show.beside = Some(beside);
        }
        self.sample = Some(show);
    }

    /// Returns the camera of a sample's picture of the given size. The sources only have perspective cameras.
    pub(crate) fn sample_camera(&self, size: [u32; 2]) -> PerspectiveCamera {
        self.camera.perspective(&self.settings.camera, size[0] as f32 / size[1] as f32)
    }

    fn draw_values(&mut self, show: &mut SampleShow, values: &SampleValues, target: &RenderTarget) {
        let camera = self.sample_camera(target.size);
        let drawn = show.drawer.draw(&self.gpu, &mut self.scene, show.sample, values, &camera, target);
        match drawn {
            Ok(SampleOutcome::Drawn { message }) => show.message = message.or(show.message.take()),
            Ok(SampleOutcome::ByTechnique) => self.draw_side(target),
            Err(error) => show.message = Some(format!("{error:#}")),
        }
    }

    /// Applies the sample's own controls to the user's input.
    pub(super) fn steer_sample(&mut self, input: &FlyInput, seconds: f32) -> FlyInput {
        let mut input = *input;
        let Some(show) = &self.sample else { return input };
        let controls = show.sample.controls;
        input.turn *= controls.turn / TURN_SPEED;
        if controls.model_turn != 0.0
            && let Some(duration) = self.duration()
        {
            let turned = input.movement.y * controls.model_turn / core::f32::consts::TAU * duration * seconds;
            input.movement.y = 0.0;
            if turned != 0.0 {
                self.set_time((self.seconds() + turned).rem_euclid(duration));
            }
        }
        input
    }

    /// Returns the view to which R moves the camera, if not the initial one.
    pub(super) fn sample_reset(&self) -> Option<FlyCamera> {
        let (eye, forward) = self.sample.as_ref()?.sample.controls.reset?;
        Some(look(eye, forward))
    }
}

/// Returns the view mode for values that a technique draws, and whether there are shadows.
fn view(sample: &Sample, values: &SampleValues) -> (ViewMode, bool) {
    let mode = if sample.is_tinted(values) { ViewMode::Maps } else { ViewMode::Final };
    (mode, values.choice("shadows") != "off")
}

fn look(eye: glam::DVec3, forward: glam::Vec3) -> FlyCamera {
    FlyCamera::look_at(eye, eye + forward.as_dvec3())
}
