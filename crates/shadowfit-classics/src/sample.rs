//! The type of a sample: its card, its options and variants, its first camera, its scene and its drawing.

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera, Technique};
use shadowfit_params::tool::CameraSettings;
use shadowfit_render::FlyCamera;
use shadowfit_render::camera::TURN_SPEED;
use shadowfit_scene::Scene;

use crate::mapped::SampleFrame;
use crate::occlusion::OcclusionFrame;
use crate::options::{OptionError, SampleOption, SampleValues};

/// A classic technique, implemented as in its source.
#[derive(Debug)]
pub struct Sample {
    /// Name in command lines and files.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// Lesson of the sample, in a sentence or two.
    pub teaches: &'static str,
    /// Known weakness.
    pub flaw: &'static str,
    /// Page below `docs`.
    pub page: &'static str,
    /// Width and height of the source's window, in pixels.
    pub size: [u32; 2],
    /// Start view.
    pub view: SampleView,
    /// Unit direction of travel of the sun for which modern maps are fitted. For a lamp, the direction of its
    /// axis.
    pub direction: Vec3,
    /// Rectangle of the map's inset in the source's window: left, top, width and height, in pixels.
    pub inset: Option<[u32; 4]>,
    /// Whether only the scene's subject casts.
    pub only_subject_casts: bool,
    /// Whether it has shadows that rays can judge.
    pub is_measurable: bool,
    /// Controls that differ from the viewer's.
    pub controls: SampleControls,
    /// Options.
    pub options: &'static [SampleOption],
    /// Variants, which show its flaws and cures.
    pub variants: &'static [SampleVariant],
    pub(crate) scene: fn() -> Scene,
    pub(crate) draws: fn(&SampleValues, &PerspectiveCamera) -> Result<SampleDrawing, FitError>,
}

/// View of a sample, in its own units. The vertical field of view is in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleView {
    /// Eye.
    pub eye: DVec3,
    /// Direction of view, of any length.
    pub forward: Vec3,
    /// Vertical field of view.
    pub fov_y: f32,
    /// Distance of the near plane.
    pub near: f32,
    /// Distance of the far plane.
    pub far: f32,
    /// Flying speed, in units a second.
    pub speed: f32,
}

/// Controls of a sample that differ from those of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleControls {
    /// Speed at which arrows and the right stick turn the view, in radians a second.
    pub turn: f32,
    /// Speed at which Q and E, and the triggers, turn the model, in radians a second. At 0 they lower and
    /// raise the camera instead. The first animation of the scene, a whole turn, turns the model.
    pub model_turn: f32,
    /// Eye and direction of view after R or a click of the right stick, if not the start view's.
    pub reset: Option<(DVec3, Vec3)>,
}

impl SampleControls {
    /// The viewer's controls.
    pub const VIEWER: Self = Self { turn: TURN_SPEED, model_turn: 0.0, reset: None };
}

/// A flaw or a cure of a sample: options, and a view that shows it.
#[derive(Debug)]
pub struct SampleVariant {
    /// Name, after the sample's name and a slash.
    pub id: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Description of the picture.
    pub text: &'static str,
    /// Options that differ from the defaults, as text of command lines.
    pub options: &'static [(&'static str, &'static str)],
    /// Eye and direction of view, if not the sample's own.
    pub view: Option<(DVec3, Vec3)>,
}

/// Way to draw a sample with its current values.
#[derive(Clone, Debug)]
pub enum SampleDrawing {
    /// With the samples' renderer.
    Mapped(SampleFrame),
    /// With a technique of the core, like any scene.
    Technique {
        /// The technique.
        technique: Technique,
        /// Whether each point is shown in the tint of the map that it reads.
        is_tinted: bool,
    },
    /// With ambient occlusion.
    Occlusion {
        /// Light, and settings of screen-space occlusion.
        frame: OcclusionFrame,
        /// Whether rays compute the occlusion instead.
        is_traced: bool,
    },
}

impl Sample {
    /// Builds its scene.
    pub fn scene(&self) -> Scene {
        (self.scene)()
    }

    /// Returns how to draw it with these values and this camera.
    ///
    /// # Errors
    ///
    /// [`FitError`] if the camera or the light cannot be fitted.
    pub fn drawing(&self, values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
        (self.draws)(values, camera)
    }

    /// Returns whether these values are drawn with a technique, like any scene.
    pub fn is_technique(&self, values: &SampleValues) -> bool {
        matches!(self.drawing(values, &self.lens(1.0)), Ok(SampleDrawing::Technique { .. }))
    }

    /// Returns the technique of these values, or the technique of modern maps for its view.
    pub fn technique(&self, values: &SampleValues) -> Technique {
        match self.drawing(values, &self.lens(1.0)) {
            Ok(SampleDrawing::Technique { technique, .. }) => technique,
            _ => modern(self.view.far),
        }
    }

    /// Returns whether these values tint each point by the map that it reads.
    pub fn is_tinted(&self, values: &SampleValues) -> bool {
        matches!(self.drawing(values, &self.lens(1.0)), Ok(SampleDrawing::Technique { is_tinted: true, .. }))
    }

    /// Returns the first camera, for a picture of an aspect (width over height).
    pub fn lens(&self, aspect: f32) -> PerspectiveCamera {
        let (camera, lens) = self.camera();
        camera.perspective(&lens, aspect)
    }

    /// Returns the camera of a variant, or the sample's own, for a picture of an aspect (width over height).
    pub fn seen_by(&self, variant: Option<&SampleVariant>, aspect: f32) -> PerspectiveCamera {
        let camera = self.lens(aspect);
        match variant.and_then(|variant| variant.view) {
            Some((eye, forward)) => PerspectiveCamera { eye, forward: forward.normalize(), ..camera },
            None => camera,
        }
    }

    /// Returns eye and lens of the first camera.
    pub fn camera(&self) -> (FlyCamera, CameraSettings) {
        let SampleView { eye, forward, fov_y, near, far, speed } = self.view;
        let camera = FlyCamera::look_at(eye, eye + forward.as_dvec3());
        (camera, CameraSettings { fov_y, near, far, speed, ..CameraSettings::default() })
    }
}

impl SampleValues {
    /// Returns the source's values.
    pub fn new(sample: &Sample) -> Self {
        Self::of(sample.id, sample.options)
    }

    /// Returns the values of a variant.
    ///
    /// # Errors
    ///
    /// [`OptionError`] if the variant names an option or a value that the sample does not have.
    pub fn of_variant(sample: &Sample, variant: Option<&SampleVariant>) -> Result<Self, OptionError> {
        let mut values = Self::new(sample);
        for (id, value) in variant.map_or(&[][..], |variant| variant.options) {
            values.set_from_str(id, value)?;
        }
        Ok(values)
    }
}

impl PartialEq for Sample {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Sample {}

impl PartialEq for SampleVariant {
    fn eq(&self, other: &Self) -> bool {
        (self.id, self.label) == (other.id, other.label)
    }
}

impl Eq for SampleVariant {}

/// Returns the technique of modern maps for a view with this far distance.
pub(crate) fn modern(far: f32) -> Technique {
    let mut technique = Technique::default();
    technique.fit = technique.fit.with_max_distance(far).with_caster_extension(far);
    technique
}
