//! The shown artefact: from the search for its view to its cure.

use shadowfit::Technique;
use shadowfit_egui::Artefact;
use shadowfit_params::tool::Settings;
use shadowfit_params::{Kind, Number, PARAMETERS, Parameter, Value};
use shadowfit_render::FlyCamera;

use super::Stage;
use super::artefact::{self, Found, Search};

/// Message when no view of a scene shows an artefact.
const NOT_FOUND: &str =
    "This scene cannot show this artefact well: no object casts a shadow on a surface that faces the light.";

/// The shown artefact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// The artefact.
    pub artefact: Artefact,
    /// Whether its cure has been applied.
    pub fixed: bool,
}

/// The shown artefact, with the camera and settings before it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ArtefactShow {
    shown: Option<Shown>,
    before: Option<(Settings, FlyCamera)>,
    /// The technique that shows or fixes it, until the user chooses another one.
    technique: Technique,
    /// The technique that shows it.
    ill: Technique,
    found: bool,
    narration: String,
    changes: Vec<String>,
}

impl Stage {
    /// Returns the shown artefact, if any.
    pub fn shown(&self) -> Option<Shown> {
        self.artefact.shown
    }

    /// Returns a note if no view of the scene shows the artefact.
    pub fn notice(&self) -> Option<&str> {
        let shown = self.artefact.shown.filter(|shown| !shown.fixed && !self.artefact.found);
        shown.map(|_| NOT_FOUND)
    }

    /// Returns a sentence that tells where to look in the view of the artefact; empty if there is none.
    pub fn narration(&self) -> &str {
        let artefact = &self.artefact;
        if self.is_missed() { NOT_FOUND } else { &artefact.narration }
    }

    /// Returns the changes by the cure of the artefact, a line each.
    pub fn cure_changes(&self) -> &[String] {
        &self.artefact.changes
    }

    /// Moves camera and settings so that an artefact is clearly visible. Blocks until a view is found.
    pub fn show_artefact(&mut self, artefact: Artefact) {
        let found = self.search(artefact).run();
        self.show_found(found);
    }

    /// Returns the input of the search for the view of an artefact, which can run on a thread.
    pub(crate) fn search(&self, artefact: Artefact) -> Search {
        let (settings, camera) = self.before_artefact();
        let lens = camera.perspective(&settings.camera, 1.0);
        Search { artefact, scene: self.scene.snapshot(), settings, lens }
    }

    /// Returns settings and camera before the shown artefact. If the technique was changed since, returns the
    /// current technique and camera.
    pub(crate) fn before_artefact(&self) -> (Settings, FlyCamera) {
        let mut settings = self.settings;
        match self.artefact.before.filter(|_| self.settings.technique == self.artefact.technique) {
            Some((before, camera)) => {
                take_shown(&mut settings, &before);
                (settings, camera)
            }
            None => (settings, self.camera),
        }
    }

    /// Shows the view that was found. Settings that do not affect it stay.
    pub(crate) fn show_found(&mut self, found: Found) {
        let before = self.before_artefact();
        take_shown(&mut self.settings, &found.settings);
        self.settings.view.outside_beside |= found.artefact == Artefact::ClippingHole;
        self.set_camera(found.camera);
        self.side.fitted = None;
        self.artefact = ArtefactShow {
            shown: Some(Shown { artefact: found.artefact, fixed: false }),
            before: Some(before),
            technique: found.settings.technique,
            ill: found.settings.technique,
            found: found.shows,
            narration: found.narration,
            changes: Vec::new(),
        };
    }

    /// Cures an artefact, after showing it if it is not shown yet.
    pub fn fix_artefact(&mut self, artefact: Artefact) {
        if self.artefact.shown.is_none_or(|shown| shown.artefact != artefact) {
            self.show_artefact(artefact);
        }
        let before = self.artefact.before.unwrap_or((self.settings, self.camera)).0.technique;
        let shown = self.settings;
        self.artefact.ill = shown.technique;
        let camera = self.camera.perspective(&self.settings.camera, 1.0);
        let seen = artefact::farthest_seen(&self.scene, self.settings.light.direction(), &camera);
        artefact::fix(&mut self.settings.technique, artefact, &before, seen);
        self.artefact.changes = changes(&shown, &self.settings);
        self.artefact.shown = Some(Shown { artefact, fixed: true });
        self.artefact.technique = self.settings.technique;
    }

    /// Stops showing an artefact. Settings and camera stay.
    pub fn close_artefact(&mut self) {
        self.artefact = ArtefactShow::default();
    }

    /// Returns whether no view of the scene shows the shown artefact.
    pub(crate) fn is_missed(&self) -> bool {
        self.artefact.shown.is_some() && !self.artefact.found
    }

    /// Returns the technique that shows the artefact, even if it is fixed.
    pub(crate) fn ill_technique(&self) -> Technique {
        self.artefact.ill
    }

    /// Shows the artefact of a link, after its settings and its camera were set. `before` and `camera` are
    /// the settings and the camera before it, and `ill` is the technique that shows it.
    pub(crate) fn resume_artefact(&mut self, shown: Shown, before: &Settings, camera: FlyCamera, ill: Technique) {
        let Shown { artefact, fixed } = shown;
        let settings = self.settings.with_technique(ill);
        let lens = self.camera.perspective(&settings.camera, 1.0);
        let search = Search { artefact, scene: self.scene.snapshot(), settings, lens };
        self.artefact = ArtefactShow {
            shown: Some(shown),
            before: Some((*before, camera)),
            technique: self.settings.technique,
            ill,
            found: true,
            narration: search.narrate(),
            changes: if fixed { changes(&settings, &self.settings) } else { Vec::new() },
        };
    }

