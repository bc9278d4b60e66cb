//! The viewer's messages about places where it cannot write, and the files that remain when it is killed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::support::{adapter_name, files_below, viewer_program};

/// Exit code after refused input.
const REFUSED: i32 = 2;
/// Number of times that the viewer is killed. Its own tests kill the code that writes the files much more
/// often.
const KILLS: u64 = 3;

/// Folder of one test, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("shadowfit-files-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A separate file system in a folder, until it is dropped.
struct Mounted(PathBuf);

impl Mounted {
    /// Mounts the file system. Prints a note and returns `None` if this user may not mount.
    fn new(folder: PathBuf, options: &str) -> Option<Self> {
        fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", options, "tmpfs"]).arg(&folder).stderr(Stdio::null());
        if mount.status().is_ok_and(|status| status.success()) {
            return Some(Self(folder));
        }
        println!("SKIPPED: a small disk cannot be mounted here");
        None
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

fn viewer(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(viewer_program());
    command.current_dir(folder).args(["--adapter", adapter_name(), "--size", "64x36"]).args(arguments);
    command
}

fn assert_refused(mut command: Command, words: &[&str]) -> Output {
    let output = command.output().expect("the program starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(REFUSED), "{command:?}: {message}");
    assert!(!message.contains("panicked"), "{command:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{command:?}: \"{word}\" is missing in: {message}");
    }
    output
}

#[test]
fn a_full_disk_is_told_with_the_picture_that_it_has_no_room_for_and_holds_whole_pictures_only() {
    let scratch = Scratch::new("full");
    let Some(disk) = Mounted::new(scratch.0.join("disk"), "size=32k") else { return };
    let output = assert_refused(viewer(&scratch.0, &["--headless", "disk"]), &["disk/", ".png: ", "the disk is full"]);
    let written = String::from_utf8_lossy(&output.stdout).matches(".png").count();
    let files = files_below(&disk.0);
    assert!(written > 0 && files.len() == written, "{files:?}");
    for file in files {
        image::open(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    }
}

#[test]
fn a_read_only_folder_is_refused_before_anything_is_drawn() {
    let scratch = Scratch::new("read-only");
    let Some(_disk) = Mounted::new(scratch.0.join("disk"), "ro") else { return };
    let reason = ["disk", "read-only"];
    let output = assert_refused(viewer(&scratch.0, &["--headless", "disk"]), &reason);
    assert!(output.stdout.is_empty(), "no picture is begun");
}

#[test]
fn folders_and_files_that_are_in_the_way_are_named() {
    let scratch = Scratch::new("in-the-way");
    fs::write(scratch.0.join("occupied"), "a file").expect("written");
    fs::create_dir(scratch.0.join("folder")).expect("a folder");
    for folder in ["occupied", "occupied/below"] {
        let words = [folder, "part of the path is a file"];
        assert_refused(viewer(&scratch.0, &["--headless", folder]), &words);
    }
    let script = "await loaded\nwindow folder\n";
    fs::write(scratch.0.join("script.txt"), script).expect("written");
    let words = ["script.txt:2: window folder", "a folder of this name exists"];
    assert_refused(viewer(&scratch.0, &["--headless", ".", "--script", "script.txt"]), &words);
}

#[test]
fn a_viewer_that_is_killed_while_it_saves_leaves_whole_pictures() {
    let scratch = Scratch::new("killed");
    let lines = "window whole.png\npicture alone.png\nfigures figures.csv\n".repeat(2000);
    fs::write(scratch.0.join("script.txt"), format!("await loaded\nset view.judge off\n{lines}")).expect("written");
    for round in 0..KILLS {
        let out = format!("out-{round}");
        let arguments = ["--headless", &out, "--no-play", "--script", "script.txt"];
        let mut child = viewer(&scratch.0, &arguments).stderr(Stdio::null()).spawn().expect("the viewer starts");
        let pictures = ["whole.png", "alone.png"].map(|name| scratch.0.join(&out).join(name));
        while !pictures.iter().all(|path| path.is_file()) {
            assert_eq!(child.try_wait().expect("a child"), None, "it ended before it saved");
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(50 + round * 37));
        child.kill().expect("killed");
        assert!(!child.wait().expect("a child").success(), "it was killed while it played");
        for path in pictures {
            image::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
    }
}
