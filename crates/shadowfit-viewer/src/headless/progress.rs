//! Terminal output while pictures are rendered.

use std::path::Path;
use std::time::Duration;

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

use crate::platform::output;
use crate::stage::Stage;

/// Update interval of the bar.
const TICK: Duration = Duration::from_millis(250);

/// Reports progress while pictures are rendered: each file name on the standard output when it is written,
/// and the remaining time on the standard error if that is a terminal.
pub(super) struct Progress {
    bar: ProgressBar,
    count: usize,
    written: usize,
    /// First error of printing.
    printed: Result<()>,
}

impl Progress {
    pub(super) fn begin(count: usize, name: &str, stage: &Stage, folder: &Path) -> Result<Self> {
        let noun = if count == 1 { "picture" } else { "pictures" };
        output::print(format_args!("{count} {noun} of {name} by {}, in {}:\n", stage.gpu().name(), folder.display()))?;
        let bar = ProgressBar::new(count as u64);
        bar.set_style(ProgressStyle::with_template("{wide_bar} {pos}/{len} pictures, {elapsed} so far, {eta} left")?);
        bar.enable_steady_tick(TICK);
        Ok(Self { bar, count, written: 0, printed: Ok(()) })
    }

    pub(super) fn wrote(&mut self, path: &Path) {
        self.written += 1;
        self.bar.inc(1);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let line = format!("  {}/{} {name}\n", self.written, self.count);
        let printed = self.bar.suspend(|| output::print(line));
        if self.printed.is_ok() {
            self.printed = printed;
        }
    }

    /// Returns the first error of printing.
    pub(super) fn end(mut self) -> Result<()> {
        std::mem::replace(&mut self.printed, Ok(()))
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
