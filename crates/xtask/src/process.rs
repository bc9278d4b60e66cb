//! Starting other programs: one place that runs them in the right folder, shows what is run, and turns a failure into
//! an error that names the command and keeps its exit code.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result};

/// A program that ended with a status other than 0.
#[derive(Debug)]
struct Failed {
    command: String,
    /// `None` when a signal ended it.
    code: Option<i32>,
}

impl fmt::Display for Failed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.code {
            Some(code) => write!(f, "`{}` failed with exit code {code}", self.command),
            None => write!(f, "`{}` was ended by a signal", self.command),
        }
    }
}

impl std::error::Error for Failed {}

/// The exit code to end with for `error`: that of the program that failed (the viewer's 2 means bad input), else 1.
pub(crate) fn exit_code_of(error: &anyhow::Error) -> u8 {
    error
        .downcast_ref::<Failed>()
        .and_then(|failed| failed.code)
        .and_then(|code| u8::try_from(code).ok())
        .filter(|&code| code != 0)
        .unwrap_or(1)
}

/// The workspace's folder.
pub(crate) fn root() -> PathBuf {
    // Cargo sets the variable for the programs it runs; the compiled-in value serves a binary started by hand.
    let manifest_dir =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    manifest_dir.ancestors().nth(2).map_or(manifest_dir.clone(), PathBuf::from)
}

/// A cargo command with its sub-command, in the workspace's folder.
pub(crate) fn cargo(subcommand: &str) -> Command {
    let mut command = cargo_here(subcommand);
    command.current_dir(root());
    command
}

/// A cargo command with its sub-command, in the caller's folder, so that relative paths on the command line hold.
pub(crate) fn cargo_here(subcommand: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.arg(subcommand);
    command
}

/// This program with its feature `tools`, without arguments yet.
pub(crate) fn with_tools() -> Command {
    let mut command = cargo_here("run");
    command.arg("--quiet").arg("--manifest-path").arg(root().join("Cargo.toml"));
    command.args(["--package", "xtask", "--features", "tools", "--"]);
    command
}

/// Shows and runs `command` with this process's own input and output.
///
/// # Errors
/// When the program cannot be started, or ends with a status other than 0.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    let shown = shown(command);
    eprintln!("+ {shown}");
    let status = command.status().with_context(|| format!("cannot start `{shown}`"))?;
    if status.success() {
        return Ok(());
    }
    Err(Failed { command: shown, code: status.code() }.into())
}

/// Whether `command` starts and ends with status 0; its output is not shown.
pub(crate) fn succeeds(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// What `command` prints to its standard output, `None` when it cannot be started or fails.
pub(crate) fn output_of(command: &mut Command) -> Option<String> {
    let output = command.stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Whether Rust can build for a target, once rustup was asked to bring it.
pub(crate) fn has_target(target: &str) -> bool {
    succeeds(Command::new("rustup").args(["target", "add", target]))
}

/// Where cargo puts what it builds.
pub(crate) fn target_folder() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// The command as a person would type it: the program's name without its folder, then the arguments.
fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str()).to_string_lossy();
    let words = command.get_args().map(|arg| quoted(&arg.to_string_lossy()));
    std::iter::once(name.into_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// `word` as a shell takes it literally.
fn quoted(word: &str) -> String {
    if word.is_empty() || word.contains(|c: char| c.is_whitespace() || "()|'\"^$*".contains(c)) {
        return format!("'{}'", word.replace('\'', r"'\''"));
    }
    word.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_program_hands_on_its_exit_code() {
        let error: anyhow::Error = Failed { command: "viewer".into(), code: Some(2) }.into();
        assert_eq!(exit_code_of(&error.context("while rendering")), 2);
    }

    #[test]
    fn any_other_error_ends_with_one() {
        assert_eq!(exit_code_of(&anyhow::anyhow!("no such thing")), 1);
        let by_signal: anyhow::Error = Failed { command: "viewer".into(), code: None }.into();
        assert_eq!(exit_code_of(&by_signal), 1);
    }

    #[test]
    fn a_command_is_shown_as_it_would_be_typed() {
        let mut command = Command::new("/usr/bin/cargo");
        command.args(["nextest", "run", "-E", "not test(real_window)"]);
        assert_eq!(shown(&command), "cargo nextest run -E 'not test(real_window)'");
    }

    #[test]
    fn the_root_is_the_folder_of_the_workspace_manifest() {
        let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
        assert!(manifest.contains("[workspace]"));
    }
}
