//! The packages as engines get them: each is packed, unpacked into an empty folder, and checked there against its
//! packed siblings, with its documentation.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::packages::{self, Package};
use crate::bevy::Rust;
use crate::ci::portability::sections;
use crate::process::{self, target_folder};

/// Greatest size of the core's package in bytes. Pictures and tests, which packages leave out, would exceed it.
const CORE_LIMIT: u64 = 320_000;
/// Folders below the target folder.
const FOLDER: &str = "packed";
const FOLDER_OF_BEVY: &str = "packed-bevy";

/// Packs all packages, checks the core's size, and builds each package in its folder.
///
/// # Errors
/// If a package cannot be packed or built, or the core is too large.
pub(super) fn check(packages: &[Package], is_quick: bool) -> Result<()> {
    pack(packages)?;
    for package in packages {
        let size = fs::metadata(file(package))?.len();
        println!("{:9} bytes  {}", size, package.name);
        ensure!(package.name != "shadowfit" || size <= CORE_LIMIT, "the core may have at most {CORE_LIMIT} bytes");
    }
    build(packages)?;
    if is_quick {
        println!("bevy-shadowfit is packed, but not built from its package");
        return Ok(());
    }
    build_bevy(packages)
}

/// Returns the folder with the unpacked packages of the workspace, without their dependencies of tests.
///
/// # Errors
/// If a package cannot be packed.
pub(super) fn unpacked(name: &str) -> Result<(PathBuf, Vec<Package>)> {
    let mut packages = packages::in_order(packages::published()?)?;
    packages.retain(|package| package.is_of_workspace);
    pack(&packages)?;
    let folder = target_folder().join(name);
    unpack(&packages, &packages, "Cargo.lock", &folder)?;
    Ok((folder, packages))
}

/// Packs the packages. The package for Bevy goes without its lock file, which would need the published siblings.
fn pack(packages: &[Package]) -> Result<()> {
    let (ours, others): (Vec<&Package>, Vec<&Package>) = packages.iter().partition(|package| package.is_of_workspace);
    let common = ["--quiet", "--no-verify", "--allow-dirty"];
    let mut cargo = process::cargo("package");
    cargo.args(common).args(ours.iter().flat_map(|package| ["--package", &package.name]));
    offline_first(cargo.env("CARGO_TARGET_DIR", target_folder()))?;
    for package in others {
        let mut cargo = process::cargo("package");
        cargo.args(common).arg("--exclude-lockfile").arg("--manifest-path").arg(package.folder.join("Cargo.toml"));
        offline_first(cargo.env("CARGO_TARGET_DIR", target_folder()))?;
    }
    Ok(())
}

/// Runs a cargo command without the network, and once more with it if that fails. Cargo asks the registry for siblings,
/// although it has packed them itself.
fn offline_first(command: &mut Command) -> Result<()> {
    const OFFLINE: &str = "CARGO_NET_OFFLINE";
    process::run(command.env(OFFLINE, "true")).or_else(|_| process::run(command.env_remove(OFFLINE)))
}

/// Returns the file of a package.
fn file(package: &Package) -> PathBuf {
    target_folder().join("package").join(package.full_name() + ".crate")
}

/// Checks each package of the workspace alone with its default features, and documents all with all features.
fn build(packages: &[Package]) -> Result<()> {
    let ours: Vec<Package> = packages.iter().filter(|package| package.is_of_workspace).cloned().collect();
    let folder = target_folder().join(FOLDER);
    unpack(&ours, &ours, "Cargo.lock", &folder)?;
    let cargo = |subcommand: &str, arguments: &[&str]| {
        let mut command = process::cargo_here(subcommand);
        command.args(arguments).arg("--quiet").current_dir(&folder).env("CARGO_TARGET_DIR", target_folder());
        process::run(process::without_lints(&mut command).env("RUSTDOCFLAGS", "-D warnings"))
    };
    for package in &ours {
        cargo("check", &["--package", &package.name])?;
    }
    cargo("doc", &["--workspace", "--no-deps", "--all-features"])
}

/// Checks the package for Bevy, if a Rust is installed that builds Bevy.
fn build_bevy(packages: &[Package]) -> Result<()> {
    let Some(rust) = Rust::find() else {
        println!("SKIPPED: bevy-shadowfit from its package: no Rust here that builds Bevy");
        return Ok(());
    };
    let of_bevy: Vec<Package> = packages.iter().filter(|package| !package.is_of_workspace).cloned().collect();
    let folder = target_folder().join(FOLDER_OF_BEVY);
    unpack(&of_bevy, packages, "crates/bevy-shadowfit/Cargo.lock", &folder)?;
    process::run(rust.cargo_in(&folder, "check").arg("--quiet"))
}

/// Unpacks `packages` into a folder with nothing else but a manifest, which makes `members` a workspace with the
/// versions of a lock file and the profiles of this workspace.
fn unpack(members: &[Package], packages: &[Package], lock_file: &str, folder: &Path) -> Result<()> {
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    for package in packages {
        // The times in packages never change, so cargo would not see changed files. `-m` gives the files today's time.
        process::run(Command::new("tar").args(["-m", "-xzf"]).arg(file(package)).arg("-C").arg(folder))?;
    }
    let root = process::root();
    let manifest = fs::read_to_string(root.join("Cargo.toml")).context("Cargo.toml")?;
    let profiles = sections(&manifest, |header| header.starts_with("[profile"));
    fs::write(folder.join("Cargo.toml"), workspace(members, packages) + &profiles)?;
    fs::copy(root.join(lock_file), folder.join("Cargo.lock")).with_context(|| lock_file.to_owned())?;
    Ok(())
}

/// Returns the manifest of a workspace that takes the packages from folders beside it, not from crates.io.
fn workspace(members: &[Package], packages: &[Package]) -> String {
    let members: Vec<String> = members.iter().map(|package| format!("\"{}\"", package.full_name())).collect();
    let patches =
        packages.iter().map(|package| format!("{} = {{ path = \"{}\" }}\n", package.name, package.full_name()));
    format!(
        "[workspace]\nresolver = \"3\"\nmembers = [{}]\n\n[patch.crates-io]\n{}\n",
        members.join(", "),
        patches.collect::<String>()
    )
}
