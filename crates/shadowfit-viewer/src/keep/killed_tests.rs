//! A process that is killed while writing files leaves the old or the new content of each.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime};

use shadowfit::Technique;
use shadowfit_study::NamedTechnique;

use super::picture_file::{settings_of_png, write_png};
use super::saved::Saved;
use super::store::Store;
use crate::platform::{StateFile, save_file};

/// Number of times that the writer is killed.
const KILLS: u64 = 200;
/// Longest life of the writer after its first files, in microseconds.
const LONGEST_LIFE: u64 = 25_000;
/// Number of contents that it writes in turn, each of a different length.
const VERSIONS: usize = 3;
/// Environment variable with the writer's folder.
const FOLDER: &str = "SHADOWFIT_TEST_WRITES_INTO";
/// Line that it prints once it has written everything for the first time.
const READY: &str = "the writer has begun";

fn saved(version: usize) -> Saved {
    let technique = Technique::preset("calm-4").expect("a preset");
    let named = |index| NamedTechnique { name: format!("preset {index:02}"), ..technique.into() };
    Saved { presets: (0..10 * version).map(named).collect(), ..Saved::default() }
}

fn report(version: usize) -> String {
    format!("line of version {version}\n").repeat(1 + 20_000 * version)
}

fn picture(version: usize) -> ([u32; 2], String) {
    ([64 + 32 * version as u32, 48], format!("version {version}"))
}

fn write_all(folder: &Path, store: &mut Store, version: usize) {
    store.save(&saved(version)).expect("settings");
    let ([width, height], settings) = picture(version);
    // Noise, so that the picture cannot be compressed to a few bytes.
    let pixels: Vec<u8> =
        (0..width * height * 4).map(|index| (index.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    write_png(&folder.join("picture.png"), [width, height], &pixels, Some(&settings)).expect("a picture");
    save_file(&folder.join("report.md"), report(version).as_bytes()).expect("a report");
}

#[test]
#[ignore = "writes until it is killed: the test below starts it"]
fn writer() {
    let Ok(folder) = std::env::var(FOLDER) else { return };
    let folder = Path::new(&folder);
    let mut store = Store::new(StateFile::at(folder.join("viewer.toml")));
    store.load();
    for version in (0..VERSIONS).cycle() {
        write_all(folder, &mut store, version);
        if version == 0 {
            println!("{READY}");
        }
    }
}

/// Returns the versions of the files, after checking that each file is complete.
fn versions(folder: &Path) -> [usize; 3] {
    let which = |is_of: &dyn Fn(usize) -> bool| (0..VERSIONS).find(|version| is_of(*version)).expect("a whole version");
    let (kept, message) = Store::new(StateFile::at(folder.join("viewer.toml"))).load();
    assert_eq!(message, None);
    let kept = kept.expect("settings");
    let text = fs::read_to_string(folder.join("report.md")).expect("a report");
    let path = folder.join("picture.png");
    let settings = settings_of_png(&path).expect("a picture");
    let mut reader =
        png::Decoder::new(BufReader::new(File::open(path).expect("a picture"))).read_info().expect("a head");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let frame = reader.next_frame(&mut pixels).expect("every pixel");
    [
        which(&|version| saved(version) == kept),
        which(&|version| report(version) == text),
        which(&|version| picture(version) == ([frame.width, frame.height], settings.clone().unwrap_or_default())),
    ]
}

#[test]
fn a_writer_that_is_killed_200_times_leaves_the_old_files_or_the_new_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = std::env::current_exe().expect("this test");
    let mut seen = [const { BTreeSet::new() }; 3];
    for round in 0..KILLS {
        let mut writer = Command::new(&program);
        writer.args(["--exact", "keep::killed_tests::writer", "--ignored", "--nocapture"]).env(FOLDER, folder.path());
        let mut writer = writer.stdout(Stdio::piped()).spawn().expect("the writer starts");
        let mut said = BufReader::new(writer.stdout.take().expect("its output")).lines().map_while(Result::ok);
        let begun = said.any(|line| line.contains(READY));
        std::thread::sleep(Duration::from_micros(round * 7_919 % LONGEST_LIFE));
        writer.kill().expect("killed");
        let ended = writer.wait().expect("it ends");
        assert!(begun && !ended.success(), "it writes until it is killed: {ended}");
        for (seen, version) in seen.iter_mut().zip(versions(folder.path())) {
            seen.insert(version);
        }
    }
    assert!(seen.iter().all(|seen| seen.len() == VERSIONS), "it is killed at different moments: {seen:?}");
    leaves_nothing_but_its_files(folder.path());
}

/// Asserts that old unfinished files are removed by the next writing.
fn leaves_nothing_but_its_files(folder: &Path) {
    let files = || fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let an_hour_ago = SystemTime::now() - Duration::from_hours(1);
    for unfinished in files().filter(|path| path.extension().is_some_and(|extension| extension == "part")) {
        File::options()
            .write(true)
            .open(&unfinished)
            .and_then(|file| file.set_modified(an_hour_ago))
            .expect("made old");
    }
    let mut store = Store::new(StateFile::at(folder.join("viewer.toml")));
    write_all(folder, &mut store, 1);
    let mut names: Vec<_> = files().filter_map(|path| path.file_name().map(std::ffi::OsStr::to_owned)).collect();
    names.sort();
    assert_eq!(names, [".viewer.toml.lock", "picture.png", "report.md", "viewer.toml"]);
}
