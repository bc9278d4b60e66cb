//! The package for Bevy, outside the workspace: checked and tested where a Rust is installed that builds Bevy.

use std::process::Command;

use anyhow::Result;

use crate::machine::Machine;
use crate::process;

/// Why it is left out, where it is.
pub(crate) const NO_RUST: &str = "no Rust 1.97 or newer here, which Bevy asks for";

/// The least Rust that builds Bevy 0.20.1: it states 1.97.1, and is content with what came before that.
const LEAST: (u32, u32) = (1, 97);

/// A Rust that builds Bevy.
pub(crate) struct Rust {
    /// Its name to rustup; `None` for the one in use.
    toolchain: Option<String>,
}

impl Rust {
    /// The one in use, else the first that rustup has.
    pub(crate) fn find() -> Option<Self> {
        let version_of = |command: &mut Command| process::output_of(command).and_then(|text| version(&text));
        let is_enough = |version: Option<(u32, u32)>| version.is_some_and(|version| version >= LEAST);
        if is_enough(version_of(Command::new("rustc").arg("--version"))) {
            return Some(Self { toolchain: None });
        }
        let installed = process::output_of(Command::new("rustup").args(["toolchain", "list"]))?;
        let names = installed.lines().filter_map(|line| line.split_whitespace().next());
        names
            .filter(|name| is_enough(version_of(Command::new("rustup").args(["run", name, "rustc", "--version"]))))
            .map(|name| Self { toolchain: Some(name.to_owned()) })
            .next()
    }

    /// A cargo command by this Rust.
    fn plain_cargo(&self, subcommand: &str) -> Command {
        let Some(name) = &self.toolchain else { return process::cargo(subcommand) };
        let mut command = Command::new("rustup");
        command.args(["run", name, "cargo", subcommand]);
        command
    }

    /// The same in the package's folder.
    fn cargo(&self, subcommand: &str) -> Command {
        let mut command = self.plain_cargo(subcommand);
        command.current_dir(process::root().join("crates/bevy-shadowfit"));
        command.env("CARGO_TARGET_DIR", process::target_folder().join("bevy"));
        command.args(["--locked", "--ignore-rust-version"]);
        // Tests need no speed, and Bevy is built in half the time.
        command.args(["--config", "profile.dev.package.'*'.opt-level=0"]);
        command
    }

    /// Lints and docs, as those of the workspace.
    pub(crate) fn check(&self) -> Result<()> {
        if process::succeeds(self.plain_cargo("clippy").arg("--version")) {
            process::run(self.cargo("clippy").args(["--all-targets", "--", "-D", "warnings"]))?;
        } else {
            println!("lints of bevy-shadowfit were not looked at: its Rust has no clippy");
        }
        process::run(self.cargo("doc").arg("--no-deps").env("RUSTDOCFLAGS", "-D warnings"))
    }

    /// All its tests, but those that the machine cannot run.
    pub(crate) fn test(&self, machine: &Machine) -> Result<()> {
        let mut tests = self.cargo("test");
        tests.arg("--no-fail-fast");
        if !machine.can_test_window() {
            println!("SKIPPED: the window of bevy-shadowfit: no Xvfb, ImageMagick's import or Vulkan driver here");
            tests.args(["--", "--skip", "real_window"]);
        }
        process::run(&mut tests)
    }
}

/// Major and minor number of what `rustc --version` prints.
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
