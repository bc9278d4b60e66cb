//! How a probe's triangles get their numbers. Fragments know their primitive on most graphics cards, but not in browsers:
//! there parts are drawn without their indices, so that vertices 3 i to 3 i + 2 are those of triangle i.

use crate::Gpu;
use crate::formats::STRIDES;
use crate::upload::Upload;

/// What a probe's triangles are numbered by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Numbering {
    /// By the primitive index of fragment shaders.
    Primitives,
    /// By the vertices of parts that are drawn without their indices.
    Vertices,
}

impl Numbering {
    /// By vertices where a device has no [`wgpu::Features::PRIMITIVE_INDEX`].
    pub fn of(device: &wgpu::Device) -> Self {
        if device.features().contains(wgpu::Features::PRIMITIVE_INDEX) { Self::Primitives } else { Self::Vertices }
    }

    /// The vertex entry point of probes, where pictures have another.
    pub const fn vertex_entry(self, of_pictures: &'static str) -> &'static str {
        match self {
            Self::Primitives => of_pictures,
            Self::Vertices => "vs_probe",
        }
    }

    /// What WGSL must begin with.
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
    /// Those that have an element for each vertex.
    streams: [Option<wgpu::Buffer>; 4],
    vertices: u32,
}

impl Unrolled {
    /// Unrolls a part's streams, which are as [`part_buffers`](crate::passes::part_buffers) has them; `None` where there is
    /// a single element.
    pub(crate) fn new(upload: &Upload<'_>, indices: &[u32], streams: [Option<&[u8]>; 4]) -> Self {
        let mut strides = STRIDES.into_iter();
        let streams = streams.map(|stream| {
            let stride = strides.next().unwrap_or_default();
            stream.map(|stream| upload.buffer(wgpu::BufferUsages::VERTEX, &unrolled(indices, stream, stride)))
        });
        Self { streams, vertices: indices.len() as u32 }
    }

    /// Rewrites positions, normals and tangents, where there are any.
    pub(crate) fn write(&self, gpu: &Gpu, indices: &[u32], streams: [&[u8]; 3]) {
        for ((buffer, stream), stride) in self.streams.iter().zip(streams).zip(STRIDES) {
            if let Some(buffer) = buffer.as_ref().filter(|_| !stream.is_empty()) {
                gpu.queue.write_buffer(buffer, 0, &unrolled(indices, stream, stride));
            }
        }
    }

    /// Draws it; `streams` are those of the part, which have the single elements.
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
