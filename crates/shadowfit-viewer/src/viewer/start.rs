//! The start of the viewer from arguments and the saved state.

use std::path::{Path, PathBuf};

use anyhow::Context;
use shadowfit_classics::SampleValues;
use shadowfit_egui::Command;
use shadowfit_params::Kind;
use shadowfit_params::tool::{Settings, ViewSettings};
use shadowfit_render::FlyCamera;
use shadowfit_study::NamedTechnique;

use super::Viewer;
use crate::arguments::Arguments;
use crate::keep::link::Link;
use crate::keep::saved::Saved;
use crate::keep::store::Store;
use crate::platform::output;
use crate::play::script::Line;
use crate::scene_source::SceneSource;

/// The start as requested by the arguments.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub(crate) arguments: Arguments,
    /// The scene in the arguments, if any.
    pub(crate) source: Option<SceneSource>,
    pub(crate) script: Vec<Line>,
    /// The link to follow.
    link: Option<Link>,
    /// Saved scene, settings and camera, until the first scene is loaded.
    pub(super) kept: Option<(SceneSource, Settings, Option<FlyCamera>)>,
    /// Whether the first scene is still loading.
    pub(super) is_pending: bool,
    /// Folder for files with a relative path; the working folder if `None`.
    folder: Option<PathBuf>,
}

impl Start {
    /// Reads the arguments.
    ///
    /// # Errors
    ///
    /// If the script cannot be read, a parameter or technique is unknown, or a scene index is given for a
    /// built-in scene.
    pub(crate) fn new(arguments: &Arguments) -> anyhow::Result<Self> {
        let source = arguments.source()?;
        // Invalid arguments are reported at once, except for values that depend on the saved settings.
        arguments.apply_what_is_there(&mut Settings::default())?;
        let script = arguments.lines()?;
        let link = arguments.link.as_deref().map(Link::parse).transpose().context("--link")?;
        Ok(Self { arguments: arguments.clone(), source, script, link, kept: None, is_pending: true, folder: None })
    }

    /// Makes scripts save their files into a folder.
    #[must_use]
    pub(crate) fn saving_into(self, folder: &Path) -> Self {
        Self { folder: Some(folder.to_owned()), ..self }
    }

    /// Returns the folder for files with a relative path; the working folder if `None`.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Returns the path at which a file is saved.
    pub(super) fn place(&self, path: PathBuf) -> PathBuf {
        self.folder.as_ref().map_or(path.clone(), |folder| folder.join(path))
    }
}

impl Viewer {
    /// Restores the saved state, and starts loading the scene.
    pub(super) fn restore(&mut self) {
        let (saved, message) = self.store.as_mut().map_or((None, None), Store::load);
        if let Some(message) = message {
            // For users who started the viewer in a terminal.
            output::tell(&message);
            self.say(message);
        }
        let saved = saved.unwrap_or_default();
        let link = self.start.link.take();
        let source = self.start.source.clone().unwrap_or_else(|| saved.scene.clone());
        // A link contains all differences from the scene's initial state.
        if self.store.is_some() && link.is_none() {
            self.start.kept = Some((saved.scene.clone(), saved.settings, saved.camera));
        }
        self.presets = saved.presets.iter().map(super::commands::preset).collect();
        self.saved = saved;
        self.run(Command::SetTheme(self.saved.theme.into()));
        if let Some(link) = link {
            self.follow(link);
        }
        if self.loading.is_none() {
            // No link, or a link to a file that the user must open, which may be the scene in the arguments.
            self.open(source);
        }
    }

