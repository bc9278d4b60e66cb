//! The check of the graphics device, on a second device.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use shadowfit_params::device_check::CheckReport;
use shadowfit_render::{AdapterChoice, Gpu, GpuError, Wanted};
use shadowfit_study::{check_device_async, in_background_async, unchecked};

use crate::platform::IS_PAGE;

/// A running or finished check; empty while its dialog is closed.
#[derive(Debug, Default)]
pub(crate) struct DeviceCheck {
    report: Option<CheckReport>,
    running: Option<Running>,
}

/// The background work of a check.
#[derive(Debug)]
struct Running {
    reports: Receiver<CheckReport>,
    is_cancelled: Arc<AtomicBool>,
}

impl DeviceCheck {
    /// Starts a check of the current adapter on a separate device, and shows its dialog. Does nothing while a
    /// check is running.
    pub(crate) fn start(&mut self, gpu: &Gpu) {
        if self.is_running() {
            return;
        }
        let (sender, reports) = channel();
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&is_cancelled);
        let adapter = gpu.adapter.clone();
        let work = move || async move {
            let report = match second_device(adapter).await {
                // The receiver is gone after the dialog is closed.
                Ok(gpu) => {
                    let tell = &mut |report: &CheckReport| drop(sender.send(report.clone()));
                    check_device_async(&gpu, &flag, tell).await
                }
                Err(error) => without_device(&error.to_string()),
            };
            let _ = sender.send(report);
        };
        let began = in_background_async("device check", work);
        self.running = began.is_ok().then_some(Running { reports, is_cancelled });
        self.report = Some(began.map_or_else(|error| without_device(&error.to_string()), |()| unchecked(None)));
    }

    /// Returns whether a check is running.
    pub(crate) fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Ends the check after its current step.
    pub(crate) fn cancel(&mut self) {
        if let Some(running) = &self.running {
            running.is_cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Closes the dialog, and drops the result of a running check.
    pub(crate) fn close(&mut self) {
        self.cancel();
        (self.report, self.running) = (None, None);
    }

    /// Takes the reports since the last frame.
    pub(crate) fn take(&mut self) {
        let Some(running) = &self.running else { return };
        loop {
            match running.reports.try_recv() {
                Ok(report) => self.report = Some(report),
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => break,
            }
        }
        self.running = None;
        // After a complete report no check is waiting. A thread that ended without one has panicked.
        if let Some(report) = &mut self.report {
            report.end("the check ended unexpectedly; this is a bug of the viewer");
        }
    }

    /// Returns the report, while its dialog is open.
    pub(crate) fn report(&self) -> Option<&CheckReport> {
        self.report.as_ref()
    }
}

/// Opens an adapter again.
async fn second_device(adapter: wgpu::Adapter) -> Result<Gpu, GpuError> {
    // A browser's adapter opens a single device, and a browser offers a single adapter.
    if IS_PAGE {
        return Gpu::headless(&AdapterChoice::Any).await;
    }
    Gpu::of_adapter(adapter, &Wanted::default()).await
}

/// Returns the report for a device that could not be opened.
fn without_device(reason: &str) -> CheckReport {
    let mut report = unchecked(None);
    report.end(reason);
    report
}
