//! Fits shadow maps to the frames of a file of scenarios, so that they can be measured beside the fits of other
//! engines: `report peers` reads what this writes.
//!
//! ```sh
//! cargo run --release --example peer_fit -- --fit list
//! cargo run --release --example peer_fit -- peers/scenarios.json --fit clusters-4 --assets assets -o clusters-4.json
//! ```

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Parser;
use glam::UVec2;
use shadowfit::SplitScheme;
use shadowfit_study::{ReceiverSource, Technique};
use shadowfit_truth::peers::Scenarios;

#[path = "../shared/geometry.rs"]
mod geometry;
mod runner;

use geometry::Source;

/// What bad input ends with, as clap's own complaints do.
const BAD_INPUT: u8 = 2;

#[derive(Parser)]
#[command(about = "Fits shadow maps to the frames of a file of scenarios")]
struct Args {
    /// Scenes, cameras and lights
    #[arg(value_name = "SCENARIOS.json")]
    scenarios: Option<PathBuf>,
    /// Name of a technique, or "list" for all of them
    #[arg(long, value_name = "NAME|list")]
    fit: String,
    /// Width and height of the maps, in texels
    #[arg(long, default_value_t = 2048, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=65536))]
    resolution: u32,
    #[command(flatten)]
    geometry: Option<Source>,
    /// The fit file to write
    #[arg(short, value_name = "OUT.json")]
    out: Option<PathBuf>,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let result = if args.fit == "list" {
        list();
        Ok(())
    } else {
        run(&args)
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(BAD_INPUT)
        }
    }
}

fn list() {
    for (name, what) in Technique::names() {
        println!("{name:12} {what}");
    }
}

fn run(args: &Args) -> Result<()> {
    let known = || format!("--fit {}: there is no such technique; --fit list names them", args.fit);
    let mut technique = Technique::named(&args.fit).with_context(known)?;
    technique.maps.fit.resolution = UVec2::splat(args.resolution);
    // The measures of fits are of points: no filter reads beside them.
    technique.maps.fit.kernel_margin = 0.0;
    let scenarios = args.scenarios.as_ref().context("give the file of scenarios")?;
    let out = args.out.as_ref().context("give the file to write with -o OUT.json")?;
    let scenarios = Scenarios::read(scenarios)?;
    let needs = technique.receivers == ReceiverSource::Clusters || technique.maps.splits == SplitScheme::FromHistogram;
    ensure!(
        !needs || args.geometry.is_some(),
        "--fit {} needs the scenes' triangles: give --assets DIR or --triangles DIR",
        args.fit
    );
    let source = args.geometry.as_ref().filter(|_| needs);
    let file = runner::run(&scenarios, &technique, source)?;
    file.write(out)?;
    println!(
        "{}: {} frames, {:.1} µs a frame",
        out.display(),
        file.frames.len(),
        file.ns_per_fit.unwrap_or(0.0) * 1e-3
    );
    Ok(())
}
