//! A shot: the plain data of one picture to draw.

use shadowfit::Camera;
use shadowfit_params::tool::{ErrorMarks, Settings};
use shadowfit_render::Gpu;
use shadowfit_study::{PreparedScene, View};

/// The data of one picture to draw.
pub(super) struct Shot<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) scene: &'a mut PreparedScene,
    /// Settings, with the technique of the side.
    pub(super) settings: &'a Settings,
    pub(super) camera: Camera,
    /// Distance that determines the haze, in metres.
    pub(super) sight: f32,
    /// Whether an animation moves the scene from frame to frame.
    pub(super) plays: bool,
    /// Part of the picture to draw: x, y, width and height in pixels; all of it if `None`.
    pub(super) scissor: Option<[u32; 4]>,
    /// Time of the scene's animation, in seconds.
    pub(super) seconds: f32,
    /// The stage's clock, in seconds.
    pub(super) clock: f32,
    /// Current strength of blinking marks, 0..=1.
    pub(super) blink: f32,
    /// Whether the verdicts of this picture are not shown.
    pub(super) is_unseen: bool,
}

impl Shot<'_> {
    /// Returns the view for fitting and judging.
    pub(super) fn view(&self) -> View {
        View { camera: self.camera, direction: self.settings.light.direction(), is_first: false }
    }

    /// Returns the distance above the surface at which shadow rays start, in metres.
    pub(super) fn ray_offset(&self) -> f64 {
        self.settings.view.ray_offset.map_or(self.scene.ray_offset(), f64::from)
    }

    /// Returns whether rays are needed. Pictures that are made one by one are judged only if they show the
    /// result.
    pub(super) fn wants_rays(&self, goes_on: bool) -> bool {
        let view = &self.settings.view;
        (view.judge && goes_on) || view.mode.is_judged() || view.marks != ErrorMarks::Off
    }
}
