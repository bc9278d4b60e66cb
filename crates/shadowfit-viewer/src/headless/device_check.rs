//! The device check on the command line.

use std::sync::atomic::AtomicBool;

use anyhow::Result;
use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_study::check_device;

use crate::platform::output;

/// Checks the adapter of the command line. Prints each check to the standard error as it ends, then the
/// report to the standard output. Returns whether all checks that the device supports have passed.
///
/// # Errors
///
/// If the adapter is missing or cannot be opened, or the report cannot be written.
pub(crate) fn run(adapter: &AdapterChoice) -> Result<bool> {
    let gpu = pollster::block_on(Gpu::headless(adapter))?;
    let mut told = 0;
    let report = check_device(&gpu, &AtomicBool::new(false), &mut |report| {
        let ended = report.ended();
        for row in report.rows.iter().take(ended).skip(told) {
            told += 1;
            let (name, word, seconds) = (row.name, row.state.word(), row.seconds);
            output::tell(format_args!("{told}/{} {name}: {word} ({seconds:.1} s)", report.rows.len()));
        }
    });
    output::print(report.text())?;
    Ok(report.has_passed())
}
