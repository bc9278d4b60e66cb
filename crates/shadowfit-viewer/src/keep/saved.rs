//! State that is saved between starts, as a readable text with a version.

mod merge;

use std::f32::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use egui::ThemePreference;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use shadowfit::Technique;
use shadowfit_params::tool::Settings;
use shadowfit_render::FlyCamera;
use shadowfit_study::{NamedTechnique, settings_from_toml, settings_to_toml, technique_to_toml};

use crate::scene_source::SceneSource;

/// Version of the file. A file of another version is set aside.
const VERSION: u32 = 1;
/// Number of recent files.
const MOST_RECENT: usize = 8;

/// Dark or light, as in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Theme {
    Dark,
    Light,
    #[default]
    System,
}

impl From<Theme> for ThemePreference {
    fn from(theme: Theme) -> Self {
        match theme {
            Theme::Dark => Self::Dark,
            Theme::Light => Self::Light,
            Theme::System => Self::System,
        }
    }
}

impl From<ThemePreference> for Theme {
    fn from(theme: ThemePreference) -> Self {
        match theme {
            ThemePreference::Dark => Self::Dark,
            ThemePreference::Light => Self::Light,
            ThemePreference::System => Self::System,
        }
    }
}

/// The saved state.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Saved {
    pub(crate) theme: Theme,
    /// The current scene, to which settings and camera belong.
    pub(crate) scene: SceneSource,
    pub(crate) settings: Settings,
    pub(crate) camera: Option<FlyCamera>,
    /// The second technique of a comparison, and the position of the bar.
    pub(crate) other: Option<(Technique, f32)>,
    /// Recent files, the last one first.
    pub(crate) recent: Vec<PathBuf>,
    pub(crate) bookmarks: Vec<Bookmark>,
    pub(crate) presets: Vec<NamedTechnique>,
    /// Options of the current sample, by name, as on the command line.
    pub(crate) sample: Vec<(String, String)>,
}

/// A numbered view of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Bookmark {
    /// Its key, 1 to 9.
    pub(crate) key: u8,
    scene: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scene_index: Option<usize>,
    #[serde(flatten)]
    view: SavedView,
}

/// A view: position in metres, angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct SavedView {
    position: [f64; 3],
    yaw: f32,
    pitch: f32,
    #[serde(default, skip_serializing_if = "is_zero")]
    roll: f32,
}

/// Returns whether a saved angle can be left out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(angle: &f32) -> bool {
    *angle == 0.0
}

impl From<FlyCamera> for SavedView {
    fn from(camera: FlyCamera) -> Self {
        let [yaw, pitch, roll] = [camera.yaw, camera.pitch, camera.roll].map(f32::to_degrees);
        Self { position: camera.position.to_array(), yaw, pitch, roll }
    }
}

impl SavedView {
    /// Returns `None` if a number is not finite.
    fn camera(self) -> Option<FlyCamera> {
        let [yaw, pitch, roll] = [self.yaw, self.pitch, self.roll].map(f32::to_radians);
        let position = DVec3::from_array(self.position);
        let is_finite = position.is_finite() && [yaw, pitch, roll].iter().all(|angle| angle.is_finite());
        is_finite.then(|| FlyCamera { position, yaw, pitch: pitch.clamp(-FRAC_PI_2, FRAC_PI_2), roll })
    }
}

impl Bookmark {
    pub(crate) fn new(key: u8, scene: &SceneSource, camera: FlyCamera) -> Self {
        Self { key, scene: scene.text(), scene_index: scene.index(), view: camera.into() }
    }

    /// Returns whether the bookmark belongs to a key and a scene.
    pub(crate) fn is_of(&self, key: u8, scene: &SceneSource) -> bool {
        (self.key, &self.scene, self.scene_index) == (key, &scene.text(), scene.index())
    }

    pub(crate) fn camera(&self) -> Option<FlyCamera> {
        self.view.camera()
    }
}

/// The part of the file above the settings.
#[derive(Debug, Serialize, Deserialize)]
struct Head {
    version: u32,
    #[serde(default)]
    theme: Theme,
    #[serde(default)]
    scene: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scene_index: Option<usize>,
    #[serde(default)]
    recent: Vec<PathBuf>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    split: Option<f32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    camera: Option<SavedView>,
    #[serde(default)]
    bookmark: Vec<Bookmark>,
}

/// Returns a text as a TOML key on one line. Values may be quoted over several lines, keys may not.
fn key(text: &str) -> Result<String> {
    let line = toml::to_string(&toml::Table::from_iter([(text.to_owned(), toml::Value::from(0))]))?;
    Ok(line.strip_suffix(" = 0\n").context("a key is a line")?.to_owned())
}

