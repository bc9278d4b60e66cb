//! The way of a picture's sums back to the CPU, without waiting: a few buffers that take turns.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use super::error::GpuTruthError;
use super::uniform::TallyRecord;

/// Buffers that take turns: the GPU works on one picture while another waits in line and the CPU reads a third.
const BUFFERS: usize = 3;

/// Can be recorded into.
const FREE: u8 = 0;
/// Recorded; the GPU is not done with it.
const BUSY: u8 = 1;
/// Can be read.
const READABLE: u8 = 2;
/// The device was lost.
const FAILED: u8 = 3;

/// What comes back of a picture: its number and its sums.
pub(super) type Back = (u64, TallyRecord);

/// The buffers.
#[derive(Debug)]
pub(super) struct ReadBacks([ReadBack; BUFFERS]);

/// A buffer of sums on their way back.
#[derive(Debug)]
pub(super) struct ReadBack {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU8>,
    /// Number of the picture that was recorded last.
    picture: u64,
}

/// Reports when the buffer can be read. An encoder that is dropped instead of submitted drops it without a report.
struct MapReport(Option<Arc<AtomicU8>>);

impl MapReport {
    fn report(mut self, is_readable: bool) {
        if let Some(state) = self.0.take() {
            state.store(if is_readable { READABLE } else { FAILED }, Ordering::Release);
        }
    }
}

impl Drop for MapReport {
    fn drop(&mut self) {
        // Only without a report: after one, another thread may read the buffer and record into it again.
        if let Some(state) = &self.0 {
            state.store(FREE, Ordering::Release);
        }
    }
}

impl ReadBacks {
    pub(super) fn new(device: &wgpu::Device) -> Self {
        Self([(); BUFFERS].map(|()| ReadBack::new(device)))
    }

    /// A buffer that can be recorded into, if there is one. Those of finished pictures that a newer finished one has
    /// overtaken are.
    pub(super) fn free(&mut self) -> Option<&mut ReadBack> {
        self.newest();
        self.0.iter_mut().find(|read_back| read_back.is(FREE))
    }

    /// What came back of the newest finished picture, once.
    pub(super) fn take(&mut self) -> Result<Option<Back>, GpuTruthError> {
        // All of them are asked, so that a lost device is told once.
        if self.0.iter().filter(|read_back| read_back.has_failed()).count() > 0 {
            return Err(GpuTruthError::Read);
        }
        self.newest().map(ReadBack::take).transpose()
    }

    /// The buffer of the newest finished picture. Those of older finished pictures are given back.
    fn newest(&mut self) -> Option<&mut ReadBack> {
        let pictures = self.0.iter().filter(|read_back| read_back.is(READABLE)).map(|read_back| read_back.picture);
        let newest = pictures.max()?;
        let older = |read_back: &&mut ReadBack| read_back.is(READABLE) && read_back.picture < newest;
        self.0.iter_mut().filter(older).for_each(ReadBack::release);
        self.0.iter_mut().find(|read_back| read_back.is(READABLE) && read_back.picture == newest)
    }
}

impl ReadBack {
    fn new(device: &wgpu::Device) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("tally on its way back"),
            size: size_of::<TallyRecord>() as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Self { buffer, state: Arc::new(AtomicU8::new(FREE)), picture: 0 }
    }

    fn is(&self, state: u8) -> bool {
        self.state.load(Ordering::Acquire) == state
    }

    /// Whether the device was lost; only once.
    fn has_failed(&self) -> bool {
        self.state.compare_exchange(FAILED, FREE, Ordering::AcqRel, Ordering::Relaxed).is_ok()
    }

    /// Records the way back of a picture's sums.
    pub(super) fn record(&mut self, encoder: &mut wgpu::CommandEncoder, sums: &wgpu::Buffer, picture: u64) {
        self.picture = picture;
        self.state.store(BUSY, Ordering::Release);
        encoder.copy_buffer_to_buffer(sums, 0, &self.buffer, 0, None);
        let report = MapReport(Some(Arc::clone(&self.state)));
        encoder
            .map_buffer_on_submit(&self.buffer, wgpu::MapMode::Read, .., move |result| report.report(result.is_ok()));
    }

    /// What came back; the buffer is free again then.
    fn take(&mut self) -> Result<Back, GpuTruthError> {
        let read = |mapped: wgpu::BufferView| (self.picture, bytemuck::pod_read_unaligned(&mapped));
        let back = self.buffer.get_mapped_range(..).ok().map(read);
        self.release();
        back.ok_or(GpuTruthError::Read)
    }

    /// Gives the buffer back.
    fn release(&mut self) {
        self.buffer.unmap();
        self.state.store(FREE, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_freed_only_without_a_report() {
        let state = Arc::new(AtomicU8::new(BUSY));
        drop(MapReport(Some(Arc::clone(&state))));
        assert_eq!(state.load(Ordering::Acquire), FREE);
        for (is_readable, wanted) in [(true, READABLE), (false, FAILED)] {
            MapReport(Some(Arc::clone(&state))).report(is_readable);
            assert_eq!(state.load(Ordering::Acquire), wanted);
        }
        // After a report the buffer belongs to whoever uses it next.
        let mut report = MapReport(Some(Arc::clone(&state)));
        report.0.take();
        state.store(BUSY, Ordering::Release);
        drop(report);
        assert_eq!(state.load(Ordering::Acquire), BUSY);
    }
}
