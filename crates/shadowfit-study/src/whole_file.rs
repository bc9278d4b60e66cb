//! Files that are written completely or not at all. After a killed process, a full disk or a power cut, the
//! old or the new file exists.
//!
//! ```text
//! .viewer.toml.k3Zx9Q.part   written, and sent to the disk
//!       | renamed
//! viewer.toml                replaced
//! ```
//!
//! If the process is killed in between, the first file is left behind. The next writer of the same file
//! removes it, once it is too old to be in use.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use anyhow::{Result, anyhow};
use tempfile::{Builder, NamedTempFile};

/// Suffix of unfinished files.
const UNFINISHED: &str = ".part";
/// Age from which on an unfinished file counts as left behind. Writing takes seconds at most.
const LEFT_BEHIND: Duration = Duration::from_mins(1);
/// Bytes of a name that are reused in its unfinished file's name. Names may be 255 bytes long.
const LONGEST: usize = 200;
/// Greatest number of links that are followed, as on Linux.
const MOST_LINKS: usize = 40;

/// Writes a file completely or not at all. If `path` is a link, its target is written. A replaced file keeps
/// its permissions. Special files, such as pipes, are written to directly.
///
/// # Errors
///
/// If it cannot be written. The message has the path, the reason and advice. The old file stays.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    replace(&followed(path), bytes).map_err(|error| refusal(path, "cannot be written", &error))
}

/// Creates a folder if it is missing, and checks that files can be created in it. Call it before long work.
///
/// # Errors
///
/// If it cannot be created or written to. The message has the path, the reason and advice.
pub fn make_folder(folder: &Path) -> Result<()> {
    let made = fs::create_dir_all(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => ErrorKind::NotADirectory.into(),
        _ => error,
    });
    made.map_err(|error| refusal(folder, "the folder cannot be created", &error))?;
    let probe = tempfile::tempfile_in(folder_of(&folder.join("file")));
    probe.map(drop).map_err(|error| refusal(folder, "the folder cannot be written to", &error))
}

/// Checks, as far as possible, that a file can be written. Call it before long work.
///
/// # Errors
///
/// If a folder has that name, or the folder of the file is missing or cannot be written to.
pub fn check_place(file: &Path) -> Result<()> {
    let path = followed(file);
    let checked = match special(&path) {
        Ok(true) => Ok(()),
        Ok(false) => tempfile::tempfile_in(folder_of(&path)).map(drop),
        Err(error) => Err(error),
    };
    checked.map_err(|error| refusal(file, "cannot be written", &error))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if special(path)? {
        return File::options().write(true).open(path)?.write_all(bytes);
    }
    let mut file = unfinished(path)?;
    file.write_all(bytes)?;
    if let Ok(old) = fs::metadata(path) {
        // Some file systems have no permissions.
        let _ = file.as_file().set_permissions(old.permissions());
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    // The content is safe by now. Some file systems cannot sync folders.
    #[cfg(unix)]
    let _ = File::open(folder_of(path)).and_then(|folder| folder.sync_all());
    remove_left_behind(path);
    Ok(())
}

/// Returns whether the path is a special file, which must be written to instead of replaced.
fn special(path: &Path) -> io::Result<bool> {
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => Err(ErrorKind::IsADirectory.into()),
        Ok(there) => Ok(!there.is_file()),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Creates a new file beside a path. It is removed unless it is renamed.
fn unfinished(path: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    let prefix = prefix(path);
    builder.prefix(&prefix).suffix(UNFINISHED);
    // Permissions of any new file, which the user's umask then reduces.
    #[cfg(unix)]
    builder.permissions(<Permissions as std::os::unix::fs::PermissionsExt>::from_mode(0o666));
    builder.tempfile_in(folder_of(path))
}

/// Removes unfinished files of a path that were left behind. Ignores failures, which do no harm.
fn remove_left_behind(path: &Path) {
    let prefix = prefix(path);
    for entry in fs::read_dir(folder_of(path)).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let middle = name.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(UNFINISHED));
        let age =
            entry.metadata().and_then(|there| there.modified()).map(|time| SystemTime::now().duration_since(time));
        let is_old = matches!(age, Ok(Ok(age)) if age > LEFT_BEHIND);
        if is_old && middle.is_some_and(|middle| middle.bytes().all(|byte| byte.is_ascii_alphanumeric())) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Returns the prefix of a path's unfinished files.
fn prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!(".{}.", &name[..name.floor_char_boundary(LONGEST)])
}

/// Returns the folder of a file; the working folder for a bare name.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Follows links. The target may be missing.
fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(target) = fs::read_link(&path) else { break };
        path = folder_of(&path).join(target);
    }
    path
}

