//! A check of a graphics device that takes about a minute. It compares the program's maps, look-ups, passes
//! and rays on the device with the same computations on the CPU.
//!
//! Each check is a file with its comparison and its tolerance. All checks draw the built-in courtyard, so
//! that reports of different devices are comparable. Tests prove that a check fails if its bias, map, view or
//! truth is wrong.

mod bench;
mod coverage;
mod demand;
mod edges;
mod facts;
mod formats;
mod kept_maps;
mod look_up;
mod numbers;
mod outcome;
mod texels;
mod twin;

use std::sync::atomic::AtomicBool;

use anyhow::{Error, Result};
use shadowfit_params::device_check::{CheckReport, CheckRow, CheckState};
use shadowfit_render::Gpu;
use web_time::Instant;

use bench::Bench;
use outcome::{Cancelled, Outcome};

/// One of the checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Check {
    LookUp,
    Formats,
    KeptMaps,
    Edges,
    Demand,
    Coverage,
}

impl Check {
    /// All checks, in the order in which they run.
    const ALL: [Self; 6] = [Self::LookUp, Self::Formats, Self::KeptMaps, Self::Edges, Self::Demand, Self::Coverage];

    const fn row(self) -> [&'static str; 3] {
        match self {
            Self::LookUp => [look_up::NAME, look_up::ABOUT, look_up::TOLERANCE],
            Self::Formats => [formats::NAME, formats::ABOUT, formats::TOLERANCE],
            Self::KeptMaps => [kept_maps::NAME, kept_maps::ABOUT, kept_maps::TOLERANCE],
            Self::Edges => [edges::NAME, edges::ABOUT, edges::TOLERANCE],
            Self::Demand => [demand::NAME, demand::ABOUT, demand::TOLERANCE],
            Self::Coverage => [coverage::NAME, coverage::ABOUT, coverage::TOLERANCE],
        }
    }

    async fn run(self, bench: &mut Bench<'_>) -> Result<Outcome> {
        match self {
            Self::LookUp => look_up::run(bench).await,
            Self::Formats => formats::run(bench).await,
            Self::KeptMaps => kept_maps::run(bench).await,
            Self::Edges => edges::run(bench).await,
            Self::Demand => demand::run(bench).await,
            Self::Coverage => coverage::run(bench).await,
        }
    }
}

/// Returns the report of a device before its check, with all checks pending. Without a device it has no
/// facts.
pub fn unchecked(gpu: Option<&Gpu>) -> CheckReport {
    let row = |check: Check| {
        let [name, about, tolerance] = check.row();
        CheckRow { name, about, tolerance, ..CheckRow::default() }
    };
    CheckReport { facts: gpu.map_or_else(Vec::new, facts::facts), rows: Check::ALL.map(row).to_vec() }
}

/// Checks a device and returns the report. Calls `progress` whenever a check begins or ends. The check ends
/// early once `is_cancelled` is set, which is read several times per second. Do not use the device for other
/// work meanwhile, because its faults are attributed to the check.
///
/// If the device is lost, the check ends: the current row has failed, and the remaining rows are reported as
/// not run.
pub fn check_device(gpu: &Gpu, is_cancelled: &AtomicBool, progress: &mut dyn FnMut(&CheckReport)) -> CheckReport {
    pollster::block_on(check_device_async(gpu, is_cancelled, progress))
}

/// Checks a device like [`check_device`]. A browser can do other work while the GPU draws.
pub async fn check_device_async(
    gpu: &Gpu,
    is_cancelled: &AtomicBool,
    progress: &mut dyn FnMut(&CheckReport),
) -> CheckReport {
    gpu.keep_faults();
    let mut report = unchecked(Some(gpu));
    let mut bench = None;
    for (index, check) in Check::ALL.into_iter().enumerate() {
        report.rows[index].state = CheckState::Running;
        progress(&report);
        let begin = Instant::now();
        let ended = run(gpu, is_cancelled, &mut bench, check).await;
        let row = &mut report.rows[index];
        row.seconds = begin.elapsed().as_secs_f64();
        let goes_on = note(row, ended);
        progress(&report);
        if let Err(reason) = goes_on {
            report.end(&reason);
            break;
        }
    }
    report
}

