//! The program: reports of scenes, tuning, and its reaction to bad input.

use std::process::{Command, Output, Stdio};

use shadowfit_testing::scene_notes::{NOTES, SCENE_WITH_NOTES};
use shadowfit_testing::{adapter_name, refuses_missing_adapter};

use crate::scratch::{REFUSED, Scratch, assert_success};

/// Exit code after Ctrl-C.
const INTERRUPTED: i32 = 130;
/// A path that looks at the courtyard's middle from two positions.
const PATH: &str = "near = 0.1\nfar = 60.0\nlight = { azimuth_deg = 40.0, elevation_deg = 45.0 }\n\
    [[keys]]\neye = [5.0, 3.0, 6.0]\ntarget = [0.0, 1.0, 0.0]\n\
    [[keys]]\neye = [4.0, 3.0, 6.5]\ntarget = [0.0, 1.0, 0.0]\n";
/// Arguments for small pictures on the tests' adapter.
fn small() -> [&'static str; 4] {
    ["--adapter", adapter_name(), "--size", "96x54"]
}

/// Creates a folder with a path.
fn with_path(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.file("path.toml", PATH);
    scratch
}

impl Scratch {
    fn small_report(&self, arguments: &[&str]) -> Output {
        self.run(&[arguments, &small()].concat())
    }
}

#[test]
fn a_report_has_tables_plots_pictures_and_a_page_that_needs_nothing_else() {
    let scratch = with_path("whole");
    assert_success(&scratch.small_report(&[
        "courtyard",
        "--path",
        "path.toml",
        "--technique",
        "xna-1",
        "--technique",
        "clusters-4",
        "--resolution",
        "512",
        "-o",
        "out",
    ]));
    let report = scratch.json("out/report.json");
    let techniques = report["techniques"].as_array().expect("a list");
    let wrong: Vec<f64> = techniques.iter().map(|t| t["overall"]["wrong %"].as_f64().expect("a number")).collect();
    assert!(wrong.len() == 2 && wrong[0] > 2.0 * wrong[1] && wrong[1] > 0.0, "{wrong:?}");
    assert_eq!((report["finished"].as_bool(), report["frames"].as_array().map(Vec::len)), (Some(true), Some(2)));
    let page = scratch.text("out/index.html");
    assert!(page.contains("data:image/png;base64,") && page.contains("<svg"), "the page holds pictures and plots");
    for outside in ["src=\"http", "href=\"http", "url(http", "@import"] {
        assert!(!page.contains(outside), "the page asks for {outside}");
    }
    assert!(scratch.text("out/report.md").contains("| clusters-4 |"));
    for kind in ["overlay", "heat", "picture"] {
        let pictures = std::fs::read_dir(scratch.0.join("out/pictures")).expect("pictures");
        let found = pictures.filter(|entry| {
            entry.as_ref().is_ok_and(|entry| entry.file_name().to_string_lossy().ends_with(&format!("{kind}.png")))
        });
        assert_eq!(found.count(), 4, "{kind}s: two frames by two techniques");
    }
    assert!(scratch.text("out/plots/wrong.svg").contains("<svg"));
    // The written path can be read for another report.
    assert_success(&scratch.small_report(&[
        "courtyard",
        "--path",
        "out/path.toml",
        "--technique",
        "xna-1",
        "-o",
        "again",
    ]));
}

#[test]
fn a_moving_scene_and_a_sun_with_a_radius_are_judged_too() {
    let scratch = with_path("moving");
    let arguments = ["courtyard", "--path", "path.toml", "--technique", "focused-4", "--resolution", "512"];
    let judged = |more: &[&str], out: &str| {
        assert_success(&scratch.small_report(&[&arguments, more, &["-o", out]].concat()));
        scratch.json(&format!("{out}/report.json"))["techniques"][0]["overall"].clone()
    };
    let still = judged(&[], "still");
    let moving = judged(&["--play", "2"], "moving");
    assert_ne!(still, moving, "the figure walks");
    let soft = judged(&["--sun-radius", "3", "--sun-rays", "16"], "soft");
    assert_ne!(soft["mean error %"], still["mean error %"], "penumbrae are neither lit nor dark");
}

