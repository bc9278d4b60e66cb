//! `cargo xtask test`: the tests in three tiers. Tests that the machine cannot run are excluded by name, and
//! the reason is printed, so that the runner counts them as skipped and never as passed.
//!
//! Tests that draw (`gpu` or `golden` in their path) and tests of all WGSL (`wgsl`) run in one process per
//! test binary, since opening a device and writing the WGSL takes longer than most of them. Nextest runs each
//! other test in its own process. Tests with `own_process` in their path measure or limit their process, so
//! they always get their own.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::iter;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

use crate::bevy;
use crate::ci::portability;
use crate::dxc;
use crate::machine::{self, Machine, Part};
use crate::process;
use crate::rustdoc;
use crate::setup::{self, Purpose};

/// The environment variable that makes golden tests write their pictures instead of comparing them.
const UPDATE_GOLDENS: &str = "SHADOWFIT_UPDATE_GOLDENS";

/// Parts of the paths of tests that draw.
const DRAWING: [&str; 2] = ["gpu", "golden"];

/// Parts of the paths of tests that share a process.
const SHARING: [&str; 3] = ["gpu", "golden", "wgsl::"];

/// Part of the paths of tests that need their own process.
const OWN_PROCESS: &str = "own_process";

/// The example programs that tests start.
const STARTED: [&str; 2] = ["viewer", "opengl"];

/// Packages of the quick tier. They do not link egui or winit.
const QUICK_PACKAGES: [&str; 9] = [
    "shadowfit",
    "shadowfit-adapter",
    "shadowfit-gpu",
    "shadowfit-params",
    "shadowfit-rays",
    "shadowfit-scene",
    "shadowfit-testing",
    "shadowfit-truth",
    "shadowfit-wgpu",
];

/// Features of the quick tier, as the packages' tests need them.
const QUICK_FEATURES: &str = "shadowfit-wgpu/rays,shadowfit-truth/gpu";

/// Tests of the quick tier that share a process: the tests of all WGSL, and one file of drawing tests for
/// each way that Rust and WGSL can disagree in.
const QUICK_SHARING: [&str; 8] =
    ["wgsl::", "parity_gpu", "fade_gpu", "tents_gpu", "formats_gpu", "texel_offset_gpu", "culling_gpu", "cut_outs_gpu"];

/// Longer runs of random cases and of the window in the tier `--all`, by environment variable. Variables that
/// are already set keep their values.
const LONG_RUNS: [(&str, &str); 4] = [
    ("PROPTEST_CASES", "4096"),
    ("SHADOWFIT_MONKEY_SECONDS", "600"),
    ("SHADOWFIT_FLIGHT_SECONDS", "600"),
    ("SHADOWFIT_SCENE_SWITCHES", "200"),
];

/// The environment variable that chooses the adapter of every test that draws.
const ADAPTER: &str = "SHADOWFIT_ADAPTER";

/// Tests that need the software driver, by a part of their paths, with the reason.
const SOFTWARE_ONLY: [(&str, &str); 2] = [
    ("golden", "golden pictures are those of the software driver"),
    ("window::", "the window's virtual X server shows what the software driver draws"),
];

/// Pixel tests that also run on a second software driver: one file for each kind of driver difference, half a
/// minute in all.
const SECOND_DRIVER: [&str; 5] =
    ["clamp_gpu", "exact_counts_gpu", "fade_gpu", "texel_offset_gpu::float", "cached_maps_gpu::gpu_reversed"];

/// Help text about the tiers, for an unknown tier.
pub(crate) const TIERS: &str = "The tiers of tests are:\n  \
    cargo xtask test --quick  the libraries without the viewer: unit and property tests, WGSL, some pictures\n  \
    cargo xtask test          the workspace: every test that finds bugs in the Rust code, goldens, the window\n  \
    cargo xtask test --all    the workspace, the page, Bevy, hours in the window, full products, many random cases";

/// Selection of the tests to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tier {
    /// The libraries below the renderer, in a minute.
    Quick,
    /// The workspace, in minutes.
    Standard,
    /// The workspace with tests that take long, the page and Bevy.
    All,
}

