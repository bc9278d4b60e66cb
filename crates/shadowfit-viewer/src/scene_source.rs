//! The source of a scene.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use shadowfit_classics::{Sample, SampleVariant};
use shadowfit_scene::builtin::BuiltinScene;
use shadowfit_scene::{LoadStep, Scene, SceneSize};

use crate::platform;

/// Prefix of the names of a sample's options, on the command line and in scripts.
pub(crate) const OPTION_PREFIX: &str = "sample.";

/// A built-in scene, a classic sample or a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum SceneSource {
    BuiltIn(BuiltinScene),
    Sample { sample: &'static Sample, variant: Option<&'static SampleVariant> },
    File { path: PathBuf, index: Option<usize> },
}

impl Default for SceneSource {
    fn default() -> Self {
        Self::BuiltIn(BuiltinScene::default())
    }
}

impl SceneSource {
    /// Returns the source that a text names: a built-in scene or a sample by its name, or a file.
    pub(crate) fn from_text(text: &str) -> Self {
        if Path::new(text).is_file() {
            return Self::file(text);
        }
        let built_in = BuiltinScene::from_id(text).map(Self::BuiltIn);
        built_in.or_else(|| Self::sample(text)).unwrap_or_else(|| Self::file(text))
    }

    /// Returns a sample by its name, optionally with a variant after a slash.
    pub(crate) fn sample(name: &str) -> Option<Self> {
        Sample::find_with_variant(name).map(|(sample, variant)| Self::Sample { sample, variant })
    }

    /// Returns a file by its absolute path, which does not depend on the working folder.
    pub(crate) fn file(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        // An empty path has no absolute form, and cannot be loaded either. In browsers files only have names.
        Self::File { path: std::path::absolute(&path).unwrap_or(path), index: None }
    }

    /// Returns the source with one of the file's scenes.
    ///
    /// # Errors
    ///
    /// For a built-in scene and an index other than 0.
    pub(crate) fn with_index(self, index: Option<usize>) -> Result<Self> {
        match (self, index) {
            (Self::File { path, .. }, index) => Ok(Self::File { path, index }),
            (own, None | Some(0)) => Ok(own),
            (_, Some(index)) => bail!("--scene-index {index}: a built-in scene has only scene 0; name a file"),
        }
    }

    /// Returns the index of the file's scene; `None` for its default one and for a built-in scene.
    pub(crate) fn index(&self) -> Option<usize> {
        match self {
            Self::BuiltIn(_) | Self::Sample { .. } => None,
            Self::File { index, .. } => *index,
        }
    }

    /// Returns the text that [`Self::from_text`] reads, without [`Self::index`].
    pub(crate) fn text(&self) -> String {
        match self {
            Self::BuiltIn(scene) => scene.id().to_owned(),
            Self::Sample { sample, variant: None } => sample.id.to_owned(),
            Self::Sample { sample, variant: Some(variant) } => format!("{}/{}", sample.id, variant.id),
            Self::File { path, .. } => path.display().to_string(),
        }
    }

    /// Returns the name for people.
    pub(crate) fn label(&self) -> String {
        match self {
            Self::BuiltIn(scene) => scene.label().to_owned(),
            Self::Sample { sample, .. } => sample.title.to_owned(),
            Self::File { path, .. } => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
        }
    }

    /// Loads the scene, and calls `progress` at each step of loading a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be loaded, or has no such scene.
    pub(crate) async fn load(&self, progress: &dyn Fn(LoadStep, &SceneSize)) -> Result<Scene> {
        Ok(match self {
            Self::BuiltIn(scene) => scene.build(),
            Self::Sample { sample, .. } => sample.scene(),
            Self::File { path, index } => platform::load_gltf(path, *index, progress).await?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_scenes_go_by_name_and_everything_else_is_a_file() {
        for scene in BuiltinScene::ALL {
            assert_eq!(SceneSource::from_text(scene.id()), SceneSource::BuiltIn(scene));
            assert_eq!(SceneSource::BuiltIn(scene).text(), scene.id());
        }
        let sample = SceneSource::from_text("xna-shadow-mapping/acne");
        assert!(matches!(sample, SceneSource::Sample { variant: Some(_), .. }), "{sample:?}");
        assert_eq!(sample.text(), "xna-shadow-mapping/acne");
        let file = SceneSource::from_text("town/kenney.glb");
        let path = std::env::current_dir().expect("a working folder").join("town/kenney.glb");
        assert_eq!((file.text(), file.label().as_str()), (path.display().to_string(), "kenney.glb"));
        assert!(SceneSource::default().with_index(Some(1)).is_err());
        let second = file.clone().with_index(Some(2)).expect("files have scenes");
        assert_eq!((second.text(), second.index()), (file.text(), Some(2)));
    }
}