/// Records how a check ended. If no other check can run, returns the reason as an error.
fn note(row: &mut CheckRow, ended: Ended) -> Result<(), String> {
    (row.state, row.found) = match ended {
        Ended::Outcome(Outcome::Passed(found)) => (CheckState::Passed, found),
        Ended::Outcome(Outcome::Failed(found)) => (CheckState::Failed, found),
        Ended::Outcome(Outcome::Unavailable(reason)) => (CheckState::Unavailable(reason), String::new()),
        Ended::Error(error) if error.is::<Cancelled>() => {
            row.state = CheckState::NotRun(error.to_string());
            return Err(error.to_string());
        }
        Ended::Error(error) => (CheckState::Failed, format!("{error:#}")),
        Ended::Lost(reason) => {
            (row.state, row.found) = (CheckState::Failed, format!("the device was lost during this check: {reason}"));
            return Err("the device was lost earlier".to_owned());
        }
    };
    Ok(())
}

/// End of a check.
enum Ended {
    Outcome(Outcome),
    Error(Error),
    /// The device was lost, with the reason that it reported.
    Lost(String),
}

/// Runs a check, and finds out whether the device was lost or faulty.
#[cfg_attr(not(target_family = "wasm"), expect(clippy::unused_async, reason = "only browsers wait"))]
async fn run<'a>(gpu: &'a Gpu, is_cancelled: &'a AtomicBool, bench: &mut Option<Bench<'a>>, check: Check) -> Ended {
    let work = async {
        let bench = match bench {
            Some(bench) => bench,
            None => bench.insert(Bench::new(gpu, is_cancelled)?),
        };
        bench.pause().await?;
        check.run(bench).await
    };
    // wgpu panics if a lost device is polled. Only browsers wait in a future, and they cannot catch a panic.
    #[cfg(not(target_family = "wasm"))]
    let ended = gpu.unless_lost(|| pollster::block_on(work));
    #[cfg(target_family = "wasm")]
    let ended = Some(work.await);
    let faults = gpu.take_faults();
    match (gpu.lost(), ended) {
        (Some(reason), _) => Ended::Lost(reason),
        (None, None) => Ended::Lost("it does not answer".to_owned()),
        (None, Some(Ok(_))) if !faults.is_empty() => Ended::Error(faults[0].clone().into()),
        (None, Some(Ok(outcome))) => Ended::Outcome(outcome),
        (None, Some(Err(error))) => Ended::Error(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Opens a separate device, because the test may lose it.
    fn own_gpu() -> Gpu {
        shadowfit_testing::open_renderer_gpu()
    }

    #[test]
    fn gpu_a_device_that_is_lost_fails_the_row_and_the_rest_are_not_run() {
        let gpu = own_gpu();
        let mut begun = 0;
        let report = check_device(&gpu, &AtomicBool::new(false), &mut |report| {
            let is_running = |row: &CheckRow| row.state == CheckState::Running;
            begun += usize::from(report.rows.iter().any(is_running));
            if report.rows[1].state == CheckState::Running {
                gpu.device.destroy();
            }
        });
        let states: Vec<&str> = report.rows.iter().map(|row| row.state.word()).collect();
        assert_eq!(states, ["passed", "FAILED", "not run", "not run", "not run", "not run"], "{}", report.text());
        assert!(report.rows[1].found.contains("lost") && report.rows[2].result().contains("lost"), "{}", report.text());
        assert!(report.has_ended() && !report.has_passed() && begun == 2);
        assert!(report.sentence().contains("Do not trust"), "{}", report.sentence());
    }

    #[test]
    fn gpu_a_check_that_is_cancelled_ends_at_once_and_proves_nothing() {
        let is_cancelled = AtomicBool::new(true);
        let report = check_device(&own_gpu(), &is_cancelled, &mut |_| ());
        assert!(report.rows.iter().all(|row| matches!(row.state, CheckState::NotRun(_))), "{}", report.text());
        assert!(report.sentence().contains("stopped early") && !report.has_passed(), "{}", report.sentence());
    }
}
