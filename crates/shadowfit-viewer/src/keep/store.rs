//! Stores the viewer's state between starts.
//!
//! A first start without a file is normal. A damaged file is renamed and reported, never overwritten. Several
//! viewers may share the file: before writing, a viewer reads the changes of others, and writes only its own
//! changes over them.

use anyhow::{Context, Result};

use super::saved::Saved;
use crate::platform::StateFile;

/// The file with the saved state.
#[derive(Clone, Debug)]
pub(crate) struct Store {
    file: StateFile,
    /// State of this viewer when it last read or wrote the file.
    known: Saved,
    /// Whether the file has that state.
    is_written: bool,
    /// Whether the last attempt to write failed.
    failed: bool,
}

impl Store {
    pub(crate) fn new(file: StateFile) -> Self {
        Self { file, known: Saved::default(), is_written: false, failed: false }
    }

    /// Returns the saved state, and a message for the user. Without a file there is neither.
    pub(crate) fn load(&mut self) -> (Option<Saved>, Option<String>) {
        let Some(name) = self.file.name() else {
            let message = "Settings are not saved: this user has no home folder. Set HOME, or name a file with \
                   --state.";
            return (None, Some(message.to_owned()));
        };
        match self.file.read().map(parsed) {
            Ok(None) => (None, None),
            Ok(Some(Ok(saved))) => {
                (self.known, self.is_written) = (saved.clone(), true);
                (Some(saved), None)
            }
            Ok(Some(Err(error))) => (
                None,
                Some(set_aside(
                    &mut self.file,
                    &error,
                    "the viewer starts with default \
                   settings",
                )),
            ),
            Err(error) => {
                let advice = "The viewer starts with default settings; name another file with --state.";
                (None, Some(format!("The saved settings cannot be read: {name}: {error}. {advice}")))
            }
        }
    }

    /// Saves changes. Returns a message for the user only if the result is new: saving failed, and will be
    /// tried again, or works again.
    pub(crate) fn keep(&mut self, saved: &Saved) -> Option<String> {
        match self.save(saved) {
            Ok(note) => {
                let can_again = std::mem::take(&mut self.failed);
                note.or_else(|| can_again.then(|| "The settings are saved again.".to_owned()))
            }
            Err(error) => {
                let is_known = std::mem::replace(&mut self.failed, true);
                (!is_known)
                    .then(|| format!("The settings cannot be saved: {error:#}. The viewer continues and tries again."))
            }
        }
    }

    /// Writes this viewer's changes over the current content of the file. Returns a message if that was
    /// damaged and has been set aside.
    ///
    /// # Errors
    ///
    /// If the file cannot be written. The old file stays.
    pub(crate) fn save(&mut self, saved: &Saved) -> Result<Option<String>> {
        let Some(name) = self.file.name() else { return Ok(None) };
        if self.is_written && *saved == self.known {
            return Ok(None);
        }
        let note = self.file.locked(|file| {
            let there = file.read().with_context(|| format!("{name} cannot be read"))?;
            let (merged, note) = match parsed(there) {
                None => (saved.clone(), None),
                Some(Ok(theirs)) => (saved.over(&self.known, theirs), None),
                Some(Err(error)) => (saved.clone(), Some(set_aside(file, &error, "this viewer's settings are saved"))),
            };
            file.write(&merged.to_toml()?)?;
            Ok(note)
        })?;
        (self.known, self.is_written) = (saved.clone(), true);
        Ok(note)
    }
}

/// Parses the state in a text, if there is a text. Fails if the text is invalid.
fn parsed(text: Option<Result<String>>) -> Option<Result<Saved>> {
    text.map(|text| text.and_then(|text| Saved::from_toml(&text)))
}

