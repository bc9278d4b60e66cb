//! Measures the cost of sun shadows.
//!
//! ```sh
//! # The core crate, by its benches.
//! cargo run --release -p shadowfit-bench -- core
//! # Shadows on a GPU: the courtyard, and a scene of its own.
//! cargo run --release -p shadowfit-bench -- gpu scene.glb
//! # Costs by the size of the world, on the CPU, with their curves.
//! cargo run --release -p shadowfit-bench -- growth --only fits --pictures out
//! # Scenes of any size: loading, rays, frames and memory.
//! cargo run --release -p shadowfit-bench -- scenes big.glb bigger.glb
//! ```
//!
//! With `--page`, the first three write their tables to `docs/figures`, as `cargo xtask bench` does.

mod core;
mod cuboid;
mod gpu;
mod growth;
mod page;
mod scenes;
mod table;
mod times;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};
use shadowfit_adapter::AdapterOptions;
use shadowfit_render::Gpu;

/// Exit code after bad input, like clap's own errors.
const BAD_INPUT: u8 = 2;

#[derive(Parser)]
#[command(about = "Measures the cost of sun shadows")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Time the core crate by its benches
    Core(core::Args),
    /// Time shadows on the GPU
    Gpu(gpu::Args),
    /// Time how costs grow with the world
    Growth(growth::Args),
    /// Measure the cost of scenes as they grow
    Scenes(scenes::Args),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Core(args) => core::run(&args),
        Command::Gpu(args) => gpu::run(&args),
        Command::Growth(args) => growth::run(&args),
        Command::Scenes(args) => scenes::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            shadowfit_study::tell(format!("error: {error:#}"));
            ExitCode::from(BAD_INPUT)
        }
    }
}

/// Opens the graphics adapter of the command line.
fn open(adapter: &AdapterOptions) -> Result<Gpu> {
    Ok(pollster::block_on(Gpu::headless(&adapter.choice()))?)
}

#[cfg(test)]
mod tests {
    use shadowfit_testing::commands::doc_commands;

    use super::*;

    #[test]
    fn every_command_of_the_docs_has_options_that_exist() {
        let mut count = 0;
        for command in doc_commands(&page::root()) {
            let Some(words) = command.program_arguments("shadowfit-bench") else { continue };
            // The help ends parsing after all other arguments, whether required ones are there or not.
            let words = ["shadowfit-bench".to_owned()].into_iter().chain(words).chain(["--help".to_owned()]);
            let error = Cli::try_parse_from(words).err().expect("help");
            assert_eq!(error.kind(), clap::error::ErrorKind::DisplayHelp, "{}: {error}", command.page);
            count += 1;
        }
        assert!(count >= 3, "{count}");
    }
}
