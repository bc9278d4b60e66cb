//! `report peers` as a program: its output, and its reaction to bad input.

use std::path::Path;
use std::process::Output;

use shadowfit::Preset;
use shadowfit_report::peers::{FitFile, FitFrame, FitMap, Scenarios};
use shadowfit_testing::adapter_name;

use crate::scratch::{REFUSED, Scratch, shared};

/// A camera 4 m over a floor of one triangle, looking down, and a light straight down.
pub(crate) const FLOOR_SCENARIOS: &str = r#"{
    "scenes": [{
        "name": "floor", "file": "floor.glb", "scale": 1, "triangles": 1,
        "objects": [[-50, 0, -50, 150, 0, 150]], "aabb": [-50, 0, -50, 150, 0, 150]
    }],
    "frames": [{
        "id": "floor/90/0", "scene": 0, "elevation_deg": 90, "frame": 0,
        "view": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, -4, 1],
        "fov_y_deg": 60, "aspect": 1.7777777777777777, "near": 0.1, "far": 100, "light_dir": [0, -1, 0]
    }]
}"#;

/// The floor's corners.
const FLOOR: [f32; 9] = [-50.0, 0.0, -50.0, -50.0, 0.0, 150.0, 150.0, 0.0, -50.0];

/// Returns the scenarios without the scene's file.
fn without_file() -> String {
    let scenarios = FLOOR_SCENARIOS.replace("\"file\": \"floor.glb\", ", "");
    assert_ne!(scenarios, FLOOR_SCENARIOS);
    scenarios
}

/// Creates a folder with the floor, its scenarios and a fit.
fn with_floor(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.file("scenarios.json", FLOOR_SCENARIOS);
    scratch.file("floor.f32", FLOOR.map(f32::to_le_bytes).concat());
    scratch.fit("fit.json", &fit("floor/90/0"));
    scratch
}

impl Scratch {
    fn fit(&self, name: &str, fit: &FitFile) {
        self.file(name, fit.to_json(Path::new(name)).expect("a fit file"));
    }

    fn report(&self, arguments: &[&str]) -> Output {
        self.run(&[&["peers"], arguments].concat())
    }

    fn peer_fit(&self, arguments: &[&str]) -> Output {
        self.run(&[&["fit"], arguments].concat())
    }
}

/// Returns a fit with a map of 20 m around the camera.
fn fit(id: &str) -> FitFile {
    let view_proj = [0.1, 0.0, 0.0, 0.0, 0.0, 0.0, -0.05, 0.0, 0.0, -0.1, 0.0, 0.0, 0.0, 0.0, 0.5, 1.0];
    let map = FitMap { view_proj, resolution: 1000, resolution_xy: None, split_near: 0.1, split_far: 100.0 };
    FitFile {
        peer: "plain".to_owned(),
        frames: vec![FitFrame { id: id.to_owned(), maps: vec![map] }],
        ..FitFile::default()
    }
}

