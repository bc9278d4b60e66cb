//! The viewer as a program: its messages and exit codes for bad input.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use shadowfit_testing::refuses_missing_adapter;
use shadowfit_testing::scene_notes::{NOTES, SCENE_WITH_NOTES};

use crate::support::{adapter_name, assets, files_below, viewer_program};

/// Exit code after refused input.
const REFUSED: i32 = 2;

/// Files that cannot be shown, and a word of the expected reason.
const BROKEN_FILES: [(&str, &str); 14] = [
    ("edge_shared/refuse/arch_gate_draco.glb", "KHR_draco_mesh_compression"),
    ("edge_shared/refuse/tree_dead_large_meshopt.glb", "EXT_meshopt_compression"),
    ("hostile_shared/synthetic/accessor_count_u32max.gltf", "accessor 0"),
    ("hostile_shared/synthetic/buffer_claims_1TiB.gltf", "buffers[0]"),
    ("hostile_shared/synthetic/cycle_two_nodes.gltf", "reached twice"),
    ("hostile_shared/synthetic/glb_json_len_u32max.glb", "GLB"),
    ("hostile_shared/synthetic/huge_extent_1e30.gltf", "vertex 1"),
    ("hostile_shared/synthetic/index_u32max.gltf", "3 vertices"),
    ("hostile_shared/synthetic/nan_positions.gltf", "not finite"),
    ("hostile_shared/synthetic/unknown_required_extension.gltf", "ACME_made_up"),
    ("hostile_shared/synthetic/uri_path_traversal.gltf", "leads out"),
    ("hostile_shared/assimp/gltf1_TwoBoxes.gltf", "version"),
    ("hostile_shared/tinygltf/invalid-buffer-index.gltf", "buffer"),
    ("hostile_shared/validator/base__data__root__valid.gltf", "no meshes"),
];

/// Folder of one test's files, empty at the start and removed at the end.
pub(super) struct Scratch(pub(super) PathBuf);

impl Scratch {
    pub(super) fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("shadowfit-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        Self(folder)
    }

    pub(super) fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        path
    }

    /// Returns all files in it.
    fn files(&self) -> Vec<PathBuf> {
        files_below(&self.0)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Runs the viewer in `folder` with small pictures and small maps.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(viewer_program());
    command
        .current_dir(folder)
        .args(["--adapter", adapter_name(), "--size", "64x36", "--set", "map.resolution=256"])
        .args(arguments);
    command.output().expect("the viewer starts")
}

/// Runs the viewer, which must refuse with a message that contains all `words` and must not write into
/// `scratch`.
fn assert_refused(scratch: &Scratch, arguments: &[&str], words: &[&str]) {
    let before = scratch.files();
    let output = run(&scratch.0, arguments);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(REFUSED), "{arguments:?}: {message}");
    assert!(!message.contains("panicked"), "{arguments:?}: {message}");
    for word in words {
        assert!(message.contains(word), "{arguments:?}: \"{word}\" is missing in: {message}");
    }
    assert_eq!(scratch.files(), before, "{arguments:?} leaves files behind");
}

#[test]
fn broken_files_end_in_exit_code_2_with_their_name_and_the_reason() {
    let Some(folder) = assets() else { return };
    let scratch = Scratch::new("broken");
    for (file, reason) in BROKEN_FILES {
        let path = folder.join(file);
        let name = path.file_name().expect("a file's name").to_string_lossy();
        let path = path.to_str().expect("a path in UTF-8");
        assert_refused(&scratch, &[path, "--headless", "out"], &[&name, reason]);
    }
}

