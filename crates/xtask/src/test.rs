//! `cargo xtask test`: doc tests, then every other test. Tests that the machine cannot run are left out by name, with
//! the reason said, so that the runner counts them as skipped and never as passed.

use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow, bail};

use crate::bevy;
use crate::machine::{Machine, Part, WEB_TARGET};
use crate::process;
use crate::setup::{self, Purpose};

/// The environment variable with which the golden tests write what they would compare.
const UPDATE_GOLDENS: &str = "SHADOWFIT_UPDATE_GOLDENS";

/// Why the page is not tested, where it is not.
const NO_PAGE: &str = "no Chromium, Node.js, npm, Vulkan driver or target of Rust for browsers here";

/// Tests that are left out, and why.
struct LeftOut {
    /// What their names hold, module path included.
    name_part: &'static str,
    reason: String,
}

/// Runs the tests; with `args` (part of a name, options of the runner) only those that they choose, without doc tests.
///
/// # Errors
/// When a test fails, and, where a GPU is required, when none is there.
pub(crate) fn test(args: &[String]) -> Result<()> {
    let machine = setup::prepare(Purpose::Test)?;
    let left_out = left_out(&machine);
    if setup::gpu_is_required() && !left_out.is_empty() {
        bail!("{} is set, and {}", setup::REQUIRE_GPU, left_out[0].reason);
    }
    let features = setup::features(&machine);
    // The window test starts the viewer, which a run of chosen tests would otherwise leave as it was.
    process::run(process::cargo("build").args(["--workspace", "--examples"]).args(features))?;
    if !args.is_empty() {
        return process::run(runner(features, &left_out).args(args));
    }
    // The runner with the most tests comes last, so that its counts close the output.
    let doc_tests = timed(process::cargo("test").args(["--workspace", "--doc", "--no-fail-fast"]).args(features));
    let tests = timed(&mut runner(features, &left_out));
    let bevy = bevy::Rust::find().map(|rust| timed_by(|| rust.test(&machine)));
    let can_test_page = machine.can_test_page() && process::has_target(WEB_TARGET);
    let page = can_test_page.then(|| timed_by(|| process::run(process::with_tools().args(["web", "--test"]))));
    for LeftOut { name_part, reason } in &left_out {
        println!("SKIPPED: tests with `{name_part}` in their name: {reason}");
    }
    match &bevy {
        Some((result, time)) => {
            println!("{} ({:.0} s)", verdict("tests of bevy-shadowfit", result), time.as_secs_f32());
        }
        None => println!("SKIPPED: tests of bevy-shadowfit: {}", bevy::NO_RUST),
    }
    match &page {
        Some((result, time)) => println!("{} ({:.0} s)", verdict("tests of the page", result), time.as_secs_f32()),
        None => println!("SKIPPED: tests of the page: {NO_PAGE}"),
    }
    println!(
        "{} ({:.0} s), {} ({:.0} s)",
        verdict("doc tests", &doc_tests.0),
        doc_tests.1.as_secs_f32(),
        verdict("all other tests", &tests.0),
        tests.1.as_secs_f32()
    );
    let page = match page {
        Some((result, _)) => result,
        None if setup::gpu_is_required() => Err(anyhow!("{} is set, and {NO_PAGE}", setup::REQUIRE_GPU)),
        None => Ok(()),
    };
    doc_tests.0.and(tests.0).and(bevy.map_or(Ok(()), |(result, _)| result)).and(page)
}

/// Runs the golden tests so that they write their pictures.
///
/// # Errors
/// When a golden test fails for another reason than its picture.
pub(crate) fn golden() -> Result<()> {
    let machine = setup::prepare(Purpose::Test)?;
    if !machine.has(Part::SoftwareDriver) {
        bail!("the golden images are rendered on Mesa's software driver, which is missing here");
    }
    process::run(runner(setup::features(&machine), &[]).arg("golden").env(UPDATE_GOLDENS, "1"))?;
    println!("look at the new pictures before committing them: git status, git diff --stat");
    Ok(())
}

fn timed(command: &mut Command) -> (Result<()>, Duration) {
    timed_by(|| process::run(command))
}

fn timed_by(work: impl FnOnce() -> Result<()>) -> (Result<()>, Duration) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed())
}

fn verdict(what: &str, result: &Result<()>) -> String {
    format!("{what} {}", if result.is_ok() { "passed" } else { "FAILED" })
}

/// What cannot run on `machine`.
fn left_out(machine: &Machine) -> Vec<LeftOut> {
    let mut left_out = Vec::new();
    if !machine.can_render() {
        let reason = "no Vulkan driver here (libvulkan.so.1 and a driver's manifest)".to_string();
        left_out.push(LeftOut { name_part: "gpu", reason: reason.clone() });
        left_out.push(LeftOut { name_part: "golden", reason });
    }
    if !machine.can_test_window() {
        let reason = "no Xvfb, xdotool, ImageMagick's import, X11 libraries or Vulkan driver here".to_string();
        left_out.push(LeftOut { name_part: "real_window", reason });
    }
    left_out
}

/// The test runner on the whole workspace: nextest where it is installed, cargo's own elsewhere.
fn runner(features: &[&str], left_out: &[LeftOut]) -> Command {
    if process::succeeds(process::cargo("nextest").arg("--version")) {
        let mut command = process::cargo("nextest");
        command.args(["run", "--workspace", "--no-fail-fast"]).args(features);
        if let Some(filter) = filter_expression(left_out) {
            command.args(["-E", &filter]);
        }
        return command;
    }
    eprintln!("cargo-nextest is not installed: running `cargo test` instead");
    let mut command = process::cargo("test");
    command.args(["--workspace", "--lib", "--bins", "--tests", "--no-fail-fast"]).args(features);
    if !left_out.is_empty() {
        command.arg("--").args(left_out.iter().flat_map(|tests| ["--skip", tests.name_part]));
    }
    command
}

/// Nextest's filter that leaves out the tests named in `left_out`, `None` when all may run.
fn filter_expression(left_out: &[LeftOut]) -> Option<String> {
    let parts: Vec<String> = left_out.iter().map(|tests| format!("test({})", tests.name_part)).collect();
    (!parts.is_empty()).then(|| format!("not ({})", parts.join(" | ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Display;

    #[test]
    fn a_complete_machine_leaves_nothing_out() {
        let left_out = left_out(&Machine::complete(Display::None));
        assert!(left_out.is_empty());
        assert_eq!(filter_expression(&left_out), None);
    }

    #[test]
    fn without_a_driver_everything_rendered_is_left_out_with_a_reason() {
        let mut machine = Machine::complete(Display::None);
        machine.parts.remove(&Part::VulkanDriver);
        let left_out = left_out(&machine);
        assert!(left_out.iter().all(|tests| !tests.reason.is_empty()));
        assert_eq!(filter_expression(&left_out).unwrap(), "not (test(gpu) | test(golden) | test(real_window))");
    }

    #[test]
    fn without_xdotool_only_the_window_test_is_left_out() {
        let mut machine = Machine::complete(Display::None);
        machine.parts.remove(&Part::Xdotool);
        assert_eq!(filter_expression(&left_out(&machine)).unwrap(), "not (test(real_window))");
    }
}