impl Tier {
    pub(crate) const fn new(is_quick: bool, is_all: bool) -> Self {
        if is_quick {
            Self::Quick
        } else if is_all {
            Self::All
        } else {
            Self::Standard
        }
    }
}

/// Tests that are excluded, and the reason.
struct LeftOut {
    /// Part of their paths.
    name_part: &'static str,
    reason: String,
}

/// Runs the tests of a tier. With `names` (parts of paths) it runs only these tests, without doc tests, page
/// and Bevy. With `gpu` the tests draw on this machine's GPU.
///
/// # Errors
/// If a test fails, or if a GPU is required and missing.
pub(crate) fn test(tier: Tier, names: &[String], gpu: bool) -> Result<()> {
    let purpose = match tier {
        Tier::Quick => Purpose::Pictures,
        Tier::Standard => Purpose::Test,
        Tier::All => Purpose::TestAll,
    };
    let machine = setup::prepare(purpose)?;
    let left_out = left_out(&machine, tier);
    if setup::gpu_is_required() && !left_out.is_empty() {
        bail!("{} is set, and {}", setup::REQUIRE_GPU, left_out[0].reason);
    }
    let mut suite = Suite { tier, features: setup::features(&machine), left_out, adapter: None, dxc: None };
    if gpu {
        suite.draw_on(suite.hardware_adapter()?);
    } else if let Some(name) = std::env::var_os(ADAPTER).filter(|name| !name.is_empty() && machine.can_render()) {
        // Otherwise every test that draws would report this error.
        let label = suite.adapters(["--adapter".into(), name]).context(format!("{ADAPTER} is set"))?;
        println!("tests draw on {label}");
    }
    if tier != Tier::Quick {
        suite.build_examples()?;
        suite.find_dxc();
    }
    if !names.is_empty() {
        suite.say_left_out();
        return suite.named(names);
    }
    let mut report = Report::default();
    if tier != Tier::Quick {
        report.run("doc tests", || process::run(&mut suite.doc_tests()?));
    }
    report.run("tests that share a device", || process::run(&mut suite.sharing()));
    report.run("all other tests", || suite.others());
    if tier != Tier::Quick && suite.adapter.is_none() {
        report.run("tests of pixels on SwiftShader", || suite.on_second_driver());
    }
    if tier == Tier::All {
        report.run("tests of the core with the oldest glam", portability::suite_with_oldest_glam);
        report.run("lints and tests of bevy-shadowfit", bevy::check_and_test);
        report.run("tests of the page", || process::run(process::with_tools().args(["web", "--test", "--long"])));
        report.run("shadows in raylib", || process::run(process::with_tools().args(["capi", "--raylib"])));
        report.run("tests of the npm package", || process::run(process::with_tools().args(["npm", "--test"])));
        report.run("tests of the C library", || process::run(process::with_tools().args(["capi", "--test"])));
    }
    suite.say_left_out();
    report.finish()
}

/// Runs the golden tests so that they write their pictures.
///
/// # Errors
/// If a golden test fails for another reason than its picture.
pub(crate) fn golden() -> Result<()> {
    let machine = setup::prepare(Purpose::Test)?;
    if !machine.has(Part::SoftwareDriver) {
        bail!("the golden images are rendered on Mesa's software driver, which is missing here");
    }
    let suite = Suite {
        tier: Tier::Standard,
        features: setup::features(&machine),
        left_out: Vec::new(),
        adapter: None,
        dxc: None,
    };
    process::run(suite.in_one_process(&["golden"]).env(UPDATE_GOLDENS, "1"))?;
    println!("look at the new pictures before committing them: git status, git diff --stat");
    Ok(())
}

/// The tests of a tier on this machine, as commands.
struct Suite {
    tier: Tier,
    features: &'static [&'static str],
    left_out: Vec<LeftOut>,
    /// Name of the adapter that the tests draw on, unless the environment chooses it.
    adapter: Option<String>,
    /// Path of Microsoft's shader compiler.
    dxc: Option<PathBuf>,
}