#[test]
fn a_report_holds_the_same_row_on_screen_for_people_and_for_programs() {
    let scratch = with_floor("whole");
    let output = scratch.report(&["scenarios.json", "fit.json", "--triangles", ".", "--no-render", "-o", "out/tables"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // A texel of 2 cm, a pixel of 4.2767 mm: 4.677 pixels, 2.225 octaves, in the bin around 2.223; 4677 in 20
    // m.
    let row = "| plain | 1 | 0 | - | - | 2.22 | 2.22 | 2.22 | 100 | 4677 | 4677 |";
    let screen = String::from_utf8_lossy(&output.stdout);
    assert!(screen.contains(row), "{screen}");
    let markdown = scratch.text("out/tables/table.md");
    assert!(markdown.starts_with("## Overall\n") && markdown.contains(row) && markdown.contains("| floor/90 |"));
    let json = scratch.text("out/tables/table.json");
    assert!(
        json.contains("\"peer\": \"plain\"") && json.contains("\"floor/90\": {") && json.contains("\"lost %\": null")
    );
}

#[test]
fn bad_input_is_refused_by_file_element_and_reason() {
    let scratch = with_floor("refused");
    scratch.file("broken.json", b"{\"peer\": 3}");
    scratch.file("short/floor.f32", [0; 35]);
    scratch.file("moved/floor.f32", FLOOR.map(|number| (number + 1.0).to_le_bytes()).concat());
    scratch.fit("other.json", &fit("floor/90/1"));
    let triangles = ["--triangles", "."];
    let cases: [(&str, &str, [&str; 2], &str); 8] = [
        ("nowhere.json", "fit.json", triangles, "nowhere.json: file: cannot be read"),
        ("fit.json", "fit.json", triangles, "fit.json: "),
        ("scenarios.json", "broken.json", triangles, "broken.json: peer: invalid type"),
        (
            "scenarios.json",
            "other.json",
            triangles,
            "other.json: frames[0].id: the scenarios have no frame \"floor/90/1\"",
        ),
        ("scenarios.json", "fit.json", ["--assets", "."], "floor.glb: cannot be read"),
        ("scenarios.json", "fit.json", ["--triangles", "nowhere"], "floor.f32: cannot be read"),
        ("scenarios.json", "fit.json", ["--triangles", "short"], "floor.f32: 35 bytes are not whole triangles"),
        ("scenarios.json", "fit.json", ["--triangles", "moved"], "floor.f32: scene \"floor\": aabb: the box is"),
    ];
    for (scenarios, fit, geometry, words) in cases {
        let output = scratch.report(&[scenarios, fit, geometry[0], geometry[1], "--no-render", "-o", "out"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{scenarios} {fit} {geometry:?}: {message}");
        assert!(message.contains(words), "\"{words}\" is missing in: {message}");
        assert!(!scratch.0.join("out").exists(), "{scenarios} {fit} {geometry:?} leaves files behind");
    }
}

#[test]
fn scenes_without_a_file_are_fitted_and_measured_by_their_triangles() {
    let scratch = with_floor("plain");
    scratch.file("scenarios.json", without_file());
    // Clusters need the triangles, boxes do not.
    for (technique, geometry) in
        [("clusters-4", &["--triangles", "."][..]), ("focused-4", &["--boxes", "objects", "--unseen"])]
    {
        let arguments = [&["scenarios.json", "--fit", technique, "-o", "ours.json"][..], geometry].concat();
        let fitted = scratch.peer_fit(&arguments);
        assert!(fitted.status.success(), "{technique}: {}", String::from_utf8_lossy(&fitted.stderr));
        let measure = ["scenarios.json", "ours.json", "--triangles", ".", "--no-render", "-o", "out"];
        let output = scratch.report(&measure);
        assert!(output.status.success(), "{technique}: {}", String::from_utf8_lossy(&output.stderr));
        let row = format!("| shadowfit {technique} | ");
        assert!(scratch.text("out/table.md").contains(&row), "{technique}");
    }
}

#[test]
fn without_triangles_a_scene_without_a_file_is_named_and_what_to_do() {
    let scratch = with_floor("nameless");
    scratch.file("scenarios.json", without_file());
    let words = ["no \"file\" for scene \"floor\"", "--triangles DIR", "floor.f32"];
    let measured: [&[&str]; 2] = [&["--assets", "."], &[]];
    for geometry in measured {
        let arguments = [&["scenarios.json", "fit.json", "--no-render", "-o", "out"][..], geometry].concat();
        assert_refused(&scratch.report(&arguments), &words);
    }
    let fitted = scratch.peer_fit(&["scenarios.json", "--fit", "clusters-4", "--assets", ".", "-o", "ours.json"]);
    assert_refused(&fitted, &words);
    assert!(!scratch.0.join("out").exists() && !scratch.0.join("ours.json").exists());
}

#[test]
fn whole_numbers_with_a_point_are_measured_alike_and_others_are_refused() {
    let scratch = with_floor("numbers");
    let whole =
        FLOOR_SCENARIOS.replace("\"triangles\": 1,", "\"triangles\": 1.0,").replace("\"scene\": 0,", "\"scene\": 0.0,");
    let whole = whole.replace("\"frame\": 0,", "\"frame\": 0.0,");
    let fit = scratch.text("fit.json");
    let geometry = ["--triangles", ".", "--no-render", "-o", "out"];
    let table = || {
        let output = scratch.report(&[&["scenarios.json", "fit.json"][..], &geometry].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        scratch.text("out/table.json")
    };
    let wanted = table();
    scratch.file("scenarios.json", whole);
    scratch.file("fit.json", fit.replace("\"resolution\":1000", "\"resolution\":1000.0"));
    assert_eq!(table(), wanted);
    for (resolution, reason) in [("2048.5", "2048.5 is not a whole number"), ("-1.0", "-1.0 is negative")] {
        let bad = fit.replace("\"resolution\":1000", &format!("\"resolution\":{resolution}"));
        scratch.file("bad.json", bad);
        let output = scratch.report(&[&["scenarios.json", "bad.json"][..], &geometry].concat());
        assert_refused(&output, &[&format!("bad.json: frames[0].maps[0].resolution: {reason}")]);
    }
    scratch.file("bad.json", FLOOR_SCENARIOS.replace("\"frame\": 0,", "\"frame\": 0.5,"));
    let output = scratch.report(&[&["bad.json", "fit.json"][..], &geometry].concat());
    assert_refused(&output, &["bad.json: frames[0].frame: 0.5 is not a whole number"]);
}

/// Asserts that the program refused its input with a message that contains these words.
fn assert_refused(output: &Output, words: &[&str]) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(REFUSED), "{message}");
    for word in words {
        assert!(message.contains(word), "\"{word}\" is missing in: {message}");
    }
}

#[test]
fn gpu_fits_are_drawn_and_their_pictures_stand_in_the_same_rows() {
    let scratch = with_floor("drawn");
    let small = ["--adapter", adapter_name(), "--size", "160x90"];
    let mut arguments = vec!["scenarios.json", "fit.json", "--triangles", ".", "-o", "out"];
    arguments.extend(small);
    let output = scratch.report(&arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_str(&scratch.text("out/table.json")).expect("JSON");
    let row = &json["fits"][0]["groups"]["floor/90"];
    // A plain floor under a vertical sun has no errors.
    for column in ["wrong %", "false shadow %", "false light %", "hole %", "edge %"] {
        assert_eq!(row[column].as_f64(), Some(0.0), "{column}");
    }
    // 0.5 m on a screen of 90 pixels over 4 m: 51.3 mm per pixel, 20 mm per texel.
    let texels = row["ppt p50"].as_f64().expect("a number");
    assert!((texels / 0.3898 - 1.0).abs() < 0.01, "{texels} pixels per texel");
    assert!(row["crit gm"].as_f64().is_some(), "the figures of the fit are there too");
}

#[test]
fn gpu_a_perspective_map_is_measured_and_its_picture_refused_with_the_reason() {
    let scratch = with_floor("warped");
    let mut warped = fit("floor/90/0");
    warped.frames[0].maps[0].view_proj[3] = 0.001;
    scratch.fit("fit.json", &warped);
    let arguments = ["scenarios.json", "fit.json", "--triangles", ".", "-o", "out"];
    let refused = scratch.report(&[&arguments[..], &["--adapter", adapter_name()]].concat());
    let message = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(REFUSED), "{message}");
    assert!(message.contains("fit.json: cannot be drawn") && message.contains("perspective"), "{message}");
    assert!(scratch.report(&[&arguments[..], &["--no-render"]].concat()).status.success());
}

/// Interval of the selected frames. The frame before each one is also selected, since fits depend on it.
const EVERY: usize = 10;

/// Writes files with some frames of two scenes and Bevy's maps for them.
fn a_part_of_the_peers(scratch: &Scratch, folder: &Path) {
    let mut scenarios = Scenarios::read(&folder.join("scenarios.json")).expect("scenarios");
    let mut bevy = FitFile::read(&folder.join("fits/bevy.json")).expect("Bevy's fit");
    let names: Vec<String> = scenarios.scenes.iter().map(|scene| scene.name.clone()).collect();
    scenarios.frames.retain(|frame| {
        ["zdm2", "graveyard"].contains(&names[frame.scene].as_str()) && frame.frame as usize % EVERY >= EVERY - 2
    });
    let ids: Vec<&str> = scenarios.frames.iter().map(|frame| frame.id.as_str()).collect();
    bevy.frames.retain(|frame| ids.contains(&frame.id.as_str()));
    // Remove scenes without a frame, so that they are not read.
    let used: Vec<usize> =
        (0..names.len()).filter(|scene| scenarios.frames.iter().any(|f| f.scene == *scene)).collect();
    for frame in &mut scenarios.frames {
        frame.scene = used.iter().position(|scene| *scene == frame.scene).expect("a scene that is used");
    }
    let mut number = 0;
    scenarios.scenes.retain(|_| {
        number += 1;
        used.contains(&(number - 1))
    });
    scratch.file("part.json", serde_json::to_string(&scenarios).expect("JSON"));
    scratch.fit("bevy.json", &bevy);
}

#[test]
fn gpu_the_default_technique_has_at_most_half_of_the_wrong_pixels_of_bevys_fit() {
    let (Some(assets), Some(peers)) = (shared("assets"), shared("peers")) else { return };
    let scratch = with_floor("half");
    a_part_of_the_peers(&scratch, &peers);
    let assets = assets.to_str().expect("a plain name");
    let fitted = scratch.peer_fit(&["part.json", "--fit", Preset::RECOMMENDED, "--assets", assets, "-o", "ours.json"]);
    assert!(fitted.status.success(), "{}", String::from_utf8_lossy(&fitted.stderr));
    let small = ["--stride", "32", "--size", "320x180", "--adapter", adapter_name()];
    let whole = [&["part.json", "bevy.json", "ours.json", "--assets", assets, "-o", "out"][..], &small].concat();
    let output = scratch.report(&whole);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_str(&scratch.text("out/table.json")).expect("JSON");
    let column = |fit: usize, name: &str| json["fits"][fit]["overall"][name].as_f64().expect("a number");
    let [bevy, ours] = [0, 1].map(|fit| column(fit, "wrong %"));
    println!("wrong: {bevy}% with Bevy's fit, {ours}% with {}", Preset::RECOMMENDED);
    assert!(ours <= 0.5 && ours * 2.0 <= bevy, "{ours}% of {bevy}%");
    assert!(column(1, "false shadow %") <= 0.01 && column(1, "false light %") <= 0.2, "off edges");
    assert_eq!((column(1, "hole %"), column(1, "uncov %"), column(1, "lost %")), (0.0, 0.0, 0.0));
}
