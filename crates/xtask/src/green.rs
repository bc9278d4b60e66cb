//! Skipping of suites that passed before on the same files. The tests of the page and of the package for Bevy
//! build hundreds of crates, and most changes affect neither. `.ci/run` skips such a suite if its files have
//! not changed since it last passed on this machine.

use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::bevy;
use crate::machine::{BROWSERS, Machine};
use crate::process;

/// The environment variable that enables the skipping. Without it every suite runs.
const SKIP_GREEN: &str = "SHADOWFIT_SKIP_GREEN";

/// Files and folders that every suite depends on, in addition to the packages that it builds.
const OF_ALL: [&str; 6] = [".cargo", ".clippy.toml", "Cargo.toml", "crates/xtask", "rustfmt.toml", "tests/fuzz/src"];
/// Further files of the page suite. The viewer's program belongs to its package, but is in another folder.
const OF_PAGE: [&str; 4] = ["Cargo.lock", "docs/images/scene-courtyard.png", "examples/viewer", "tests/web"];
/// Folders of a package that only its own tests read.
const OWN_TESTS: [&str; 2] = ["benches", "tests"];
/// Folder of files that tests read if it exists, relative to the workspace.
const ASSETS: &str = "../shared/assets";

/// A suite that may be skipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Suite {
    /// Tests of the page in a browser.
    Page,
    /// Lints, docs and tests of the package for Bevy.
    Bevy,
    /// Tests of the npm package for three.js in a browser.
    Npm,
}

impl Suite {
    fn name(self) -> &'static str {
        match self {
            Self::Page => "tests of the page",
            Self::Bevy => "lints and tests of bevy-shadowfit",
            Self::Npm => "tests of the npm package",
        }
    }

    /// Returns the folder in `crates` of the package under test.
    fn package(self) -> &'static str {
        match self {
            Self::Page => "shadowfit-viewer",
            Self::Bevy => "bevy-shadowfit",
            Self::Npm => "shadowfit-wasm",
        }
    }
}

/// Runs a suite and records that it passed. Skips it if [`SKIP_GREEN`] is set and its inputs have not changed
/// since it last passed.
///
/// # Errors
/// If the suite fails.
pub(crate) fn unless_unchanged(suite: Suite, run: impl FnOnce() -> Result<()>) -> Result<()> {
    let may_skip = std::env::var(SKIP_GREEN).is_ok_and(|value| !value.is_empty() && value != "0");
    let record = process::target_folder().join("green").join(suite.package());
    run_unless_green(suite, &record, may_skip, || Key::of(suite), run)
}

/// Implements [`unless_unchanged`] for a given record file. `key` computes the key of the suite.
fn run_unless_green(
    suite: Suite,
    record: &Path,
    may_skip: bool,
    key: impl Fn() -> Result<Key>,
    run: impl FnOnce() -> Result<()>,
) -> Result<()> {
    let name = suite.name();
    let before = key();
    if let Err(error) = &before {
        eprintln!("{name}: cannot tell whether they are unchanged: {error:#}");
    }
    if may_skip && before.as_ref().is_ok_and(|key| key.is_recorded(record)) {
        println!("{name}: unchanged since their last green run on this machine, skipped");
        return Ok(());
    }
    println!("{name}: run");
    // A run that fails or is interrupted leaves no record.
    let _ = fs::remove_file(record);
    run()?;
    match (before, key()) {
        // The run may have installed tools, so record the machine after it. Record nothing if files changed
        // meanwhile.
        (Ok(before), Ok(after)) if before.files == after.files => after.write(record),
        _ => Ok(()),
    }
}

/// Hashes over all inputs of a suite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    /// Hash of the names and contents of its files.
    files: u64,
    /// Hash of the machine's state: tools, their versions, assets.
    machine: u64,
}

