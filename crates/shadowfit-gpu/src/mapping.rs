//! State of a buffer between the GPU and the CPU. A callback on any thread changes it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// State of a buffer that the GPU fills and the CPU reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum MapState {
    /// The GPU does not use the buffer: a copy may be recorded.
    Free = 0,
    /// The GPU fills the buffer.
    Busy = 1,
    /// The CPU can read the buffer.
    Readable = 2,
    /// The buffer could not be mapped: the device was lost or is out of memory.
    Failed = 3,
}

/// Tracker of a buffer's state.
#[derive(Debug)]
pub struct Mapping(Arc<AtomicU8>);

impl Default for Mapping {
    fn default() -> Self {
        Self::new()
    }
}

impl Mapping {
    /// Creates the tracker of a free buffer.
    pub fn new() -> Self {
        Self(Arc::new(AtomicU8::new(MapState::Free as u8)))
    }

    /// Returns the current state. Poll the device first, because wgpu reports results there.
    pub fn state(&self) -> MapState {
        let state = self.0.load(Ordering::Acquire);
        let states = [MapState::Free, MapState::Busy, MapState::Readable];
        states.into_iter().find(|known| *known as u8 == state).unwrap_or(MapState::Failed)
    }

    /// Maps a buffer for reading. Submit the work that fills it first.
    pub fn map(&self, buffer: &wgpu::Buffer) {
        let report = self.begin();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| report.send(result.is_ok()));
    }

    /// Maps a buffer for reading when the encoder, whose work fills it, is submitted. If the encoder is
    /// dropped instead, the buffer becomes free again.
    pub fn map_on_submit(&self, encoder: &wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let report = self.begin();
        encoder.map_buffer_on_submit(buffer, wgpu::MapMode::Read, .., move |result| report.send(result.is_ok()));
    }

    /// Unmaps a buffer, and makes it free.
    pub fn release(&self, buffer: &wgpu::Buffer) {
        buffer.unmap();
        self.0.store(MapState::Free as u8, Ordering::Release);
    }

    /// Returns whether mapping has failed, and makes the buffer free, so that each failure is returned once.
    pub fn take_failure(&self) -> bool {
        let [failed, free] = [MapState::Failed, MapState::Free].map(|state| state as u8);
        self.0.compare_exchange(failed, free, Ordering::AcqRel, Ordering::Relaxed).is_ok()
    }

    fn begin(&self) -> Report {
        self.0.store(MapState::Busy as u8, Ordering::Release);
        Report(Some(Arc::clone(&self.0)))
    }
}

/// Sender of the mapping's result. If an encoder is dropped without being submitted, the sender is dropped
/// without a report.
struct Report(Option<Arc<AtomicU8>>);

impl Report {
    fn send(mut self, is_readable: bool) {
        if let Some(state) = self.0.take() {
            let reported = if is_readable { MapState::Readable } else { MapState::Failed };
            state.store(reported as u8, Ordering::Release);
        }
    }
}

impl Drop for Report {
    fn drop(&mut self) {
        // Only without a report: after a report, another thread may read the buffer and record into it again.
        if let Some(state) = &self.0 {
            state.store(MapState::Free as u8, Ordering::Release);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_freed_only_without_a_report() {
        let mapping = Mapping::new();
        let report = mapping.begin();
        assert_eq!(mapping.state(), MapState::Busy);
        drop(report);
        assert_eq!(mapping.state(), MapState::Free);
        for (is_readable, wanted) in [(true, MapState::Readable), (false, MapState::Failed)] {
            mapping.begin().send(is_readable);
            assert_eq!(mapping.state(), wanted);
        }
        assert!(mapping.take_failure() && !mapping.take_failure());
        // After a report the buffer belongs to its next user.
        let mut report = mapping.begin();
        report.0.take();
        drop(report);
        assert_eq!(mapping.state(), MapState::Busy);
    }
}
