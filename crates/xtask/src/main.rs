//! Development tasks of the workspace: `cargo xtask run` and `cargo xtask test` are the README's two commands, the
//! others are what a contributor and the continuous integration call. Each task first looks at what the machine has
//! and, on Debian and systems derived from it, installs what is missing.

#![cfg_attr(not(feature = "tools"), allow(dead_code, reason = "other commands share it"))]

#[cfg(feature = "tools")]
mod bench;
mod bevy;
mod ci;
#[cfg(test)]
mod docs;
#[cfg(feature = "tools")]
mod gallery;
mod machine;
#[cfg(feature = "tools")]
mod maths;
mod process;
mod run;
mod setup;
mod test;
#[cfg(feature = "tools")]
mod web;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

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
    /// Run every test of the workspace: unit, property, golden-image, window and doc tests.
    Test {
        /// Arguments of the test runner, for example part of a test's name; doc tests are then left out.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Run every check that comes before the tests: format, lints, docs, MSRV, `no_std`, dependencies, examples.
    Ci,
    /// Render the pictures of the README and the docs again.
    Gallery {
        /// What alone is rendered: samples by their names, for example `xna-shadow-mapping`, or `film` for the film of
        /// the README.
        only: Vec<String>,
    },
    /// Draw those pictures of docs/MATHS.md again that show what the core crate's fits give.
    Maths,
    /// Measure the core crate, with `--gpu` what shadows cost on a GPU, or with `--growth` how costs grow with the world,
    /// and write the times and ratios into docs/BENCHMARKS.md.
    Bench {
        /// Arguments of the benches, for example part of a name or `--quick`; after `--gpu` those of the example
        /// `gpu_cost`, for example glTF files, or `--from FILE` for what it wrote on another machine; after `--growth`
        /// those of the example `growth`.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Build the viewer as a web page, serve it on this machine and open it in the browser where there is one.
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
        /// The same with ten minutes of random actions instead of a fraction of one.
        #[arg(long, requires = "test")]
        long: bool,
    },
    /// Rewrite the golden images of the tests from what is rendered now; look at the diff before committing it.
    Golden,
}

fn main() -> ExitCode {
    let result = match Cli::parse().task {
        Task::Run { args } => run::run(&args),
        Task::Test { args } => test::test(&args),
        Task::Ci => ci::ci(),
        Task::Golden => test::golden(),
        #[cfg(feature = "tools")]
        Task::Gallery { only } => gallery::gallery(&only),
        #[cfg(feature = "tools")]
        Task::Maths => maths::maths(),
        #[cfg(feature = "tools")]
        Task::Bench { args } => bench::bench(&args),
        #[cfg(feature = "tools")]
        Task::Web { test: true, long, .. } => web::test(long),
        #[cfg(feature = "tools")]
        Task::Web { build, port, .. } => web::web(build.as_deref(), port),
        #[cfg(not(feature = "tools"))]
        Task::Gallery { .. } | Task::Maths | Task::Bench { .. } | Task::Web { .. } => {
            process::run(process::with_tools().args(std::env::args_os().skip(1)))
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(process::exit_code_of(&error))
        }
    }
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
        for task in ["test", "ci", "gallery", "maths", "bench", "web", "golden"] {
            let asked = Cli::try_parse_from(["xtask", task, "--help"]).err().map(|error| error.kind());
            assert_eq!(asked, Some(clap::error::ErrorKind::DisplayHelp), "{task}");
        }
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
