//! Reports: how wrong the shadows of techniques are, measured against ray-traced truth.
//!
//! ```sh
//! # Techniques over an orbit and a flight through a scene: tables, plots, pictures, and a page that shows them.
//! cargo run --release --example report -- courtyard -o out/report
//! cargo run --release --example report -- town.glb --path walk.toml --config xna-1 --config mine.toml -o out/report
//! # The technique with the least error, within a budget.
//! cargo run --release --example report -- tune town.glb --maps 4 --resolution 2048 -o out/tuned
//! # Fit files of any code over 300 frames of five scenes, drawn by the same renderer.
//! cargo run --release --example report -- peers peers/scenarios.json peers/fits/*.json --assets assets -o out/peers
//! # The classes on the GPU: agreement with the processor, and milliseconds.
//! cargo run --release --example report -- live town.glb
//! ```

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

mod data;
mod drawing;
#[path = "../shared/geometry.rs"]
mod geometry;
mod heat;
mod interrupt;
mod job;
mod live;
mod overlay;
mod page;
mod path;
mod peers;
mod plots;
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
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    scene: Option<scene::Args>,
}

#[derive(Subcommand)]
enum Command {
    /// Measure fit files on the frames of a file of scenarios
    Peers(Box<peers::Args>),
    /// Search the technique with the least error
    Tune(Box<tune::Args>),
    /// Judge on the GPU, compare with the processor, and time it
    Live(Box<live::Args>),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
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
    match (cli.command, cli.scene) {
        (Some(Command::Peers(args)), _) => peers::run(&args, &interrupt)?,
        (Some(Command::Tune(args)), _) => tune::run(&args, &interrupt)?,
        (Some(Command::Live(args)), _) => live::run(&args, &interrupt)?,
        (None, Some(args)) => return scene::run(&args, &interrupt),
        (None, None) => anyhow::bail!("give a scene; --help says how"),
    }
    Ok(!interrupt.is_requested())
}
