//! How the viewer starts: arguments, and what was kept from the last time.

use std::path::{Path, PathBuf};

use shadowfit::tool::Settings;
use shadowfit_render::FlyCamera;
use shadowfit_study::NamedTechnique;

use super::Viewer;
use crate::cli::Arguments;
use crate::command::Command;
use crate::saved::{Saved, Store};
use crate::script::Step;
use crate::source::SceneSource;

/// What the arguments ask for.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub(crate) arguments: Arguments,
    /// The scene that they name, if any.
    pub(crate) source: Option<SceneSource>,
    pub(crate) script: Vec<Step>,
    /// Settings, camera and comparison of the last time, until the scene of the start is there.
    pub(super) kept: Option<(SceneSource, Settings, Option<FlyCamera>)>,
    /// Whether the scene of the start is still on its way.
    pub(super) is_pending: bool,
    /// Folder of files that are asked for by a relative path; the working folder if `None`.
    folder: Option<PathBuf>,
}

impl Start {
    /// Reads the arguments.
    ///
    /// # Errors
    ///
    /// If they name a script that makes no sense, a parameter or a technique that there is not, or a scene of an index
    /// that a built-in one has not.
    pub(crate) fn new(arguments: &Arguments) -> anyhow::Result<Self> {
        let source = arguments.source()?;
        // What is wrong with them is told at once.
        arguments.apply(&mut Settings::default())?;
        let script = arguments.steps()?;
        Ok(Self { arguments: arguments.clone(), source, script, kept: None, is_pending: true, folder: None })
    }

    /// Puts the files that a script saves into a folder.
    #[must_use]
    pub(crate) fn saving_into(self, folder: &Path) -> Self {
        Self { folder: Some(folder.to_owned()), ..self }
    }

    /// Where a file is saved.
    pub(super) fn place(&self, path: PathBuf) -> PathBuf {
        self.folder.as_ref().map_or(path.clone(), |folder| folder.join(path))
    }
}

impl Viewer {
    /// Takes up where the last time ended, and begins to load the scene.
    pub(super) fn restore(&mut self) {
        let (saved, message) = self.store.as_mut().map_or((None, None), Store::load);
        if let Some(message) = message {
            // Whoever starts it in a terminal sees it there, too.
            eprintln!("{message}");
            self.say(message);
        }
        let saved = saved.unwrap_or_default();
        let source = self.start.source.clone().unwrap_or_else(|| {
            let is_there = |path: &std::path::Path| path.exists();
            match &saved.scene {
                SceneSource::File { path, .. } if !is_there(path) => SceneSource::default(),
                source => source.clone(),
            }
        });
        if self.store.is_some() {
            self.start.kept = Some((saved.scene.clone(), saved.settings, saved.camera));
        }
        self.presets = saved.presets.iter().map(super::commands::preset).collect();
        self.saved = saved;
        self.run(Command::SetTheme(self.saved.theme));
        self.open(source);
    }

    /// Sets up the scene of the start: its own settings, over them what was kept, over that the arguments.
    pub(super) fn set_up(&mut self) -> anyhow::Result<Option<NamedTechnique>> {
        self.start.is_pending = false;
        let arguments = self.start.arguments.clone();
        self.stage.animation = arguments.animation;
        let mut settings = self.stage.settings;
        let technique = arguments.apply(&mut settings)?;
        self.stage.settings = settings;
        self.stage.set_home();
        let Some((source, kept, camera)) = self.start.kept.take() else { return Ok(technique) };
        if !self.saved_is_there() {
            return Ok(technique);
        }
        let home = self.stage.home_settings();
        let mut settings = if source == self.source { kept } else { of_scene(&kept, &home) };
        // What is saved yields to the arguments.
        arguments.apply(&mut settings)?;
        self.stage.settings = settings;
        if let Some(camera) = camera.filter(|_| source == self.source) {
            self.stage.set_camera(camera);
        }
        if let Some((other, split)) = self.saved.other {
            self.stage.compare_with(Some(other));
            self.stage.set_split(split);
        }
        Ok(technique)
    }

    /// Whether anything was kept from the last time.
    fn saved_is_there(&self) -> bool {
        self.saved != Saved { theme: self.saved.theme, ..Saved::default() }
    }

    /// What is to be kept, written if it changed.
    pub(crate) fn save(&mut self) {
        self.saved_at = self.clock;
        let Some(store) = &mut self.store else { return };
        if !self.has_scene || self.start.is_pending {
            return;
        }
        self.saved.scene = self.source.clone();
        self.saved.settings = self.stage.settings;
        self.saved.camera = Some(self.stage.camera);
        self.saved.other = self.stage.other_technique().map(|other| (other, self.stage.split));
        if let Err(error) = store.save(&self.saved) {
            // Told once, and not every few seconds.
            self.say(format!("Settings cannot be saved: {error:#}"));
            self.store = None;
        }
    }
}

/// Settings of another scene, with the lengths and the light of this one.
fn of_scene(kept: &Settings, home: &Settings) -> Settings {
    let mut settings = Settings { light: home.light, camera: home.camera, ..*kept };
    settings.technique.fit.max_distance = home.technique.fit.max_distance;
    settings.technique.fit.caster_extension = home.technique.fit.caster_extension;
    settings
}
