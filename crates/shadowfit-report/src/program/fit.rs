//! `shadowfit-report fit`: fits shadow maps to the frames of a scenario file, for comparison with the fits of
//! other engines. The command `peers` reads the resulting fit file.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use shadowfit::{PRESETS, Preset};
use shadowfit_params::{BoxSource, NAMED_INPUTS, NamedInputs};
use shadowfit_report::geometry::Source;
use shadowfit_report::peers::Scenarios;
use shadowfit_study::{NamedTechnique, check_place, make_folder, print, write_whole};

mod runner;

use super::inputs::InputArgs;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scenes, cameras and lights
    #[arg(value_name = "SCENARIOS.json")]
    scenarios: Option<PathBuf>,
    /// Technique, by name or as a TOML file, or "list" for all names
    #[arg(long, value_name = "NAME|FILE.toml|list")]
    fit: String,
    /// Width and height of the maps, in texels [default: the technique's own, 2048 for named ones]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=65536))]
    resolution: Option<u32>,
    #[command(flatten)]
    inputs: InputArgs,
    #[command(flatten)]
    geometry: Option<Source>,
    /// The fit file to write
    #[arg(short, value_name = "OUT.json")]
    out: Option<PathBuf>,
}

/// Returns the presets and the names with inputs, with a paragraph for each.
fn list() -> String {
    let preset = |preset: &Preset| format!("{:15} {}\n{:15} {}\n", preset.name, preset.summary, "", preset.advice);
    let named = |named: &NamedInputs| format!("{:15} {}, {}\n", named.name, named.preset, named.inputs);
    PRESETS.iter().map(preset).chain(NAMED_INPUTS.iter().map(named)).collect()
}

/// Fits, and writes the fit file.
pub(crate) fn run(args: &Args) -> Result<()> {
    if args.fit == "list" {
        return print(list());
    }
    let mut named = NamedTechnique::find(&args.fit).with_context(|| format!("--fit {}", args.fit))?;
    if let Some(texels) = args.resolution {
        named = named.with_resolution(texels);
    }
    named.inputs = args.inputs.changed(named.inputs);
    // Fits are measured at points, so no border is needed for a filter.
    let technique = &mut named.technique;
    technique.fit.border = Some(0.0);
    let scenarios = args.scenarios.as_ref().context("give the file of scenarios")?;
    let out = args.out.as_ref().context("give the file to write with -o OUT.json")?;
    let scenarios = Scenarios::read(scenarios)?;
    let needs = named.inputs.boxes == BoxSource::Clusters || named.inputs.tell(&named.technique);
    ensure!(
        !needs || args.geometry.is_some(),
        "--fit {} needs the scenes' triangles: give --assets DIR or --triangles DIR, or \
         --boxes objects --unseen",
        args.fit
    );
    let source = args.geometry.as_ref().filter(|_| needs);
    if let Some(folder) = out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        make_folder(folder)?;
    }
    check_place(out)?;
    let (file, times) = runner::run(&scenarios, &named, source)?;
    write_whole(out, file.to_json(out)?.as_bytes())?;
    let [median, slowest, first] = [times.median, times.slowest, times.first].map(|nanoseconds| nanoseconds * 1e-3);
    print(format_args!(
        "{}: {} frames, {median:.1} µs for the median frame, {slowest:.1} µs for the slowest, {first:.1} µs for the \
         slowest first frame of a path\n",
        out.display(),
        file.frames.len(),
    ))
}