impl Key {
    fn of(suite: Suite) -> Result<Self> {
        let root = process::root();
        let watched = watched(&root, suite)?;
        let listed = Command::new("git")
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .current_dir(&root)
            .output()
            .context("git does not start")?;
        ensure!(listed.status.success(), "git lists no files: {}", String::from_utf8_lossy(&listed.stderr).trim());
        let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
        let files = listed.split('\0').filter(|file| is_watched(&watched, Path::new(file))).map(PathBuf::from);
        // A suite leaves out tests whose tools are missing.
        let parts = format!("{:?}", Machine::probe().parts);
        let mut hasher = DefaultHasher::new();
        (tools(suite)?, parts, sizes(&root.join(ASSETS))).hash(&mut hasher);
        Ok(Self { files: hash(&root, files.collect())?, machine: hasher.finish() })
    }

    fn is_recorded(self, record: &Path) -> bool {
        fs::read_to_string(record).is_ok_and(|text| text == self.to_string())
    }

    fn write(self, record: &Path) -> Result<()> {
        if let Some(folder) = record.parent() {
            fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
        }
        fs::write(record, self.to_string()).with_context(|| format!("cannot write {}", record.display()))
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x} {:016x}", self.files, self.machine)
    }
}

/// Returns the versions of the programs that build and run a suite.
fn tools(suite: Suite) -> Result<Vec<String>> {
    let version = |program: &str| process::output_of(Command::new(program).arg("--version"));
    let compiler = version("rustc").context("rustc does not start")?;
    Ok(match suite {
        Suite::Page | Suite::Npm => {
            let browsers = BROWSERS.iter().filter_map(|name| version(name));
            std::iter::once(compiler).chain(version("node")).chain(browsers).collect()
        }
        Suite::Bevy => vec![bevy::Rust::find().map_or(compiler, |rust| rust.version)],
    })
}

/// Returns names and sizes of all files below a folder.
fn sizes(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
            match entry.metadata() {
                Ok(data) if data.is_dir() => folders.push(entry.path()),
                Ok(data) => found.push(format!("{} {}", entry.path().display(), data.len())),
                Err(_) => {}
            }
        }
    }
    found.sort_unstable();
    found
}

/// A file or folder that a suite depends on.
#[derive(Debug, PartialEq, Eq)]
struct Watched {
    path: PathBuf,
    /// Whether its tests and benches are included.
    with_tests: bool,
}

/// Returns all files and folders that a suite depends on, relative to `root`.
fn watched(root: &Path, suite: Suite) -> Result<Vec<Watched>> {
    let more: &[&str] = if suite == Suite::Page { &OF_PAGE } else { &[] };
    let plain = OF_ALL.iter().chain(more).map(|path| Watched { path: path.into(), with_tests: true });
    let packages = packages(&root.join("crates"), suite.package())?;
    let folders = packages
        .into_iter()
        .map(|name| Watched { path: Path::new("crates").join(&name), with_tests: name == suite.package() });
    Ok(plain.chain(folders).collect())
}

fn is_watched(watched: &[Watched], file: &Path) -> bool {
    watched.iter().any(|Watched { path, with_tests }| {
        file.strip_prefix(path)
            .is_ok_and(|within| *with_tests || !OWN_TESTS.iter().any(|folder| within.starts_with(folder)))
    })
}

/// Returns a package and all packages of the folder that it depends on. A package counts as a dependency if
/// the manifest mentions its name anywhere: this may return too many packages, but never too few.
fn packages(folder: &Path, package: &str) -> Result<BTreeSet<String>> {
    let mut found = BTreeSet::new();
    let mut waiting = vec![package.to_owned()];
    while let Some(package) = waiting.pop() {
        let manifest = folder.join(&package).join("Cargo.toml");
        let text = fs::read_to_string(&manifest).with_context(|| format!("cannot read {}", manifest.display()))?;
        if found.insert(package) {
            let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && !"-_".contains(letter));
            let named = words.filter(|word| !word.is_empty() && folder.join(word).join("Cargo.toml").is_file());
            waiting.extend(named.map(str::to_owned));
        }
    }
    Ok(found)
}

