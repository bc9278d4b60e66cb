//! `cargo xtask matrix`: the published packages with their features in many combinations, with the lowest versions of
//! their dependencies, and their API against the last release. Continuous integration runs it by night, since it
//! builds the packages fifty times.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use super::folders;
use super::packages::Package;
use crate::ci::portability::{oldest_version, sections};
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
    adapt_manifests(&folder, &packages)?;
    api(&folder, &packages)?;
    features(&folder, &packages)?;
    lowest_versions(&folder)
}

/// Returns a cargo command in the folder of the packages, compiled by rustc.
fn cargo(folder: &Path, subcommand: &str) -> Command {
    let mut command = process::cargo_here(subcommand);
    command.current_dir(folder).env("CARGO_TARGET_DIR", target_folder());
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

/// Removes dependencies of tests from the unpacked manifests, because tests are not in the packages. Adds the folders of
/// siblings, because cargo-semver-checks ignores the patches of the workspace.
fn adapt_manifests(folder: &Path, packages: &[Package]) -> Result<()> {
    for package in packages {
        let file = folder.join(package.full_name()).join("Cargo.toml");
        let manifest = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        let mut manifest = sections(&manifest, |header| !header.contains("dev-dependencies"));
        for sibling in packages {
            let header = format!("[dependencies.{}]\n", sibling.name);
            manifest = manifest.replace(&header, &format!("{header}path = \"../{}\"\n", sibling.full_name()));
        }
        fs::write(&file, manifest)?;
    }
    Ok(())
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
    let _ = fs::remove_file(folder.join("Cargo.lock"));
    // The option is unstable. The variable allows it in a stable cargo, and is set for this command alone.
    process::run(cargo(folder, "update").args(["-Z", "direct-minimal-versions"]).env("RUSTC_BOOTSTRAP", "1"))?;
    // Cargo takes the newest glam for obvhs, whose vectors must be of the same glam as ours.
    let manifest = fs::read_to_string(process::root().join("Cargo.toml"))?;
    let oldest = oldest_version(&manifest, "glam").context("the workspace's Cargo.toml states no range of glam")?;
    let lock = fs::read_to_string(folder.join("Cargo.lock"))?;
    for version in versions(&lock, "glam").into_iter().filter(|&version| version != oldest) {
        let package = format!("glam@{version}");
        process::run(cargo(folder, "update").args(["--package", &package, "--precise", oldest]))?;
    }
    process::run(cargo(folder, "check").args(["--workspace", "--all-features", "--quiet"]))
}

/// Returns the versions of a package in the text of a lock file.
fn versions<'a>(lock: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!("name = \"{name}\"\nversion = \"");
    lock.match_indices(&start).filter_map(move |(at, _)| lock[at..].split('"').nth(3)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_versions_of_a_package_are_read_from_a_lock_file() {
        let lock = "[[package]]\nname = \"a\"\nversion = \"1.0.0\"\n\n[[package]]\nname = \"ab\"\nversion = \"2.0.0\"\n\n\
                    [[package]]\nname = \"a\"\nversion = \"3.0.0\"\n";
        assert_eq!(versions(lock, "a"), ["1.0.0", "3.0.0"]);
    }
}