impl Saved {
    /// Puts a file first in the list of recent files.
    pub(crate) fn remember(&mut self, path: &Path) {
        self.recent.retain(|recent| recent != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(MOST_RECENT);
    }

    /// Returns the text of the file.
    pub(crate) fn to_toml(&self) -> Result<String> {
        let head = Head {
            version: VERSION,
            theme: self.theme,
            scene: self.scene.text(),
            scene_index: self.scene.index(),
            recent: self.recent.clone(),
            split: self.other.map(|(_, split)| split),
            camera: self.camera.map(SavedView::from),
            bookmark: self.bookmarks.clone(),
        };
        let mut text = String::from("# State of the shadowfit viewer when it was last closed.\n\n");
        text.push_str(&toml::to_string(&head)?);
        text.push('\n');
        if !self.sample.is_empty() {
            text.push_str("[sample]\n\n");
            for (option, value) in &self.sample {
                let _ = writeln!(text, "{} = {}", key(option)?, toml::Value::from(value.as_str()));
            }
            text.push('\n');
        }
        text.push_str(&settings_to_toml(&self.settings, "settings."));
        if let Some((other, _)) = self.other {
            text.push_str(&technique_to_toml(&other, self.settings.inputs, "other."));
        }
        for preset in &self.presets {
            let name = key(&preset.name)?;
            let _ = writeln!(text, "[presets.{name}]\n");
            text.push_str(&technique_to_toml(&preset.technique, preset.inputs, &format!("presets.{name}.")));
        }
        Ok(text)
    }

    /// Parses the text of the file.
    pub(crate) fn from_toml(text: &str) -> Result<Self> {
        let mut file: toml::Table = toml::from_str(text)?;
        check_version(&file)?;
        let mut table = |name: &str| match file.remove(name) {
            Some(toml::Value::Table(table)) => Ok(Some(table)),
            Some(_) => bail!("{name} is not a table"),
            None => Ok(None),
        };
        let (settings, other, presets) = (table("settings")?, table("other")?, table("presets")?);
        let sample = table("sample")?.unwrap_or_default();
        let head: Head = toml::Value::Table(file).try_into()?;
        let mut saved = Self {
            theme: head.theme,
            scene: SceneSource::from_text(&head.scene).with_index(head.scene_index)?,
            camera: head.camera.and_then(SavedView::camera),
            recent: head.recent,
            bookmarks: head.bookmark,
            ..Self::default()
        };
        for (option, value) in sample {
            let value = value.as_str().with_context(|| format!("sample.{option} is not text"))?;
            saved.sample.push((option, value.to_owned()));
        }
        if let Some(settings) = settings {
            settings_from_toml(&settings, &mut saved.settings).context("settings")?;
        }
        if let Some(other) = other {
            saved.other = Some((read_technique(&other).context("other")?.technique, head.split.unwrap_or(0.5)));
        }
        for (name, preset) in presets.unwrap_or_default() {
            let table = preset.as_table().with_context(|| format!("presets.{name} is not a table"))?;
            let Settings { technique, inputs, .. } =
                read_technique(table).with_context(|| format!("presets.{name}"))?;
            saved.presets.push(NamedTechnique { name, inputs, ..technique.into() });
        }
        Ok(saved)
    }
}

/// Rejects a file of another version.
fn check_version(file: &toml::Table) -> Result<()> {
    match file.get("version").and_then(toml::Value::as_integer) {
        Some(version) if version == i64::from(VERSION) => Ok(()),
        Some(version) => bail!("it has version {version}, and this viewer reads version {VERSION}"),
        None => bail!("it has no version"),
    }
}

/// Reads a technique and the inputs of its fits.
fn read_technique(table: &toml::Table) -> Result<Settings> {
    let mut settings = Settings::default();
    settings_from_toml(table, &mut settings)?;
    Ok(settings)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Returns a state that differs from a first start in every part.
    pub(crate) fn saved() -> Saved {
        let camera = FlyCamera { position: DVec3::new(1e5, 2.0, -3.5), yaw: 0.5, pitch: -0.25, roll: 0.75 };
        let mut saved = Saved {
            theme: Theme::Light,
            scene: SceneSource::from_text("some/town.glb").with_index(Some(1)).expect("files have scenes"),
            camera: Some(camera),
            other: Some((Technique::preset("stable-4").expect("a preset"), 0.25)),
            ..Saved::default()
        };
        saved.settings.technique = Technique::preset("calm-4").expect("a preset");
        saved.settings.light.hour = Some(9.5);
        saved.sample = vec![("bias".to_owned(), "0.002".to_owned()), ("format".to_owned(), "r16f".to_owned())];
        saved.bookmarks.push(Bookmark::new(3, &saved.scene, camera));
        saved.presets.push(NamedTechnique { name: "my \"best\" one".to_owned(), ..saved.settings.technique.into() });
        saved.remember(Path::new("a.glb"));
        saved.remember(Path::new("b.glb"));
        saved.remember(Path::new("a.glb"));
        saved
    }
}