/// Returns the message for people. The system's message would name the unfinished file.
fn refusal(path: &Path, what: &str, error: &io::Error) -> anyhow::Error {
    let reason = match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "the disk is full; make room, or choose another folder",
        ErrorKind::PermissionDenied => "permission is denied; choose a folder that you may write to",
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only; choose a folder on another one",
        ErrorKind::NotFound => "its folder does not exist; create it first, or choose another one",
        ErrorKind::NotADirectory => "part of the path is a file, not a folder; choose another path",
        ErrorKind::IsADirectory => "a folder of this name exists; move it, or choose another name",
        _ => return anyhow!("{}: {what}: {error}; choose another place", path.display()),
    };
    anyhow!("{}: {what}: {reason}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a folder")
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn refused(path: &Path) -> String {
        write_whole(path, b"x").expect_err("it cannot be written").to_string()
    }

    #[test]
    fn a_file_is_replaced_whole_and_nothing_else_is_left() {
        let folder = folder();
        let path = folder.path().join("a.txt");
        for text in ["long and first", "short", ""] {
            check_place(&path).expect("a place");
            write_whole(&path, text.as_bytes()).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("it is there"), text);
        }
        let long = folder.path().join("n".repeat(255));
        write_whole(&long, b"x").expect("the unfinished file has a shorter name");
        assert_eq!(names(folder.path()).len(), 2);
    }

    #[test]
    fn what_was_left_behind_goes_once_it_is_old_and_what_others_are_writing_stays() {
        let folder = folder();
        let path = folder.path().join("a.txt");
        let old = SystemTime::now() - 2 * LEFT_BEHIND;
        let before = [".a.txt.Abc123.part", ".a.txt.new.part", ".a.txt.b.c.part", ".b.txt.Abc123.part", "a.txt.part"];
        for name in before {
            let file = File::create(folder.path().join(name)).expect("a file");
            if name != ".a.txt.new.part" {
                file.set_modified(old).expect("an old file");
            }
        }
        write_whole(&path, b"x").expect("written");
        let mut expected = before[1..].to_vec();
        expected.push("a.txt");
        expected.sort_unstable();
        assert_eq!(names(folder.path()), expected);
    }

    #[test]
    fn places_that_cannot_be_written_are_named_with_the_reason_and_stay_as_they_were() {
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("folder")).expect("a folder");
        fs::write(at("file"), "text").expect("a file");
        for (name, reason) in [
            ("folder", "a folder of this name exists"),
            ("missing/file", "its folder does not exist"),
            ("file/below", "part of the path is a file"),
        ] {
            let message = refused(&at(name));
            assert!(message.contains(name) && message.contains(reason), "{message}");
            assert_eq!(check_place(&at(name)).expect_err("refused").to_string(), message);
        }
        for name in ["file", "file/below"] {
            let message = make_folder(&at(name)).expect_err("refused").to_string();
            assert!(message.contains(name) && message.contains("part of the path is a file"), "{message}");
        }
        make_folder(&at("folder/new")).expect("a new folder");
        assert_eq!(names(folder.path()), ["file", "folder"]);
        assert_eq!(names(&at("folder/new")), [""; 0]);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_permissions_stay_and_devices_are_written_to() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("elsewhere")).expect("a folder");
        symlink("elsewhere/real", at("link")).expect("a link");
        let mode = |name: &str| fs::metadata(at(name)).expect("it is there").permissions().mode() & 0o777;
        write_whole(&at("link"), b"1").expect("the link's file is made");
        fs::write(at("plain"), "").expect("a file");
        assert_eq!(mode("link"), mode("plain"), "as any new file");
        fs::set_permissions(at("elsewhere/real"), Permissions::from_mode(0o640)).expect("changed");
        write_whole(&at("link"), b"2").expect("written");
        assert!(fs::symlink_metadata(at("link")).expect("it is there").is_symlink());
        assert_eq!((fs::read(at("elsewhere/real")).expect("it is there"), mode("link")), (b"2".to_vec(), 0o640));
        symlink("circle", at("circle")).expect("a link");
        assert!(refused(&at("circle")).contains("circle"));
        write_whole(Path::new("/dev/null"), b"x").expect("gone");
        assert!(fs::metadata("/dev/null").expect("it is there").file_type().is_char_device());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_called_full() {
        assert!(refused(Path::new("/dev/full")).contains("the disk is full; make room"));
    }
}
