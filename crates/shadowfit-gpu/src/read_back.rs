//! Results on their way from the GPU to the CPU, without waiting: a ring of buffers.

use core::fmt;

use crate::mapping::{MapState, Mapping};

/// Ring of read-back buffers. Each one brings the contents of a buffer to the CPU, together with a value of
/// the caller, for example the camera of the frame.
#[derive(Debug)]
pub struct ReadBackRing<T> {
    buffers: Vec<ReadBack<T>>,
    /// Number of recordings so far.
    recordings: u64,
    /// Recordings up to the last [`Self::forget`].
    forgotten: u64,
}

/// A buffer of the ring.
#[derive(Debug)]
struct ReadBack<T> {
    buffer: wgpu::Buffer,
    mapping: Mapping,
    /// Number of the last recording.
    recording: u64,
    value: Option<T>,
}

/// Error: the device was lost, or is out of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceLost;

impl fmt::Display for DeviceLost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the graphics device was lost, or is out of memory: open it again")
    }
}

impl core::error::Error for DeviceLost {}

impl<T> ReadBackRing<T> {
    /// Creates `buffers` buffers of this size in bytes, which must be a multiple of 4. Graphics APIs let the
    /// CPU be up to three frames ahead of the GPU.
    pub fn new(device: &wgpu::Device, label: &str, size: u64, buffers: usize) -> Self {
        let buffer = |_| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            ReadBack { buffer, mapping: Mapping::new(), recording: 0, value: None }
        };
        Self { buffers: (0..buffers).map(buffer).collect(), recordings: 0, forgotten: 0 }
    }

    /// Returns the index of a free buffer, or `None` if all are on their way.
    pub fn free(&self) -> Option<usize> {
        self.buffers.iter().position(|read_back| read_back.mapping.state() == MapState::Free)
    }

    /// Records the copy of the first bytes of `source`, with the value that [`Self::take`] returns with them.
    /// Returns `false`, and records no copy, if all buffers are on their way.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Buffer, value: T) -> bool {
        let Some(free) = self.free() else { return false };
        self.recordings += 1;
        let read_back = &mut self.buffers[free];
        (read_back.recording, read_back.value) = (self.recordings, Some(value));
        encoder.copy_buffer_to_buffer(source, 0, &read_back.buffer, 0, Some(read_back.buffer.size()));
        read_back.mapping.map_on_submit(encoder, &read_back.buffer);
        true
    }

    /// Returns the newest recording that the GPU has finished, only once: its value, and the result of `read`
    /// for its bytes. Returns `None` if there is none. Frees the buffers of older recordings. Never waits;
    /// poll the device first.
    ///
    /// # Errors
    ///
    /// [`DeviceLost`], once per loss.
    pub fn take<R>(&mut self, read: impl FnOnce(&[u8]) -> R) -> Result<Option<(T, R)>, DeviceLost> {
        // Check all buffers, so that a loss is returned once.
        if self.buffers.iter().filter(|read_back| read_back.mapping.take_failure()).count() > 0 {
            return Err(DeviceLost);
        }
        self.free_overtaken();
        let forgotten = self.forgotten;
        let Some(newest) = self.buffers.iter_mut().find(|read_back| read_back.is_readable()) else { return Ok(None) };
        let value = newest.value.take().filter(|_| newest.recording > forgotten);
        let taken = value.map(|value| {
            let mapped = newest.buffer.get_mapped_range(..).map_err(|_| DeviceLost)?;
            Ok((value, read(&mapped)))
        });
        newest.release();
        taken.transpose()
    }

    /// Frees the buffers of finished recordings if a newer one is finished.
    pub fn free_overtaken(&mut self) {
        let finished = self.buffers.iter().filter(|read_back| read_back.is_readable());
        let newest = finished.map(|read_back| read_back.recording).max().unwrap_or_default();
        let overtaken = |read_back: &&ReadBack<T>| read_back.is_readable() && read_back.recording < newest;
        self.buffers.iter().filter(overtaken).for_each(ReadBack::release);
    }

    /// Forgets all recordings so far, after a camera cut.
    pub fn forget(&mut self) {
        self.forgotten = self.recordings;
    }
}

impl<T> ReadBack<T> {
    fn is_readable(&self) -> bool {
        self.mapping.state() == MapState::Readable
    }

    fn release(&self) {
        self.mapping.release(&self.buffer);
    }
}