/// Sets a damaged file aside, and returns a message about it.
fn set_aside(file: &mut StateFile, error: &anyhow::Error, then: &str) -> String {
    format!("The saved settings are invalid: {error:#}. {}", file.set_aside(then))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use glam::DVec3;
    use shadowfit::Technique;
    use shadowfit_render::FlyCamera;
    use shadowfit_study::NamedTechnique;

    use super::*;
    use crate::keep::saved::tests::saved;
    use crate::keep::saved::{Bookmark, Theme};
    use crate::scene_source::SceneSource;

    #[test]
    fn everything_comes_back_at_the_next_start() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("deep").join("viewer.toml");
        let mut store = Store::new(StateFile::at(path.clone()));
        assert_eq!(store.load(), (None, None), "a first start is ordinary");
        let saved = saved();
        assert_eq!(saved.recent, [PathBuf::from("a.glb"), PathBuf::from("b.glb")]);
        store.save(&saved).expect("written");
        let (read, message) = Store::new(StateFile::at(path)).load();
        let read = read.expect("what was written");
        assert_eq!(message, None);
        // Angles are written in degrees, which rounds them.
        let near = |a: Option<FlyCamera>, b: Option<FlyCamera>| {
            let (a, b) = (a.expect("a camera"), b.expect("a camera"));
            a.position == b.position && (a.yaw - b.yaw).abs() < 1e-6 && (a.pitch - b.pitch).abs() < 1e-6
        };
        assert!(near(read.camera, saved.camera) && near(read.bookmarks[0].camera(), saved.camera));
        assert!(read.bookmarks[0].is_of(3, &saved.scene), "{:?}", read.bookmarks);
        let first = SceneSource::from_text("some/town.glb");
        assert!(!read.bookmarks[0].is_of(3, &first), "a bookmark is of one of the file's scenes");
        let same = Saved { camera: saved.camera, bookmarks: saved.bookmarks.clone(), ..read };
        assert_eq!(same, saved);
    }

    #[test]
    fn a_damaged_file_is_set_aside_and_told_and_never_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("viewer.toml");
        let damaged = ["", "version = 99", "version = 1\n[settings.bias]\nconstant = \"x\"", "\u{0}\u{1}", "version"];
        for (round, text) in damaged.into_iter().enumerate() {
            fs::write(&path, text).expect("written");
            let mut store = Store::new(StateFile::at(path.clone()));
            let (read, message) = store.load();
            let message = message.expect("a person is told");
            assert!(read.is_none() && message.contains("damaged"), "{message}");
            let aside = folder.path().join(format!("viewer.damaged-{}.toml", round + 1));
            assert_eq!(fs::read_to_string(aside).expect("it is there"), text);
            store.save(&saved()).expect("a new one");
        }
        fs::write(&path, [0xff, 0xfe, 0x00]).expect("written");
        assert!(Store::new(StateFile::at(path)).load().1.expect("not text").contains("not text"));
    }

    /// Two viewers that share a file and start with the same state, and a third one that reads it.
    struct Two {
        folder: tempfile::TempDir,
        stores: [Store; 2],
        states: [Saved; 2],
    }

    impl Two {
        fn new(start: Option<Saved>) -> Self {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("viewer.toml");
            if let Some(start) = start {
                Store::new(StateFile::at(path.clone())).save(&start).expect("written");
            }
            let mut stores = [Store::new(StateFile::at(path.clone())), Store::new(StateFile::at(path))];
            let states = stores.each_mut().map(|store| store.load().0.unwrap_or_default());
            Self { folder, stores, states }
        }

        fn save(&mut self, viewer: usize) {
            assert_eq!(self.stores[viewer].keep(&self.states[viewer]), None);
        }

        fn file(&self) -> Saved {
            Store::new(StateFile::at(self.folder.path().join("viewer.toml"))).load().0.expect("a file")
        }
    }

    fn camera() -> FlyCamera {
        FlyCamera { position: DVec3::ONE, yaw: 0.0, pitch: 0.0, roll: 0.0 }
    }

    fn preset(name: &str) -> NamedTechnique {
        NamedTechnique { name: name.to_owned(), ..Technique::preset("calm-4").expect("a preset").into() }
    }

    fn preset_names(saved: &Saved) -> Vec<&str> {
        let mut names: Vec<_> = saved.presets.iter().map(|preset| preset.name.as_str()).collect();
        names.sort_unstable();
        names
    }

    #[test]
    fn a_sun_of_the_file_that_moves_is_followed_after_two_viewers_have_saved() {
        for number in [Some(2), None] {
            let mut start = saved();
            start.settings.light.file = Some(1);
            let mut two = Two::new(Some(start));
            two.states[0].settings.light.file = number;
            two.states[0].settings.light.azimuth = 0.5;
            two.save(0);
            // The file's sun moved below the horizon, and the user changed something else.
            (two.states[1].settings.light.azimuth, two.states[1].settings.light.elevation) = (0.25, -0.5);
            two.states[1].settings.technique.bias.slope = 2.5;
            two.save(1);
            let light = two.file().settings.light;
            assert_eq!(light.file, number);
            assert!((light.azimuth - 0.5).abs() < 1e-6, "{light:?}");
            assert_eq!(two.file().settings.technique.bias.slope, 2.5);
        }
    }

    #[test]
    fn two_viewers_keep_what_the_other_one_added_changed_and_deleted() {
        for start in [Some(saved()), None] {
            let mut two = Two::new(start.clone());
            two.states[0].presets.push(preset("of one"));
            two.states[0].theme = Theme::Dark;
            two.states[0].remember(Path::new("one.glb"));
            two.states[0].settings.technique.bias.constant = 0.75;
            two.save(0);
            let bookmark = Bookmark::new(7, &SceneSource::default(), camera());
            two.states[1].presets.push(preset("of two"));
            two.states[1].bookmarks.push(bookmark.clone());
            two.states[1].remember(Path::new("two.glb"));
            two.states[1].settings.technique.bias.slope = 2.5;
            two.save(1);
            two.states[0].presets.push(preset("of one, later"));
            two.save(0);
            let file = two.file();
            let names: Vec<_> = preset_names(&file).into_iter().filter(|name| name.starts_with("of")).collect();
            assert_eq!(names, ["of one", "of one, later", "of two"]);
            assert_eq!((file.theme, file.bookmarks.contains(&bookmark)), (Theme::Dark, true));
            assert_eq!(file.recent[..2], [PathBuf::from("two.glb"), PathBuf::from("one.glb")]);
            let bias = file.settings.technique.bias;
            assert_eq!((bias.constant, bias.slope), (0.75, 2.5));
            two.states[1].presets.retain(|preset| preset.name != "of two");
            two.save(1);
            two.states[0].theme = Theme::Light;
            two.save(0);
            assert!(!preset_names(&two.file()).contains(&"of two"), "what one deletes, the other does not bring back");
        }
    }

    #[test]
    fn settings_and_camera_go_with_the_scene_of_the_viewer_that_changed_it() {
        let mut two = Two::new(Some(saved()));
        two.states[0].scene = SceneSource::from_text("plain");
        two.states[0].camera = Some(camera());
        two.states[0].settings.light.hour = Some(12.0);
        two.states[0].other = None;
        two.states[1].settings.technique.bias.constant = 0.75;
        two.save(1);
        two.save(0);
        let file = two.file();
        assert_eq!((&file.scene, file.other), (&SceneSource::from_text("plain"), None));
        assert_eq!(file.settings, two.states[0].settings, "settings suit the scene that they were made for");
        two.states[1].presets.push(preset("of two"));
        two.save(1);
        assert_eq!(two.file().scene, SceneSource::from_text("plain"));
    }

    #[test]
    fn what_another_program_damaged_meanwhile_is_set_aside() {
        let mut two = Two::new(Some(saved()));
        fs::write(two.folder.path().join("viewer.toml"), "version = ").expect("written");
        two.states[0].theme = Theme::Dark;
        let message = two.stores[0].keep(&two.states[0]).expect("a message");
        assert!(message.contains("viewer.damaged-1.toml"), "{message}");
        let aside = fs::read_to_string(two.folder.path().join("viewer.damaged-1.toml"));
        assert_eq!((aside.expect("it is there").as_str(), two.file().theme), ("version = ", Theme::Dark));
    }

    #[test]
    fn what_cannot_be_saved_is_told_once_and_tried_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("viewer.toml");
        fs::create_dir(&path).expect("a folder");
        let mut store = Store::new(StateFile::at(path.clone()));
        let (none, message) = store.load();
        assert!(none.is_none() && message.is_some_and(|message| message.contains("it is a folder")));
        let message = store.keep(&saved()).expect("a message");
        assert!(message.contains("viewer.toml") && message.contains("it is a folder"), "{message}");
        assert_eq!(store.keep(&saved()), None);
        fs::remove_dir(&path).expect("removed");
        assert_eq!(store.keep(&saved()).as_deref(), Some("The settings are saved again."));
        assert!(path.is_file());
        let mut nowhere = Store::new(StateFile::default());
        assert!(nowhere.load().1.is_some_and(|message| message.contains("--state")));
        assert_eq!(nowhere.keep(&saved()), None);
    }
}