impl Suite {
    /// Returns the name of this machine's GPU, preferring a discrete one.
    fn hardware_adapter(&self) -> Result<String> {
        let found = self.adapters(["--hardware".into()]);
        let name = found.context("`--gpu` needs a GPU. Without it, tests draw on the software adapter")?;
        ensure!(!name.is_empty(), "the GPU has no name, so tests cannot choose it");
        Ok(name)
    }

    /// Builds the examples that tests start. Otherwise they would start outdated ones.
    fn build_examples(&self) -> Result<()> {
        let mut build = process::cargo("build");
        build.arg("--workspace").args(self.features);
        if process::lints_tests() {
            build.args(["--examples", "--benches"]);
        } else {
            build.args(STARTED.iter().flat_map(|example| ["--example", example]));
        }
        process::run(&mut build)
    }

    /// Builds and runs the example that finds graphics adapters, and returns its output. If no adapter fits,
    /// the example lists all adapters.
    fn adapters<const N: usize>(&self, arguments: [OsString; N]) -> Result<String> {
        process::run(process::cargo("build").args(self.packages()).args(["--example", "adapters"]))?;
        let program = format!("debug/examples/adapters{}", std::env::consts::EXE_SUFFIX);
        process::printed_by(Command::new(process::target_folder().join(program)).args(arguments))
    }

    /// Finds Microsoft's shader compiler. Fetches it where a GPU is required. Without it, its tests are excluded.
    fn find_dxc(&mut self) {
        self.dxc = if setup::gpu_is_required() {
            dxc::fetch().unwrap_or_else(|error| {
                eprintln!("{error:#}; going on without");
                None
            })
        } else {
            dxc::fetched()
        };
        if self.dxc.is_none() {
            let reason = format!("Microsoft's shader compiler is missing; {}=1 fetches it", setup::REQUIRE_GPU);
            self.left_out.push(LeftOut { name_part: "dxc::", reason });
        }
    }

    /// Makes the tests draw on an adapter, and excludes the tests that need the software driver.
    fn draw_on(&mut self, adapter: String) {
        println!("tests draw on {adapter}");
        let needing_software = SOFTWARE_ONLY.map(|(name_part, why)| LeftOut { name_part, reason: why.to_owned() });
        self.left_out.extend(needing_software);
        self.adapter = Some(adapter);
    }

    fn say_left_out(&self) {
        for LeftOut { name_part, reason } in &self.left_out {
            println!("SKIPPED: tests with `{name_part}` in their path: {reason}");
        }
    }

