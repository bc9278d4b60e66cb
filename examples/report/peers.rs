//! `report peers`: the measures of fit files, as a table for people and one for programs.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit_truth::Tracer;
use shadowfit_truth::peers::{FitFile, Scenarios, Study, overall_markdown, to_json, to_markdown};

use crate::geometry::Source;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scenes, cameras and lights
    scenarios: PathBuf,
    /// Maps that a fit made for each frame
    #[arg(required = true)]
    fits: Vec<PathBuf>,
    #[command(flatten)]
    geometry: Source,
    /// Take every Nth ray across and down: a quick look, its figures are approximate
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=180))]
    stride: u32,
    /// Folder for table.json and table.md
    #[arg(short, value_name = "DIR")]
    out: PathBuf,
}

/// Measures, writes both tables, and prints the rows over all frames.
pub(crate) fn run(args: &Args) -> Result<()> {
    let mut study = Study::new(Scenarios::read(&args.scenarios)?);
    for file in &args.fits {
        study.add(&FitFile::read(file)?, file)?;
    }
    measure(&mut study, &args.geometry, args.stride)?;
    let tables = study.tables();
    fs::create_dir_all(&args.out).with_context(|| format!("{}: cannot be made", args.out.display()))?;
    write(&args.out.join("table.json"), &to_json(&tables))?;
    write(&args.out.join("table.md"), &to_markdown(&tables))?;
    print!("{}", overall_markdown(&tables));
    Ok(())
}

fn measure(study: &mut Study, source: &Source, stride: u32) -> Result<()> {
    let progress = ProgressBar::new(study.scenarios().frames.len() as u64);
    progress.set_style(ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len} frames, {eta} left")?);
    for (index, scene) in study.scenarios().scenes.clone().iter().enumerate() {
        progress.set_message(scene.name.clone());
        let tracer = Tracer::new(source.read(scene)?.into_iter().flatten());
        study.measure_scene(index, &tracer, stride, &|| progress.inc(1));
    }
    progress.finish_and_clear();
    Ok(())
}

fn write(file: &Path, text: &str) -> Result<()> {
    fs::write(file, text).with_context(|| format!("{}: cannot be written", file.display()))
}
