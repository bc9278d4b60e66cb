//! Reports: the errors of techniques' shadows, measured against ray-traced truth.
//!
//! ```sh
//! # Techniques over an orbit and a flight through a scene: tables, plots, pictures, and a page that shows them.
//! cargo run --release -p shadowfit-report -- courtyard -o out/report
//! cargo run --release -p shadowfit-report -- town.glb --path walk.toml --technique xna-1 --technique mine.toml -o out/report
//! # The technique with the least error, within a budget.
//! cargo run --release -p shadowfit-report -- tune town.glb --maps 4 --resolution 2048 -o out/tuned
//! # Fit files made by any code over 300 frames of five scenes, drawn by the same renderer.
//! cargo run --release -p shadowfit-report -- peers peers/scenarios.json peers/fits/*.json --assets assets -o out/peers
//! # A fit file of a technique, for comparison with the fits of other engines, and the casters that culling leaves.
//! cargo run --release -p shadowfit-report -- fit peers/scenarios.json --fit clusters-4 --assets assets -o clusters-4.json
//! cargo run --release -p shadowfit-report -- culling peers/scenarios.json --assets assets
//! # Pixels judged on the GPU: how far that agrees with the CPU, and how long it takes.
//! cargo run --release -p shadowfit-report -- live town.glb
//! ```

use std::ffi::OsString;
use std::process::ExitCode;

use anyhow::Result;
use clap::{CommandFactory, Parser, Subcommand};

mod culling;
mod drawing;
mod figures;
mod fit;
mod inputs;
mod interrupt;
mod job;
mod live;
mod path;
mod peers;
mod scene;
mod tune;

use interrupt::{INTERRUPTED, Interrupt};

/// Exit code after bad input. It is also clap's exit code.
const BAD_INPUT: u8 = 2;

#[derive(Parser)]
#[command(
    about = "Measures how wrong shadows are, against ray-traced truth",
    after_help = "Exit codes: 0; 2 after bad input, or if a file cannot be written; 130 after Ctrl-C, when all \
                  finished parts have been written."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compare techniques over a camera path; the default command
    Scene(Box<scene::Args>),
    /// Reproduce the figures of README and BENCHMARKS on generated scenes
    Figures(Box<figures::Args>),
    /// Measure fit files on the frames of a file of scenarios
    Peers(Box<peers::Args>),
    /// Search the technique with the least error
    Tune(Box<tune::Args>),
    /// Judge on the GPU, compare with the CPU, and time it
    Live(Box<live::Args>),
    /// Fit maps to the frames of a file of scenarios, as a fit file for `peers`
    Fit(Box<fit::Args>),
    /// Count the casters and triangles of each shadow pass after culling
    Culling(Box<culling::Args>),
}

/// Returns the arguments, with the default command if none is named.
fn arguments(given: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = given.into_iter().collect();
    let command = Cli::command();
    let is_command = |word: &OsString| {
        let named = command.get_subcommands().any(|known| known.get_name() == word);
        named || ["help", "--help", "-h"].iter().any(|help| help == word)
    };
    if arguments.get(1).is_some_and(|first| !is_command(first)) {
        arguments.insert(1, "scene".into());
    }
    arguments
}

fn main() -> ExitCode {
    let cli = Cli::parse_from(arguments(std::env::args_os()));
    match run(cli) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(INTERRUPTED),
        Err(error) => {
            shadowfit_study::tell(format_args!("error: {error:#}"));
            ExitCode::from(BAD_INPUT)
        }
    }
}

/// Runs the command. Returns false if Ctrl-C stopped it early.
fn run(cli: Cli) -> Result<bool> {
    match cli.command {
        // Ctrl-C ends these at once: they write nothing before they are finished.
        Command::Fit(args) => fit::run(&args).map(|()| true),
        Command::Culling(args) => culling::run(&args).map(|()| true),
        Command::Scene(args) => scene::run(&args, &Interrupt::install()?),
        Command::Figures(args) => figures::run(&args, &Interrupt::install()?),
        Command::Peers(args) => interruptible(|interrupt| peers::run(&args, interrupt)),
        Command::Tune(args) => interruptible(|interrupt| tune::run(&args, interrupt)),
        Command::Live(args) => interruptible(|interrupt| live::run(&args, interrupt)),
    }
}

/// Runs a command that finishes early at Ctrl-C. Returns whether it finished all of its work.
fn interruptible(command: impl FnOnce(&Interrupt) -> Result<()>) -> Result<bool> {
    let interrupt = Interrupt::install()?;
    command(&interrupt)?;
    Ok(!interrupt.is_requested())
}
