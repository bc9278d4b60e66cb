//! Faults of an open device: it is out of memory, refuses something, or is lost.

use core::fmt;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Mutex, PoisonError};

use crate::Gpu;
use crate::wait::making;

/// Greatest number of faults that wait to be taken. One fault often causes others in each frame.
const MOST_FAULTS: usize = 8;

/// Reason why a device failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DeviceFault {
    /// The device is out of memory, with its own message.
    OutOfMemory(String),
    /// The device was asked for something unsupported or invalid, with its own message.
    Refused(String),
}

impl fmt::Display for DeviceFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfMemory(why) => write!(f, "the graphics device has no memory left: {why}"),
            Self::Refused(why) => write!(f, "the graphics device refused something: {why}"),
        }
    }
}

impl core::error::Error for DeviceFault {}

impl From<wgpu::Error> for DeviceFault {
    fn from(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { .. } => Self::OutOfMemory(error.to_string()),
            _ => Self::Refused(error.to_string()),
        }
    }
}

/// Faults of a device that were reported asynchronously.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    /// Faults that are reported nowhere else, until they are taken.
    kept: Vec<DeviceFault>,
    lost: Option<String>,
}

fn with<T>(faults: &Mutex<Faults>, work: impl FnOnce(&mut Faults) -> T) -> T {
    work(&mut faults.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Records the loss of a device.
pub(crate) fn watched(device: &wgpu::Device) -> Arc<Mutex<Faults>> {
    let faults = Arc::new(Mutex::new(Faults::default()));
    let sink = Arc::clone(&faults);
    device.set_device_lost_callback(move |reason, message| {
        let words = if message.is_empty() { format!("{reason:?}") } else { message };
        with(&sink, |faults| faults.lost = Some(words));
    });
    faults
}

fn is_lost(faults: &Mutex<Faults>) -> bool {
    with(faults, |faults| faults.lost.is_some())
}

std::thread_local! {
    /// Faults of the device that this thread is using in [`Gpu::unless_lost`].
    static IN_USE: RefCell<Option<Arc<Mutex<Faults>>>> = const { RefCell::new(None) };
}

/// Silences panics that [`Gpu::unless_lost`] takes for the loss of a device. All other panics go to the
/// previous hook.
pub fn hush_lost_devices() {
    let others = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let is_lost =
            IN_USE.with(|in_use| in_use.try_borrow().is_ok_and(|faults| faults.as_deref().is_some_and(is_lost)));
        if !is_lost {
            others(panic);
        }
    }));
}

impl Gpu {
    /// Returns the reason for the loss of the device; `None` while it works.
    pub fn lost(&self) -> Option<String> {
        let told = || with(&self.faults, |faults| faults.lost.clone());
        told().or_else(|| {
            // A destroyed device reports its loss only when it is polled.
            let _ = self.unless_lost(|| self.device.poll(wgpu::PollType::Poll));
            told()
        })
    }

    /// Runs work that may find the device lost, and returns `None` if it was. In that case wgpu 30 panics
    /// when it polls, and so does code that relies on a working device. Any other panic is passed on.
    pub fn unless_lost<T>(&self, work: impl FnOnce() -> T) -> Option<T> {
        let outer = IN_USE.replace(Some(Arc::clone(&self.faults)));
        let done = catch_unwind(AssertUnwindSafe(work));
        IN_USE.set(outer);
        match done {
            Ok(done) => Some(done),
            Err(_) if is_lost(&self.faults) => None,
            Err(panic) => resume_unwind(panic),
        }
    }

    /// Keeps future faults of the device for [`Self::take_faults`], instead of ending the program.
    pub fn keep_faults(&self) {
        let sink = Arc::clone(&self.faults);
        self.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            with(&sink, |faults| {
                if faults.kept.len() < MOST_FAULTS {
                    faults.kept.push(error.into());
                }
            });
        }));
    }

    /// Takes the faults since the last call, in order. Faults of a lost device only follow from its loss and
    /// are left out.
    pub fn take_faults(&self) -> Vec<DeviceFault> {
        let is_lost = self.lost().is_some();
        let kept = with(&self.faults, |faults| std::mem::take(&mut faults.kept));
        if is_lost { Vec::new() } else { kept }
    }

    /// Creates something that may exceed the device's memory. In browsers WebGPU reports this later, to the
    /// device's own handler.
    ///
    /// # Errors
    ///
    /// [`DeviceFault`]. The result is then dropped.
    pub fn try_making<T>(&self, make: impl FnOnce() -> T) -> Result<T, DeviceFault> {
        Ok(shadowfit_gpu::catch_errors(&self.device, || making(make))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AdapterChoice;

    fn gpu() -> Gpu {
        pollster::block_on(Gpu::headless(&AdapterChoice::Software)).expect("the software adapter")
    }

    /// Creates a buffer whose usages exclude each other.
    fn impossible(gpu: &Gpu) -> wgpu::Buffer {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("impossible"),
            size: 4,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    }

    #[test]
    fn gpu_a_device_keeps_its_faults_and_its_loss_until_somebody_asks() {
        let gpu = gpu();
        gpu.keep_faults();
        for _ in 0..2 * MOST_FAULTS {
            impossible(&gpu);
        }
        let faults = gpu.take_faults();
        assert_eq!(faults.len(), MOST_FAULTS);
        assert!(matches!(&faults[0], DeviceFault::Refused(why) if why.contains("impossible")), "{:?}", faults[0]);
        assert_eq!((gpu.take_faults(), gpu.lost()), (Vec::new(), None));
        gpu.device.destroy();
        assert!(gpu.lost().is_some());
    }

    #[test]
    fn gpu_what_cannot_be_made_is_an_error_of_its_maker_alone() {
        let gpu = gpu();
        gpu.keep_faults();
        let error = gpu.try_making(|| impossible(&gpu)).expect_err("it cannot be made");
        assert!(error.to_string().contains("refused"), "{error}");
        assert_eq!(gpu.try_making(|| 7), Ok(7));
        assert_eq!(gpu.take_faults(), []);
    }
}
