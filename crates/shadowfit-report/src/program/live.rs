//! `report live`: compares pixels judged on the GPU with pixels judged on the CPU, and measures the time.

use anyhow::{Result, bail};
use shadowfit_study::{Agreement, LiveTruth, NamedTechnique, SharedTruth, print};

use crate::interrupt::Interrupt;
use crate::job::Job;

/// Number of timed pictures, after the same number for warm-up.
const REPEATS: u32 = 50;
/// Guaranteed shares of pixels of equal class: off edges, and of all pixels that face the light.
const PROMISED: [f64; 2] = [0.999, 0.995];

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    job: Job,
    /// Technique, by name or as a TOML file
    #[arg(long = "technique", alias = "config", value_name = "NAME|FILE.toml", default_value = shadowfit::Preset::RECOMMENDED)]
    technique: String,
}

/// Compares and times all frames. Fails if they agree less than guaranteed.
pub(crate) fn run(args: &Args, interrupt: &Interrupt) -> Result<()> {
    let mut job = args.job.prepare()?;
    job.comparison.add(args.job.drawing.changed(NamedTechnique::find(&args.technique)?)?)?;
    let mut live = LiveTruth::new(job.comparison.gpu(), job.comparison.scene())?;
    let (title, adapter, [width, height]) = (args.job.title(), job.comparison.gpu().name(), job.judging.size);
    let (triangles, size) = (job.comparison.scene().casting_triangles(), live.bytes() as f64 / f64::from(1 << 20));
    print(format_args!("{title}: {triangles} triangles, {size:.1} MiB on {adapter}, {width} by {height} pixels\n"))?;
    let mut sum = Agreement::default();
    let mut times = Vec::new();
    for frame in &job.frames {
        if interrupt.is_requested() {
            break;
        }
        if let Some(seconds) = frame.seconds {
            job.comparison.set_time(0, seconds);
            live.set_pose(job.comparison.gpu(), job.comparison.scene())?;
        }
        let outcomes = job.comparison.frame(&frame.view, &mut SharedTruth::default())?;
        let (gpu, evaluator, scene) = job.comparison.evaluator(0);
        for outcome in outcomes {
            let pixels = evaluator.judge_live(gpu, scene, &frame.view, &outcome.maps, &mut live)?;
            let repeats = if gpu.is_software() { 1 } else { REPEATS };
            times.push(evaluator.time_live(gpu, scene, &frame.view, &outcome.maps, &mut live, repeats)?);
            sum.add(&outcome.judged, &pixels);
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times.get(((times.len() as f64 - 1.0) * share).round() as usize).copied().unwrap_or(f64::NAN);
    let [median, slowest] = [0.5, 1.0].map(at);
    print(format_args!(
        "judging takes {median:.2} ms (median), {slowest:.2} ms (slowest) of {} frames\n",
        times.len()
    ))?;
    say(&sum)
}

/// Prints the agreement of the two judges. Fails if it is less than guaranteed.
fn say(agreement: &Agreement) -> Result<()> {
    let [off_edges, all] = [agreement.off_edges(), agreement.all()];
    print(format_args!(
        "the CPU agrees on {:.4}% of the pixels off edges and {:.4}% of all that face the light; the edge zone \
         is the same at {:.4}%\n",
        100.0 * off_edges,
        100.0 * all,
        100.0 * agreement.edge_zone(),
    ))?;
    if off_edges < PROMISED[0] || all < PROMISED[1] {
        bail!("the GPU's classes differ from the CPU's by more than {PROMISED:?} allow");
    }
    Ok(())
}
