//! What a side is asked to draw: plain data of one picture.

use shadowfit::Camera;
use shadowfit_params::tool::{ErrorMarks, Settings};
use shadowfit_render::Gpu;
use shadowfit_study::{PreparedScene, View};

/// What is to be drawn.
pub(super) struct Shot<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) scene: &'a mut PreparedScene,
    /// With the technique of the side.
    pub(super) settings: &'a Settings,
    pub(super) camera: Camera,
    /// Distance that the haze suits, in metres.
    pub(super) sight: f32,
    /// Whether an animation moves the scene from frame to frame.
    pub(super) plays: bool,
    /// Part of the picture that is drawn: x, y, width and height in pixels; all of it if `None`.
    pub(super) scissor: Option<[u32; 4]>,
    /// Time of the scene's animation, in seconds.
    pub(super) seconds: f32,
    /// The stage's clock, in seconds.
    pub(super) clock: f32,
    /// Strength of blinking marks at this time, 0..=1.
    pub(super) blink: f32,
    /// Whether nothing shows the verdicts of this picture.
    pub(super) is_unseen: bool,
}

impl Shot<'_> {
    /// The view as it is fitted and judged.
    pub(super) fn view(&self) -> View {
        View { camera: self.camera, direction: self.settings.light.direction(), is_first: false }
    }

    /// Distance above the surface at which shadow rays start, in metres.
    pub(super) fn ray_offset(&self) -> f64 {
        self.settings.view.ray_offset.map_or(self.scene.ray_offset(), f64::from)
    }

    /// Whether rays are asked for. Pictures that are made one by one are judged only where they show it.
    pub(super) fn wants_rays(&self, goes_on: bool) -> bool {
        let view = &self.settings.view;
        (view.judge && goes_on) || view.mode.is_judged() || view.marks != ErrorMarks::Off
    }
}
