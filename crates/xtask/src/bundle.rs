//! `cargo xtask bundle`: the tests and the examples as programs, with a runner, for machines without a Rust
//! toolchain.
//!
//! The bundle keeps the layout of the repository, including `workspace/target/debug/deps`, so that tests find
//! the files of their package and the examples that they start at the same relative paths.

#[cfg(all(test, target_os = "linux"))]
mod runner_tests;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

use crate::process::{self, root};
use crate::setup::{self, Purpose};

/// The runner, in POSIX shell.
const RUNNER: &str = include_str!("bundle/run.sh");

/// The list of tests for the runner: program, folder of its package and name, separated by tabs.
const TESTS: &str = "tests.txt";

/// Tracked files that no test of the bundle reads: pictures, and the golden pictures, which need one
/// particular driver.
const LEFT_OUT: [&str; 4] = ["docs/images/", "docs/samples/", "tests/golden/", "crates/shadowfit-egui/tests/golden/"];

/// The package whose tests concern the development tasks themselves.
const TASKS: &str = "xtask";

/// A program that Cargo has built.
struct Program {
    file: PathBuf,
    /// Folder of its package, relative to the workspace; empty for the root package.
    package: PathBuf,
    /// Name of the package and of the target.
    name: String,
    kind: Kind,
}

/// A kind of program. Each kind has its own folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Test,
    Example,
    /// A program with the name of its package, which the tests of the package start.
    OfPackage,
}

impl Program {
    /// Returns the subfolder of the profile's folder.
    fn place(&self) -> &'static str {
        match self.kind {
            Kind::Test => "deps",
            Kind::Example => "examples",
            Kind::OfPackage => "",
        }
    }
}

/// Writes the bundle into `folder`. `gles` adds OpenGL to Vulkan.
///
/// # Errors
/// If the folder is not empty, or a program cannot be built or copied.
pub(crate) fn bundle(folder: &Path, gles: bool) -> Result<()> {
    let is_empty = fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none());
    ensure!(is_empty, "{} is not empty: a bundle needs an empty folder", folder.display());
    let machine = setup::prepare(Purpose::Pictures)?;
    let mut features = setup::features(&machine).join(" ");
    if gles {
        features += ",shadowfit-adapter/gles";
    }
    let features: Vec<&str> = features.split(' ').collect();
    let workspace = folder.join("workspace");
    copy_files(&workspace)?;
    let mut list = String::new();
    for program in built(&features)? {
        let copy = Path::new("target/debug").join(program.place()).join(program.file.file_name().unwrap_or_default());
        copy_stripped(&program.file, &workspace.join(&copy))?;
        if program.kind == Kind::Test {
            // Writing to a String cannot fail.
            let _ = writeln!(list, "{}\t{}\t{}", copy.display(), package_path(&program.package), program.name);
        }
    }
    fs::write(folder.join(TESTS), list)?;
    write_runner(&folder.join("run.sh"))?;
    println!("the bundle is in {0}. Run it with: {0}/run.sh [--adapter NAME] [FILTER...]", folder.display());
    // The programs share most of their code. A dictionary that is larger than a program finds it.
    println!("pack it with: XZ_OPT=--lzma2=preset=4,dict=512MiB tar -C {} -cJf bundle.tar.xz .", folder.display());
    Ok(())
}

/// Returns the text of a folder for the list, where an empty word would be lost.
fn package_path(package: &Path) -> String {
    if package.as_os_str().is_empty() { ".".into() } else { package.display().to_string() }
}

/// Builds the examples and the tests of the workspace, and returns their programs.
fn built(features: &[&str]) -> Result<Vec<Program>> {
    let mut programs = Vec::new();
    for kinds in [&["build", "--bins", "--examples"][..], &["test", "--no-run", "--lib", "--bins", "--tests"]] {
        let mut command = process::cargo(kinds[0]);
        command.arg("--workspace").args(features).args(&kinds[1..]);
        command.args(["--message-format", "json-render-diagnostics"]).stderr(Stdio::inherit());
        let output = command.output().context("cargo does not start")?;
        if !output.status.success() {
            bail!("the programs of the bundle cannot be built");
        }
        let messages = String::from_utf8_lossy(&output.stdout);
        programs.extend(messages.lines().filter_map(|line| program(&serde_json::from_str(line).ok()?)));
    }
    ensure!(!programs.is_empty(), "Cargo has built no program");
    Ok(programs)
}

