//! `cargo xtask ci`: every check before the tests, in an order that shows mistakes early. Stops at the first
//! failure. `.ci/run` calls this and then `cargo xtask test`.

mod circles;
pub(crate) mod portability;
mod prose;
mod size;

use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::generate;
use crate::machine::Machine;
use crate::process;
use crate::setup::{self, Purpose};

/// A named check.
struct Step {
    name: &'static str,
    check: fn(&Machine) -> Result<()>,
}

const STEPS: [Step; 13] = [
    Step { name: "format", check: format },
    Step { name: "import circles", check: circles::check },
    Step { name: "lines of code", check: size::check },
    Step { name: "prose", check: prose::check },
    Step { name: "generated text", check: |_| generate::check() },
    Step { name: "dependencies", check: dependencies },
    Step { name: "no_std build of the core", check: portability::no_std },
    Step { name: "lints", check: lints },
    Step { name: "docs", check: docs },
    Step { name: "minimum supported Rust version", check: msrv },
    Step { name: "the core's own minimum Rust version", check: portability::msrv },
    Step { name: "same bits without SIMD and in WebAssembly", check: portability::determinism },
    Step { name: "the core with the oldest glam", check: portability::oldest_glam },
];

/// Prepares the machine and runs the checks.
///
/// # Errors
/// If a check fails. Later checks are then not run.
pub(crate) fn ci() -> Result<()> {
    let machine = setup::prepare(Purpose::Pictures)?;
    let mut done: Vec<(&str, Duration)> = Vec::new();
    for Step { name, check } in &STEPS {
        eprintln!("\n==== {name} ====");
        let start = Instant::now();
        check(&machine).with_context(|| format!("the check \"{name}\" failed"))?;
        done.push((name, start.elapsed()));
    }
    println!("\nall checks passed:");
    for (name, duration) in done {
        println!("{:7.1} s  {name}", duration.as_secs_f32());
    }
    Ok(())
}

fn format(_: &Machine) -> Result<()> {
    process::run(process::cargo("fmt").args(["--all", "--check"]))?;
    process::run(process::cargo("fmt").args(["--manifest-path", "crates/bevy-shadowfit/Cargo.toml", "--check"]))
}

fn dependencies(_: &Machine) -> Result<()> {
    // Check for a stale lock file first: every later step would update it silently.
    let locked = process::cargo("metadata").args(["--locked", "--format-version", "1"]).output()?;
    if !locked.status.success() {
        bail!("Cargo.lock is not up to date: {}", String::from_utf8_lossy(&locked.stderr).trim());
    }
    if !process::succeeds(process::cargo("deny").arg("--version")) {
        println!("Cargo.lock is up to date; licences and sources are not checked: cargo-deny is not installed");
        return Ok(());
    }
    process::run(process::cargo("deny").args(["--workspace", "--all-features"]).args([
        "check",
        "--hide-inclusion-graph",
        "bans",
        "licenses",
        "sources",
    ]))
}

fn lints(machine: &Machine) -> Result<()> {
    if process::lints_tests() {
        println!("checked while the tests are compiled");
        return Ok(());
    }
    let features = setup::features(machine);
    process::run(
        process::cargo("clippy").args(["--workspace", "--all-targets"]).args(features).args(["--", "-D", "warnings"]),
    )
}

fn docs(machine: &Machine) -> Result<()> {
    if process::lints_tests() {
        println!("written while their examples are tested");
        return Ok(());
    }
    let features = setup::features(machine);
    process::run(
        process::cargo("doc").args(["--workspace", "--no-deps"]).args(features).env("RUSTDOCFLAGS", "-D warnings"),
    )
}

/// Checks the workspace with the oldest supported Rust. If that is the Rust in use, every other step is
/// already this check.
fn msrv(machine: &Machine) -> Result<()> {
    let manifest = std::fs::read_to_string(process::root().join("Cargo.toml"))?;
    let promised = rust_version(&manifest).context("the workspace's Cargo.toml states no rust-version")?;
    let used = process::output_of(Command::new("rustc").arg("--version")).context("rustc does not start")?;
    if is_release(&used, promised) {
        println!("the minimum is Rust {promised}, and everything here is built with it: {}", used.trim());
        return Ok(());
    }
    process::run(Command::new("rustup").args(["toolchain", "install", promised, "--profile", "minimal"]))?;
    let target_dir = process::root().join("target/msrv");
    process::run(
        Command::new("rustup")
            .args(["run", promised, "cargo", "check", "--workspace"])
            .args(setup::features(machine))
            .current_dir(process::root())
            .env("CARGO_TARGET_DIR", target_dir),
    )
}

/// Returns the first `rust-version` in a manifest.
fn rust_version(manifest: &str) -> Option<&str> {
    let value = manifest.lines().find_map(|line| line.trim().strip_prefix("rust-version"))?;
    value.split('"').nth(1)
}

/// Returns whether the output of `rustc --version` is of release `version` (major.minor or
/// major.minor.patch).
fn is_release(rustc: &str, version: &str) -> bool {
    let Some(number) = rustc.split_whitespace().nth(1) else { return false };
    number == version || number.strip_prefix(version).is_some_and(|rest| rest.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_promised_rust_is_read_from_the_manifest() {
        let manifest = "[workspace.package]\nedition = \"2024\"\nrust-version = \"1.95\"\n";
        assert_eq!(rust_version(manifest), Some("1.95"));
        assert_eq!(rust_version("[package]\nname = \"x\"\n"), None);
    }

    #[test]
    fn the_manifest_of_this_workspace_promises_a_rust() {
        let manifest = std::fs::read_to_string(process::root().join("Cargo.toml")).unwrap();
        assert!(rust_version(&manifest).is_some());
    }

    #[test]
    fn a_release_is_told_from_its_neighbours() {
        let cases = [
            ("rustc 1.95.0 (abc 2026-01-01)", "1.95", true),
            ("rustc 1.95.0", "1.95.0", true),
            ("rustc 1.96.0 (abc 2026-03-01)", "1.95", false),
            ("rustc 1.950.0", "1.95", false),
            ("rustc 1.97.0-nightly", "1.95", false),
            ("", "1.95", false),
        ];
        for (printed, version, expected) in cases {
            assert_eq!(is_release(printed, version), expected, "{printed:?} {version:?}");
        }
    }
}
