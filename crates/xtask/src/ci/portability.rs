//! The core crate's guarantees beyond this machine: targets without a standard library, each feature alone,
//! the same bits everywhere, the oldest and newest supported glam, and the core's own minimum Rust version.
//!
//! If a target, a toolchain or a runtime is not available, the check prints which part it skipped.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::{is_release, rust_version};
use crate::machine::Machine;
use crate::process::{self, has_target, target_folder};

/// A microcontroller target without a standard library, which proves that the core needs none.
const BARE_TARGET: &str = "thumbv7em-none-eabi";

/// The target of browsers.
const WASM_TARGET: &str = "wasm32-unknown-unknown";

/// Features that must build without the standard library, each alone and all together.
const FEATURES: [&str; 10] = [
    "",
    "alloc",
    "serde",
    "bytemuck",
    "mint",
    "cascades",
    "windows",
    "cache",
    "alloc,cascades,serde",
    "cache,serde,bytemuck,mint,cascades,windows",
];

/// The package that hashes fits.
const DETERMINISM: &str = "shadowfit-determinism";

/// Folder below the target folder for a workspace with its own lock file.
const COPY_OF_THE_CORE: &str = "oldest-glam";

/// Builds the core without the standard library.
pub(super) fn no_std(_: &Machine) -> Result<()> {
    let target = has_target(BARE_TARGET);
    for features in FEATURES {
        let mut command = process::cargo("check");
        command.args(["--package", "shadowfit", "--no-default-features", "--features", features]);
        if target {
            command.args(["--target", BARE_TARGET]);
        }
        // Some lints suggest changes that break the build with more features.
        process::run(process::without_lints(&mut command))?;
    }
    if target {
        println!("checked with no feature, each alone and all together, for {BARE_TARGET}");
    } else {
        println!(
            "built with no feature, each alone and all together, for this machine only: rustup has no {BARE_TARGET}"
        );
    }
    Ok(())
}

/// Compares the hash of the fits without SIMD and in WebAssembly with the pinned hash. The ordinary tests
/// compare it for this machine's own build.
pub(super) fn determinism(_: &Machine) -> Result<()> {
    process::run(process::cargo("test").args(["--package", DETERMINISM, "--features", "scalar-math"]))?;
    if !has_target(WASM_TARGET) {
        println!("same bits without SIMD; not built for WebAssembly: rustup has no {WASM_TARGET}");
        return Ok(());
    }
    process::run(process::cargo("build").args(["--package", DETERMINISM, "--lib", "--target", WASM_TARGET]))?;
    if !process::succeeds(Command::new("node").arg("--version")) {
        println!("same bits without SIMD; built for WebAssembly, but not run there: node is missing");
        return Ok(());
    }
    let module = target_folder().join(WASM_TARGET).join("debug/shadowfit_determinism.wasm");
    let host = process::root().join("tests/determinism/hash.mjs");
    process::run(Command::new("node").arg(host).arg(module))
}

/// Compares the hash of the fits with the oldest supported glam, and builds and runs an engine that pins this
/// version and passes its own vectors to the core. All other builds use the newest glam, from the lock file.
pub(super) fn oldest_glam(_: &Machine) -> Result<()> {
    // Both packages in each command: cargo would otherwise compile the core once more for the engine's
    // features.
    let packages = ["--package", DETERMINISM, "--package", "engine", "--all-features"];
    let oldest = with_oldest_glam(&[&["build"], &packages[..]].concat())?;
    process::run(&mut Command::new(target_folder().join("debug/engine")))?;
    in_copy_of_the_core(&[&["test"], &packages[..], &["--lib", "--tests"]].concat())?;
    println!("with glam {oldest} the core fits with the same bits, and an engine that pins it runs");
    Ok(())
}

/// Runs all tests of the core with the oldest supported glam.
///
/// # Errors
/// If a test fails or the older glam is not available.
pub(crate) fn suite_with_oldest_glam() -> Result<()> {
    with_oldest_glam(&["test", "--package", "shadowfit", "--all-features", "--lib", "--tests"]).map(|_| ())
}

/// Runs cargo in a copy of the core whose lock file has the oldest supported glam. Returns that version.
fn with_oldest_glam(arguments: &[&str]) -> Result<String> {
    let manifest = fs::read_to_string(process::root().join("Cargo.toml"))?;
    let oldest = oldest_version(&manifest, "glam").context("the workspace's Cargo.toml states no range of glam")?;
    let folder = target_folder().join(COPY_OF_THE_CORE);
    copy_of_the_core(&folder, &manifest)
        .and_then(|()| engine_with(oldest, &folder.join("crates/engine")))
        .with_context(|| format!("cannot write {}", folder.display()))?;
    let update = ["update", "--package", "glam", "--precise", oldest];
    // Try offline first: a query of the registry takes long, and cargo's cache may hold the crate already.
    in_copy_of_the_core(&[&update[..], &["--offline"]].concat()).or_else(|_| in_copy_of_the_core(&update))?;
    in_copy_of_the_core(arguments)?;
    Ok(oldest.to_owned())
}

fn in_copy_of_the_core(arguments: &[&str]) -> Result<()> {
    let [subcommand, rest @ ..] = arguments else { return Ok(()) };
    let mut command = process::cargo_here(subcommand);
    // Quiet, since the copied profiles name packages that are not in the copy, and cargo would warn about
    // each.
    command.args(rest).arg("--quiet").current_dir(target_folder().join(COPY_OF_THE_CORE));
    process::run(process::without_lints(&mut command).env("CARGO_TARGET_DIR", target_folder()))
}