    /// Returns cargo's arguments for the packages and their features.
    fn packages(&self) -> Vec<&'static str> {
        if self.tier == Tier::Quick {
            let packages = QUICK_PACKAGES.iter().flat_map(|package| ["--package", package]);
            return packages.chain(["--features", QUICK_FEATURES]).collect();
        }
        iter::once("--workspace").chain(self.features.iter().copied()).collect()
    }

    /// Returns cargo's arguments for the packages, their features and the kinds of targets with tests.
    fn targets(&self) -> Vec<&'static str> {
        let mut targets = self.packages();
        targets.extend(["--lib", "--bins", "--tests", "--no-fail-fast"]);
        targets
    }

    fn doc_tests(&self) -> Result<Command> {
        let mut command = process::cargo("test");
        command.args(["--workspace", "--doc", "--no-fail-fast"]).args(self.features);
        if process::lints_tests() {
            rustdoc::write_documentation(&mut command)?;
        }
        Ok(command)
    }

    /// Returns the command for the tests that share a device or the texts of WGSL, in one process per binary.
    fn sharing(&self) -> Command {
        self.in_one_process(if self.tier == Tier::Quick { &QUICK_SHARING } else { &SHARING })
    }

    /// Runs a few pixel tests on `SwiftShader`, which Chromium includes. If a GPU is required, Chromium is
    /// installed, and a missing `SwiftShader` is a failure.
    fn on_second_driver(&self) -> Result<()> {
        if setup::gpu_is_required() {
            setup::prepare(Purpose::SecondDriver)?;
        }
        let Some(manifest) = machine::swiftshader_manifest() else {
            println!("SKIPPED: tests of pixels on SwiftShader: Debian's package chromium, which has it, is missing");
            return Ok(());
        };
        let mut command = self.in_one_process(&SECOND_DRIVER);
        process::run(command.env("VK_DRIVER_FILES", manifest).env(ADAPTER, "SwiftShader"))
    }

    /// Returns the command for tests with any of `parts` in their paths, in one process per binary.
    fn in_one_process(&self, parts: &[&str]) -> Command {
        let mut command = process::cargo("test");
        command.args(self.targets()).arg("--quiet").arg("--").args(parts).args(["--skip", OWN_PROCESS]);
        // Each test waits half of its time, for the driver's threads or for its own.
        let threads = 2 * std::thread::available_parallelism().map_or(1, usize::from);
        command.arg(format!("--test-threads={threads}"));
        command.args(self.left_out.iter().flat_map(|tests| ["--skip", tests.name_part]));
        if self.tier == Tier::All {
            command.arg("--include-ignored");
        }
        self.prepared(command)
    }

    /// Runs the tests that do not draw, each in its own process if nextest is installed.
    fn others(&self) -> Result<()> {
        if has_nextest() {
            return process::run(&mut self.nextest(&self.filter_of_others()));
        }
        eprintln!("cargo-nextest is not installed: running `cargo test` instead");
        let mut command = process::cargo("test");
        command.args(self.targets()).arg("--");
        let left_out = self.left_out.iter().map(|tests| tests.name_part);
        command.args(SHARING.into_iter().chain([OWN_PROCESS]).chain(left_out).flat_map(|part| ["--skip", part]));
        process::run(&mut self.prepared(command))?;
        let mut own_process = process::cargo("test");
        own_process.args(self.targets()).args(["--", OWN_PROCESS, "--test-threads=1"]);
        process::run(&mut self.prepared(own_process))
    }

    /// Runs tests selected by parts of their paths, each in its own process.
    fn named(&self, names: &[String]) -> Result<()> {
        if has_nextest() {
            let left_out: Vec<String> =
                self.left_out.iter().map(|tests| format!("test({})", tests.name_part)).collect();
            let filter = if left_out.is_empty() { "all()".into() } else { format!("not ({})", left_out.join(" | ")) };
            return process::run(self.nextest(&filter).args(names));
        }
        let mut command = process::cargo("test");
        command.args(self.targets()).arg("--").args(names);
        command.args(self.left_out.iter().flat_map(|tests| ["--skip", tests.name_part]));
        process::run(&mut self.prepared(command))
    }

    fn nextest(&self, filter: &str) -> Command {
        let mut command = process::cargo("nextest");
        command.arg("run").args(self.targets()).args(["-E", filter]);
        if self.tier == Tier::All {
            command.args(["--run-ignored", "all"]);
        }
        self.prepared(command)
    }

    /// Returns nextest's filter for the tests that do not share a process.
    fn filter_of_others(&self) -> String {
        let any = |parts: &[&str]| parts.iter().map(|part| format!("test({part})")).collect::<Vec<_>>().join(" | ");
        let left_out: Vec<&str> = self.left_out.iter().map(|tests| tests.name_part).collect();
        let filter = format!("(not ({})) | test({OWN_PROCESS})", any(&SHARING));
        if left_out.is_empty() { filter } else { format!("({filter}) & not ({})", any(&left_out)) }
    }

    /// Sets the environment of the tests.
    fn prepared(&self, mut command: Command) -> Command {
        process::with_driver_for_tests(&mut command);
        if let Some(name) = &self.adapter {
            command.env(ADAPTER, name);
        }
        if let Some(library) = &self.dxc {
            command.env(dxc::LIBRARY, library);
        }
        if self.tier == Tier::All {
            for (variable, value) in LONG_RUNS {
                if std::env::var_os(variable).is_none() {
                    command.env(variable, value);
                }
            }
        }
        command
    }
}

fn has_nextest() -> bool {
    process::succeeds(process::cargo("nextest").arg("--version"))
}

/// The results of the parts of a run, in order.
#[derive(Default)]
struct Report {
    parts: Vec<(&'static str, Result<()>, Duration)>,
}

impl Report {
    /// Runs a part. Later parts run even if it fails.
    fn run(&mut self, name: &'static str, work: impl FnOnce() -> Result<()>) {
        let start = Instant::now();
        let result = work();
        self.parts.push((name, result, start.elapsed()));
    }

