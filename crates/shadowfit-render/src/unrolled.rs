//! Numbering of a probe's triangles. On most graphics cards fragments have a primitive index, but not in
//! browsers. There parts are drawn without indices, so that triangle i has the vertices 3 i to 3 i + 2.

use crate::Gpu;
use crate::formats::STRIDES;
use crate::upload::Upload;

/// Source of a probe's triangle numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Numbering {
    /// The primitive index of fragment shaders.
    Primitives,
    /// The vertex index of parts that are drawn without indices.
    Vertices,
}

impl Numbering {
    /// Returns the numbering for a device: by vertices if it lacks [`wgpu::Features::PRIMITIVE_INDEX`].
    pub fn of(device: &wgpu::Device) -> Self {
        if device.features().contains(wgpu::Features::PRIMITIVE_INDEX) { Self::Primitives } else { Self::Vertices }
    }

    /// Returns the vertex entry point of probes. `of_pictures` is the entry point of pictures.
    pub const fn vertex_entry(self, of_pictures: &'static str) -> &'static str {
        match self {
            Self::Primitives => of_pictures,
            Self::Vertices => "vs_probe",
        }
    }

    /// Returns the directives that WGSL must begin with.
    pub const fn directive(self) -> &'static str {
        match self {
            Self::Primitives => "enable primitive_index;\n",
            Self::Vertices => "",
        }
    }
}

/// Vertices of a part in the order of its indices.
#[derive(Clone, Debug)]
pub(crate) struct Unrolled {
    /// Streams that have an element for each vertex.
    streams: [Option<wgpu::Buffer>; 4],
    vertices: u32,
}

impl Unrolled {
    /// Unrolls a part's streams, in the order of [`part_buffers`](crate::passes::part_buffers). `None` for
    /// streams with a single element.
    pub(crate) fn new(upload: &Upload<'_>, indices: &[u32], streams: [Option<&[u8]>; 4]) -> Self {
        let mut strides = STRIDES.into_iter();
        let streams = streams.map(|stream| {
            let stride = strides.next().unwrap_or_default();
            stream.map(|stream| upload.buffer(wgpu::BufferUsages::VERTEX, &unrolled(indices, stream, stride)))
        });
        Self { streams, vertices: indices.len() as u32 }
    }

    /// Rewrites positions, normals and tangents, if there are any.
    pub(crate) fn write(&self, gpu: &Gpu, indices: &[u32], streams: [&[u8]; 3]) {
        for ((buffer, stream), stride) in self.streams.iter().zip(streams).zip(STRIDES) {
            if let Some(buffer) = buffer.as_ref().filter(|_| !stream.is_empty()) {
                gpu.queue.write_buffer(buffer, 0, &unrolled(indices, stream, stride));
            }
        }
    }

    /// Draws the part. `streams` are the part's streams, used for the single elements.
    pub(crate) fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        streams: &[wgpu::Buffer; 4],
        instances: core::ops::Range<u32>,
    ) {
        for ((unrolled, single), slot) in self.streams.iter().zip(streams).zip(0..) {
            pass.set_vertex_buffer(slot, unrolled.as_ref().unwrap_or(single).slice(..));
        }
        pass.draw(0..self.vertices, instances);
    }
}

fn unrolled(indices: &[u32], stream: &[u8], stride: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(indices.len() * stride);
    for index in indices {
        bytes.extend_from_slice(&stream[*index as usize * stride..][..stride]);
    }
    bytes
}
