//! Long runs of the viewer: random actions, a flight with everything on, and scene after scene. An ordinary
//! run takes moments. Environment variables with seconds extend it to hours.

use std::path::PathBuf;
use std::time::Duration;

use super::desktop::{Desktop, Viewer};
use super::{PATIENCE, desktop};

/// Growth of memory that is not a leak, in MB: memory that drivers and allocators keep.
const GROWTH: f64 = 96.0;
/// Growth of memory that is not a leak in a short run, in MB. Its first part ends before pipelines, scene
/// textures and the maps of a second technique have all been created.
const SHORT_GROWTH: f64 = 1000.0;
/// Shortest duration of a long run, in seconds.
const LONG: u32 = 300;
/// Share of a run before the first memory measurement.
const WARM_UP: f64 = 0.25;

/// Returns a number of seconds or scenes from an environment variable, or the default.
fn asked(variable: &str, usual: u32) -> u32 {
    std::env::var(variable).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Plays a script of about this many seconds in the viewer and returns its output. The viewer must succeed.
fn play(desktop: &Desktop, text: &str, seconds: u32) -> String {
    let (script, state) = (desktop.file("script.txt"), desktop.file("state.toml"));
    std::fs::write(&script, text).expect("the script is written");
    let (script, state) = (script.display().to_string(), state.display().to_string());
    let arguments = ["--size", "640x400", "--software", "--script", &script, "--state", &state, "--log-frames"];
    let mut viewer = Viewer::start(desktop, &arguments);
    let limit = PATIENCE * 4 + Duration::from_secs(u64::from(seconds) * 3);
    assert_eq!(viewer.exit_code(limit), Some(0), "the viewer fell over, or never ended\n{}", viewer.log());
    let log = viewer.log();
    println!("{log}");
    for word in ["panicked", "validation", "Validation", "error:", "no memory left"] {
        assert!(!log.contains(word), "{word}\n{log}");
    }
    log
}

/// Asserts that memory does not grow from a quarter of the run to its end.
fn assert_flat(log: &str, seconds: u32) {
    let place = |line: &str| {
        let (frame, rest) = line.strip_prefix("frame ")?.split_once(" at ")?;
        let memory = rest.rsplit(", ").next()?.strip_suffix(" MB")?;
        Some((frame.parse::<f64>().ok()?, memory.parse::<f64>().ok()?))
    };
    let memory: Vec<(f64, f64)> = log.lines().filter_map(place).collect();
    let Some((last, _)) = memory.last() else { panic!("no memory was told\n{log}") };
    let after_warm_up = || memory.iter().filter(|(frame, _)| *frame >= last * WARM_UP).map(|(_, memory)| *memory);
    // While a scene is replaced, both are in memory, so use the least value of each part.
    let half = after_warm_up().count().div_ceil(2);
    let least = |part: Vec<f64>| part.into_iter().fold(f64::INFINITY, f64::min);
    let (before, after) =
        (least(after_warm_up().take(half).collect()), least(after_warm_up().skip(half / 2).collect()));
    let most = if seconds < LONG { SHORT_GROWTH } else { GROWTH };
    println!("memory: {before:.0} MB, later {after:.0} MB");
    assert!(after - before < most, "memory grows from {before:.0} to {after:.0} MB");
}

#[test]
#[ignore = "plays for long: cargo xtask test --all"]
fn random_keys_clicks_drags_resizes_and_files_neither_stop_the_viewer_nor_leak() {
    let Some(desktop) = desktop("monkey") else { return };
    let seconds = asked("SHADOWFIT_MONKEY_SECONDS", 25);
    let files = crate::support::assets().unwrap_or_else(|| few_files(&desktop));
    let files = files.display();
    let text = format!("await loaded\nset map.resolution 512\nset view.judge on\nmonkey {seconds} 1 {files}\nquit\n");
    let log = play(&desktop, &text, seconds);
    let report = log.lines().find(|line| line.starts_with("monkey:")).unwrap_or_else(|| panic!("no report\n{log}"));
    let growth = report.rsplit("growth ").next().and_then(|text| text.trim_end_matches(" MB").parse::<f64>().ok());
    let growth = growth.unwrap_or_else(|| panic!("no growth was measured: {report}"));
    let most = if seconds < LONG { SHORT_GROWTH } else { GROWTH };
    assert!(growth < most, "memory grows: {report}");
}

/// Lines of a flight around a position that takes twenty seconds.
const ROUND: [&str; 8] =
    ["hold w 3", "hold Right 2", "hold d 3", "hold Left 4", "hold a 3", "hold Right 2", "hold s 3", "reset-camera"];
const ROUND_SECONDS: u32 = 20;

#[test]
#[ignore = "plays for long: cargo xtask test --all"]
fn a_flight_with_everything_on_takes_no_more_memory_and_no_more_time_in_the_end() {
    let Some(desktop) = desktop("flight") else { return };
    let seconds = asked("SHADOWFIT_FLIGHT_SECONDS", ROUND_SECONDS);
    let everything =
        "await loaded\nset map.resolution 512\nset view.judge on\nset view.marks outline\nsun\ncompare on\n";
    let round = ROUND.map(|line| format!("{line}\n")).concat();
    let rounds = round.repeat(seconds.div_ceil(ROUND_SECONDS) as usize);
    let log = play(&desktop, &format!("{everything}{rounds}quit\n"), seconds);
    assert_flat(&log, seconds);
    assert!(log.contains("own CPU time of frames without loads"), "{log}");
}

#[test]
#[ignore = "plays for long: cargo xtask test --all"]
fn a_scene_after_the_other_takes_no_more_memory_than_the_first_ones() {
    let Some(desktop) = desktop("scenes") else { return };
    let switches = asked("SHADOWFIT_SCENE_SWITCHES", 8);
    let scenes = ["courtyard", "plain", "xna-shadow-mapping", "arcade", "terrain-vehicles", "forest"];
    let lines = scenes.iter().cycle().take(switches as usize);
    let lines: Vec<String> = lines.map(|scene| format!("open {scene}\nawait loaded\nframes 12\n")).collect();
    let lines = lines.concat();
    let log = play(
        &desktop,
        &format!("await loaded\nset map.resolution 512\n{lines}open plain\nawait loaded\nquit\n"),
        3 * switches,
    );
    assert_flat(&log, 3 * switches);
}

/// Creates files to drop, for machines without the collection: a scene, a technique, and files that are not
/// valid scenes.
fn few_files(desktop: &Desktop) -> PathBuf {
    /// A triangle, ten metres wide.
    const SCENE: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[10,1,10]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAgQQAAAAAAAAAAAAAAAAAAgD8AACBB"}]}"#;
    let folder = desktop.file("files");
    std::fs::create_dir_all(&folder).expect("a folder for the files");
    let files: [(&str, &[u8]); 5] = [
        ("triangle.gltf", SCENE.as_bytes()),
        ("filter.toml", b"[map]\nfilter = \"pcf_3x3\"\n"),
        ("cut.glb", b"glTF\x02\0\0\0\xff\xff\xff\x7f"),
        ("empty.glb", b""),
        ("text.gltf", b"no scene"),
    ];
    for (name, bytes) in files {
        std::fs::write(folder.join(name), bytes).expect("the file is written");
    }
    folder
}
