//! What a sample is: its card, its options and variants, the camera it starts with, its scene and how it is drawn.

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera, Technique};
use shadowfit_params::tool::CameraSettings;
use shadowfit_render::FlyCamera;
use shadowfit_render::camera::TURN_SPEED;
use shadowfit_scene::Scene;

use crate::mapped::SampleFrame;
use crate::occlusion::OcclusionFrame;
use crate::options::{OptionError, SampleOption, SampleValues};

/// A classic technique that runs as its source has it.
#[derive(Debug)]
pub struct Sample {
    /// Its name in command lines and files.
    pub id: &'static str,
    /// Its name for people.
    pub title: &'static str,
    /// What it teaches, as a sentence or two.
    pub teaches: &'static str,
    /// What it is known to do badly.
    pub flaw: &'static str,
    /// Its page below `docs`.
    pub page: &'static str,
    /// Width and height of its source's window, in pixels.
    pub size: [u32; 2],
    /// Where it is seen from.
    pub view: SampleView,
    /// Unit direction of travel of the sun that modern maps are fitted to; for a lamp, along its axis.
    pub direction: Vec3,
    /// Where its map is shown in the source's window: left, top, width and height, in pixels.
    pub inset: Option<[u32; 4]>,
    /// Whether only the scene's subject casts.
    pub only_subject_casts: bool,
    /// Whether it has shadows that rays can judge.
    pub is_measurable: bool,
    /// What its own controls do otherwise than those of the viewer.
    pub controls: SampleControls,
    /// What can be changed.
    pub options: &'static [SampleOption],
    /// What it can show beside itself: its flaws and its cures.
    pub variants: &'static [SampleVariant],
    pub(crate) scene: fn() -> Scene,
    pub(crate) draws: fn(&SampleValues, &PerspectiveCamera) -> Result<SampleDrawing, FitError>,
}

/// Where a sample is seen from, in its own units; the vertical field of view is in radians.
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
    /// How fast arrows and the right stick turn the view, in radians a second.
    pub turn: f32,
    /// How fast Q and E, and the triggers, turn the model, in radians a second: 0 where they let the camera sink and rise.
    /// The model turns by the first animation of its scene, a whole turn.
    pub model_turn: f32,
    /// Eye and direction of view that R, and a click of the right stick, put the camera to, if not those of the start.
    pub reset: Option<(DVec3, Vec3)>,
}

impl SampleControls {
    /// Those of the viewer.
    pub const VIEWER: Self = Self { turn: TURN_SPEED, model_turn: 0.0, reset: None };
}

/// A flaw or a cure of a sample: options, and a view where it shows.
#[derive(Debug)]
pub struct SampleVariant {
    /// Its name, behind the sample's and a slash.
    pub id: &'static str,
    /// Its name for people.
    pub label: &'static str,
    /// What is to be seen.
    pub text: &'static str,
    /// Options that differ from the defaults, as command lines say them.
    pub options: &'static [(&'static str, &'static str)],
    /// Eye and direction of view, if not the sample's own.
    pub view: Option<(DVec3, Vec3)>,
}

/// How a sample is drawn at present.
#[derive(Clone, Debug)]
pub enum SampleDrawing {
    /// By the samples' renderer.
    Mapped(SampleFrame),
    /// As any scene, by a technique of the core.
    Technique {
        /// The technique.
        technique: Technique,
        /// Whether each point is shown in the tint of the map that it reads.
        is_tinted: bool,
    },
    /// With ambient occlusion.
    Occlusion {
        /// Light, and occlusion as it is found in screen space.
        frame: OcclusionFrame,
        /// Whether it is found by rays instead.
        is_traced: bool,
    },
}

impl Sample {
    /// Builds its scene.
    pub fn scene(&self) -> Scene {
        (self.scene)()
    }

    /// How it is drawn by its values, as a camera sees it.
    ///
    /// # Errors
    ///
    /// [`FitError`] where the camera or the light cannot be fitted to.
    pub fn drawing(&self, values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
        (self.draws)(values, camera)
    }

    /// Whether its values are drawn by a technique, as any scene is.
    pub fn is_technique(&self, values: &SampleValues) -> bool {
        matches!(self.drawing(values, &self.lens(1.0)), Ok(SampleDrawing::Technique { .. }))
    }

    /// The technique of its values, or the one that modern maps of its view have.
    pub fn technique(&self, values: &SampleValues) -> Technique {
        match self.drawing(values, &self.lens(1.0)) {
            Ok(SampleDrawing::Technique { technique, .. }) => technique,
            _ => modern(self.view.far),
        }
    }

    /// Whether its values show each point in the tint of the map that it reads.
    pub fn is_tinted(&self, values: &SampleValues) -> bool {
        matches!(self.drawing(values, &self.lens(1.0)), Ok(SampleDrawing::Technique { is_tinted: true, .. }))
    }

    /// The camera that it is seen through at first, for a picture of an aspect (width over height).
    pub fn lens(&self, aspect: f32) -> PerspectiveCamera {
        let (camera, lens) = self.camera();
        camera.perspective(&lens, aspect)
    }

    /// The camera of a variant, or of the sample itself, for a picture of an aspect (width over height).
    pub fn seen_by(&self, variant: Option<&SampleVariant>, aspect: f32) -> PerspectiveCamera {
        let camera = self.lens(aspect);
        match variant.and_then(|variant| variant.view) {
            Some((eye, forward)) => PerspectiveCamera { eye, forward: forward.normalize(), ..camera },
            None => camera,
        }
    }

    /// Eye and lens that it is seen through at first.
    pub fn camera(&self) -> (FlyCamera, CameraSettings) {
        let SampleView { eye, forward, fov_y, near, far, speed } = self.view;
        let camera = FlyCamera::look_at(eye, eye + forward.as_dvec3());
        (camera, CameraSettings { fov_y, near, far, speed, ..CameraSettings::default() })
    }
}

impl SampleValues {
    /// The values of the source.
    pub fn new(sample: &Sample) -> Self {
        Self::of(sample.id, sample.options)
    }

    /// The values of a variant.
    ///
    /// # Errors
    ///
    /// [`OptionError`] where the variant names an option or a value that the sample does not have.
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

/// The technique of modern maps for a view as deep as this.
pub(crate) fn modern(far: f32) -> Technique {
    let mut technique = Technique::default();
    technique.fit = technique.fit.with_max_distance(far).with_caster_extension(far);
    technique
}
