//! Reports: how wrong the shadows of techniques are, measured against ray-traced truth.
//!
//! ```sh
//! # Techniques over an orbit and a flight through a scene: tables, plots, pictures, and a page that shows them.
//! cargo run --release --example report -- courtyard -o out/report
//! cargo run --release --example report -- town.glb --path walk.toml --technique xna-1 --technique mine.toml -o out/report
//! # The technique with the least error, within a budget.
//! cargo run --release --example report -- tune town.glb --maps 4 --resolution 2048 -o out/tuned
//! # Fit files made by any code over 300 frames of five scenes, drawn by the same renderer.
//! cargo run --release --example report -- peers peers/scenarios.json peers/fits/*.json --assets assets -o out/peers
//! # Pixels judged on the GPU: how far that agrees with the CPU, and how long it takes.
//! cargo run --release --example report -- live town.glb
//! ```

use std::ffi::OsString;
use std::process::ExitCode;

use anyhow::Result;
use clap::{CommandFactory, Parser, Subcommand};

mod data;
mod drawing;
#[path = "../shared/geometry.rs"]
mod geometry;
mod heat;
#[path = "../shared/inputs.rs"]
mod inputs;
mod interrupt;
mod job;
mod live;
mod overlay;
mod page;
mod path;
mod peers;
mod plots;
#[path = "../shared/plotting.rs"]
mod plotting;
mod png;
mod scene;
mod tables;
mod text;
mod tune;
mod write;

use interrupt::{INTERRUPTED, Interrupt};

/// What bad input ends with, as clap's own complaints do.
const BAD_INPUT: u8 = 2;

#[derive(Parser)]
#[command(
    about = "Measures how wrong shadows are, against ray-traced truth",
    after_help = "Exit codes: 0; 2 after bad input, or where a file cannot be written; 130 after Ctrl-C, when what was \
                  finished has been written."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compare techniques over a camera path; what is meant when no command is named
    Scene(Box<scene::Args>),
    /// Measure fit files on the frames of a file of scenarios
    Peers(Box<peers::Args>),
    /// Search the technique with the least error
    Tune(Box<tune::Args>),
    /// Judge on the GPU, compare with the CPU, and time it
    Live(Box<live::Args>),
}

/// The arguments, with the command that is meant when none is named.
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
            eprintln!("error: {error:#}");
            ExitCode::from(BAD_INPUT)
        }
    }
}

/// Whether all was done, Ctrl-C aside.
fn run(cli: Cli) -> Result<bool> {
    let interrupt = Interrupt::install()?;
    match cli.command {
        Command::Scene(args) => return scene::run(&args, &interrupt),
        Command::Peers(args) => peers::run(&args, &interrupt)?,
        Command::Tune(args) => tune::run(&args, &interrupt)?,
        Command::Live(args) => live::run(&args, &interrupt)?,
    }
    Ok(!interrupt.is_requested())
}
