//! The file of the viewer's state. A damaged file is renamed, and other viewers wait while one writes.

use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result};
use etcetera::BaseStrategy;
use shadowfit_study::{make_folder, write_whole};

/// Longest wait for another viewer that writes the file: short enough that people rarely notice.
const PATIENCE: Duration = Duration::from_millis(300);
/// Time between two attempts.
const ASK_AGAIN: Duration = Duration::from_millis(10);

/// The file of the viewer's state.
#[derive(Clone, Debug, Default)]
pub(crate) struct StateFile {
    /// `None` if the system has no folder for settings.
    path: Option<PathBuf>,
}

impl StateFile {
    /// Returns the file of the user on this system.
    pub(crate) fn of_person() -> Self {
        let folders = etcetera::choose_base_strategy().ok();
        Self { path: folders.map(|folders| folders.config_dir().join("shadowfit").join("viewer.toml")) }
    }

    pub(crate) fn at(path: PathBuf) -> Self {
        Self { path: Some(path) }
    }

    /// Returns the name of the file for messages, `None` if the system has no place for it.
    pub(crate) fn name(&self) -> Option<String> {
        self.path.as_ref().map(|path| path.display().to_string())
    }

    /// Reads the file. Returns `None` if it does not exist. The inner error means that its content is not
    /// text.
    pub(crate) fn read(&self) -> io::Result<Option<Result<String>>> {
        let Some(path) = &self.path else { return Ok(None) };
        match fs::metadata(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Ok(there) if there.is_dir() => return Err(io::Error::other("it is a folder")),
            // Devices may have no end.
            Ok(there) if !there.is_file() => return Err(io::Error::other("it is not an ordinary file")),
            known => known?,
        };
        Ok(Some(String::from_utf8(fs::read(path)?).context("it is not text")))
    }

    /// Runs `work` while no other viewer writes the file. Creates the file's folder first.
    pub(crate) fn locked<T>(&mut self, work: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let parent = self.path.as_deref().and_then(Path::parent);
        make_folder(parent.unwrap_or(Path::new("")))?;
        let _lock = self.path.as_deref().and_then(lock);
        work(self)
    }

    /// Replaces the file as a whole.
    pub(crate) fn write(&mut self, text: &str) -> Result<()> {
        self.path.as_ref().map_or(Ok(()), |path| write_whole(path, text.as_bytes()))
    }

    /// Renames a damaged file. Returns a sentence about it, with the consequence `then`.
    pub(crate) fn set_aside(&mut self, then: &str) -> String {
        let Some(path) = &mut self.path else { return String::new() };
        let aside = (1..=u16::MAX)
            .map(|number| path.with_extension(format!("damaged-{number}.toml")))
            .find(|path| !path.exists())
            .unwrap_or_else(|| path.clone());
        match fs::rename(&path, &aside) {
            Ok(()) => format!("They are set aside as {}, and {then}.", aside.display()),
            Err(error) => {
                // It must not be overwritten.
                *path = aside;
                format!("They stay where they are, since they cannot be renamed: {error}.")
            }
        }
    }
}

/// Locks the file against other viewers until the lock is dropped. Returns `None` if files cannot be locked,
/// or another viewer holds the lock for too long. Then files are still written whole, but a change of that
/// viewer may be lost.
fn lock(path: &Path) -> Option<File> {
    let mut name = OsString::from(".");
    name.push(path.file_name()?);
    name.push(".lock");
    let file = File::options().create(true).truncate(false).write(true).open(path.with_file_name(name)).ok()?;
    for _ in 0..PATIENCE.as_millis() / ASK_AGAIN.as_millis() {
        match file.try_lock() {
            Ok(()) => return Some(file),
            Err(TryLockError::WouldBlock) => std::thread::sleep(ASK_AGAIN),
            Err(TryLockError::Error(_)) => return None,
        }
    }
    None
}