#[test]
fn filters_are_compared_side_by_side_on_every_nth_frame() {
    let scratch = with_path("filters");
    let arguments = ["courtyard", "--path", "path.toml", "--technique", "focused-1", "--resolution", "512"];
    let filters = ["--filters", "point,pcss", "--every", "2", "-o", "out"];
    assert_success(&scratch.small_report(&[&arguments[..], &filters].concat()));
    let report = scratch.json("out/report.json");
    let techniques = report["techniques"].as_array().expect("a list");
    let names: Vec<&str> = techniques.iter().filter_map(|technique| technique["name"].as_str()).collect();
    assert_eq!(names, ["focused-1 point", "focused-1 pcss"]);
    assert_eq!(report["frames"].as_array().map(Vec::len), Some(1), "of two");
    assert_ne!(techniques[0]["overall"]["mean error %"], techniques[1]["overall"]["mean error %"]);
}

#[test]
fn what_import_notes_of_a_scene_is_said_and_stands_in_the_report() {
    let scratch = with_path("notes");
    scratch.file("notes.gltf", SCENE_WITH_NOTES);
    let arguments = ["notes.gltf", "--path", "path.toml", "--technique", "xna-1", "--resolution", "256", "-o", "out"];
    let output = scratch.small_report(&arguments);
    assert_success(&output);
    let message = String::from_utf8_lossy(&output.stderr);
    let report = scratch.json("out/report.json");
    let noted: Vec<&str> =
        report["scene_notes"].as_array().expect("a list").iter().filter_map(|n| n.as_str()).collect();
    for note in NOTES {
        assert!(message.contains(&format!("warning: notes.gltf: {note}")), "\"{note}\" is missing in: {message}");
        assert!(noted.iter().any(|noted| noted.starts_with(note)), "{noted:?}");
    }
    for file in ["out/report.md", "out/index.html"] {
        let text = scratch.text(file);
        assert!(text.contains("Notes on the scene") && text.contains("lines skipped"), "{file}");
    }
}

