//! Starts other programs: runs them in the right folder, prints the command, and turns a failure into an
//! error that names the command and keeps its exit code.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result};

/// The environment variable that moves lints and documentation into the builds of the tests. `.ci/run` sets
/// it, since `cargo clippy` and `cargo doc` each check all dependencies again.
const LINT_TESTS: &str = "SHADOWFIT_LINT_TESTS";

/// Cargo's environment variable for a program that compiles the packages of the workspace.
const WRAPPER: &str = "RUSTC_WORKSPACE_WRAPPER";

/// Exit code after an interrupt.
const INTERRUPTED: i32 = 130;

/// A program that ended with a status other than 0.
#[derive(Debug)]
struct Failed {
    command: String,
    /// Exit code, or `None` if a signal ended the program.
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

/// Returns the exit code for `error`: the code of the program that failed (the viewer's 2 means bad input),
/// else 1.
pub(crate) fn exit_code_of(error: &anyhow::Error) -> u8 {
    error
        .downcast_ref::<Failed>()
        .and_then(|failed| failed.code)
        .and_then(|code| u8::try_from(code).ok())
        .filter(|&code| code != 0)
        .unwrap_or(1)
}

/// Returns the workspace's folder.
pub(crate) fn root() -> PathBuf {
    // Cargo sets the variable for programs that it runs. The compiled-in value is for a binary started by
    // hand.
    let manifest_dir =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    manifest_dir.ancestors().nth(2).map_or(manifest_dir.clone(), PathBuf::from)
}

/// Returns a cargo command with its sub-command, run in the workspace's folder.
pub(crate) fn cargo(subcommand: &str) -> Command {
    let mut command = cargo_here(subcommand);
    command.current_dir(root());
    command
}

/// Returns a cargo command with its sub-command, run in the caller's folder, so that relative paths stay
/// valid.
pub(crate) fn cargo_here(subcommand: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.arg(subcommand);
    if lints_tests() {
        with_lints(&mut command);
    }
    command
}

/// Returns a command that runs this program with its feature `tools`, without arguments yet.
pub(crate) fn with_tools() -> Command {
    let mut command = cargo_here("run");
    command.arg("--quiet").arg("--manifest-path").arg(root().join("Cargo.toml"));
    command.args(["--package", "xtask", "--features", "tools", "--"]);
    command
}

/// Prints and runs `command` with this process's own input and output.
///
/// # Errors
/// If the program cannot be started, or ends with a status other than 0.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    let shown = shown(command);
    eprintln!("+ {shown}");
    let status = command.status().with_context(|| format!("cannot start `{shown}`"))?;
    if status.success() {
        return Ok(());
    }
    Err(Failed { command: shown, code: status.code() }.into())
}

/// Runs `command` and returns its trimmed standard output. Its standard error is shown.
///
/// # Errors
/// If the program cannot be started, or ends with a status other than 0.
pub(crate) fn printed_by(command: &mut Command) -> Result<String> {
    let shown = shown(command);
    let output = command.stderr(Stdio::inherit()).output().with_context(|| format!("cannot start `{shown}`"))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned());
    }
    Err(Failed { command: shown, code: output.status.code() }.into())
}

/// Makes an interrupt or termination also end all descendants of this process. Otherwise servers, displays
/// and browsers would outlive the test runner.
pub(crate) fn end_children_on_interrupt() {
    let handled = ctrlc::set_handler(|| {
        let children = descendants(std::process::id());
        for signal in ["-TERM", "-KILL"] {
            let ids = children.iter().map(u32::to_string);
            let _ = succeeds(Command::new("kill").arg(signal).args(ids));
            std::thread::sleep(Duration::from_millis(300));
        }
        std::process::exit(INTERRUPTED);
    });
    if let Err(error) = handled {
        eprintln!("programs may outlive an interrupt: {error}");
    }
}

/// Returns the process ids of all descendants of a process.
fn descendants(ancestor: u32) -> Vec<u32> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let processes: Vec<(u32, u32)> = entries
        .filter_map(|entry| {
            let id = entry.file_name().to_str()?.parse().ok()?;
            Some((id, parent(&std::fs::read_to_string(entry.path().join("stat")).ok()?)?))
        })
        .collect();
    let mut found = vec![ancestor];
    let mut next = 0;
    while let Some(&id) = found.get(next) {
        found.extend(processes.iter().filter(|(_, parent)| *parent == id).map(|(child, _)| *child));
        next += 1;
    }
    found.split_off(1)
}

