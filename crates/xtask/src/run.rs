//! `cargo xtask run`: the viewer in a window or, without a display, its set of pictures.

use std::path::Path;
use std::process::Command;

use anyhow::Result;

use crate::machine::{Display, Machine};
use crate::process;
use crate::setup::{self, Purpose};

/// Folder of the pictures without a display, relative to the workspace's folder.
const PICTURES: &str = "out/pictures";

/// Prepares the machine, builds the viewer and starts it with `args`.
///
/// # Errors
/// If the viewer cannot be built, or ends with an error. Its exit code is kept.
pub(crate) fn run(args: &[String]) -> Result<()> {
    let machine = setup::prepare(Purpose::Run)?;
    let pictures = process::root().join(PICTURES);
    let mut viewer = viewer(&machine);
    if machine.display != Display::None || needs_no_display(args) {
        return process::run(viewer.args(args));
    }
    eprintln!("no display (neither DISPLAY nor WAYLAND_DISPLAY is set): rendering the set of pictures instead");
    process::run(viewer.arg("--headless").arg(&pictures).args(args))?;
    say_where(&pictures);
    Ok(())
}

/// Returns the command that builds and starts the viewer, without the viewer's own arguments. The build is
/// optimised: with a software driver, rays and scene preparation share the CPU with rendering.
pub(crate) fn viewer(machine: &Machine) -> Command {
    let mut command = process::cargo_here("run");
    command.arg("--manifest-path").arg(process::root().join("Cargo.toml"));
    // Only the viewer's package: the workspace's examples and tests need more crates.
    command.args(["--release", "--package", "shadowfit-viewer", "--example", "viewer"]);
    command.args(setup::viewer_features(machine)).arg("--");
    process::with_runtime_folder(&mut command);
    command
}

/// Prints the folder of the pictures and their number.
pub(crate) fn say_where(folder: &Path) {
    let count = std::fs::read_dir(folder).map_or(0, |entries| {
        entries.flatten().filter(|entry| entry.path().extension().is_some_and(|extension| extension == "png")).count()
    });
    println!("{count} pictures in {}", folder.display());
}

/// Returns whether the viewer's arguments already select a mode without a window.
fn needs_no_display(args: &[String]) -> bool {
    args.iter().any(|arg| {
        matches!(arg.as_str(), "--headless" | "--check" | "--parameters" | "--help" | "-h" | "--version" | "-V")
            || arg.starts_with("--headless=")
    })
}

#[cfg(test)]
mod tests {
    use super::needs_no_display;

    #[test]
    fn only_a_flag_that_opens_no_window_keeps_the_arguments_as_they_are() {
        let asks = |args: &[&str]| needs_no_display(&args.iter().map(ToString::to_string).collect::<Vec<_>>());
        assert!(asks(&["--headless", "shots"]));
        assert!(asks(&["scene.glb", "--headless=shots"]));
        assert!(asks(&["--help"]));
        assert!(asks(&["--check", "--software"]));
        assert!(!asks(&["--size", "640x360"]));
        assert!(!asks(&["headless.glb"]));
        assert!(!asks(&[]));
    }
}