#[test]
fn a_camera_that_sees_nothing_is_refused_by_reports_and_by_the_search() {
    let scratch = with_path("sky");
    scratch.file("sky.toml", "near = 0.1\nfar = 9.0\n[[keys]]\neye = [0.0, 50.0, 0.0]\nforward = [0.0, 0.9, 1.0]\n");
    for (kind, file) in [(&[][..], "report.json"), (&["tune"][..], "technique.toml")] {
        let output = scratch.small_report(&[kind, &["courtyard", "--path", "sky.toml", "-o", "out"]].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{kind:?}: {message}");
        assert!(message.contains("nothing was judged"), "{kind:?}: {message}");
        assert!(!scratch.0.join("out").join(file).exists(), "{kind:?} writes figures of nothing");
    }
}

#[test]
fn bad_input_is_refused_by_file_and_reason_and_nothing_is_written() {
    let scratch = with_path("refused");
    scratch.file("broken.toml", "near = 0.1\nfar = ");
    scratch.file("backwards.toml", PATH.replace("far = 60.0", "far = 0.01"));
    scratch.file("empty.gltf", r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0}"#);
    scratch.file("technique.toml", "[splits]\ncount = 9\n");
    let cases: [(&[&str], &str); 12] = [
        (&["courtyard", "--path", "broken.toml"], "broken.toml"),
        (&["courtyard", "--path", "backwards.toml"], "backwards.toml"),
        (&["courtyard", "--path", "nowhere.toml"], "nowhere.toml"),
        (&["empty.gltf"], "empty"),
        (&["nowhere.glb"], "nowhere.glb"),
        (&["courtyard", "--technique", "technique.toml"], "technique.toml: splits.count is 9"),
        (&["courtyard", "--technique", "best"], "there is no technique \"best\""),
        (&["courtyard", "--max-memory", "0.001"], "GiB of memory, more than --max-memory 0.001"),
        (&["courtyard", "--light", "30"], "AZIMUTH,ELEVATION"),
        (&["courtyard", "--units-per-metre", "0"], "0 is not a number above 0"),
        (&["courtyard", "--sun-radius", "NaN"], "NaN degrees; give 0 to 45"),
        (&["courtyard", "--bias", "normal_offset"], "\"normal_offset\" is not NAME=TEXELS"),
    ];
    for (arguments, words) in cases {
        let output = scratch.small_report(&[arguments, &["-o", "out"]].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{arguments:?}: {message}");
        assert!(message.contains(words), "{arguments:?}: \"{words}\" is missing in: {message}");
        assert!(!scratch.0.join("out").exists(), "{arguments:?} leaves files behind");
    }
}

#[test]
fn tuning_finds_the_same_technique_twice_and_says_what_each_change_bought() {
    let scratch = with_path("tuned");
    let tuned = |out: &str| {
        let budget = ["--maps", "2", "--resolution", "256", "--frames", "2"];
        let whole = [&["tune", "courtyard", "--path", "path.toml"][..], &budget, &["-o", out]].concat();
        assert_success(&scratch.small_report(&whole));
        ["technique.toml", "technique.rs", "steps.md"].map(|file| scratch.text(&format!("{out}/{file}")))
    };
    let [technique, code, steps] = tuned("a");
    assert_eq!(tuned("b"), [technique.clone(), code.clone(), steps.clone()]);
    assert!(technique.contains("name = \"tuned\"") && code.starts_with("let mut technique = Technique"));
    let bought = steps.lines().filter(|line| line.ends_with("% |")).count();
    assert!(bought >= 2, "changes that helped:\n{steps}");
    // Reports accept the file as a technique.
    let arguments = ["courtyard", "--path", "path.toml", "--technique", "a/technique.toml", "--technique", "xna-1"];
    assert_success(&scratch.small_report(&[&arguments[..], &["--resolution", "256", "-o", "out"]].concat()));
    let report = scratch.json("out/report.json");
    let wrong = |index: usize| report["techniques"][index]["overall"]["wrong %"].as_f64().expect("a number");
    assert!(wrong(0) < wrong(1), "{} and {}", wrong(0), wrong(1));
}

#[test]
fn the_gpus_classes_are_compared_and_timed() {
    let scratch = with_path("live");
    let output = scratch.small_report(&["live", "courtyard", "--path", "path.toml", "--technique", "focused-4"]);
    assert_success(&output);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("judging takes") && text.contains("the CPU agrees on"), "{text}");
}

#[cfg(unix)]
#[test]
fn what_is_finished_at_ctrl_c_is_written_and_said_to_be_a_part() {
    let scratch = with_path("stopped");
    scratch.file("long.toml", format!("frames_per_key = 3000\n{PATH}"));
    let arguments = ["courtyard", "--path", "long.toml", "--technique", "xna-1", "--resolution", "256", "-o", "out"];
    let mut command = scratch.command(&[&arguments[..], &small()].concat());
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the report starts");
    // The folder is created just before the first frame is measured.
    while !scratch.0.join("out/pictures").is_dir() {
        assert_eq!(child.try_wait().expect("a child"), None, "it ended before it began");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    std::thread::sleep(std::time::Duration::from_millis(500));
    let stopped = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill starts");
    assert!(stopped.success());
    assert_eq!(child.wait().expect("a child").code(), Some(INTERRUPTED));
    let report = scratch.json("out/report.json");
    let frames = report["frames"].as_array().map_or(0, Vec::len);
    assert!((1..3000).contains(&frames), "{frames} frames");
    assert_eq!(report["finished"].as_bool(), Some(false));
    assert!(scratch.text("out/report.md").contains("Stopped early"));
}

#[test]
fn an_adapter_that_the_machine_lacks_is_refused_with_a_list_of_adapters() {
    let scratch = Scratch::new("adapter");
    refuses_missing_adapter(|| scratch.command(&["courtyard", "-o", "out"]));
    assert!(!scratch.0.join("out").exists());
}

#[test]
fn files_in_the_way_of_the_folder_are_named_before_anything_is_measured() {
    let scratch = Scratch::new("in-the-way");
    scratch.file("occupied", "a file");
    for folder in ["occupied", "occupied/below"] {
        for kind in [&[][..], &["tune"]] {
            let output = scratch.small_report(&[kind, &["courtyard", "-o", folder]].concat());
            let message = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(REFUSED), "{kind:?}: {message}");
            assert!(message.contains(folder) && message.contains("part of the path is a file"), "{kind:?}: {message}");
            assert!(output.stdout.is_empty(), "{kind:?} begins");
        }
    }
}
