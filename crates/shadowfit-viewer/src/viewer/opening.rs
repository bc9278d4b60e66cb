//! Opens scenes and other files: techniques and screenshots with their settings.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use shadowfit::Technique;
use shadowfit_params::Group;
use shadowfit_params::tool::Settings;
use shadowfit_study::{NamedTechnique, PreparedScene, settings_from_toml};

use super::Viewer;
use super::start::of_scene;
use crate::arguments::check_animation;
use crate::background::loading::Loading;
use crate::background::measuring::Measuring;
use crate::keep::link::LinkedScene;
use crate::keep::picture_file::settings_of_png;
use crate::keep::undo::History;
use crate::platform;
use crate::platform::output;
use crate::play::playback::Player;
use crate::play::script;
use crate::scene_source::SceneSource;

impl Viewer {
    /// Starts loading a scene; the old one is shown until then.
    pub(super) fn open(&mut self, source: SceneSource) {
        // Another scene than that of a link which is being followed ends that, unless the link waits for a person.
        self.link.take_if(|link| link.scene.request().is_none());
        let source = self.of_link(source);
        let line = self.line.clone();
        self.loading = Some(Loading::start(source, line, self.stage.gpu(), self.stage.material_layout()));
    }

    /// The source, with the scene of the file that a link of that file asks for.
    fn of_link(&self, source: SceneSource) -> SceneSource {
        match self.link.as_ref().map(|link| &link.scene) {
            Some(LinkedScene::File { name, index: Some(index) }) if *name == source.label() => {
                source.clone().with_index(Some(*index)).unwrap_or(source)
            }
            _ => source,
        }
    }

    /// Opens a file: a picture, a technique or a scene.
    pub(super) fn open_file(&mut self, path: &Path) {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let opened = match extension.as_str() {
            "png" => self.open_picture(path),
            "toml" => technique(path).map(|named| self.take_technique(named)),
            "txt" => self.play_file(path),
            _ => {
                self.open(SceneSource::file(path));
                return;
            }
        };
        self.tell(opened.with_context(|| format!("{} cannot be opened", path.display())));
    }

    /// Lets the user choose a file to open.
    pub(super) fn choose_file(&mut self) {
        if self.chooser.is_none() {
            self.chooser = platform::choose_file();
        }
    }

    /// Plays a script.
    fn play_file(&mut self, path: &Path) -> Result<String> {
        self.player = Player::new(script::read(path)?);
        Ok(format!("Playing {}", path.display()))
    }

    /// Takes the settings that a screenshot was made with: the technique for the side that the panel edits. The camera stays,
    /// with its lens. In a picture of another scene, the sun of that scene's file counts as one by hand.
    fn open_picture(&mut self, path: &Path) -> Result<String> {
        let text = settings_of_png(path)?.ok_or_else(|| anyhow!("it has no settings of the viewer"))?;
        let mut table: toml::Table = toml::from_str(&text)?;
        let is_of_scene = table.get("scene").and_then(toml::Value::as_str) == Some(&self.source.text());
        let settings = table.get_mut("settings").and_then(toml::Value::as_table_mut).context("it has no settings")?;
        settings.remove(Group::Camera.id());
        if let Some(light) = settings.get_mut(Group::Light.id()).and_then(toml::Value::as_table_mut)
            && !is_of_scene
        {
            light.remove("file");
        }
        let mut read = self.stage.settings.with_technique(self.edited_technique());
        settings_from_toml(settings, &mut read)?;
        self.stage.settings = read.with_technique(self.stage.settings.technique);
        *self.edited() = read.technique;
        Ok(format!("Settings of {}", path.display()))
    }

    /// Shows the scene that has been loaded. After an error the old one stays. At the start there is none: instead of the
    /// scene of the last time the built-in one is opened, and for a scene of the arguments the viewer ends.
    pub(super) fn take_scene(&mut self) {
        // What comes of a lost device is loaded anew for the next one.
        let Some(result) = self.loading.as_ref().and_then(Loading::take) else { return };
        if self.stage.gpu().lost().is_some() {
            return;
        }
        let Some(loading) = self.loading.take() else { return };
        let is_of_last_time = self.start.source.is_none() && loading.source != SceneSource::default();
        match result {
            Ok(prepared) => self.show(loading.source, prepared),
            Err(error) if self.start.is_pending && is_of_last_time => {
                let message = format!("The scene of the last time cannot be opened: {error:#}");
                output::tell(&message);
                self.say(message);
                self.open(SceneSource::default());
            }
            Err(error) if self.start.is_pending => {
                self.failure = Some(error);
                self.window_requests.quit = true;
            }
            Err(error) => {
                self.line = loading.line;
                self.tell(Err(error));
                self.line = None;
            }
        }
    }

    /// Shows a scene that has been loaded.
    fn show(&mut self, source: SceneSource, prepared: PreparedScene) {
        if let SceneSource::File { path, .. } = &source {
            self.saved.remember(path);
        }
        self.source = source;
        // Background work and undo belong to the scene before.
        self.searching = None;
        self.tuning.abandon();
        self.history = History::default();
        let kept = self.stage.settings;
        let comparing = self.stage.other_technique();
        self.stage.set_prepared(prepared);
        if let SceneSource::Sample { sample, variant } = &self.source {
            self.stage.set_sample(sample, *variant);
        }
        self.measuring = Measuring::default();
        self.own_settings = self.stage.settings;
        self.has_scene = true;
        self.window_requests.new_title = true;
        if self.start.is_pending {
            self.show_first();
        } else {
            self.message = None;
            // A sample keeps the settings of its source.
            if !matches!(self.source, SceneSource::Sample { .. }) {
                self.keep_technique(&kept, comparing);
            }
        }
        self.interface.scene_changed(&self.stage);
        self.follow_on();
    }

    /// Sets up the scene of the start. If that is impossible, the viewer ends.
    fn show_first(&mut self) {
        // Messages of the meantime are shown from now on.
        self.message.iter_mut().for_each(|message| message.since = self.clock);
        let scene = self.stage.scene();
        let is_there = check_animation(self.start.arguments.animation, scene.animations.len(), &scene.name);
        match is_there.and_then(|()| self.set_up()) {
            Ok(Some(named)) => self.interface.panel().name_technique(named.name, &named.technique),
            Ok(None) => {}
            Err(error) => {
                self.failure = Some(error);
                self.window_requests.quit = true;
            }
        }
    }

    /// Goes on with the techniques and the view of the scene before, with the lengths of this scene.
    fn keep_technique(&mut self, kept: &Settings, comparing: Option<Technique>) {
        let Settings { technique, view, .. } = of_scene(kept, &self.own_settings);
        (self.stage.settings.technique, self.stage.settings.view) = (technique, view);
        self.stage.compare_with(comparing.map(|other| other.with_lengths_of(&self.own_settings.technique)));
    }
}

/// The technique of a file; one without a name gets the file's.
fn technique(path: &Path) -> Result<NamedTechnique> {
    Ok(NamedTechnique::from_toml(std::str::from_utf8(&platform::read(path)?)?)?.or_named_after(path))
}
