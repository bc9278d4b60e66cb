//! `cargo xtask npm`: the npm package for three.js. Its sources are in `crates/shadowfit-wasm/npm`. They are
//! copied into the target folder, where npm installs the tools and the modules are built, so that the sources stay
//! as they are.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::machine::WEB_TARGET;
use crate::process::{self, has_target, target_folder};
use crate::setup::{self, Purpose};
use crate::web;

/// Folder of the package's sources.
const SOURCES: &str = "crates/shadowfit-wasm/npm";
/// The modules, each with one kind of maps.
const MODULES: [&str; 2] = ["windows", "cascades"];
/// Files that npm wants beside the manifest.
const LICENSES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

/// Builds the package and writes it to `out/npm`. Returns its file.
///
/// # Errors
/// If a tool is missing or a module is larger than it may be.
pub(crate) fn pack() -> Result<PathBuf> {
    let folder = build()?;
    let out = process::root().join("out/npm");
    fs::create_dir_all(&out).with_context(|| format!("cannot create {}", out.display()))?;
    let mut npm = Command::new("npm");
    npm.args(["pack", "--silent", "--pack-destination"]).arg(&out).current_dir(&folder);
    let file = out.join(process::printed_by(&mut npm)?);
    println!("the package is {}", file.display());
    Ok(file)
}

/// Packs the package and tests it.
///
/// # Errors
/// If a tool is missing or a test fails.
pub(crate) fn test() -> Result<()> {
    let package = pack()?;
    let folder = work_folder();
    let mut node = Command::new("node");
    node.args(["--test", "--test-reporter=spec", "--test-concurrency=1", "--test-force-exit", "tests/"])
        .current_dir(&folder);
    process::run(node.env("BROWSER", web::browser()?).env("PACKAGE", package))
}

/// Measures the shadows of three.js with this package and without.
///
/// # Errors
/// If a tool is missing or a measurement fails.
pub(crate) fn figures(is_quick: bool) -> Result<()> {
    let folder = build()?;
    let scenes = target_folder().join("npm-scenes");
    let mut report = process::cargo("run");
    report.args(["--release", "--package", "shadowfit-report", "--", "figures", "--write-scenes"]).arg(&scenes);
    process::run(&mut report)?;
    let out = process::root().join("out/npm-figures");
    let mut node = Command::new("node");
    node.arg("figures/run.mjs").arg("--scenes").arg(scenes).arg("--out").arg(out).current_dir(&folder);
    if is_quick {
        node.arg("--quick");
    }
    process::run(node.env("BROWSER", web::browser()?).env("PACKAGES", &folder))
}

/// Builds the package in the target folder. Returns its folder.
fn build() -> Result<PathBuf> {
    let machine = setup::prepare(Purpose::Page)?;
    if !machine.can_test_page() {
        bail!("the package cannot be built and tested: Chromium, Node.js or npm is missing");
    }
    if !has_target(WEB_TARGET) {
        bail!("the package needs Rust's target {WEB_TARGET}: install it with `rustup target add {WEB_TARGET}`");
    }
    let folder = work_folder();
    // Files that were removed from the sources must not be tested.
    for part in ["src", "tests", "figures", "examples"] {
        let _ = fs::remove_dir_all(folder.join(part));
    }
    copy(&process::root().join(SOURCES), &folder)?;
    for license in LICENSES {
        fs::copy(process::root().join(license), folder.join(license)).with_context(|| license.to_owned())?;
    }
    let mut npm = Command::new("npm");
    process::run(npm.args(["install", "--no-audit", "--no-fund", "--silent"]).current_dir(&folder))?;
    let modules = target_folder().join("npm-modules");
    fs::create_dir_all(&modules)?;
    for name in MODULES {
        let mut cargo = process::cargo("rustc");
        cargo.args(["--package", "shadowfit-wasm", "--lib", "--crate-type", "cdylib", "--profile", "web"]);
        cargo.args(["--target", WEB_TARGET, "--no-default-features", "--features", name]);
        process::run(process::without_lints(&mut cargo))?;
        let built = target_folder().join(WEB_TARGET).join("web/shadowfit_wasm.wasm");
        fs::copy(built, modules.join(format!("{name}.wasm")))?;
    }
    process::run(Command::new("node").arg("build.mjs").arg(modules).current_dir(&folder))?;
    Ok(folder)
}

fn work_folder() -> PathBuf {
    target_folder().join("npm")
}

/// Copies a folder with all folders in it, but not what npm installed there.
fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("cannot create {}", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))? {
        let path = entry?.path();
        let Some(name) = path.file_name() else { continue };
        if name == "node_modules" || name == "package-lock.json" {
            continue;
        }
        if path.is_dir() {
            copy(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name))?;
        }
    }
    Ok(())
}