/// Returns the parent's id from the text of `/proc/ID/stat`: the second word after the name in parentheses.
fn parent(stat: &str) -> Option<u32> {
    stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse().ok()
}

/// Returns whether `command` starts and ends with status 0. Its output is not shown.
pub(crate) fn succeeds(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Returns the standard output of `command`, or `None` if it cannot be started or fails.
pub(crate) fn output_of(command: &mut Command) -> Option<String> {
    let output = command.stdin(Stdio::null()).stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Installs a target with rustup. Returns whether Rust can build for it.
pub(crate) fn has_target(target: &str) -> bool {
    succeeds(Command::new("rustup").args(["target", "add", target]))
}

/// Returns cargo's target folder.
pub(crate) fn target_folder() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// Returns whether lints and documentation are checked while tests are built.
pub(crate) fn lints_tests() -> bool {
    std::env::var(LINT_TESTS).is_ok_and(|value| !value.is_empty() && value != "0")
}

/// Makes rustc compile the packages of the workspace, even if clippy compiles them for other commands.
pub(crate) fn without_lints(command: &mut Command) -> &mut Command {
    command.env_remove(WRAPPER)
}

/// Makes clippy compile the packages of the workspace in place of rustc, with warnings as errors, like `cargo
/// clippy`. Lints then need no second build of all dependencies.
pub(crate) fn with_lints(command: &mut Command) -> &mut Command {
    command.env(WRAPPER, "clippy-driver").env("CLIPPY_ARGS", "-D__CLIPPY_HACKERY__warnings")
}

/// Configures Mesa's software driver for tests. Compiling a shader takes longer than drawing a small picture
/// with it, so shaders are compiled without optimisation and cached in the target folder.
pub(crate) fn with_driver_for_tests(command: &mut Command) -> &mut Command {
    with_runtime_folder(command).env("GALLIVM_PERF", "nopt").env("MESA_SHADER_CACHE_DIR", target_folder().join("mesa"))
}

/// Sets a runtime folder outside login sessions. Mesa warns without one, but does not use it here.
pub(crate) fn with_runtime_folder(command: &mut Command) -> &mut Command {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
    }
    command
}

/// Returns the command as typed in a shell: the program's name without its folder, then the arguments.
fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str()).to_string_lossy();
    let words = command.get_args().map(|arg| quoted(&arg.to_string_lossy()));
    std::iter::once(name.into_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Quotes `word` for a shell if necessary.
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

    #[cfg(unix)]
    #[test]
    fn a_program_s_output_is_returned_or_its_exit_code_handed_on() {
        let shell = |text: &str| printed_by(Command::new("sh").args(["-c", text]));
        assert_eq!(shell("echo ' a name '").unwrap(), "a name");
        assert_eq!(exit_code_of(&shell("echo text; exit 2").unwrap_err()), 2);
    }

    #[test]
    fn a_command_is_shown_as_it_would_be_typed() {
        let mut command = Command::new("/usr/bin/cargo");
        command.args(["nextest", "run", "-E", "not test(window)"]);
        assert_eq!(shown(&command), "cargo nextest run -E 'not test(window)'");
    }

    #[test]
    fn the_parent_is_found_behind_any_name() {
        assert_eq!(parent("12 (a) b) S 7 12 12 0"), Some(7));
        assert_eq!(parent("12 (cargo"), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn children_of_children_are_descendants() {
        let mut shell = Command::new("sh").args(["-c", "sleep 60 & wait"]).spawn().unwrap();
        let own = std::process::id();
        while descendants(shell.id()).is_empty() {
            std::thread::sleep(Duration::from_millis(10));
        }
        let children = descendants(own);
        assert!(children.contains(&shell.id()) && children.contains(&descendants(shell.id())[0]));
        for id in descendants(shell.id()) {
            succeeds(Command::new("kill").arg(id.to_string()));
        }
        shell.wait().unwrap();
        assert!(!descendants(own).contains(&shell.id()));
    }

    #[test]
    fn the_root_is_the_folder_of_the_workspace_manifest() {
        let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
        assert!(manifest.contains("[workspace]"));
    }
}