    /// Returns all texts about the shown artefact.
    pub(crate) fn artefact_show(&self) -> &ArtefactShow {
        &self.artefact
    }

    /// Restores the texts about an artefact after an undo.
    pub(crate) fn restore_artefact(&mut self, show: ArtefactShow) {
        self.artefact = show;
    }
}

/// Copies the settings that show an artefact.
fn take_shown(settings: &mut Settings, from: &Settings) {
    settings.technique = from.technique;
    let (camera, other) = (&mut settings.camera, &from.camera);
    if camera.height.is_some() != other.height.is_some() {
        camera.near = other.near;
    }
    (camera.far, camera.height) = (other.far, other.height);
    settings.light.animate = from.light.animate;
    let (view, from) = (&mut settings.view, &from.view);
    (view.mode, view.play, view.freeze_fit) = (from.mode, from.play, from.freeze_fit);
    (view.shadows, view.outside_beside) = (from.shadows, from.outside_beside);
}

/// Returns the differences of the settings, a line for each parameter: "Constant bias: 0 → 1 texels".
pub(crate) fn changes(before: &Settings, after: &Settings) -> Vec<String> {
    let differs = PARAMETERS.iter().filter(|parameter| !parameter.is_equal(before, after));
    differs
        .map(|parameter| {
            let (from, to) = (value(before, parameter), value(after, parameter));
            format!("{}: {from} → {to} {}", parameter.label, parameter.unit).trim_end().to_owned()
        })
        .collect()
}

/// Returns a value as text, without its unit.
fn value(settings: &Settings, parameter: &Parameter) -> String {
    let number = |value: f64| format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_owned();
    match (parameter.get(settings), &parameter.kind) {
        (Some(Value::Number(value)), _) => number(value),
        (Some(Value::Unset), Kind::Number(Number { unset: Some(unset), .. })) => unset.option.label.to_owned(),
        (Some(Value::Option(index)), Kind::Choice(options)) => {
            options.get(index).map_or("", |option| option.label).to_owned()
        }
        (Some(Value::Toggle(on)), _) => if on { "on" } else { "off" }.to_owned(),
        _ => "none".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use shadowfit::settings::FitKind;
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_testing::renderer_gpu;

    use super::*;

    #[test]
    fn what_changed_while_an_artefact_was_searched_or_on_show_stays() {
        let mut stage = Stage::new(renderer_gpu(), default_scene(), 1).expect("the default scene");
        stage.settings.technique.maps = shadowfit::Windows::default().into();
        (stage.settings.camera.height, stage.settings.camera.near) = (Some(10.0), 9.0);
        let first = stage.settings;
        let found = stage.search(Artefact::ClippingHole).run();
        stage.settings.light.azimuth += 0.5;
        stage.show_found(found);
        assert_eq!(stage.settings.light.azimuth, first.light.azimuth + 0.5);
        assert_ne!(stage.settings.technique, first.technique);
        let near = shadowfit_study::near_of(&stage.bounds());
        assert_eq!((stage.settings.camera.height, stage.settings.camera.near), (None, near));
        // A second artefact is based on the technique before the first one.
        stage.settings.camera.fov_y *= 1.1;
        let (before, _) = stage.before_artefact();
        assert_eq!((before.technique, before.view), (first.technique, first.view));
        assert_eq!((before.camera.height, before.camera.near), (Some(10.0), 9.0));
        assert_eq!((before.light.azimuth, before.camera.fov_y), (first.light.azimuth + 0.5, first.camera.fov_y * 1.1));
        // Unless the user has chosen another one.
        stage.settings.technique = first.technique.with_count(2);
        let (before, camera) = stage.before_artefact();
        assert_eq!((before, camera), (stage.settings, stage.camera));
    }

    #[test]
    fn changes_are_told_with_name_values_and_unit() {
        let before = Settings::default();
        let mut after = before;
        after.technique.bias.normal_offset = 1.5;
        assert_eq!(changes(&before, &after), ["Normal offset: 0 → 1.5 texels"]);
        assert!(changes(&before, &before).is_empty());
    }

    #[test]
    fn changes_have_the_names_of_the_menus_and_three_decimals_at_most() {
        let mut before = Settings::default();
        before.technique.maps = before.technique.maps.with_kind(FitKind::Sphere);
        before.technique.bias.receiver_plane = 1.003_906_2;
        before.view.shadows = true;
        let mut after = before;
        after.technique.maps = after.technique.maps.with_kind(FitKind::Focused);
        after.technique.bias.receiver_plane = 0.501_953_1;
        after.view.shadows = false;
        let lines = changes(&before, &after);
        assert_eq!(lines.len(), 3, "{lines:?}");
        for line in
            ["Fit: Stable sphere → Focused on the scene", "Receiver plane: 1.004 → 0.502 texels", "Shadows: on → off"]
        {
            assert!(lines.iter().any(|told| told == line), "{line} in {lines:?}");
        }
    }
}
