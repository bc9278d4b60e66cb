//! A vertex buffer that is rewritten in each frame and grows with its content.

use bytemuck::NoUninit;

use crate::Gpu;

/// Instances of a frame: lines, insets, quads.
#[derive(Debug)]
pub(crate) struct VertexBuffer {
    label: &'static str,
    buffer: wgpu::Buffer,
    count: u32,
}

/// Bytes of a new buffer.
const FIRST_SIZE: u64 = 4096;

impl VertexBuffer {
    pub(crate) fn new(device: &wgpu::Device, label: &'static str) -> Self {
        Self { label, buffer: buffer(device, label, FIRST_SIZE), count: 0 }
    }

    /// Uploads a frame's instances.
    pub(crate) fn write<T: NoUninit>(&mut self, gpu: &Gpu, instances: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(instances);
        let size = bytes.len() as u64;
        if size > self.buffer.size() {
            self.buffer = buffer(&gpu.device, self.label, size.next_power_of_two());
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytes);
        self.count = instances.len() as u32;
    }

    /// Draws `vertices` vertices for each instance, if there are any instances.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, vertices: u32) {
        if self.count > 0 {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, self.buffer.slice(..));
            pass.draw(0..vertices, 0..self.count);
        }
    }
}

fn buffer(device: &wgpu::Device, label: &str, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
