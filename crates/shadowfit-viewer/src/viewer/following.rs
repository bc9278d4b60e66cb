//! Links: the state of the viewer as a [`Link`], and back.

use shadowfit_classics::SampleValues;
use shadowfit_params::tool::Settings;

use super::Viewer;
use crate::keep::command_line::{changed, differences};
use crate::keep::link::{Link, LinkedArtefact, LinkedScene, apply};
use crate::keep::undo::History;
use crate::stage::Shown;

impl Viewer {
    /// Returns a link to the current state: scene, settings, camera, comparison and artefact.
    pub(crate) fn link(&self) -> Link {
        let stage = &self.stage;
        let now = &stage.settings;
        let other = stage.other_technique().map(|other| (differences(&now.with_technique(other), now), stage.split));
        // A scene opens at time 0, so other times of a paused animation are written.
        let stands = !now.view.play && stage.seconds() != 0.0;
        let sample = stage.sample().map(|show| changed(show).collect::<Vec<_>>());
        Link {
            scene: LinkedScene::of(&self.source),
            animation: stage.animation,
            camera: now.camera.file.is_none().then_some(stage.camera),
            seconds: stands.then(|| stage.seconds()),
            settings: differences(now, &self.own_with_lens()),
            sample: sample.into_iter().flatten().map(|(option, value)| (option.to_owned(), value)).collect(),
            other,
            artefact: self.linked_artefact(),
            notes: Vec::new(),
        }
    }

    /// Returns the scene's own settings with the lens of the followed camera of the file. Reading a link or a
    /// command line applies that lens first.
    pub(super) fn own_with_lens(&self) -> Settings {
        let (mut own, followed) = (self.own_settings, self.stage.settings.camera.file);
        if let Some(number) = followed.filter(|_| followed != own.camera.file) {
            self.stage.choose_camera([("camera.file", number.to_string().as_str())], &mut own);
            own.camera.file = self.own_settings.camera.file;
        }
        own
    }

    /// Returns the shown artefact, unless no view of it was found.
    fn linked_artefact(&self) -> Option<LinkedArtefact> {
        let shown = self.stage.shown().filter(|_| !self.stage.is_missed())?;
        let now = &self.stage.settings;
        let (settings, camera) = self.stage.before_artefact();
        let ill = now.with_technique(self.stage.ill_technique());
        Some(LinkedArtefact {
            artefact: shown.artefact,
            fixed: shown.fixed,
            before: (camera != self.stage.camera).then_some(camera),
            was: differences(&settings, now),
            ill: if shown.fixed { differences(&ill, now) } else { Vec::new() },
        })
    }

    /// Opens the scene of a link, and applies the link once the scene is loaded. A file cannot be opened
    /// automatically, so the panel asks the user for it.
    pub(crate) fn follow(&mut self, link: Link) {
        if self.has_scene && self.loading.is_none() && link.is_of(&self.source) {
            return self.bring_back(&link);
        }
        if let LinkedScene::Known(source) = &link.scene {
            self.open(source.clone());
        }
        self.link = Some(link);
    }

    /// Applies a link that has waited for the scene that was just opened.
    pub(super) fn follow_on(&mut self) {
        if let Some(link) = self.link.take_if(|link| link.is_of(&self.source)) {
            self.bring_back(&link);
        }
    }

    /// Applies a link to the current scene.
    fn bring_back(&mut self, link: &Link) {
        let mut notes = link.notes.clone();
        let mut settings = self.own_settings;
        self.stage.choose_camera(link.settings.iter().map(|(id, value)| (id.as_str(), value.as_str())), &mut settings);
        apply(&link.settings, &mut settings);
        if let Some(show) = self.stage.sample() {
            let (sample, variant) = (show.sample, show.variant);
            let own = SampleValues::of_variant(sample, variant).unwrap_or_else(|_| SampleValues::new(sample));
            self.stage.set_sample_values(own);
            for (option, value) in &link.sample {
                notes.extend(self.stage.set_sample_text(option, value).err().map(|error| format!("{error:#}")));
            }
        }
        self.searching = None;
        self.interface.edits_other = false;
        self.stage.restore_settings(&settings);
        self.stage.animation = link.animation;
        self.stage.compare_with(link.other.as_ref().map(|(other, _)| with(other, &settings).technique));
        if let Some((_, split)) = &link.other {
            self.stage.set_split(*split);
        }
        if let Some(camera) = link.camera {
            self.stage.set_camera(camera);
        }
        let seconds = link.seconds.unwrap_or(0.0);
        if seconds != self.stage.seconds() {
            self.stage.set_time(seconds);
        }
        self.stage.close_artefact();
        if let Some(linked) = &link.artefact {
            let shown = Shown { artefact: linked.artefact, fixed: linked.fixed };
            let camera = linked.before.unwrap_or(self.stage.camera);
            let ill = with(&linked.ill, &settings).technique;
            self.stage.resume_artefact(shown, &with(&linked.was, &settings), camera, ill);
        }
        self.history = History::default();
        if !notes.is_empty() {
            self.say(notes.join(" "));
        }
    }

    /// Copies a link to the current state: with the address of the page in which the viewer runs, or only the
    /// fragment.
    pub(super) fn copy_link(&self) -> String {
        let page = self.page.as_deref().unwrap_or_default();
        self.interface.context.copy_text(format!("{page}{}", self.link().to_fragment()));
        if self.page.is_some() {
            "Copied a link to this scene and its settings".to_owned()
        } else {
            "Copied a link for `viewer --link`".to_owned()
        }
    }
}

/// Returns settings with some parameters changed.
fn with(pairs: &crate::keep::link::Pairs, settings: &Settings) -> Settings {
    let mut changed = *settings;
    apply(pairs, &mut changed);
    changed
}