    /// Sets up the first scene: its own settings, then the saved settings, then the arguments.
    pub(super) fn set_up(&mut self) -> anyhow::Result<Option<NamedTechnique>> {
        self.start.is_pending = false;
        let arguments = self.start.arguments.clone();
        self.stage.animation = arguments.animation;
        self.set_up_sample(&arguments)?;
        let kept = self.start.kept.take().filter(|_| self.saved_is_there());
        let mut home = self.own_settings;
        self.stage.choose_camera(arguments.settings(), &mut home);
        let Some((source, kept, camera)) = kept else {
            let technique = arguments.apply(&mut home)?;
            self.stage.restore_settings(&home);
            self.stage.set_home();
            return Ok(technique);
        };
        // The state for a reset: without saved settings, and with the arguments that are valid without them.
        arguments.apply_what_is_there(&mut home)?;
        self.stage.restore_settings(&home);
        self.stage.set_home();
        let mut settings = if source == self.source { with_own_near(kept, &home) } else { of_scene(&kept, &home) };
        // Arguments override saved settings.
        self.stage.choose_camera(arguments.settings(), &mut settings);
        let technique = arguments.apply(&mut settings)?;
        self.stage.restore_settings(&settings);
        if let Some(camera) = camera.filter(|_| source == self.source && settings.camera.file.is_none()) {
            self.stage.set_camera(camera);
        }
        if let Some((other, split)) = self.saved.other {
            let is_of_it = source == self.source;
            let other = if is_of_it { other } else { other.with_lengths_of(&self.own_settings.technique) };
            self.stage.compare_with(Some(other));
            self.stage.set_split(split);
        }
        Ok(technique)
    }

    /// Sets the options of the first sample: the saved ones, if it was the last scene, then the arguments.
    fn set_up_sample(&mut self, arguments: &Arguments) -> anyhow::Result<()> {
        let is_of_it = self.saved.scene == self.source;
        for (option, text) in self.saved.sample.clone().iter().filter(|_| is_of_it) {
            // An option that this version does not know is ignored.
            let _ = self.stage.set_sample_text(option, text);
        }
        for (option, text) in arguments.sample_options() {
            self.stage.set_sample_text(option, text).with_context(|| format!("--set sample.{option}={text}"))?;
        }
        Ok(())
    }

    /// Returns whether there is a saved state.
    fn saved_is_there(&self) -> bool {
        self.saved != Saved { theme: self.saved.theme, ..Saved::default() }
    }

    /// Writes the state for the next start, if it changed.
    pub(crate) fn save(&mut self) {
        self.saved_at = self.clock;
        let Some(store) = &mut self.store else { return };
        // After a failed start there is nothing to save.
        if !self.has_scene || self.start.is_pending || self.failure.is_some() {
            return;
        }
        self.saved.scene = self.source.clone();
        self.saved.settings = self.stage.settings;
        self.saved.sample = self.stage.sample().map_or_else(Vec::new, |show| {
            show.values
                .iter()
                .map(|(option, value)| (option.id.to_owned(), SampleValues::text(option, value)))
                .collect()
        });
        self.saved.camera = self.stage.settings.camera.file.is_none().then_some(self.stage.camera);
        self.saved.other = self.stage.other_technique().map(|other| (other, self.stage.split));
        if let Some(message) = store.keep(&self.saved) {
            // For users who started the viewer in a terminal, since the panel is gone at the end.
            output::tell(&message);
            self.say(message);
        }
    }
}

/// Returns settings of the same scene. A file stores no near plane below the parameter's range, but a tiny
/// scene may have one.
fn with_own_near(mut kept: Settings, home: &Settings) -> Settings {
    let least = shadowfit_params::parameter("camera.near").and_then(|near| match &near.kind {
        Kind::Number(range) => Some(range.min as f32),
        _ => None,
    });
    if least.is_some_and(|least| kept.camera.near == least && home.camera.near < least) {
        kept.camera.near = home.camera.near;
    }
    kept
}

/// Returns settings of another scene, with the shadow distance, caster extension, camera and light of this
/// one.
pub(super) fn of_scene(kept: &Settings, home: &Settings) -> Settings {
    let technique = kept.technique.with_lengths_of(&home.technique);
    let view = ViewSettings { ray_offset: home.view.ray_offset, ..kept.view };
    Settings { light: home.light, camera: home.camera, technique, view, ..*kept }
}