/// Returns the program of one of Cargo's messages, if it belongs in the bundle.
fn program(message: &Value) -> Option<Program> {
    let file = PathBuf::from(message["executable"].as_str()?);
    let manifest = Path::new(message["manifest_path"].as_str()?);
    let package = manifest.parent()?.strip_prefix(root()).ok()?.to_owned();
    let is_test = message["profile"]["test"].as_bool()?;
    let crate_name = package.file_name().map_or("workspace".into(), |name| name.to_string_lossy());
    let target = message["target"]["name"].as_str()?;
    let kind = match message["target"]["kind"][0].as_str()? {
        _ if package.ends_with(TASKS) => return None,
        _ if is_test => Kind::Test,
        "example" => Kind::Example,
        _ if target == crate_name => Kind::OfPackage,
        _ => return None,
    };
    let name = format!("{crate_name}/{target}");
    Some(Program { file, package, name, kind })
}

/// Copies the tracked files of the repository that tests may read.
fn copy_files(workspace: &Path) -> Result<()> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let listed = listed.ok().filter(|output| output.status.success()).context("`git ls-files` fails")?;
    let names = String::from_utf8(listed.stdout).context("a file's name is not UTF-8")?;
    let is_wanted = |name: &&str| !name.is_empty() && !LEFT_OUT.iter().any(|folder| name.starts_with(folder));
    for name in names.split('\0').filter(is_wanted) {
        let (from, to) = (root().join(name), workspace.join(name));
        // A file may be deleted and still be tracked.
        if from.is_file() {
            make_parent(&to)?;
            fs::copy(&from, &to).with_context(|| format!("cannot copy {name}"))?;
        }
    }
    Ok(())
}

fn make_parent(file: &Path) -> Result<()> {
    let folder = file.parent().unwrap_or(file);
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))
}

/// Copies a program without its symbols, which are most of its size.
fn copy_stripped(from: &Path, to: &Path) -> Result<()> {
    make_parent(to)?;
    let strip = Command::new("strip").arg("-o").arg(to).arg(from).stderr(Stdio::inherit()).status();
    ensure!(strip.is_ok_and(|status| status.success()), "`strip` (binutils) cannot copy {}", from.display());
    Ok(())
}

fn write_runner(file: &Path) -> Result<()> {
    fs::write(file, RUNNER)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(file, fs::Permissions::from_mode(0o755))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(package: &str, kind: &str, is_test: bool) -> Value {
        let manifest = root().join(package).join("Cargo.toml");
        serde_json::json!({
            "executable": "/target/debug/deps/suite-1", "manifest_path": manifest,
            "profile": { "test": is_test }, "target": { "name": "suite", "kind": [kind] },
        })
    }

    #[test]
    fn tests_and_examples_are_bundled_with_the_folders_of_their_packages() {
        let test = program(&message("crates/shadowfit-render", "test", true)).expect("a test");
        assert_eq!((test.name.as_str(), test.kind), ("shadowfit-render/suite", Kind::Test));
        assert_eq!(package_path(&test.package), "crates/shadowfit-render");
        let example = program(&message("", "example", false)).expect("an example");
        assert_eq!((example.name.as_str(), example.kind), ("workspace/suite", Kind::Example));
        assert_eq!(package_path(&example.package), ".");
        let of_package = program(&message("crates/suite", "bin", false)).expect("a program of its package");
        assert_eq!((of_package.kind, of_package.place()), (Kind::OfPackage, ""));
    }

    #[test]
    fn development_tasks_and_libraries_are_left_out() {
        assert!(program(&message("crates/xtask", "bin", true)).is_none());
        assert!(program(&message("tests/determinism", "bin", false)).is_none());
        assert!(program(&serde_json::json!({ "reason": "build-finished" })).is_none());
    }
}
