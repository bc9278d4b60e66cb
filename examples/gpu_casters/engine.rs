//! The part of an engine that keeps its casters on the GPU: a compute shader culls the casters for each
//! region of a shadow pass, and writes the arguments of one indirect draw per region.

use shadowfit_wgpu::{CullingRegion, DrawRegion, SunShadows, WgslOptions, caster_wgsl, culling_wgsl};
use wgpu::util::{BufferInitDescriptor, DeviceExt, DrawIndexedIndirectArgs};

use super::town::Block;

/// WGSL of a caster in the storage buffer.
const CASTER: &str = "
struct Caster {
    centre: vec3<f32>,
    moves: u32,
    half_size: vec3<f32>,
    padding: u32,
}
";

/// WGSL that culls the casters: one thread for each pair of region and caster.
const CULL: &str = "
struct Draw {
    index_count: u32,
    instance_count: atomic<u32>,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32,
}
@group(1) @binding(0) var<storage, read> casters: array<Caster>;
@group(1) @binding(1) var<storage, read_write> draws: array<Draw>;
@group(1) @binding(2) var<storage, read_write> numbers: array<u32>;

@compute @workgroup_size(64) fn cull(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = arrayLength(&casters);
    if id.x >= count {
        return;
    }
    let caster = casters[id.x];
    let low = caster.centre - caster.half_size;
    let high = caster.centre + caster.half_size;
    if shadowfit_draws_box(id.y, caster.moves == 1u, low, high) {
        let place = atomicAdd(&draws[id.y].instance_count, 1u);
        numbers[id.y * count + place] = id.x;
    }
}
";

/// WGSL that draws an instance by its caster number.
const VERTEX: &str = "
@group(1) @binding(0) var<storage, read> casters: array<Caster>;

@vertex fn vs(@location(0) corner: vec3<f32>, @location(1) number: u32) -> @builtin(position) vec4<f32> {
    let caster = casters[number];
    return shadowfit_caster_position(caster.centre + corner * caster.half_size);
}
";

/// Indices of the mesh that all blocks share.
const INDICES: [u16; 36] =
    [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6];

/// The buffers of a frame that the compute shader writes.
pub(crate) struct Draws {
    /// Arguments of an indirect draw for each region.
    pub(crate) arguments: wgpu::Buffer,
    /// Numbers of the casters to draw. Each region has room for all casters.
    numbers: wgpu::Buffer,
}

/// Pipelines and buffers of the casters.
pub(crate) struct GpuCasters {
    device: wgpu::Device,
    /// The blocks of the town.
    pub(crate) casters: wgpu::Buffer,
    corners: wgpu::Buffer,
    indices: wgpu::Buffer,
    cull: wgpu::ComputePipeline,
    draw: wgpu::RenderPipeline,
    /// Bind group of the casters for the vertex shader.
    group: wgpu::BindGroup,
}

impl GpuCasters {
    pub(crate) fn new(device: &wgpu::Device, sun: &SunShadows, blocks: &[Block]) -> Self {
        let (cull, draw) = (cull_pipeline(device), draw_pipeline(device, sun));
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let casters = filled(device, bytemuck::cast_slice(blocks), usage);
        let corner = |bits: u32| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { 1.0_f32 } else { -1.0 });
        let corners: Vec<[f32; 3]> = (0..8).map(corner).collect();
        let group = group(device, &draw.get_bind_group_layout(1), &[&casters]);
        Self {
            device: device.clone(),
            casters,
            corners: filled(device, bytemuck::cast_slice(&corners), wgpu::BufferUsages::VERTEX),
            indices: filled(device, bytemuck::cast_slice(&INDICES), wgpu::BufferUsages::INDEX),
            cull,
            draw,
            group,
        }
    }

    fn count(&self) -> u32 {
        (self.casters.size() / size_of::<Block>() as u64) as u32
    }

    /// Records the compute pass that culls the casters of each region. Returns `None` if the frame has no
    /// region.
    pub(crate) fn cull(&self, encoder: &mut wgpu::CommandEncoder, sun: &SunShadows) -> Option<Draws> {
        let regions: Vec<CullingRegion> = sun.culling_regions().collect();
        if regions.is_empty() {
            return None;
        }
        let arguments = DrawIndexedIndirectArgs { index_count: INDICES.len() as u32, ..Default::default() };
        let arguments: Vec<u8> = regions.iter().flat_map(|_| arguments.as_bytes().to_vec()).collect();
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_SRC;
        let draws = Draws {
            arguments: filled(&self.device, &arguments, usage),
            numbers: self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: regions.len() as u64 * self.numbers_of_a_region(),
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX,
                mapped_at_creation: false,
            }),
        };
        let pieces_buffer = filled(&self.device, bytemuck::cast_slice(&regions), wgpu::BufferUsages::STORAGE);
        let layouts = [0, 1].map(|group| self.cull.get_bind_group_layout(group));
        let groups = [
            group(&self.device, &layouts[0], &[&pieces_buffer]),
            group(&self.device, &layouts[1], &[&self.casters, &draws.arguments, &draws.numbers]),
        ];
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.cull);
        pass.set_bind_group(0, &groups[0], &[]);
        pass.set_bind_group(1, &groups[1], &[]);
        pass.dispatch_workgroups(self.count().div_ceil(64), regions.len() as u32, 1);
        drop(pass);
        Some(draws)
    }

    /// Returns the size of a region's caster numbers, in bytes.
    fn numbers_of_a_region(&self) -> u64 {
        u64::from(self.count()) * size_of::<u32>() as u64
    }

    /// Draws a region of a shadow pass.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, region: &DrawRegion<'_>, draws: &Draws) {
        let number = region.number as u64;
        self.bind(pass, draws.numbers.slice(number * self.numbers_of_a_region()..));
        pass.draw_indexed_indirect(&draws.arguments, number * size_of::<DrawIndexedIndirectArgs>() as u64);
    }

    /// Binds everything that is needed to draw the casters with these numbers.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>, numbers: wgpu::BufferSlice<'_>) {
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.set_vertex_buffer(1, numbers);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
    }
}

fn filled(device: &wgpu::Device, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
}

fn group(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
    let resources = buffers.iter().map(|buffer| buffer.as_entire_binding());
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

fn module(device: &wgpu::Device, wgsl: &[&str]) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(wgsl.concat().into());
    device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
}

fn cull_pipeline(device: &wgpu::Device) -> wgpu::ComputePipeline {
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module(device, &[&culling_wgsl(&WgslOptions::group(0)), CASTER, CULL]),
        entry_point: Some("cull"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}

fn draw_pipeline(device: &wgpu::Device, sun: &SunShadows) -> wgpu::RenderPipeline {
    let map = sun.map();
    let casters = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(map.caster_layout()), Some(&casters)],
        immediate_size: 0,
    });
    let buffer =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module(device, &[&caster_wgsl(map.descriptor(), &WgslOptions::group(0)), CASTER, VERTEX]),
            entry_point: Some("vs"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[
                buffer(12, wgpu::VertexStepMode::Vertex, &wgpu::vertex_attr_array![0 => Float32x3]),
                buffer(4, wgpu::VertexStepMode::Instance, &wgpu::vertex_attr_array![1 => Uint32]),
            ],
        },
        primitive: map.primitive_state(),
        depth_stencil: Some(map.depth_stencil_state()),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}
