//! A buffer of records that grows by doubling, with an allocator of ranges.

use core::ops::Range;

use super::device::{buffer_limit, caught};
use crate::error::RayError;

/// Initial number of records in a buffer: enough for small scenes, and less than a page.
const FIRST_RECORDS: u64 = 64;
/// Bytes per upload, to avoid a second copy of a large mesh in memory.
const UPLOAD_BYTES: usize = 1 << 20;

/// A storage buffer of records.
#[derive(Debug)]
pub(crate) struct Records {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Name of the records, for labels and errors.
    what: &'static str,
    /// Bytes of one record.
    stride: u64,
    limit: u64,
    buffer: wgpu::Buffer,
}

impl Records {
    pub(crate) fn new<T>(device: &wgpu::Device, queue: &wgpu::Queue, what: &'static str) -> Result<Self, RayError> {
        let stride = size_of::<T>() as u64;
        let buffer = caught(device, || buffer(device, what, stride * FIRST_RECORDS))?;
        let limit = buffer_limit(device) / stride * stride;
        Ok(Self { device: device.clone(), queue: queue.clone(), what, stride, limit, buffer })
    }

    pub(crate) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Makes room for a number of records, and keeps the existing ones. This may replace the buffer.
    pub(crate) fn reserve(&mut self, records: u64) -> Result<(), RayError> {
        let bytes = records.saturating_mul(self.stride);
        if bytes <= self.buffer.size() {
            return Ok(());
        }
        if bytes > self.limit {
            return Err(RayError::TooLarge { what: self.what, bytes, limit: self.limit });
        }
        let bytes = bytes.max((self.buffer.size() * 2).min(self.limit));
        let larger = caught(&self.device, || buffer(&self.device, self.what, bytes))?;
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&self.buffer, 0, &larger, 0, self.buffer.size());
        self.queue.submit([encoder.finish()]);
        self.buffer = larger;
        Ok(())
    }

    /// Writes records from index `first` on.
    pub(crate) fn write<T: bytemuck::Pod>(&self, first: u32, records: &[T]) {
        self.queue.write_buffer(&self.buffer, u64::from(first) * self.stride, bytemuck::cast_slice(records));
    }

    /// Writes records from index `first` on, in several uploads.
    pub(crate) fn write_all<T: bytemuck::Pod>(&self, first: u32, mut records: impl ExactSizeIterator<Item = T>) {
        let at_a_time = (UPLOAD_BYTES / size_of::<T>()).min(records.len());
        let (mut first, mut piece) = (first, Vec::with_capacity(at_a_time));
        while records.len() > 0 {
            piece.clear();
            piece.extend(records.by_ref().take(at_a_time));
            self.write(first, &piece);
            first += piece.len() as u32;
        }
    }
}

/// A storage buffer with its free ranges.
#[derive(Debug)]
pub(crate) struct Pool {
    pub(crate) records: Records,
    /// Free ranges in ascending order. They are not empty and do not touch each other.
    free: Vec<Range<u32>>,
    /// End of all ranges that were ever taken.
    end: u32,
}

impl Pool {
    pub(crate) fn new<T>(device: &wgpu::Device, queue: &wgpu::Queue, what: &'static str) -> Result<Self, RayError> {
        Ok(Self { records: Records::new::<T>(device, queue, what)?, free: Vec::new(), end: 0 })
    }

    /// Takes a range of a length: the first free one that is long enough, or a new one at the end.
    pub(crate) fn take(&mut self, length: usize) -> Result<Range<u32>, RayError> {
        let wanted = length as u64;
        if let Some(place) = self.free.iter().position(|free| free.len() as u64 >= wanted && wanted > 0) {
            let free = &mut self.free[place];
            let taken = free.start..free.start + length as u32;
            free.start = taken.end;
            if free.start == free.end {
                self.free.remove(place);
            }
            return Ok(taken);
        }
        let end = u64::from(self.end) + wanted;
        let taken = self.end..u32::try_from(end).map_err(|_| self.too_many(end))?;
        self.records.reserve(end)?;
        self.end = taken.end;
        Ok(taken)
    }

    /// Returns a range to the pool.
    pub(crate) fn give(&mut self, range: Range<u32>) {
        if range.is_empty() {
            return;
        }
        let place = self.free.partition_point(|free| free.end < range.start);
        let mut joined = range;
        // At most two free ranges touch it, one in front of it and one behind it.
        while self.free.get(place).is_some_and(|free| free.start <= joined.end) {
            let free = self.free.remove(place);
            joined = joined.start.min(free.start)..joined.end.max(free.end);
        }
        if joined.end == self.end {
            self.end = joined.start;
        } else {
            self.free.insert(place, joined);
        }
    }

    fn too_many(&self, records: u64) -> RayError {
        let bytes = records.saturating_mul(self.records.stride);
        RayError::TooLarge { what: self.records.what, bytes, limit: u64::from(u32::MAX) * self.records.stride }
    }
}

fn buffer(device: &wgpu::Device, what: &str, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: false })
}
