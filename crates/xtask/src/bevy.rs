//! The package for Bevy, outside the workspace. It is checked and tested if a Rust is installed that builds
//! Bevy. Building Bevy takes nearly all of the time, so lints, docs and tests share one build, where `cargo
//! clippy` and `cargo doc` would each need another one: clippy compiles the package in place of rustc, and
//! the documentation is written when its tests run.

use std::path::Path;
use std::process::Command;

use anyhow::Result;

use crate::process;
use crate::rustdoc;
use crate::setup::{self, Purpose};

/// The reason for skipping the package.
const NO_RUST: &str = "no Rust 1.97 or newer here, which Bevy needs";

/// The oldest Rust that builds Bevy 0.20.1. Bevy states 1.97.1, but also builds with 1.97.
const LEAST: (u32, u32) = (1, 97);

/// Lints, documents and tests the package, except tests that the machine cannot run.
///
/// # Errors
/// If a lint, a link of the documentation or a test fails.
pub(crate) fn check_and_test() -> Result<()> {
    let machine = setup::prepare(Purpose::Test)?;
    let Some(rust) = Rust::find() else {
        println!("SKIPPED: the package for Bevy: {NO_RUST}");
        return Ok(());
    };
    let mut tests = rust.cargo("test");
    tests.arg("--no-fail-fast");
    if process::succeeds(rust.plain_cargo("clippy").arg("--version")) {
        process::with_lints(&mut tests);
    } else {
        println!("lints of bevy-shadowfit were not checked: its Rust has no clippy");
    }
    rustdoc::write_documentation(&mut tests)?;
    if !machine.can_test_window() {
        println!("SKIPPED: the window of bevy-shadowfit: no Xvfb, ImageMagick's import or Vulkan driver here");
        tests.args(["--", "--skip", "real_window"]);
    }
    process::run(process::with_driver_for_tests(&mut tests))
}

/// A Rust that builds Bevy.
pub(crate) struct Rust {
    /// Name in rustup, or `None` for the Rust in use.
    toolchain: Option<String>,
    /// First line of the compiler's `--version`.
    pub(crate) version: String,
}

impl Rust {
    /// Returns the Rust in use if it builds Bevy, else the first toolchain of rustup that does.
    pub(crate) fn find() -> Option<Self> {
        let used = process::output_of(Command::new("rustc").arg("--version"));
        if let Some(version) = used.filter(|text| is_enough(text)) {
            return Some(Self { toolchain: None, version });
        }
        let installed = process::output_of(Command::new("rustup").args(["toolchain", "list"]))?;
        let mut names = installed.lines().filter_map(|line| line.split_whitespace().next());
        names.find_map(|name| {
            let version = process::output_of(Command::new("rustup").args(["run", name, "rustc", "--version"]))?;
            is_enough(&version).then(|| Self { toolchain: Some(name.to_owned()), version })
        })
    }

    /// Returns a cargo command with this Rust.
    fn plain_cargo(&self, subcommand: &str) -> Command {
        let Some(name) = &self.toolchain else { return process::cargo(subcommand) };
        let mut command = Command::new("rustup");
        command.args(["run", name, "cargo", subcommand]);
        command
    }

    /// Returns a cargo command with this Rust and the versions of the lock file, run in the package's folder.
    fn cargo(&self, subcommand: &str) -> Command {
        let mut command = self.cargo_in(&process::root().join("crates/bevy-shadowfit"), subcommand);
        command.arg("--locked");
        command
    }

    /// Returns a cargo command with this Rust, run in a folder. All such commands share compiled code.
    pub(crate) fn cargo_in(&self, folder: &Path, subcommand: &str) -> Command {
        let mut command = self.plain_cargo(subcommand);
        command.current_dir(folder);
        command.env("CARGO_TARGET_DIR", process::target_folder().join("bevy"));
        command.arg("--ignore-rust-version");
        // Tests need neither speed nor a debugger, and Bevy builds in half the time.
        for setting in ["opt-level=0", "package.'*'.opt-level=0", "debug=false"] {
            command.args(["--config", &format!("profile.dev.{setting}")]);
        }
        command
    }
}

/// Returns whether a compiler builds Bevy, given its version text.
fn is_enough(printed: &str) -> bool {
    version(printed).is_some_and(|version| version >= LEAST)
}

/// Returns major and minor version from the output of `rustc --version`.
fn version(printed: &str) -> Option<(u32, u32)> {
    let mut numbers = printed.split_whitespace().nth(1)?.split('.').map(|number| number.parse().ok());
    Some((numbers.next()??, numbers.next()??))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_what_rustc_prints() {
        assert_eq!(version("rustc 1.97.0-nightly (e50aa6fba 2026-05-19)"), Some((1, 97)));
        assert_eq!(version("rustc 1.100.2"), Some((1, 100)));
        assert!(version("rustc 1.95.0 (abc 2026-01-01)") < Some(LEAST));
        assert_eq!(version("cargo"), None);
    }
}
