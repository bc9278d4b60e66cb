//! Upload of vertices, indices and images to the GPU, in pieces. Once the device is out of memory, nothing
//! more is uploaded: without memory for small allocations, it would be lost.

use std::cell::RefCell;

use crate::{DeviceFault, Gpu};

/// Bytes in transit at a time. Each of them is held twice meanwhile.
const PIECE: usize = 16 << 20;
/// Bytes of an empty buffer.
const LEAST: u64 = 4;

/// Upload of a scene.
pub(crate) struct Upload<'a> {
    pub(crate) gpu: &'a Gpu,
    fault: RefCell<Option<DeviceFault>>,
}

impl<'a> Upload<'a> {
    pub(crate) fn new(gpu: &'a Gpu) -> Self {
        Self { gpu, fault: RefCell::default() }
    }

    /// Returns the uploaded value, unless there was a fault.
    pub(crate) fn result<T>(self, uploaded: T) -> Result<T, DeviceFault> {
        match self.fault.into_inner() {
            Some(fault) => Err(fault),
            None => Ok(uploaded),
        }
    }

    /// Creates a buffer with these bytes. After a fault it is an unused placeholder.
    pub(crate) fn buffer(&self, usage: wgpu::BufferUsages, bytes: &[u8]) -> wgpu::Buffer {
        let empty = |size| {
            self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("primitive"),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let Some(buffer) = self.make(|| empty((bytes.len() as u64).max(LEAST))) else { return empty(LEAST) };
        for (index, piece) in bytes.chunks(PIECE).enumerate() {
            self.gpu.queue.write_buffer(&buffer, (index * PIECE) as u64, piece);
            if bytes.len() > PIECE {
                self.send();
            }
        }
        buffer
    }

    /// Creates a texture whose first level has these rows of four-byte pixels; `None` after a fault.
    pub(crate) fn texture(&self, descriptor: &wgpu::TextureDescriptor<'_>, rgba: &[u8]) -> Option<wgpu::Texture> {
        let texture = self.make(|| self.gpu.device.create_texture(descriptor))?;
        let row = descriptor.size.width as usize * 4;
        let rows = (PIECE / row).max(1);
        for (index, piece) in rgba.chunks(rows * row).enumerate() {
            let y = (index * rows) as u32;
            let origin = wgpu::Origin3d { y, ..wgpu::Origin3d::ZERO };
            self.gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() },
                piece,
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None },
                wgpu::Extent3d { height: (piece.len() / row) as u32, ..descriptor.size },
            );
            if rgba.len() > PIECE {
                self.send();
            }
        }
        Some(texture)
    }

    fn make<T>(&self, make: impl FnOnce() -> T) -> Option<T> {
        let mut fault = self.fault.borrow_mut();
        if fault.is_some() {
            return None;
        }
        self.gpu.try_making(make).map_err(|error| *fault = Some(error)).ok()
    }

    /// Waits until all uploads have arrived.
    fn send(&self) {
        self.gpu.submit([]);
        // A lost device is reported when it is used for drawing.
        let _ = self.gpu.device.poll(wgpu::PollType::wait_indefinitely());
    }
}