#[test]
fn what_import_notes_of_a_scene_goes_to_the_standard_error_a_line_for_each_note() {
    let scratch = Scratch::new("notes");
    scratch.file("notes.gltf", SCENE_WITH_NOTES.as_bytes());
    let output = run(&scratch.0, &["notes.gltf", "--headless", "out"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    for note in NOTES {
        let line = format!("warning: notes.gltf: {note}");
        assert!(message.lines().any(|said| said.starts_with(&line)), "\"{line}\" is missing in: {message}");
    }
    let output = run(&scratch.0, &["--headless", "out"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !message.contains("warning"), "the built-in scene has no notes: {message}");
}

#[test]
fn missing_empty_and_foreign_files_end_in_exit_code_2_with_their_name() {
    let scratch = Scratch::new("foreign");
    scratch.file("empty.glb", b"");
    scratch.file("empty.gltf", b"");
    scratch.file("words.gltf", b"these are words");
    scratch.file("picture.png", b"\x89PNG\r\n\x1a\n");
    scratch.file("cut.glb", b"glTF\x02\x00\x00\x00\xff\x00\x00\x00");
    std::fs::create_dir(scratch.0.join("folder.gltf")).expect("a new folder");
    let files = ["missing.glb", "empty.glb", "empty.gltf", "words.gltf", "picture.png", "cut.glb", "folder.gltf"];
    for file in files {
        assert_refused(&scratch, &[file, "--headless", "out"], &["error", file]);
    }
}

// Draws maps in all filters and formats, a walk and six judged pictures: half a minute on the software
// adapter. It is the only test that runs all checks in sequence on one device.
#[test]
fn the_check_of_the_software_adapter_passes_and_reports_every_row() {
    let scratch = Scratch::new("check");
    let check = |arguments: &[&str]| {
        let mut command = Command::new(viewer_program());
        command.current_dir(&scratch.0).args(["--adapter", adapter_name(), "--check"]).args(arguments);
        command.output().expect("the viewer starts")
    };
    let output = check(&[]);
    let (report, progress) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{report}\n{progress}");
    for row in ["Look-up", "Map formats", "Kept maps", "Exact edges", "Visible points", "Coverage"] {
        assert!(report.contains(&format!("[passed] {row} (")), "{row} is missing in: {report}");
        assert!(progress.contains(&format!("{row}: passed")), "{row} is missing in: {progress}");
    }
    for fact in ["adapter", "driver", "backend", "device type", "limits", "features", "Shadows can be trusted"] {
        assert!(report.contains(fact), "{fact} is missing in: {report}");
    }
    assert_eq!(report.matches("tolerance").count(), 6, "{report}");
    assert!(scratch.files().is_empty(), "the check leaves files behind");
    for arguments in [&["--headless", "out"][..], &["no/such/scene.glb"], &["--sample", "list"], &["--parameters"]] {
        let output = check(arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{arguments:?}: {message}");
        assert!(message.contains("--check"), "{arguments:?}: {message}");
    }
}

#[test]
fn absurd_flags_end_in_exit_code_2_and_name_themselves() {
    let scratch = Scratch::new("flags");
    let cases: [(&[&str], &str); 10] = [
        (&["--no-such-flag"], "--no-such-flag"),
        (&["--set", "no.such=1"], "no.such"),
        (&["--set", "bias.constant"], "ID=VALUE"),
        (&["--set", "bias.constant=much"], "bias.constant"),
        (&["--set", "bias.constant=nan"], "bias.constant"),
        (&["--set", "map.resolution=200"], "map.resolution"),
        (&["--set", "camera.far=1e99"], "camera.far"),
        (&["--animation", "-1"], "-1"),
        (&["--scene-index", "first"], "first"),
        (&["one.glb", "two.glb"], "two.glb"),
    ];
    for (arguments, word) in cases {
        assert_refused(&scratch, &[arguments, &["--headless", "out"]].concat(), &[word]);
    }
    for size in ["0x0", "64", "axb", "99999x10", "-5x9"] {
        let output = Command::new(viewer_program())
            .current_dir(&scratch.0)
            .args(["--adapter", adapter_name(), "--headless", "out", &format!("--size={size}")])
            .output()
            .expect("the viewer starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{size}: {message}");
        assert!(message.contains(size) && message.contains("1280x720"), "{size}: {message}");
    }
    assert!(scratch.files().is_empty());
}

#[test]
fn an_adapter_that_the_machine_lacks_is_refused_with_a_list_of_adapters() {
    let scratch = Scratch::new("adapter");
    refuses_missing_adapter(|| {
        let mut viewer = Command::new(viewer_program());
        viewer.current_dir(&scratch.0).args(["--headless", "out"]);
        viewer
    });
    assert!(scratch.files().is_empty(), "{:?}", scratch.files());
}

#[test]
fn a_scene_that_the_file_does_not_have_is_named_with_the_number_there_are() {
    let Some(folder) = assets() else { return };
    let scratch = Scratch::new("scene-index");
    let file = folder.join("edge_shared/khronos_embedded/MultipleScenes.gltf");
    let path = file.to_str().expect("a path in UTF-8");
    assert_refused(&scratch, &[path, "--scene-index", "99", "--headless", "out"], &["MultipleScenes.gltf", "99"]);
    assert_refused(&scratch, &["--scene-index", "99", "--headless", "out"], &["99"]);
    assert_refused(&scratch, &["--animation", "99", "--headless", "out"], &["99"]);
}

#[test]
fn a_folder_that_cannot_be_written_is_named_and_left_as_it_was() {
    let scratch = Scratch::new("folder");
    scratch.file("occupied", b"a file, not a folder");
    assert_refused(&scratch, &["--headless", "occupied"], &["occupied"]);
    assert_refused(&scratch, &["--headless", "occupied/below"], &["occupied/below"]);
    // The file name of a picture is taken by a folder.
    std::fs::create_dir_all(scratch.0.join("taken/final.png/inside")).expect("new folders");
    let output = run(&scratch.0, &["--headless", "taken"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(REFUSED), "{message}");
    assert!(message.contains("final.png"), "{message}");
    let names: Vec<_> = scratch.files().iter().map(|path| path.display().to_string()).collect();
    assert!(names.iter().all(|name| name.ends_with("occupied")), "half-written files: {names:?}");
}

#[test]
fn the_picture_set_is_whole_and_what_was_saved_stays_as_it_was() {
    let scratch = Scratch::new("pictures");
    let kept = scratch.0.join("config/shadowfit/viewer.toml");
    std::fs::create_dir_all(kept.parent().expect("a folder")).expect("new folders");
    let text = "version = 1\nscene = \"plain\"\n[settings.splits]\ncount = 2\n";
    std::fs::write(&kept, text).expect("written");
    let mut command = Command::new(viewer_program());
    command.current_dir(&scratch.0).env("XDG_CONFIG_HOME", scratch.0.join("config"));
    command.args(["--adapter", adapter_name(), "--size", "96x64", "--headless", "out"]);
    let output = command.output().expect("the viewer starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(!said.contains("plain"), "the scene of the last time is not restored: {said}");
    assert_eq!(std::fs::read_to_string(&kept).expect("it is there"), text);
    let files = scratch.files();
    for number in 1..=shadowfit_viewer::PICTURES {
        let line = format!("  {number}/{} ", shadowfit_viewer::PICTURES);
        assert!(said.contains(&line), "each picture is told: {said}");
    }
    let (pictures, others): (Vec<_>, Vec<_>) = files.iter().partition(|path| path.starts_with(scratch.0.join("out")));
    assert_eq!(pictures.len(), shadowfit_viewer::PICTURES);
    assert!(pictures.iter().all(|path| path.extension().is_some_and(|extension| extension == "png")));
    assert_eq!(others, [&kept]);
}

#[test]
fn a_script_without_a_window_saves_into_the_folder_and_ends_by_how_its_lines_went() {
    let scratch = Scratch::new("script");
    let good = "await loaded\ntechnique stable-4\nwindow whole.png\npicture alone.png\nfigures figures.csv\n";
    scratch.file("good.txt", good.as_bytes());
    let output = run(&scratch.0, &["--headless", "out", "--script", "good.txt"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let names: Vec<_> = scratch.files().iter().filter_map(|path| path.file_name().map(ToOwned::to_owned)).collect();
    for name in ["whole.png", "alone.png", "figures.csv"] {
        assert!(scratch.0.join("out").join(name).is_file(), "{name} is not in {names:?}");
    }
    assert_eq!(names.len(), 4, "nothing else is saved: {names:?}");
    for line in ["set splits.count 99", "open missing.glb", "window no/such/folder/whole.png"] {
        scratch.file("bad.txt", format!("await loaded\n\n{line}\nview truth\n").as_bytes());
        let output = run(&scratch.0, &["--headless", "out", "--script", "bad.txt"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{line}: {message}");
        assert!(message.contains(&format!("error: bad.txt:3: {line}: ")), "{message}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_closed_output_ends_quietly_and_a_full_one_in_exit_code_2() {
    let scratch = Scratch::new("outputs");
    let full = || std::fs::File::create("/dev/full").expect("a device of Linux");
    let start = |arguments: &[&str], output: Stdio, errors: Stdio| {
        let mut command = Command::new(viewer_program());
        command.current_dir(&scratch.0).args(arguments).stdout(output).stderr(errors);
        command.spawn().expect("the viewer starts")
    };
    let mut closed = start(&["--parameters"], Stdio::piped(), Stdio::piped());
    drop(closed.stdout.take());
    let ended = closed.wait_with_output().expect("a child");
    assert_eq!((ended.status.code(), ended.stderr.as_slice()), (Some(0), &b""[..]));
    let ended = start(&["--parameters"], full().into(), Stdio::piped()).wait_with_output().expect("a child");
    let message = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(REFUSED), "{message}");
    assert!(message.starts_with("error: cannot write to the standard output: "), "{message}");
    let refused = start(&["--headless", "out", "no_such_scene.glb"], Stdio::null(), full().into()).wait();
    assert_eq!(refused.expect("a child").code(), Some(REFUSED));
}

#[test]
fn help_version_and_parameters_end_with_success() {
    let scratch = Scratch::new("help");
    for (flag, word) in [("--help", "--headless"), ("--version", "viewer"), ("--parameters", "bias.normal_offset")] {
        let output = run(&scratch.0, &[flag]);
        assert_eq!(output.status.code(), Some(0), "{flag}");
        assert!(String::from_utf8_lossy(&output.stdout).contains(word), "{flag}");
    }
}
