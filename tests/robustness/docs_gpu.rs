//! The commands of the docs that start the viewer, run as they are written, without a window and with small
//! pictures.

use std::collections::BTreeSet;
use std::process::Command;

use shadowfit_testing::commands::doc_commands;
use shadowfit_testing::package_folder;
use shadowfit_testing::scene_notes::SCENE_WITH_NOTES;

use super::command_line_gpu::Scratch;
use crate::support::{adapter_name, viewer_program};

/// Options that print something, which need no picture.
const PRINTING: [&str; 4] = ["--help", "--parameters", "--actions", "list"];

/// Replaces placeholders of the docs.
fn filled(word: &str) -> String {
    match word {
        "DIR" => "pictures".to_owned(),
        "ID=VALUE" => "fit.kind=sphere".to_owned(),
        // Its file takes words from the folder in which the test runs.
        "scene.glb" => "scene.gltf".to_owned(),
        // The graphics driver of the tests.
        "--software" => format!("--adapter={}", adapter_name()),
        _ => word.to_owned(),
    }
}

/// Returns the arguments of a command, with those that make it quick. `None` if other tests run it.
fn arguments(words: &[String]) -> Option<Vec<String>> {
    // The tour, which `cargo xtask gallery` plays, and the check of the device are long.
    if words.iter().any(|word| word == "--check" || word.ends_with("tour.txt")) {
        return None;
    }
    let mut arguments: Vec<String> = words.iter().map(|word| filled(word)).collect();
    if words.iter().any(|word| PRINTING.contains(&word.as_str())) {
        return Some(arguments);
    }
    let adapter = format!("--adapter={}", adapter_name());
    let quick = ["--headless=pictures", "--script=script.txt", &adapter, "--set=map.resolution=256"];
    let name = |word: &str| word.split('=').next().map(str::to_owned);
    let given: BTreeSet<Option<String>> = arguments.iter().map(|word| name(word)).collect();
    // Without a script, `--headless` renders the viewer's own pictures.
    let is_album = given.contains(&name("--headless"));
    let lacks = |option: &&&str| match name(option).as_deref() {
        Some("--set") => true,
        Some("--script") => !is_album && !given.contains(&name(option)),
        _ => !given.contains(&name(option)),
    };
    arguments.extend(quick.iter().filter(lacks).map(|option| (*option).to_owned()));
    match arguments.iter().position(|word| word == "--size") {
        Some(size) => "64x36".clone_into(&mut arguments[size + 1]),
        None => arguments.push("--size=64x36".to_owned()),
    }
    Some(arguments)
}

#[test]
fn every_command_of_the_docs_that_starts_the_viewer_runs() {
    let scratch = Scratch::new("docs");
    scratch.file("scene.gltf", SCENE_WITH_NOTES.as_bytes());
    scratch.file("script.txt", b"await loaded\nframes 2\npicture picture.png\n");
    let mut run = BTreeSet::new();
    for command in doc_commands(&package_folder(env!("CARGO_MANIFEST_DIR"))) {
        let Some(words) = command.words.strip_prefix(&["xtask".to_owned(), "run".to_owned()]) else { continue };
        let Some(arguments) = arguments(words).filter(|_| run.insert(words.to_vec())) else { continue };
        println!("{}: {}", command.page, arguments.join(" "));
        let mut viewer = Command::new(viewer_program());
        let output = viewer.current_dir(&scratch.0).args(&arguments).output().expect("the viewer starts");
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        let printed = words.iter().any(|word| PRINTING.contains(&word.as_str()));
        assert!(!printed || !output.stdout.is_empty(), "{arguments:?}");
        let pictures = scratch.0.join("pictures");
        assert!(
            printed || ["picture.png", "final.png"].iter().any(|file| pictures.join(file).exists()),
            "{arguments:?}"
        );
        let _ = std::fs::remove_dir_all(pictures);
    }
    assert!(run.len() >= 15, "{run:?}");
}
