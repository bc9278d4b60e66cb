//! The way of counts back to the CPU, without waiting: a few buffers that take turns.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Can be recorded into.
const FREE: u8 = 0;
/// Recorded; the GPU is not done with it.
const BUSY: u8 = 1;
/// Can be read.
const READABLE: u8 = 2;
/// The device was lost.
const FAILED: u8 = 3;

/// A buffer of counts on their way back, with what is known of the picture that they are of.
#[derive(Debug)]
pub(crate) struct ReadBack<T> {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU8>,
    /// What is known of the last recording, and its number.
    recorded: Option<(T, u64)>,
}

/// Gets a message when the buffer can be read. An encoder that is dropped instead of submitted drops it without one.
struct Told(Option<Arc<AtomicU8>>);

impl Told {
    fn tell(mut self, readable: bool) {
        if let Some(state) = self.0.take() {
            state.store(if readable { READABLE } else { FAILED }, Ordering::Release);
        }
    }
}

impl Drop for Told {
    fn drop(&mut self) {
        // Only without a message: after one, another thread may already read the buffer and record into it again.
        if let Some(state) = &self.0 {
            state.store(FREE, Ordering::Release);
        }
    }
}

impl<T> ReadBack<T> {
    /// For so many counts.
    pub(crate) fn new(device: &wgpu::Device, counts: usize) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("shadowfit read back"),
            size: (counts * size_of::<u32>()) as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Self { buffer, state: Arc::new(AtomicU8::new(FREE)), recorded: None }
    }

    pub(crate) fn is_free(&self) -> bool {
        self.state.load(Ordering::Acquire) == FREE
    }

    /// Whether it can be read.
    pub(crate) fn is_readable(&self) -> bool {
        self.state.load(Ordering::Acquire) == READABLE
    }

    /// Whether the device was lost; only once.
    pub(crate) fn has_failed(&self) -> bool {
        self.state.compare_exchange(FAILED, FREE, Ordering::AcqRel, Ordering::Relaxed).is_ok()
    }

    /// Number of the recording that it holds.
    pub(crate) fn number(&self) -> u64 {
        self.recorded.as_ref().map_or(0, |(_, number)| *number)
    }

    /// Records the way back of the first counts in a buffer.
    pub(crate) fn record(&mut self, encoder: &mut wgpu::CommandEncoder, counts: &wgpu::Buffer, known: T, number: u64) {
        self.recorded = Some((known, number));
        self.state.store(BUSY, Ordering::Release);
        encoder.copy_buffer_to_buffer(counts, 0, &self.buffer, 0, Some(self.buffer.size()));
        let told = Told(Some(Arc::clone(&self.state)));
        encoder.map_buffer_on_submit(&self.buffer, wgpu::MapMode::Read, .., move |result| told.tell(result.is_ok()));
    }

    /// The counts, if they can be read; the buffer is free again then.
    pub(crate) fn take(&mut self) -> Option<(T, Vec<u32>)> {
        let (known, _) = self.recorded.take().filter(|_| self.is_readable())?;
        let counts = self.buffer.get_mapped_range(..).ok().map(|mapped| bytemuck::pod_collect_to_vec(&mapped));
        self.release();
        Some((known, counts?))
    }

    /// The newest of several that can be read; the older ones are given back.
    pub(crate) fn newest<'a>(all: impl Iterator<Item = &'a mut Self>) -> Option<&'a mut Self>
    where
        T: 'a,
    {
        let mut newest: Option<&mut Self> = None;
        for read_back in all.filter(|read_back| read_back.is_readable()) {
            let older = match newest.take() {
                Some(other) if other.number() > read_back.number() => {
                    newest = Some(other);
                    Some(read_back)
                }
                other => {
                    newest = Some(read_back);
                    other
                }
            };
            older.into_iter().for_each(Self::release);
        }
        newest
    }

    /// Gives the buffer back without reading it.
    pub(crate) fn release(&mut self) {
        self.buffer.unmap();
        self.state.store(FREE, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_freed_only_where_nobody_was_told() {
        let state = Arc::new(AtomicU8::new(BUSY));
        drop(Told(Some(Arc::clone(&state))));
        assert_eq!(state.load(Ordering::Acquire), FREE);
        for (is_readable, wanted) in [(true, READABLE), (false, FAILED)] {
            Told(Some(Arc::clone(&state))).tell(is_readable);
            assert_eq!(state.load(Ordering::Acquire), wanted);
        }
        // After its message it leaves the buffer alone, whoever uses it next.
        let mut told = Told(Some(Arc::clone(&state)));
        told.0.take();
        state.store(BUSY, Ordering::Release);
        drop(told);
        assert_eq!(state.load(Ordering::Acquire), BUSY);
    }
}
