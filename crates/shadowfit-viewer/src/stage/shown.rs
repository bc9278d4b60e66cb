//! The artefact on show: from the search for its view to its cure.

use shadowfit::params::{PARAMETERS, format_value};
use shadowfit::tool::{ErrorMarks, Settings};
use shadowfit_egui::Artefact;
use shadowfit_render::FlyCamera;

use super::Stage;
use crate::artefact::{self, Found, Search};

/// Shown when no view of a scene shows an artefact.
const NOT_FOUND: &str =
    "No place in this scene shows this well: nothing throws a shadow on a surface that faces the light.";

/// The artefact on show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Which one.
    pub artefact: Artefact,
    /// Whether its cure has been applied.
    pub fixed: bool,
}

/// The artefact on show, and what was there before it.
#[derive(Debug, Default)]
pub(super) struct ArtefactShow {
    shown: Option<Shown>,
    before: Option<(Settings, FlyCamera)>,
    found: bool,
    narration: String,
    changes: Vec<String>,
}

impl Stage {
    /// The artefact on show, if any.
    pub fn shown(&self) -> Option<Shown> {
        self.artefact.shown
    }

    /// A readable note about what is shown: that no view of the scene shows the artefact.
    pub fn notice(&self) -> Option<&str> {
        let shown = self.artefact.shown.filter(|shown| !shown.fixed && !self.artefact.found);
        shown.map(|_| NOT_FOUND)
    }

    /// What to look for in the view of the artefact, in a sentence about this scene; empty where there is none.
    pub fn narration(&self) -> &str {
        let artefact = &self.artefact;
        if artefact.shown.is_some() && !artefact.found { NOT_FOUND } else { &artefact.narration }
    }

    /// What the cure of the artefact changed, a line each.
    pub fn cure_changes(&self) -> &[String] {
        &self.artefact.changes
    }

    /// Moves camera and settings so that an artefact is plainly visible. Takes until a view is found.
    pub fn show_artefact(&mut self, artefact: Artefact) {
        let found = self.search(artefact).run();
        self.show_found(found);
    }

    /// What the search for the view of an artefact begins with; it can be run on a thread.
    pub(crate) fn search(&self, artefact: Artefact) -> Search {
        let (settings, camera) = self.artefact.before.unwrap_or((self.settings, self.camera));
        let lens = camera.perspective(&settings.camera, 1.0);
        Search { artefact, scene: self.scene.snapshot(), settings, lens }
    }

    /// Shows what was found. What a person sees beside the picture stays as it is.
    pub(crate) fn show_found(&mut self, found: Found) {
        let before = self.artefact.before.unwrap_or((self.settings, self.camera));
        self.settings = found.settings;
        self.settings.view.outside_beside |= found.artefact == Artefact::ClippingHole;
        self.set_camera(found.camera);
        self.side.fitted = None;
        self.artefact = ArtefactShow {
            shown: Some(Shown { artefact: found.artefact, fixed: false }),
            before: Some(before),
            found: found.shows,
            narration: found.narration,
            changes: Vec::new(),
        };
    }

    /// Cures an artefact: shows it first if it is not on show.
    pub fn fix_artefact(&mut self, artefact: Artefact) {
        if self.artefact.shown.is_none_or(|shown| shown.artefact != artefact) {
            self.show_artefact(artefact);
        }
        let before = self.artefact.before.unwrap_or((self.settings, self.camera)).0.technique;
        let shown = self.settings;
        let camera = self.camera.perspective(&self.settings.camera, 1.0);
        let seen = artefact::farthest_seen(&self.scene, self.settings.light.direction(), &camera);
        artefact::fix(&mut self.settings.technique, artefact, &before, seen);
        self.artefact.changes = changes(&shown, &self.settings);
        self.artefact.shown = Some(Shown { artefact, fixed: true });
    }

    /// Stops showing an artefact; settings and camera stay.
    pub fn close_artefact(&mut self) {
        self.artefact = ArtefactShow::default();
        self.settings.view.marks = ErrorMarks::Off;
    }

    /// Says which artefact is on show, as it was before a change was taken back.
    pub(crate) fn restore_shown(&mut self, shown: Option<Shown>) {
        if shown.is_none() {
            self.artefact = ArtefactShow::default();
        }
        self.artefact.shown = shown;
    }
}

/// What is different in the settings, a line for each parameter: "Constant bias: 0 → 1 texels".
pub(crate) fn changes(before: &Settings, after: &Settings) -> Vec<String> {
    let text = |settings: &Settings, parameter| {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = format_value(settings, parameter, &mut text);
        text
    };
    let differs = PARAMETERS.iter().filter(|parameter| !parameter.is_equal(before, after));
    differs
        .map(|parameter| {
            let (from, to) = (text(before, parameter), text(after, parameter));
            format!("{}: {from} → {to} {}", parameter.label, parameter.unit).trim_end().to_owned()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_told_with_name_values_and_unit() {
        let before = Settings::default();
        let mut after = before;
        after.technique.bias.normal_offset = 1.5;
        assert_eq!(changes(&before, &after), ["Normal offset: 0 → 1.5 texels"]);
        assert!(changes(&before, &before).is_empty());
    }
}
