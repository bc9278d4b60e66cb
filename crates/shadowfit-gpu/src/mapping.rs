//! The state of a buffer between the GPU and the CPU, which a callback on any thread changes.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// The state of a buffer that the GPU fills and the CPU reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum MapState {
    /// The GPU may be asked to fill it.
    Free = 0,
    /// The GPU fills it.
    Busy = 1,
    /// The CPU can read it.
    Readable = 2,
    /// It could not be mapped: the device was lost, or has no memory left.
    Failed = 3,
}

/// Watches whether a buffer can be read.
#[derive(Debug)]
pub struct Mapping(Arc<AtomicU8>);

impl Default for Mapping {
    fn default() -> Self {
        Self::new()
    }
}

impl Mapping {
    /// A buffer that is free.
    pub fn new() -> Self {
        Self(Arc::new(AtomicU8::new(MapState::Free as u8)))
    }

    /// Returns the present state. Poll the device before: wgpu reports results there.
    pub fn state(&self) -> MapState {
        let state = self.0.load(Ordering::Acquire);
        let states = [MapState::Free, MapState::Busy, MapState::Readable];
        states.into_iter().find(|known| *known as u8 == state).unwrap_or(MapState::Failed)
    }

    /// Maps a buffer for reading, after the work that fills it was submitted.
    pub fn map(&self, buffer: &wgpu::Buffer) {
        let report = self.begin();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| report.send(result.is_ok()));
    }

    /// Maps a buffer for reading as soon as the encoder's work, which fills it, is submitted. The buffer is free again if
    /// the encoder is dropped instead.
    pub fn map_on_submit(&self, encoder: &wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let report = self.begin();
        encoder.map_buffer_on_submit(buffer, wgpu::MapMode::Read, .., move |result| report.send(result.is_ok()));
    }

    /// Unmaps a buffer that was read, or that nobody will read. It is free then.
    pub fn release(&self, buffer: &wgpu::Buffer) {
        buffer.unmap();
        self.0.store(MapState::Free as u8, Ordering::Release);
    }

    /// Whether mapping has failed. It is free then, so that each failure is returned once.
    pub fn take_failure(&self) -> bool {
        let [failed, free] = [MapState::Failed, MapState::Free].map(|state| state as u8);
        self.0.compare_exchange(failed, free, Ordering::AcqRel, Ordering::Relaxed).is_ok()
    }

    fn begin(&self) -> Report {
        self.0.store(MapState::Busy as u8, Ordering::Release);
        Report(Some(Arc::clone(&self.0)))
    }
}

/// Reports when the buffer can be read. An encoder that is dropped instead of submitted drops it without a report.
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
        // Only without a report: after one, another thread may read the buffer and record into it again.
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