    /// Prints a line for each part. Returns the first failure.
    fn finish(self) -> Result<()> {
        for (name, result, time) in &self.parts {
            let verdict = if result.is_ok() { "passed" } else { "FAILED" };
            println!("{:7.1} s  {name} {verdict}", time.as_secs_f32());
        }
        self.parts.into_iter().try_for_each(|(_, result, _)| result)
    }
}

/// Returns the tests of a tier that cannot run on `machine`.
fn left_out(machine: &Machine, tier: Tier) -> Vec<LeftOut> {
    let mut left_out = BTreeMap::new();
    if !machine.can_render() {
        for part in DRAWING {
            left_out.insert(part, "no Vulkan driver here (libvulkan.so.1 and a driver's manifest)");
        }
    }
    if tier != Tier::Quick && !machine.can_test_window() {
        left_out.insert("window::", "no Xvfb, xdotool, ImageMagick's import, X11 libraries or Vulkan driver here");
    }
    if tier != Tier::Quick && !machine.has(Part::Glslang) {
        left_out.insert("glslang::", "no glslangValidator here");
    }
    if tier != Tier::Quick && !machine.has(Part::Egl) {
        left_out.insert("opengl_gpu", "no libEGL.so.1 here");
    }
    left_out.into_iter().map(|(name_part, reason)| LeftOut { name_part, reason: reason.to_owned() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Display;

    fn suite(machine: &Machine, tier: Tier) -> Suite {
        Suite { tier, features: &[], left_out: left_out(machine, tier), adapter: None, dxc: None }
    }

    #[test]
    fn a_complete_machine_leaves_nothing_out() {
        let suite = suite(&Machine::complete(Display::None), Tier::Standard);
        assert!(suite.left_out.is_empty());
        assert_eq!(suite.filter_of_others(), "(not (test(gpu) | test(golden) | test(wgsl::))) | test(own_process)");
    }

    #[test]
    fn without_a_driver_everything_rendered_is_left_out_with_a_reason() {
        let mut machine = Machine::complete(Display::None);
        machine.parts.remove(&Part::VulkanDriver);
        let suite = suite(&machine, Tier::Standard);
        assert!(suite.left_out.iter().all(|tests| !tests.reason.is_empty()));
        let filter = suite.filter_of_others();
        assert!(filter.ends_with(" & not (test(golden) | test(gpu) | test(window::))"), "{filter}");
    }

    #[test]
    fn without_xdotool_only_the_window_tests_are_left_out_and_the_quick_tier_has_none() {
        let mut machine = Machine::complete(Display::None);
        machine.parts.remove(&Part::Xdotool);
        assert!(suite(&machine, Tier::Standard).filter_of_others().ends_with(" & not (test(window::))"));
        assert!(suite(&machine, Tier::Quick).left_out.is_empty());
    }

    #[test]
    fn on_a_gpu_golden_pictures_and_the_window_are_left_out_and_the_tests_get_its_name() {
        let mut suite = suite(&Machine::complete(Display::None), Tier::Standard);
        suite.draw_on("Some GPU".into());
        assert!(suite.filter_of_others().ends_with(" & not (test(golden) | test(window::))"));
        let command = suite.sharing();
        let adapter = command.get_envs().find(|(name, _)| *name == ADAPTER);
        assert_eq!(adapter, Some((ADAPTER.as_ref(), Some("Some GPU".as_ref()))));
        let words: Vec<_> = command.get_args().collect();
        assert!(words.windows(2).any(|pair| pair == ["--skip", "golden"]), "{words:?}");
    }

    #[test]
    fn only_the_last_tier_runs_ignored_tests() {
        let machine = Machine::complete(Display::None);
        let words = |tier| {
            let command = suite(&machine, tier).sharing();
            command.get_args().map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>()
        };
        assert!(words(Tier::All).contains(&"--include-ignored".to_owned()));
        assert!(!words(Tier::Standard).contains(&"--include-ignored".to_owned()));
        assert!(words(Tier::Quick).contains(&"shadowfit-wgpu".to_owned()));
    }
}
