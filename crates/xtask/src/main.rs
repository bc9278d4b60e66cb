//! Development tasks of the workspace. `cargo xtask run` and `cargo xtask test` are the README's two
//! commands. The others are for contributors and the continuous integration. Each task first checks the
//! machine and, on Debian and its derivatives, installs missing packages.

#![cfg_attr(not(feature = "tools"), allow(dead_code, reason = "other commands share it"))]

mod bevy;
#[cfg(feature = "tools")]
mod bundle;
#[cfg(feature = "tools")]
mod capi;
mod ci;
#[cfg(test)]
mod docs;
mod dxc;
mod figures;
#[cfg(feature = "tools")]
mod gallery;
mod generate;
mod green;
mod machine;
#[cfg(feature = "tools")]
mod maths;
#[cfg(feature = "tools")]
mod npm;
mod process;
#[cfg(feature = "tools")]
mod raylib;
#[cfg(feature = "tools")]
mod release;
mod run;
mod rustdoc;
mod setup;
#[cfg(feature = "tools")]
mod shaders;
mod source;
mod test;
#[cfg(feature = "tools")]
mod web;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::test::Tier;

/// Development tasks of the shadowfit workspace.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Fly through a scene in the viewer; without a display, render its set of pictures instead.
    #[command(disable_help_flag = true)]
    Run {
        /// Arguments of the viewer, for example a path to a .glb file; `--help` lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Run the tests of the workspace: unit, property, golden-image, window and doc tests.
    Test {
        /// Only the libraries without the viewer, in a minute: unit and property tests, WGSL, some pictures.
        #[arg(long)]
        quick: bool,
        /// Also the page, Bevy, hours in the window, full products and many random cases.
        #[arg(long, conflicts_with = "quick")]
        all: bool,
        /// Parts of the paths of the tests to run; without doc tests, page and Bevy.
        names: Vec<String>,
        /// Draws on this machine's GPU instead of the software adapter, without golden pictures and the
        /// window. The variable `SHADOWFIT_ADAPTER` names any other adapter.
        #[arg(long)]
        gpu: bool,
    },
    /// Write the tests and the examples as programs, with a runner, for machines without a Rust toolchain.
    Bundle {
        /// Folder of the bundle, new or empty.
        folder: std::path::PathBuf,
        /// Also builds OpenGL in: run with `WGPU_BACKEND=gl`.
        #[arg(long)]
        gles: bool,
    },
    /// Lint, document and test the package for Bevy.
    Bevy,
    /// Write the generated files: examples in documents, drawings of docs/MATHS.md, and shaders for engines without wgpu.
    Generate,
    /// Run every check before the tests: format, lints, docs, MSRV, `no_std`, dependencies, examples.
    Ci,
    /// Render the pictures of the README and the docs again.
    Gallery {
        /// Render only these: samples by their names, for example `xna-shadow-mapping`, `tour` for the pictures
        /// of the viewer's window, `raylib` for the example in C, or `film` for the film of the README.
        only: Vec<String>,
    },
    /// Measure with `shadowfit-bench` and write the tables to docs/figures: of the core crate, with
    /// `--gpu` of shadows on a GPU, or with `--growth` of costs by the size of the world.
    Bench {
        /// Arguments of the program's command `core`, `gpu` or `growth`: part of a bench's name, glTF files, `--quick`.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Measure the figures of README and BENCHMARKS again, on generated scenes: in about ten minutes with a software
    /// driver. The results are in out/figures.
    Figures(figures::Figures),
    /// Build the viewer as a web page, serve it on this machine and open it in the browser, if there is one.
    Web {
        /// Writes the page into this folder instead, for any host of static files.
        #[arg(long, value_name = "DIR")]
        build: Option<std::path::PathBuf>,
        /// Port to serve on; any free one if it is 0.
        #[arg(long, value_name = "PORT", default_value_t = 8080)]
        port: u16,
        /// Tests the page in headless Chromium, on software WebGPU and WebGL2.
        #[arg(long, conflicts_with = "build")]
        test: bool,
        /// Tests with ten minutes of random actions instead of a fraction of one.
        #[arg(long, requires = "test")]
        long: bool,
    },
    /// Build the npm package for three.js into out/npm.
    Npm {
        /// Tests it in headless Chromium, in a fresh project with a bundler and in a page without one.
        #[arg(long)]
        test: bool,
        /// Measures three.js's own pictures with it and with three.js's own shadows, judged by rays.
        #[arg(long, conflicts_with = "test")]
        figures: bool,
        /// Measures a few frames only.
        #[arg(long, requires = "figures")]
        quick: bool,
    },
    /// Build the C library, and write it with header, shaders and an example into an archive in out/c.
    Capi {
        /// Writes the archive into this folder instead.
        #[arg(long, value_name = "DIR")]
        archive: Option<std::path::PathBuf>,
        /// Tests the library in C, with sanitizers, in threads, and against the same fits in Rust.
        #[arg(long, conflicts_with = "archive")]
        test: bool,
        /// Fetches raylib, builds the example with it, and compares its shadows with rays.
        #[arg(long, conflicts_with_all = ["archive", "test"])]
        raylib: bool,
    },
    /// Prepare a release: check it, and print the commands that publish it.
    Release {
        /// Checks versions, changelog, tag, packages, features and lowest versions. Publishes nothing.
        #[arg(long, required_unless_present = "owner")]
        dry_run: bool,
        /// Neither builds bevy-shadowfit from its package nor runs `cargo xtask matrix`.
        #[arg(long, requires = "dry_run")]
        quick: bool,
        /// Writes the owner of the repository into all addresses.
        #[arg(long, value_name = "NAME", conflicts_with = "dry_run")]
        owner: Option<String>,
    },
    /// Check the packages with many combinations of features, with the lowest versions of their dependencies, and
    /// against the last release.
    Matrix,
    /// Rewrite the golden images of the tests; look at the diff before committing it.
    Golden,
}

fn main() -> ExitCode {
    if let Some(code) = rustdoc::as_rustdoc() {
        return code;
    }
    process::end_children_on_interrupt();
    let cli = Cli::try_parse().unwrap_or_else(|error| refuse(&error));
    let result = match cli.task {
        Task::Run { args } => run::run(&args),
        Task::Test { quick, all, names, gpu } => test::test(Tier::new(quick, all), &names, gpu),
        #[cfg(feature = "tools")]
        Task::Bundle { folder, gles } => bundle::bundle(&folder, gles),
        Task::Bevy => green::unless_unchanged(green::Suite::Bevy, bevy::check_and_test),
        Task::Ci => ci::ci(),
        #[cfg(feature = "tools")]
        Task::Generate => generate::generate(),
        Task::Golden => test::golden(),
        #[cfg(feature = "tools")]
        Task::Gallery { only } => gallery::gallery(&only),
        Task::Bench { args } => bench(&args),
        Task::Figures(options) => figures::figures(&options),
        #[cfg(feature = "tools")]
        Task::Web { test: true, long, .. } => green::unless_unchanged(green::Suite::Page, || web::test(long)),
        #[cfg(feature = "tools")]
        Task::Web { build, port, .. } => web::web(build.as_deref(), port),
        #[cfg(feature = "tools")]
        Task::Npm { test: true, .. } => green::unless_unchanged(green::Suite::Npm, npm::test),
        #[cfg(feature = "tools")]
        Task::Npm { figures: true, quick, .. } => npm::figures(quick),
        #[cfg(feature = "tools")]
        Task::Npm { .. } => npm::pack().map(|_| ()),
        #[cfg(feature = "tools")]
        Task::Capi { test: true, .. } => capi::test(),
        #[cfg(feature = "tools")]
        Task::Capi { raylib: true, .. } => raylib::test(),
        #[cfg(feature = "tools")]
        Task::Capi { archive, .. } => {
            capi::archive(&archive.unwrap_or_else(|| process::root().join("out/c"))).map(|_| ())
        }
        #[cfg(feature = "tools")]
        Task::Release { owner: Some(owner), .. } => release::set_owner(&owner),
        #[cfg(feature = "tools")]
        Task::Release { quick, .. } => release::dry_run(quick),
        #[cfg(feature = "tools")]
        Task::Matrix => release::matrix(),
        #[cfg(not(feature = "tools"))]
        Task::Bundle { .. }
        | Task::Capi { .. }
        | Task::Gallery { .. }
        | Task::Generate
        | Task::Matrix
        | Task::Npm { .. }
        | Task::Release { .. }
        | Task::Web { .. } => process::run(process::with_tools().args(std::env::args_os().skip(1))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(process::exit_code_of(&error))
        }
    }
}

/// Runs `shadowfit-bench`, which writes its tables to docs/figures.
fn bench(args: &[String]) -> anyhow::Result<()> {
    let (command, args) = match args.split_first() {
        Some((first, args)) if first == "--gpu" => ("gpu", args),
        Some((first, args)) if first == "--growth" => ("growth", args),
        _ => ("core", args),
    };
    let program = ["--release", "--package", "shadowfit-bench", "--", command, "--page"];
    process::run(process::cargo("run").args(program).args(args))
}

/// Prints the error in the command line and, for the tests, the list of tiers. Ends with clap's exit code: 2,
/// or 0 for help.
fn refuse(error: &clap::Error) -> ! {
    let _ = error.print();
    let is_for_tests = std::env::args().nth(1).is_some_and(|task| task == "test");
    if is_for_tests && error.use_stderr() {
        eprintln!("\n{}", test::TIERS);
    }
    std::process::exit(error.exit_code())
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::{Cli, Task};

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_task_but_the_viewer_has_help_of_its_own() {
        for task in [
            "test", "bundle", "bevy", "generate", "ci", "gallery", "bench", "figures", "web", "release", "matrix",
            "golden",
        ] {
            let asked = Cli::try_parse_from(["xtask", task, "--help"]).err().map(|error| error.kind());
            assert_eq!(asked, Some(clap::error::ErrorKind::DisplayHelp), "{task}");
        }
    }

    #[test]
    fn unknown_tiers_are_refused_with_exit_code_2() {
        for tier in ["--quik", "--slow", "--quick=1"] {
            let error = Cli::try_parse_from(["xtask", "test", tier]).err().expect("no such tier");
            assert_eq!(error.exit_code(), 2, "{tier}");
        }
        assert_eq!(Cli::try_parse_from(["xtask", "test", "--quick", "--all"]).err().unwrap().exit_code(), 2);
    }

    #[test]
    fn flags_after_run_reach_the_viewer() {
        for flags in [&["--size", "640x360", "--help"][..], &["--help"]] {
            let cli = Cli::try_parse_from(["xtask", "run"].iter().chain(flags)).unwrap();
            let Task::Run { args } = cli.task else { panic!("not the run task") };
            assert_eq!(args, flags);
        }
    }
}
