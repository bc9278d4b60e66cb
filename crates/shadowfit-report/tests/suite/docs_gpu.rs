//! The commands of the docs, run as they are written, with less and smaller pictures.

use std::ffi::OsStr;
use std::path::PathBuf;

use shadowfit_testing::commands::doc_commands;
use shadowfit_testing::scene_notes::SCENE_WITH_NOTES;
use shadowfit_testing::{adapter_name, package_folder};

use crate::peers::FLOOR_SCENARIOS;
use crate::scratch::{Scratch, assert_success};

fn root() -> PathBuf {
    package_folder(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns a scene as a binary glTF file: a header and one chunk of JSON.
fn glb(json: &str) -> Vec<u8> {
    let json = format!("{json}{}", " ".repeat(json.len().next_multiple_of(4) - json.len()));
    let numbers = [2, 20 + json.len() as u32, json.len() as u32].map(u32::to_le_bytes);
    [b"glTF", &numbers[0], &numbers[1], &numbers[2], b"JSON", json.as_bytes()].concat()
}

/// Creates a folder with all files that the commands name.
fn with_files() -> Scratch {
    let scratch = Scratch::new("docs");
    for scene in ["scene.glb", "town.glb"] {
        scratch.file(scene, glb(SCENE_WITH_NOTES));
    }
    scratch.file("scenarios.json", FLOOR_SCENARIOS);
    scratch.file("floor.glb", glb(FLOOR));
    scratch.file("mine.toml", "[splits]\ncount = 2\n");
    let gallery = root().join("docs/gallery");
    for entry in gallery.read_dir().expect("the folder of the gallery").map(|entry| entry.expect("a file")) {
        let bytes = std::fs::read(entry.path()).expect("a file");
        scratch.file(&format!("docs/gallery/{}", entry.file_name().display()), bytes);
    }
    scratch
}

/// The floor of the scenarios: one triangle.
const FLOOR: &str = r#"{
    "asset": { "version": "2.0" }, "nodes": [{ "mesh": 0 }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
    "buffers": [{ "byteLength": 36, "uri": "data:;base64,AABIwgAAAAAAAEjCAABIwgAAAAAAABZDAAAWQwAAAAAAAEjC" }]
}"#;

/// Returns a command with the adapter of the tests, and with options that make it quick.
fn quick(words: &[String]) -> Vec<String> {
    // The pictures in the docs are frames with even numbers.
    let every = if words.iter().any(|word| word == "--picture") { "2" } else { "24" };
    let options: &[[&str; 2]] = match words[0].as_str() {
        "tune" => &[["--size", "64x36"], ["--frames", "1"], ["--resolution", "256"]],
        "culling" => &[["--frames", "2"]],
        "fit" | "peers" => &[],
        _ => &[["--size", "64x36"], ["--every", every], ["--resolution", "256"]],
    };
    let mut quick: Vec<String> = words.iter().filter(|word| *word != "--software").cloned().collect();
    if words[0] != "fit" {
        quick.extend(["--adapter".to_owned(), adapter_name().to_owned()]);
    }
    for [name, value] in options {
        match quick.iter().position(|word| word == name) {
            Some(at) => (*value).clone_into(&mut quick[at + 1]),
            None => quick.extend([(*name).to_owned(), (*value).to_owned()]),
        }
    }
    quick
}

/// Replaces names of files with `*` by the files of the folder.
fn expanded(scratch: &Scratch, word: &str) -> Vec<String> {
    let Some((folder, ending)) = word.split_once('*') else {
        return vec![if word == "DIR" { ".".to_owned() } else { word.to_owned() }];
    };
    let files = scratch.0.join(folder).read_dir().expect("a folder").map(|entry| entry.expect("a file").path());
    let files = files.filter(|path| path.extension() == Some(OsStr::new(ending.trim_start_matches('.'))));
    files.map(|path| path.display().to_string()).collect()
}

#[test]
fn every_command_of_the_docs_runs() {
    let scratch = with_files();
    let mut run: Vec<Vec<String>> = Vec::new();
    for command in doc_commands(&root()) {
        let Some(words) = command.program_arguments("shadowfit-report") else { continue };
        if run.contains(&words) {
            continue;
        }
        let arguments: Vec<String> = quick(&words).iter().flat_map(|word| expanded(&scratch, word)).collect();
        println!("{}: {}", command.page, arguments.join(" "));
        assert_success(&scratch.run(&arguments.iter().map(String::as_str).collect::<Vec<_>>()));
        run.push(words);
    }
    assert!(run.len() >= 10, "{run:?}");
    for file in ["out/report/index.html", "out/tuned/technique.toml", "out/peers/table.md"] {
        assert!(scratch.0.join(file).exists(), "{file}");
    }
}

#[test]
fn the_figures_of_the_docs_are_measured_and_written() {
    let scratch = Scratch::new("figures");
    let quick = ["--every", "20", "--size", "64x36", "--scene", "plain", "--adapter", adapter_name()];
    assert_success(&scratch.run(&[&["figures"][..], &quick].concat()));
    let table = scratch.text("out/figures/overall.md");
    let wrong = |fit: &str| -> f64 {
        let row =
            table.lines().find(|line| line.starts_with(&format!("| {fit} |"))).unwrap_or_else(|| panic!("{table}"));
        row.split('|').nth(2).expect("a column").trim().parse().expect("a number")
    };
    assert!(wrong("xna-1") > wrong("windows-4"), "{table}");
    assert!(scratch.text("out/figures/figures.csv").lines().count() > 10);
    assert!(scratch.text("out/figures/index.html").contains("data:image/png;base64,"));
}
