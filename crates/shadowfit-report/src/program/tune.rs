//! `report tune`: searches the technique with the least error in a scene, within a budget.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit_study::{Budget, TuneSettings, Tuned, View, Weights, make_folder, print, tune, write_whole};

use crate::interrupt::Interrupt;
use crate::job::Job;

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    job: Job,
    /// Greatest number of maps
    #[arg(long, default_value_t = 4, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8))]
    maps: u32,
    /// Width and height of each map, in texels
    #[arg(long, default_value_t = 2048, value_name = "N", value_parser = clap::value_parser!(u32).range(256..=8192))]
    resolution: u32,
    /// Number of measured frames of the path, evenly spread
    #[arg(long, default_value_t = 12, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    #[arg(
        long,
        value_name = "NAME=WEIGHT,...",
        value_parser = weights,
        default_value = "",
        hide_default_value = true,
        help = "Weights of errors, such as \"wrong=1,hole=20\": wrong, false_shadow, false_light, hole, \
                light_error and crawl, all shares in per cent"
    )]
    weights: Weights,
    /// Folder for technique.toml, technique.rs and steps.md
    #[arg(short, value_name = "DIR")]
    out: PathBuf,
}

/// Searches, and writes the technique and the gain of each change.
pub(crate) fn run(args: &Args, interrupt: &Interrupt) -> Result<()> {
    ensure!(
        !args.job.drawing.changes_techniques(),
        "report tune chooses the settings itself; leave out --filter, --bias, --color-format and --set"
    );
    let mut job = args.job.prepare()?;
    make_folder(&args.out)?;
    let views = picked(&job.frames.iter().map(|frame| frame.view).collect::<Vec<_>>(), args.frames as usize);
    let budget = Budget { maps: args.maps, resolution: args.resolution };
    let inputs = args.job.drawing.inputs();
    let settings = TuneSettings { inputs, weights: args.weights, ..TuneSettings::within(budget) };
    let bar = ProgressBar::new(0);
    let template = "{wide_bar} {pos}/{len} tried, {eta} left, {msg}";
    bar.set_style(ProgressStyle::with_template(template)?);
    let tuned = tune(&mut job.comparison, &views, &settings, &mut |progress| {
        bar.set_length(progress.at_most as u64);
        bar.set_position(progress.tried as u64);
        bar.set_message(format!("error {:.4} of {:.4}", progress.best_error, progress.start_error));
        !interrupt.is_requested()
    })?;
    bar.finish_and_clear();
    let steps = steps(&tuned);
    for (name, text) in [
        ("technique.toml", tuned.technique.to_toml()?),
        ("technique.rs", shadowfit_params::to_rust(&tuned.technique.technique)),
        ("steps.md", steps.clone()),
    ] {
        write_whole(&args.out.join(name), text.as_bytes())?;
    }
    let (code, folder) = (shadowfit_params::to_rust(&tuned.technique.technique), args.out.display());
    print(format_args!("{steps}\n{code}\n{folder}: technique.toml (for --technique), technique.rs, steps.md\n"))
}

/// Picks `count` of the frames, as evenly spread pairs of neighbours, since fits and crawl depend on the
/// previous frame.
fn picked(views: &[View], count: usize) -> Vec<View> {
    if count >= views.len() {
        return views.to_vec();
    }
    let pairs = count.div_ceil(2);
    let begin = |pair: usize| (2 * pair + 1) * views.len() / (2 * pairs);
    let pair = |pair: usize| {
        let first = begin(pair).min(views.len().saturating_sub(2));
        let first =
            if views.get(first + 1).is_some_and(|view| view.is_first) { first.saturating_sub(1) } else { first };
        [View { is_first: true, ..views[first] }, views[first + 1]]
    };
    (0..pairs).flat_map(pair).take(count).collect()
}

/// Returns all changes that were tried, as Markdown.
fn steps(tuned: &Tuned) -> String {
    let mut text = String::from("| change | error | wrong % | false shadow % | false light % | hole % | bought |\n");
    text += "|---|---:|---:|---:|---:|---:|---|\n";
    let mut best = f64::NAN;
    for step in &tuned.steps {
        let percent = |count: u64| 100.0 * step.tally.share(count);
        let bought = if step.is_kept && best.is_finite() {
            format!("{:.1}%", 100.0 * (best - step.error) / best)
        } else if step.is_kept {
            "start".to_owned()
        } else {
            "-".to_owned()
        };
        let _ = writeln!(
            text,
            "| {} | {:.4} | {:.4} | {:.4} | {:.4} | {:.4} | {bought} |",
            step.what,
            step.error,
            percent(step.tally.all.wrong),
            percent(step.tally.all.false_shadow),
            percent(step.tally.all.false_light),
            percent(step.tally.all.hole),
        );
        if step.is_kept {
            best = step.error;
        }
    }
    if tuned.stopped_early {
        text += "\nStopped before all changes were tried.\n";
    }
    text
}

fn weights(text: &str) -> Result<Weights> {
    let mut weights = Weights::default();
    for part in text.split(',').filter(|part| !part.is_empty()) {
        let (name, value) = part.split_once('=').with_context(|| format!("\"{part}\" is not NAME=WEIGHT"))?;
        let value: f64 = value.trim().parse().with_context(|| format!("\"{value}\" is not a number"))?;
        ensure!(value.is_finite() && value >= 0.0, "{name}: {value} is not a weight; give 0 or more");
        let weight = match name.trim() {
            "wrong" => &mut weights.wrong,
            "false_shadow" => &mut weights.false_shadow,
            "false_light" => &mut weights.false_light,
            "hole" => &mut weights.hole,
            "light_error" => &mut weights.light_error,
            "crawl" => &mut weights.crawl,
            other => anyhow::bail!("there is no weight \"{other}\""),
        };
        *weight = value;
    }
    Ok(weights)
}