/// Returns a hash over the names and contents of files. Ignores files that git lists but that do not exist.
fn hash(root: &Path, mut files: Vec<PathBuf>) -> Result<u64> {
    files.sort_unstable();
    files.dedup();
    let mut hasher = DefaultHasher::new();
    for file in files {
        let path = root.join(&file);
        if path.is_file() {
            let content = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            (file, content).hash(&mut hasher);
        }
    }
    Ok(hasher.finish())
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// A temporary folder that is removed when dropped.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("shadowfit-green-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn with(name: &str, files: &[(&str, &str)]) -> Self {
            let folder = Self::new(name);
            for (file, text) in files {
                let file = folder.0.join(file);
                fs::create_dir_all(file.parent().unwrap()).unwrap();
                fs::write(file, text).unwrap();
            }
            folder
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn the_hash_tells_contents_names_and_numbers_of_files_apart_and_not_their_order() {
        let folder = Folder::with("hash", &[("a", "1"), ("b", "2"), ("c", "1")]);
        let hash = |files: &[&str]| hash(&folder.0, files.iter().map(PathBuf::from).collect()).unwrap();
        let usual = hash(&["a", "b"]);
        assert_eq!(hash(&["b", "a"]), usual, "order");
        assert_eq!(hash(&["a", "b", "gone"]), usual, "a file that is listed and gone");
        assert_ne!(hash(&["b", "c"]), usual, "a name");
        assert_ne!(hash(&["a", "b", "c"]), usual, "a file more");
        assert_ne!(hash(&["a"]), usual, "a file less");
        fs::write(folder.0.join("a"), "3").unwrap();
        assert_ne!(hash(&["a", "b"]), usual, "a content");
    }

    /// Returns whether a suite ran, or `None` if it failed.
    fn ran(record: &Path, key: Key, may_skip: bool, passes: bool) -> Option<bool> {
        let ran = Cell::new(false);
        let run = || {
            ran.set(true);
            ensure!(passes, "a test failed");
            Ok(())
        };
        run_unless_green(Suite::Page, record, may_skip, || Ok(key), run).ok().map(|()| ran.get())
    }

    #[test]
    fn a_suite_runs_unless_it_passed_with_the_same_key_and_may_be_skipped() {
        let folder = Folder::new("record");
        let record = folder.0.join("green/page");
        let usual = Key { files: 1, machine: 1 };
        assert_eq!(ran(&record, usual, true, true), Some(true), "no record is not green");
        assert_eq!(ran(&record, usual, true, true), Some(false));
        assert_eq!(ran(&record, usual, false, true), Some(true), "nobody asked to skip");
        assert_eq!(ran(&record, Key { machine: 2, ..usual }, true, true), Some(true), "another toolchain");
        assert_eq!(ran(&record, usual, true, true), Some(true), "the first toolchain again");
        assert_eq!(ran(&record, Key { files: 2, ..usual }, true, false), None, "other files");
        assert!(!record.exists(), "a run that failed leaves no record");
    }

    #[test]
    fn files_that_change_while_a_suite_runs_leave_no_record_and_tools_do() {
        let folder = Folder::new("meanwhile");
        let record = folder.0.join("page");
        let usual = Key { files: 1, machine: 1 };
        for (later, is_green) in [(Key { files: 2, ..usual }, false), (Key { machine: 2, ..usual }, true)] {
            let key = Cell::new(usual);
            let change = || {
                key.set(later);
                Ok(())
            };
            run_unless_green(Suite::Page, &record, true, || Ok(key.get()), change).unwrap();
            assert_eq!(later.is_recorded(&record), is_green, "{later:?}");
        }
    }

    #[test]
    fn packages_bring_those_that_they_depend_on() {
        let crates = Folder::with(
            "packages",
            &[
                ("top/Cargo.toml", "[dependencies]\nmiddle.workspace = true\nserde = \"1\"\n"),
                ("middle/Cargo.toml", "[dependencies]\nlow-er = { path = \"../low-er\" }\n"),
                ("low-er/Cargo.toml", "[package]\nname = \"low-er\"\n"),
                ("other/Cargo.toml", "[dependencies]\ntop.workspace = true\n"),
            ],
        );
        let found: Vec<String> = packages(&crates.0, "top").unwrap().into_iter().collect();
        assert_eq!(found, ["low-er", "middle", "top"]);
    }

    #[test]
    fn each_suite_watches_what_it_builds_from() {
        let root = process::root();
        let cases = [
            (Suite::Page, "crates/shadowfit/src/lib.rs", true),
            (Suite::Page, "crates/shadowfit/tests/any.rs", false),
            (Suite::Page, "crates/shadowfit-viewer/web/page.js", true),
            (Suite::Page, "crates/bevy-shadowfit/src/lib.rs", false),
            (Suite::Page, "examples/viewer/main.rs", true),
            (Suite::Page, "tests/web/tour.txt", true),
            (Suite::Page, "Cargo.lock", true),
            (Suite::Page, "README.md", false),
            (Suite::Bevy, "crates/shadowfit/src/lib.rs", true),
            (Suite::Bevy, "crates/bevy-shadowfit/Cargo.lock", true),
            (Suite::Bevy, "crates/bevy-shadowfit/tests/suite/window.rs", true),
            (Suite::Bevy, "crates/shadowfit-viewer/src/lib.rs", false),
            (Suite::Bevy, "crates/xtask/src/bevy.rs", true),
        ];
        for (suite, file, expected) in cases {
            let watched = watched(&root, suite).unwrap();
            assert_eq!(is_watched(&watched, Path::new(file)), expected, "{suite:?} {file}");
        }
    }

    #[test]
    fn files_that_packages_take_in_from_elsewhere_are_watched() {
        let root = process::root();
        for suite in [Suite::Page, Suite::Bevy] {
            let watched = watched(&root, suite).unwrap();
            for package in packages(&root.join("crates"), suite.package()).unwrap() {
                for file in sources(&root.join("crates").join(package).join("src")) {
                    for path in taken_in(&file) {
                        let path = normal(&file.parent().unwrap().join(path));
                        let within = path.strip_prefix(&root).unwrap();
                        assert!(is_watched(&watched, within), "{}: {}", file.display(), within.display());
                    }
                }
            }
        }
    }

    /// Returns all Rust files of a folder.
    fn sources(folder: &Path) -> Vec<PathBuf> {
        let files = sizes(folder).into_iter().filter_map(|line| Some(PathBuf::from(line.rsplit_once(' ')?.0)));
        files.filter(|file| file.extension().is_some_and(|extension| extension == "rs")).collect()
    }

    /// Returns the paths that lead upward in a file's `include_str!`, `include_bytes!` and `#[path]`.
    fn taken_in(file: &Path) -> Vec<String> {
        let text = fs::read_to_string(file).unwrap();
        let lines = text.lines().filter(|line| line.contains("include_") || line.contains("#[path"));
        let words = lines.flat_map(|line| line.split('"'));
        words.filter(|word| word.starts_with("../")).map(str::to_owned).collect()
    }

    /// Returns a path without `..`.
    fn normal(path: &Path) -> PathBuf {
        let mut normal = PathBuf::new();
        for part in path.components() {
            if part == std::path::Component::ParentDir {
                normal.pop();
            } else {
                normal.push(part);
            }
        }
        normal
    }

    #[test]
    fn suites_of_this_workspace_have_a_key() {
        for suite in [Suite::Page, Suite::Bevy] {
            Key::of(suite).unwrap();
        }
    }
}
