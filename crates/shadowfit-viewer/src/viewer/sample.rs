//! Samples in the viewer: their variants, and their comparison with modern maps.

use super::Viewer;
use crate::background::measuring::{Measuring, SampleView};
use crate::scene_source::SceneSource;

impl Viewer {
    /// Shows a variant of the current sample, or the sample as in its source.
    pub(super) fn show_sample_variant(&mut self, variant: Option<usize>) {
        let Some(show) = self.stage.sample() else { return };
        let sample = show.sample;
        let variant = variant.and_then(|index| sample.variants.get(index));
        self.stage.set_sample(sample, variant);
        self.source = SceneSource::Sample { sample, variant };
        // The variant's own settings become the scene's. All other changes remain differences.
        let (own, now) = (&mut self.own_settings, &self.stage.settings);
        (own.technique, own.light, own.camera) = (now.technique, now.light, now.camera);
        (own.view.mode, own.view.shadows, own.view.play) = (now.view.mode, now.view.shadows, now.view.play);
        self.measuring = Measuring::default();
        self.window_requests.new_title = true;
    }

    /// Starts to judge the sample and modern maps against rays.
    pub(super) fn measure_sample(&mut self) {
        let Some(show) = self.stage.sample() else { return };
        let camera = self.stage.sample_camera(self.interface.pictures.size());
        let (sample, values) = (show.sample, show.values.clone());
        let view = SampleView { sample, values, camera, seconds: self.stage.seconds() };
        self.measuring.start(self.start.arguments.adapter(), view);
    }
}
