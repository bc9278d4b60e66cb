//! What may go wrong with a device that is open: it has no memory left, refuses something, or is lost.

use core::fmt;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Arc, Mutex, PoisonError};

use crate::Gpu;
use crate::wait::making;

/// Most faults that wait to be taken: one often brings others in each frame.
const MOST_FAULTS: usize = 8;

/// Why a device did not do something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DeviceFault {
    /// It has not enough memory, with its own words.
    OutOfMemory(String),
    /// It was asked for what it cannot do, with its own words.
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

/// What became known of a device from elsewhere than where it was used.
#[derive(Debug, Default)]
pub(crate) struct Faults {
    /// Those that nothing else reports, until they are taken.
    kept: Vec<DeviceFault>,
    lost: Option<String>,
}

fn with<T>(faults: &Mutex<Faults>, work: impl FnOnce(&mut Faults) -> T) -> T {
    work(&mut faults.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Notes when a device is lost.
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
    /// Those of the device that this thread does work [unless it is lost](Gpu::unless_lost) with.
    static IN_USE: RefCell<Option<Arc<Mutex<Faults>>>> = const { RefCell::new(None) };
}

/// Panics that [`Gpu::unless_lost`] takes for the loss of a device print nothing from now on. All others go to the hook that
/// was set before.
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
    /// Why the device was lost; `None` while it works.
    pub fn lost(&self) -> Option<String> {
        let told = || with(&self.faults, |faults| faults.lost.clone());
        told().or_else(|| {
            // A device that was destroyed tells only somebody who asks.
            let _ = self.unless_lost(|| self.device.poll(wgpu::PollType::Poll));
            told()
        })
    }

    /// Does work that may find the device lost; `None` where it does. wgpu 30 panics then where it polls, and so does what
    /// takes it for granted that a device gives it what it asks for. Any other panic goes on.
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

    /// From now on faults of the device do not end the program, and wait for [`Self::take_faults`].
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

    /// Takes the faults since the last call, the first one first. Those of a lost device follow from its loss, and are left
    /// out.
    pub fn take_faults(&self) -> Vec<DeviceFault> {
        let is_lost = self.lost().is_some();
        let kept = with(&self.faults, |faults| std::mem::take(&mut faults.kept));
        if is_lost { Vec::new() } else { kept }
    }

    /// Makes something that the device may have no memory for. WebGPU in browsers reports that later, to the device's own
    /// handler.
    ///
    /// # Errors
    ///
    /// [`DeviceFault`]; the result is dropped.
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

    /// A buffer whose usages exclude each other.
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
