//! Refits of skinned or morphed meshes: passes that read their positions from the engine's vertex buffer and
//! fit their hierarchy.

use shadowfit_gpu::bindings::{group, layout, storage};
use shadowfit_gpu::{compute_pipeline, wgsl_module};

use super::device::{LABEL, WORKGROUP_THREADS};
use super::ranges::MeshRanges;
use super::wgsl::refit_wgsl;
use crate::error::{RayError, VertexBufferLack};
use crate::mesh::RayMesh;
use crate::records::{RefitUniform, TriangleRecord};

/// Alignment of the dispatches' uniforms, in bytes: the greatest alignment that WebGPU allows a device to
/// require.
const UNIFORM_STEP: u64 = 256;
/// Bytes of a position.
const POSITION: u64 = 12;

/// Positions in a vertex buffer: three `f32` each, in the space of the mesh, in metres.
#[derive(Clone, Copy, Debug)]
pub struct VertexBuffer<'a> {
    /// The buffer, with the usage `STORAGE`.
    pub buffer: &'a wgpu::Buffer,
    /// Start of the first position, in bytes. A multiple of 4.
    pub offset: u64,
    /// Distance from one position to the next, in bytes. A multiple of 4, at least 12.
    pub stride: u32,
}

/// The pipelines of the passes.
#[derive(Debug)]
pub(crate) struct RefitPass {
    layout: wgpu::BindGroupLayout,
    triangles: wgpu::ComputePipeline,
    level: wgpu::ComputePipeline,
}

/// Data for refits of one mesh.
#[derive(Debug)]
pub(crate) struct Deforming {
    vertices: u64,
    /// Three vertex indices per triangle, in leaf order.
    indices: wgpu::Buffer,
    uniforms: wgpu::Buffer,
    /// The dispatches: first the triangles, then the levels, deepest first.
    steps: Vec<RefitUniform>,
    bound: Option<Bound>,
}

/// The buffers of a scene that a refit writes.
pub(crate) struct Refitted<'a> {
    pub(crate) triangles: &'a wgpu::Buffer,
    pub(crate) nodes: &'a wgpu::Buffer,
}

/// The bound part of a vertex buffer, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window {
    offset: u64,
    size: u64,
}

/// The bind group of the last refit, with its buffers.
#[derive(Debug)]
struct Bound {
    buffers: [wgpu::Buffer; 3],
    window: Window,
    group: wgpu::BindGroup,
}

impl RefitPass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: None,
        };
        let types = [uniform, storage(true), storage(true), storage(false), storage(false)];
        let layout = layout(device, LABEL, wgpu::ShaderStages::COMPUTE, &types);
        let module = wgsl_module(device, "shadowfit rays refit", refit_wgsl());
        let pipeline = |entry| compute_pipeline(device, entry, &[Some(&layout)], &module, entry);
        Self { triangles: pipeline("move_triangles"), level: pipeline("fit_level"), layout }
    }

    /// Records the refit of a mesh of a scene.
    pub(crate) fn record(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        deforming: &mut Deforming,
        scene: &Refitted<'_>,
        vertices: &VertexBuffer<'_>,
    ) -> Result<(), RayError> {
        let limits = device.limits();
        let window = window(vertices, deforming.vertices, &limits)?;
        deforming.bind(device, &self.layout, scene, vertices.buffer, window);
        let step = &mut deforming.steps[0];
        let read = ((vertices.offset - window.offset) as u32 / 4, vertices.stride / 4);
        if (step.offset, step.stride) != read {
            (step.offset, step.stride) = read;
            queue.write_buffer(&deforming.uniforms, 0, bytemuck::bytes_of(step));
        }
        let Some(bound) = &deforming.bound else { return Ok(()) };
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("shadowfit rays refit"),
            timestamp_writes: None,
        });
        for (number, step) in deforming.steps.iter().enumerate() {
            pass.set_pipeline(if number == 0 { &self.triangles } else { &self.level });
            pass.set_bind_group(0, &bound.group, &[(number as u64 * UNIFORM_STEP) as u32]);
            let [columns, rows] = groups(step.count, limits.max_compute_workgroups_per_dimension);
            pass.dispatch_workgroups(columns, rows, 1);
        }
        Ok(())
    }
}

