//! Facts for tests of the page, as a line of JSON.

use serde_json::json;
use shadowfit_egui::Tune;

use super::Viewer;
use crate::platform::memory;

impl Viewer {
    /// Returns the facts, with `size`, the size of the canvas in pixels.
    pub(crate) fn facts(&self, size: [u32; 2]) -> String {
        let stage = &self.stage;
        let figures = stage.judged_figures();
        let camera = &stage.camera;
        let tried = match self.tuning.shown() {
            Tune::Running { tried, .. } => Some(tried),
            _ => None,
        };
        json!({
            "title": self.title(),
            "is_ready": self.is_ready(),
            "is_waiting": self.is_waiting(),
            "has_played": self.has_played(),
            "tried": tried,
            "is_judged": stage.is_judged(),
            "size": size,
            "memory": memory(),
            "drawer": self.interface.drawer_open,
            "frame_ms": self.interface.frame_ms,
            "position": camera.position.to_array(),
            "angles": [camera.yaw, camera.pitch],
            "artefact": stage.shown().map(|shown| (format!("{:?}", shown.artefact), shown.fixed)),
            "view": format!("{:?}", stage.settings.view.mode),
            "wrong": figures.map(|figures| figures.wrong),
            "false_shadow": figures.map(|figures| figures.false_shadow),
            "hole": figures.map(|figures| figures.hole),
            "problem": stage.problem(),
            "message": self.message.as_ref().map(|message| message.text.as_str()),
            "settings": shadowfit_study::settings_to_toml(&stage.settings, ""),
        })
        .to_string()
    }
}
