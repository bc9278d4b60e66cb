//! `cargo xtask matrix`: the published packages with their features in many combinations, with the lowest versions of
//! their dependencies, and their API against the last release. Continuous integration runs it by night, since it
//! builds the packages a hundred times.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use super::folders;
use super::packages::Package;
use crate::ci::portability::sections;
use crate::process::{self, target_folder};

/// Folder below the target folder.
const FOLDER: &str = "packed-matrix";
/// The core's features that add implementations of traits. They do not affect each other, so all are on or off.
const TRAITS: &str = "bytemuck,mint,serde";

/// Checks features, lowest versions and API of the packages. Tools that are not installed are named and skipped.
///
/// # Errors
/// If a package does not build, or a change of its API needs a higher version.
pub(crate) fn check() -> Result<()> {
    let (folder, packages) = folders::unpacked(FOLDER)?;
    api(&folder, &packages)?;
    without_tests(&folder, &packages)?;
    features(&folder, &packages)?;
    lowest_versions(&folder)
}

/// Returns a cargo command in the folder of the packages, compiled by rustc.
fn cargo(folder: &Path, subcommand: &str) -> Command {
    let mut command = process::cargo_here(subcommand);
    command.current_dir(folder).env("CARGO_TARGET_DIR", target_folder().join(FOLDER).join("target"));
    process::without_lints(&mut command);
    command
}

/// Returns whether a tool of cargo is installed. Prints how to install it otherwise.
fn is_installed(tool: &str, part: &str) -> bool {
    let is_installed = process::succeeds(process::cargo(tool).arg("--version"));
    if !is_installed {
        println!("SKIPPED: {part}: `cargo install --locked cargo-{tool}` installs the tool");
    }
    is_installed
}

/// Compares the API with the last release. Before the first release, with the packages, which have lost nothing then.
fn api(folder: &Path, packages: &[Package]) -> Result<()> {
    if !is_installed("semver-checks", "the API against the last release") {
        return Ok(());
    }
    let tag = process::output_of(
        Command::new("git").args(["describe", "--tags", "--abbrev=0", "--match", "v*"]).current_dir(process::root()),
    );
    let mut command = process::cargo("semver-checks");
    command.args(packages.iter().flat_map(|package| ["--package", &package.name]));
    match tag {
        Some(tag) => command.args(["--baseline-rev", tag.trim()]),
        None => command.arg("--baseline-root").arg(folder),
    };
    process::run(process::without_lints(&mut command))
}

/// Removes dependencies of tests from the unpacked manifests: tests are not in the packages.
fn without_tests(folder: &Path, packages: &[Package]) -> Result<()> {
    for package in packages {
        let file = folder.join(package.full_name()).join("Cargo.toml");
        let manifest = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        fs::write(&file, sections(&manifest, |header| !header.contains("dev-dependencies")))?;
    }
    Ok(())
}

/// Checks the core with all combinations of its features, and the other packages with each feature alone.
fn features(folder: &Path, packages: &[Package]) -> Result<()> {
    if !is_installed("hack", "combinations of features") {
        return Ok(());
    }
    let core = ["check", "--package", "shadowfit", "--feature-powerset", "--group-features", TRAITS];
    process::run(cargo(folder, "hack").args(core).args(["--exclude-features", "default", "--quiet"]))?;
    let mut others = cargo(folder, "hack");
    others.args(["check", "--each-feature", "--quiet"]);
    let names = packages.iter().map(|package| package.name.as_str()).filter(|&name| name != "shadowfit");
    process::run(others.args(names.flat_map(|name| ["--package", name])))
}

/// Checks the packages with the lowest versions that their manifests allow.
fn lowest_versions(folder: &Path) -> Result<()> {
    // The option is unstable. The variable allows it in a stable cargo, and is set for this command alone.
    process::run(cargo(folder, "update").args(["-Z", "direct-minimal-versions"]).env("RUSTC_BOOTSTRAP", "1"))?;
    process::run(cargo(folder, "check").args(["--workspace", "--all-features", "--quiet"]))
}
