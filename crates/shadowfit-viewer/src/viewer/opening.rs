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
    /// Starts loading a scene. The old one is shown until then.
    pub(super) fn open(&mut self, source: SceneSource) {
        // Opening another scene cancels a link that is being followed, unless the link waits for the user's
        // file.
        self.link.take_if(|link| link.scene.request().is_none());
        let source = self.of_link(source);
        let line = self.line.clone();
        self.loading = Some(Loading::start(source, line, self.stage.gpu(), self.stage.material_layout()));
    }

    /// Returns the source, with the scene index of a link to the same file.
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

    /// Applies the settings in a screenshot, with the technique for the side that the panel edits. The camera
    /// and its lens stay. In a picture of another scene, the number of the file's sun is ignored.
    fn open_picture(&mut self, path: &Path) -> Result<String> {
        let text = settings_of_png(path)?.ok_or_else(|| anyhow!("it contains no settings of the viewer"))?;
        let mut table: toml::Table = toml::from_str(&text)?;
        let is_of_scene = table.get("scene").and_then(toml::Value::as_str) == Some(&self.source.text());
        let settings =
            table.get_mut("settings").and_then(toml::Value::as_table_mut).context("it contains no settings")?;
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

    /// Shows the scene that has been loaded. On an error the old one stays. At the start there is no old
    /// scene: if the last scene fails, the built-in one is opened; if a scene in the arguments fails, the
    /// viewer ends.
    pub(super) fn take_scene(&mut self) {
        // A result for a lost device is discarded, and the scene is loaded again for the next device.
        let Some(result) = self.loading.as_ref().and_then(Loading::take) else { return };
        if self.stage.gpu().lost().is_some() {
            return;
        }
        let Some(loading) = self.loading.take() else { return };
        let is_of_last_time = self.start.source.is_none() && loading.source != SceneSource::default();
        match result {
            Ok(prepared) => self.show(loading.source, prepared),
            Err(error) if self.start.is_pending && is_of_last_time => {
                let message = format!("The last scene cannot be opened: {error:#}");
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
        // Background work and undo belong to the previous scene.
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

    /// Sets up the first scene. If that fails, the viewer ends.
    fn show_first(&mut self) {
        // Messages during loading are shown from now on.
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

    /// Keeps the techniques and the view of the previous scene, with the shadow distance and caster extension
    /// of this one.
    fn keep_technique(&mut self, kept: &Settings, comparing: Option<Technique>) {
        let Settings { technique, view, .. } = of_scene(kept, &self.own_settings);
        (self.stage.settings.technique, self.stage.settings.view) = (technique, view);
        self.stage.compare_with(comparing.map(|other| other.with_lengths_of(&self.own_settings.technique)));
    }
}

/// Reads the technique of a file. Without a name, it gets the file's name.
fn technique(path: &Path) -> Result<NamedTechnique> {
    Ok(NamedTechnique::from_toml(std::str::from_utf8(&platform::read(path)?)?)?.or_named_after(path))
}
