//! Tests of the page in headless Chromium: `tests/web/page.test.mjs`, driven by playwright-core.

use std::path::Path;
use std::process::Command;
use std::{fs, thread};

use anyhow::{Context, Result, bail};

use super::{Modules, build, serve};
use crate::machine::{BROWSERS, Machine};
use crate::process::{self, target_folder};
use crate::setup::{self, Purpose};

/// Size of the window for comparing its pictures with the page's, in pixels. `page.test.mjs` uses the same
/// size.
const SIZE: &str = "720x300";

/// Builds the page with little optimisation and tests it. `is_long` adds ten minutes of random actions.
///
/// # Errors
/// If a program is missing or a test fails.
pub(crate) fn test(is_long: bool) -> Result<()> {
    let machine = setup::prepare(Purpose::Page)?;
    if !machine.can_test_page() {
        bail!("the page cannot be tested: Chromium, Node.js or npm is missing");
    }
    let folder = target_folder().join("web-test");
    let page = folder.join("page");
    build(&page, Modules::Quick)?;
    let tests = process::root().join("tests/web");
    let native = folder.join("native");
    play(&machine, &tests.join("tour.txt"), &native)?;
    let modules = folder.join("tests");
    copy(&tests, &modules)?;
    process::run(Command::new("npm").args(["install", "--no-audit", "--no-fund", "--silent"]).current_dir(&modules))?;
    let address = serve_beside(page);
    let mut node = Command::new("node");
    // Without `--test`, which starts another process: this one ends its browser when it is ended.
    node.args(["--test-reporter=spec", "page.test.mjs"]).current_dir(&modules);
    node.env("PAGE", address).env("NATIVE", &native).env("BROWSER", browser()?);
    node.env("ASSETS", process::root().join("../shared/assets"));
    if is_long {
        node.env("LONG", "1");
    }
    process::run(&mut node)
}

/// Plays a script in the native viewer with the software driver. The files that it saves stay in `folder`.
fn play(machine: &Machine, script: &Path, folder: &Path) -> Result<()> {
    // Use the program and features of the workspace's tests, so that it is built once.
    let mut compiler = process::cargo("build");
    process::run(compiler.args(["--workspace", "--example", "viewer"]).args(setup::features(machine)))?;
    let program = format!("debug/examples/viewer{}", std::env::consts::EXE_SUFFIX);
    let mut viewer = Command::new(target_folder().join(program));
    viewer.current_dir(process::root()).arg("--headless").arg(folder);
    viewer.args(["--no-state", "--software", "--size", SIZE]).arg("--script").arg(script);
    process::run(process::with_driver_for_tests(&mut viewer))
}

/// Copies the files of a folder, so that npm does not install into the sources.
fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("cannot create {}", to.display()))?;
    for entry in fs::read_dir(from)? {
        let file = entry?.path();
        if file.is_file() {
            fs::copy(&file, to.join(file.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}

/// Serves a folder on a thread that ends with the process. Returns its address.
fn serve_beside(folder: std::path::PathBuf) -> String {
    let (sender, address) = std::sync::mpsc::channel();
    thread::spawn(move || {
        let served = serve::serve(&folder, 0, |address| {
            // The receiver waits for it.
            let _ = sender.send(address.to_owned());
        });
        if let Err(error) = served {
            eprintln!("{error:#}");
        }
    });
    address.recv().unwrap_or_default()
}

/// Returns the path of the installed browser.
pub(crate) fn browser() -> Result<String> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&path)
        .flat_map(|folder| BROWSERS.map(|name| folder.join(name)))
        .find(|program| program.is_file());
    Ok(found.context("Chromium is missing")?.to_string_lossy().into_owned())
}
