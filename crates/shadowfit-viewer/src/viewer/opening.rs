//! Opening scenes, and whatever else a file can be: a technique, a screenshot, saved settings.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use shadowfit_study::{NamedTechnique, PreparedScene, settings_from_toml};

use super::Viewer;
use crate::files::settings_of_png;
use crate::loading::Loading;
use crate::source::SceneSource;

impl Viewer {
    /// Begins to load a scene; the present one stays until it is there.
    pub(super) fn open(&mut self, source: SceneSource) {
        self.loading = Some(Loading::start(source, self.stage.gpu(), self.stage.material_layout()));
    }

    /// Opens whatever a file is.
    pub(super) fn open_file(&mut self, path: &Path) {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let opened = match extension.as_str() {
            "png" => self.open_picture(path),
            "toml" => self.open_technique(path),
            _ => {
                self.open(SceneSource::file(path));
                return;
            }
        };
        self.tell(opened.with_context(|| format!("{} cannot be opened", path.display())));
    }

    /// Takes the settings that a screenshot was made with.
    fn open_picture(&mut self, path: &Path) -> Result<String> {
        let text = settings_of_png(path)?.ok_or_else(|| anyhow!("it has no settings of the viewer"))?;
        let table: toml::Table = toml::from_str(&text)?;
        let settings = table.get("settings").and_then(toml::Value::as_table);
        let mut read = self.stage.settings;
        settings_from_toml(settings.context("it has no settings")?, &mut read)?;
        self.stage.settings = read;
        Ok(format!("Settings of {}", path.display()))
    }

    fn open_technique(&mut self, path: &Path) -> Result<String> {
        let named = NamedTechnique::read(path)?;
        self.stage.settings.technique = named.technique;
        self.interface.panel().name_technique(named.name.clone(), &named.technique);
        Ok(format!("Technique {}", named.name))
    }

    /// Shows the scene that has been loaded; on an error the old one stays, and without one the viewer ends.
    pub(super) fn take_scene(&mut self) {
        let Some(result) = self.loading.as_ref().and_then(Loading::take) else { return };
        let Some(loading) = self.loading.take() else { return };
        match result {
            Ok(prepared) => self.show(loading.source, prepared),
            Err(error) if self.start.is_pending => {
                self.failure = Some(error);
                self.wishes.quit = true;
            }
            Err(error) => self.say(format!("{error:#}")),
        }
    }

    fn show(&mut self, source: SceneSource, prepared: PreparedScene) {
        if let SceneSource::File { path, .. } = &source {
            self.saved.remember(path);
        }
        let is_first = self.start.is_pending;
        let animations = prepared.scene().animations.len();
        let name = prepared.scene().name.clone();
        self.source = source;
        self.searching = None;
        self.message = None;
        let view = self.stage.settings.view;
        let comparing = self.stage.other_technique();
        let technique = self.stage.settings.technique;
        self.stage.set_prepared(prepared);
        self.has_scene = true;
        self.wishes.new_title = true;
        if is_first {
            match check_animation(self.start.arguments.animation, animations, &name).and_then(|()| self.set_up()) {
                Ok(Some(named)) => self.interface.panel().name_technique(named.name, &named.technique),
                Ok(None) => {}
                Err(error) => {
                    self.failure = Some(error);
                    self.wishes.quit = true;
                }
            }
        } else {
            // Another scene is looked at in the same way, with lengths and light of its own.
            let fit = self.stage.settings.technique.fit;
            self.stage.settings.technique = technique;
            let own = &mut self.stage.settings.technique.fit;
            (own.max_distance, own.caster_extension) = (fit.max_distance, fit.caster_extension);
            self.stage.settings.view = view;
            self.stage.compare_with(comparing);
        }
        self.interface.scene_changed(&self.stage);
    }
}

/// Refuses an animation that a scene has not; the first one is the default, which is accepted for a scene without any.
pub(crate) fn check_animation(animation: usize, animations: usize, scene: &str) -> Result<()> {
    if animation < animations.max(1) {
        return Ok(());
    }
    let there = if animations == 1 { "is 1 animation".to_owned() } else { format!("are {animations} animations") };
    Err(anyhow!("--animation {animation}: there {there} in {scene}, counted from 0"))
}
