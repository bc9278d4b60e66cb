//! The benchmarks as a program.

use std::process::Command;

use shadowfit_testing::commands::doc_commands;
use shadowfit_testing::scene_notes::SCENE_WITH_NOTES;
use shadowfit_testing::{adapter_name, package_folder, package_program, refuses_missing_adapter};

/// Returns the program with the arguments of a quick run.
fn quick() -> Command {
    let mut growth = Command::new(package_program(env!("CARGO_BIN_EXE_shadowfit-bench")));
    growth.args(["growth", "--quick"]);
    growth
}

#[test]
fn a_quick_run_of_growth_has_every_row_and_draws_every_curve() {
    let folder = std::env::temp_dir().join(format!("shadowfit-growth-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let tables = folder.join("growth.md");
    let mut growth = quick();
    growth.args(["--adapter", adapter_name()]).arg("--out").arg(&tables).arg("--pictures").arg(&folder);
    let output = growth.output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(&tables).expect("the tables");

    let rows = text.lines().filter(|line| line.starts_with("| ") && line.contains(" ms |")).count();
    assert_eq!(rows, ROWS, "{text}");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    let pictures: Vec<&str> =
        text.split("(../images/benchmarks/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert_eq!(pictures, ["fits.svg", "culling.svg", "frames.svg", "maps.svg"]);
    for picture in pictures {
        let svg = std::fs::read_to_string(folder.join(picture)).unwrap_or_else(|error| panic!("{picture}: {error}"));
        assert!(svg.matches("<circle").count() > 2 && !svg.contains("NaN"), "{picture}: {svg}");
    }
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn an_adapter_that_the_machine_lacks_is_refused_with_a_list_of_adapters() {
    refuses_missing_adapter(quick);
}

#[test]
fn the_commands_of_the_docs_run() {
    let folder = std::env::temp_dir().join(format!("shadowfit-bench-docs-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("scene.gltf"), SCENE_WITH_NOTES).expect("a scene");
    let mut count = 0;
    for command in doc_commands(&package_folder(env!("CARGO_MANIFEST_DIR")).join("../..")) {
        let Some(words) = command.program_arguments("shadowfit-bench") else { continue };
        let quick: &[&str] = match words[0].as_str() {
            "gpu" => &["--frames", "2", "--height", "36", "--map", "512"],
            "scenes" => &[],
            // Another test measures growth, and `core` runs the benches of another crate for minutes.
            _ => continue,
        };
        // The words of the docs, with a scene that exists.
        let is_scene = |word: &str| std::path::Path::new(word).extension().is_some_and(|ending| ending == "glb");
        let words = words.iter().map(|word| if is_scene(word) { "scene.gltf" } else { word });
        let mut bench = Command::new(package_program(env!("CARGO_BIN_EXE_shadowfit-bench")));
        bench.current_dir(&folder).args(words).args(["--adapter", adapter_name()]).args(quick);
        let output = bench.output().expect("the program starts");
        assert!(output.status.success(), "{bench:?}: {}", String::from_utf8_lossy(&output.stderr));
        let table = String::from_utf8_lossy(&output.stdout);
        assert!(table.lines().any(|line| line.starts_with("| ")), "{bench:?}: {table}");
        count += 1;
    }
    assert!(count >= 2, "{count}");
    let _ = std::fs::remove_dir_all(&folder);
}

/// Towns of 100 and 1,000 boxes: four fits, culling, five kinds of frames. Then eight numbers of maps and six
/// sides.
const ROWS: usize = 2 * (4 + 1 + 5) + 8 + 6;
