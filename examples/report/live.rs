//! `report live`: the classes from the GPU, compared with those of the processor, and how long they take.

use anyhow::{Result, bail};
use shadowfit_truth::gpu::GpuPixel;
use shadowfit_truth::{Class, Judged};
use shadowfit_viewer::study::{LiveTruth, SharedTruth, Technique};

use crate::interrupt::Interrupt;
use crate::job::Job;

/// Pictures that are judged for the clock, after as many to warm up.
const REPEATS: u32 = 50;
/// Shares of pixels of the same class that the two promise: off edges, and of all that face the light.
const PROMISED: [f64; 2] = [0.999, 0.995];

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    job: Job,
    /// Technique, by name or as a TOML file
    #[arg(long = "config", value_name = "NAME|FILE.toml", default_value = shadowfit_viewer::study::DEFAULT_TECHNIQUE)]
    config: String,
}

/// Pixels that both judged, and those of the same class.
#[derive(Clone, Copy, Debug, Default)]
struct Agreement {
    off_edges: [u64; 2],
    all: [u64; 2],
    edge_zone_differs: u64,
}

/// Compares all frames and times each, and fails when they agree less than promised.
pub(crate) fn run(args: &Args, interrupt: &Interrupt) -> Result<()> {
    let mut job = args.job.prepare()?;
    job.comparison.add(args.job.drawing.changed(Technique::find(&args.config)?)?)?;
    let mut live = LiveTruth::new(job.comparison.gpu(), job.comparison.subject())?;
    println!(
        "{}: {} triangles, {:.1} MiB on {}, {} by {} pixels",
        args.job.title(),
        job.comparison.subject().triangles(),
        live.bytes() as f64 / f64::from(1 << 20),
        job.comparison.gpu().name(),
        job.judging.size[0],
        job.judging.size[1],
    );
    let mut sum = Agreement::default();
    let mut times = Vec::new();
    for frame in &job.frames {
        if interrupt.is_requested() {
            break;
        }
        if let Some(seconds) = frame.seconds {
            job.comparison.set_time(0, seconds);
            live.set_pose(job.comparison.gpu(), job.comparison.subject())?;
        }
        let outcomes = job.comparison.frame(&frame.shot, &mut SharedTruth::default())?;
        let (gpu, contender, subject) = job.comparison.contender(0);
        for outcome in outcomes {
            let pixels = contender.judge_live(gpu, subject, &frame.shot, &outcome.maps, &mut live)?;
            let repeats = if gpu.is_software() { 1 } else { REPEATS };
            times.push(contender.time_live(gpu, subject, &frame.shot, &outcome.maps, (&mut live, repeats))?);
            sum.add(&outcome.judged, &pixels);
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times.get(((times.len() as f64 - 1.0) * share).round() as usize).copied().unwrap_or(f64::NAN);
    println!("judging takes {:.2} ms (median), {:.2} ms (slowest) of {} frames", at(0.5), at(1.0), times.len());
    sum.tell()
}

impl Agreement {
    fn add(&mut self, judged: &Judged, pixels: &[GpuPixel]) {
        for (pixel, found) in pixels.iter().enumerate() {
            let class = judged.classes[pixel];
            if class == Class::NotJudged && found.class == Class::NotJudged {
                continue;
            }
            let same = u64::from(class == found.class);
            self.all = [self.all[0] + 1, self.all[1] + same];
            if !judged.edge_zone[pixel] {
                self.off_edges = [self.off_edges[0] + 1, self.off_edges[1] + same];
            }
            self.edge_zone_differs += u64::from(judged.edge_zone[pixel] != found.is_in_edge_zone);
        }
    }

    fn tell(&self) -> Result<()> {
        let share = |[pixels, same]: [u64; 2]| if pixels == 0 { 1.0 } else { same as f64 / pixels as f64 };
        let shares = [share(self.off_edges), share(self.all)];
        println!(
            "the processor agrees on {:.4}% of the pixels off edges and {:.4}% of all that face the light; the edge zone \
             differs at {:.4}%",
            100.0 * shares[0],
            100.0 * shares[1],
            100.0 * (1.0 - share([self.all[0], self.all[0] - self.edge_zone_differs])),
        );
        if shares[0] < PROMISED[0] || shares[1] < PROMISED[1] {
            bail!("the GPU's classes differ from the processor's by more than {PROMISED:?} allow");
        }
        Ok(())
    }
}