/// Checks the core with its own minimum Rust, which is older than the workspace's.
pub(super) fn msrv(_: &Machine) -> Result<()> {
    let manifest = fs::read_to_string(process::root().join("crates/shadowfit/Cargo.toml"))?;
    let promised = rust_version(&manifest).context("the core's Cargo.toml states no rust-version")?;
    let installed = || {
        let list = process::output_of(Command::new("rustup").args(["toolchain", "list"]))?;
        list.lines()
            .filter_map(|line| line.split_whitespace().next())
            .find(|name| names(name, promised))
            .map(String::from)
    };
    let toolchain = installed().or_else(|| {
        let _ = process::run(Command::new("rustup").args(["toolchain", "install", promised, "--profile", "minimal"]));
        installed()
    });
    let Some(toolchain) = toolchain else {
        println!("the core promises Rust {promised}, which is NOT CHECKED here: rustup cannot install it");
        return Ok(());
    };
    process::run(
        Command::new("rustup")
            .args(["run", &toolchain, "cargo", "check", "--package", "shadowfit", "--all-features"])
            .current_dir(process::root())
            .env("CARGO_TARGET_DIR", target_folder().join("msrv")),
    )
}

/// Returns whether a toolchain, as rustup lists it, is of a release.
fn names(toolchain: &str, version: &str) -> bool {
    let number = toolchain.split('-').next().unwrap_or_default();
    is_release(&format!("rustc {number}"), version)
}

/// Returns the lowest version of a dependency from its range in the workspace's manifest.
pub(crate) fn oldest_version<'a>(manifest: &'a str, dependency: &str) -> Option<&'a str> {
    let line = manifest.lines().find(|line| line.split('=').next().is_some_and(|name| name.trim() == dependency))?;
    let range = &line[line.find(">=")? + 2..];
    range.split([',', '"']).next().map(str::trim)
}

/// Writes a workspace with only the core and its hash, so that it can have its own lock file.
fn copy_of_the_core(folder: &Path, manifest: &str) -> Result<()> {
    let _ = fs::remove_dir_all(folder);
    let root = process::root();
    for part in ["crates/shadowfit", "tests/determinism"] {
        copy_folder(&root.join(part), &folder.join(part))?;
    }
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    let workspace = sections(manifest, |header| header.starts_with("[workspace") || header.starts_with("[profile"));
    fs::write(folder.join("Cargo.toml"), workspace)?;
    // Benchmarks are not needed here, and take the longest to build.
    let core = folder.join("crates/shadowfit/Cargo.toml");
    let without_benches = sections(&fs::read_to_string(&core)?, |header| header != "[[bench]]");
    let lines: Vec<&str> = without_benches.lines().filter(|line| !line.starts_with("criterion")).collect();
    fs::write(core, lines.join("\n") + "\n")?;
    fs::remove_dir_all(folder.join("crates/shadowfit/benches"))?;
    Ok(())
}

/// Writes a crate next to the core that is the first example with its own version of glam.
fn engine_with(glam: &str, folder: &Path) -> Result<()> {
    let example = fs::read_to_string(process::root().join("examples/fit_once.rs"))?;
    let main = example.replace("use shadowfit::glam::", "use glam::");
    ensure!(main != example, "examples/fit_once.rs no longer takes its vectors from shadowfit::glam");
    let manifest = format!(
        "[package]\nname = \"engine\"\nedition = \"2024\"\n\n\
         [dependencies]\nglam = \"={glam}\"\nshadowfit = {{ path = \"../shadowfit\" }}\n"
    );
    fs::create_dir_all(folder.join("src"))?;
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::write(folder.join("src/main.rs"), main)?;
    Ok(())
}

fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let place = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &place)?;
        } else {
            fs::copy(entry.path(), place)?;
        }
    }
    Ok(())
}

/// Returns the sections of a manifest whose header is kept.
pub(crate) fn sections(manifest: &str, keep: impl Fn(&str) -> bool) -> String {
    let mut is_kept = false;
    let mut kept = String::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            is_kept = keep(line.trim());
        }
        if is_kept {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_version_of_a_range_is_read() {
        let manifest = "[x]\nglam-extra = \"1\"\nglam = { version = \">=0.33.2, <0.35\", default-features = false }\n";
        assert_eq!(oldest_version(manifest, "glam"), Some("0.33.2"));
        assert_eq!(oldest_version(manifest, "glam-extra"), None);
    }

    #[test]
    fn sections_are_kept_whole() {
        let manifest = "[a]\nx = [1]\n[[bench]]\nname = \"b\"\n[a.b]\ny = 2\n";
        assert_eq!(sections(manifest, |header| header != "[[bench]]"), "[a]\nx = [1]\n[a.b]\ny = 2\n");
    }

    #[test]
    fn a_toolchain_is_known_by_its_release() {
        assert!(names("1.88.0-x86_64-unknown-linux-gnu", "1.88"));
        assert!(names("1.88-x86_64-unknown-linux-gnu", "1.88"));
        assert!(!names("1.87.0-x86_64-unknown-linux-gnu", "1.88"));
        assert!(!names("stable-x86_64-unknown-linux-gnu", "1.88"));
    }
}