impl Deforming {
    /// Creates the buffers for the refits of a mesh in a scene.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, mesh: &RayMesh, ranges: &MeshRanges) -> Self {
        let step = |first: u32, count: u32| RefitUniform { first, count, ..RefitUniform::default() };
        let ends = mesh.hierarchy.levels.iter().skip(1).copied().chain([ranges.nodes.len() as u32]);
        let levels = mesh.hierarchy.levels.iter().zip(ends);
        let mut steps = vec![step(ranges.triangles.start, ranges.triangles.len() as u32)];
        steps.extend(levels.map(|(first, end)| step(ranges.nodes.start + first, end - first)));
        steps[1..].reverse();
        let vertices_of = |triangle: &TriangleRecord| mesh.vertices_of(triangle.index);
        let mut indices: Vec<[u32; 3]> = mesh.triangles.iter().map(vertices_of).collect();
        // Empty buffers cannot be bound.
        if indices.is_empty() {
            indices.push([0; 3]);
        }
        let uniform_bytes = steps.len() as u64 * UNIFORM_STEP;
        let uniforms = buffer(device, "refit steps", uniform_bytes, wgpu::BufferUsages::UNIFORM);
        for (number, step) in (0..).zip(&steps) {
            queue.write_buffer(&uniforms, number * UNIFORM_STEP, bytemuck::bytes_of(step));
        }
        let bytes = bytemuck::cast_slice(&indices);
        let index_buffer = buffer(device, "refit indices", bytes.len() as u64, wgpu::BufferUsages::STORAGE);
        queue.write_buffer(&index_buffer, 0, bytes);
        Self { vertices: mesh.vertices as u64, indices: index_buffer, uniforms, steps, bound: None }
    }

    /// Returns the bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        self.indices.size() + self.uniforms.size()
    }

    /// Creates the bind group, unless the last refit had the same buffers.
    fn bind(
        &mut self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        scene: &Refitted<'_>,
        vertices: &wgpu::Buffer,
        window: Window,
    ) {
        let buffers = [vertices, scene.triangles, scene.nodes];
        let is_same = |bound: &Bound| bound.window == window && bound.buffers.each_ref() == buffers;
        if self.bound.as_ref().is_some_and(is_same) {
            return;
        }
        let part = |buffer, offset, size| {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size: wgpu::BufferSize::new(size) })
        };
        let resources = [
            part(&self.uniforms, 0, size_of::<RefitUniform>() as u64),
            part(vertices, window.offset, window.size),
            self.indices.as_entire_binding(),
            scene.triangles.as_entire_binding(),
            scene.nodes.as_entire_binding(),
        ];
        let group = group(device, LABEL, layout, &resources);
        self.bound = Some(Bound { buffers: buffers.map(Clone::clone), window, group });
    }
}

/// Returns the part of a vertex buffer to bind for a number of vertices.
fn window(vertices: &VertexBuffer<'_>, count: u64, limits: &wgpu::Limits) -> Result<Window, RayError> {
    let VertexBuffer { buffer, offset, stride } = *vertices;
    let lacks = |lack| Err(RayError::Vertices(lack));
    if !buffer.usage().contains(wgpu::BufferUsages::STORAGE) {
        return lacks(VertexBufferLack::Usage(buffer.usage()));
    }
    if !offset.is_multiple_of(4) || !stride.is_multiple_of(4) || u64::from(stride) < POSITION {
        return lacks(VertexBufferLack::Alignment { offset, stride });
    }
    let length = count.saturating_sub(1).saturating_mul(stride.into()).saturating_add(POSITION);
    let needed = offset.saturating_add(length);
    if needed > buffer.size() {
        return lacks(VertexBufferLack::Size { size: buffer.size(), needed });
    }
    let alignment = u64::from(limits.min_storage_buffer_offset_alignment);
    let first = offset / alignment * alignment;
    let limit = limits.max_storage_buffer_binding_size;
    if needed - first > limit {
        return Err(RayError::TooLarge { what: "vertices of a deforming mesh", bytes: needed - first, limit });
    }
    Ok(Window { offset: first, size: needed - first })
}

/// Returns columns and rows of workgroups for a number of threads. One row may be too short for all.
fn groups(threads: u32, limit: u32) -> [u32; 2] {
    let all = threads.div_ceil(WORKGROUP_THREADS);
    let columns = all.min(limit);
    [columns, all.div_ceil(columns.max(1))]
}

fn buffer(device: &wgpu::Device, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let usage = usage | wgpu::BufferUsages::COPY_DST;
    device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_workgroups_than_a_row_holds_stand_in_rows_that_hold_all_threads() {
        for (threads, wanted) in [(0, [0, 0]), (1, [1, 1]), (256, [1, 1]), (257, [2, 1]), (256 * 65_535, [65_535, 1])] {
            assert_eq!(groups(threads, 65_535), wanted, "{threads}");
        }
        let [columns, rows] = groups(u32::MAX, 65_535);
        assert_eq!((columns, rows), (65_535, 257));
        assert!(u64::from(columns) * u64::from(rows) * u64::from(WORKGROUP_THREADS) >= u64::from(u32::MAX));
    }
}
