//! Reports: how shadow-map fits compare on the same frames.
//!
//! ```sh
//! # Columns of fit files over 300 frames of five scenes, as table.json and table.md.
//! cargo run --release --example report -- peers peers/scenarios.json peers/fits/*.json --assets assets -o out/peers
//! # A quick look with one ray of 16.
//! cargo run --release --example report -- peers peers/scenarios.json fit.json --assets assets --stride 4 -o out/peers
//! ```

use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod data;
#[path = "../shared/geometry.rs"]
mod geometry;
mod heat;
mod interrupt;
mod overlay;
mod page;
mod path;
mod peers;
mod plots;
mod tables;
mod text;
mod write;

/// What bad input ends with, as clap's own complaints do.
const BAD_INPUT: u8 = 2;

#[derive(Parser)]
#[command(about = "Compares shadow-map fits")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Measure fit files on the frames of a file of scenarios
    Peers(peers::Args),
}

fn main() -> ExitCode {
    let Cli { command: Command::Peers(args) } = Cli::parse();
    match peers::run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(BAD_INPUT)
        }
    }
}
