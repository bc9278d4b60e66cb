//! Creation of pipelines: their differences, and the vertex streams of the scene's parts.

use core::mem::offset_of;

use crate::formats::{COLOR_FORMAT, DEPTH_FORMAT, STRIDES};
use crate::uniform::InstanceData;
use crate::wait::making;

/// Creates modules, layouts and pipelines.
#[derive(Clone, Copy, Debug)]
pub struct Maker<'a> {
    /// Device for the new objects.
    pub device: &'a wgpu::Device,
    /// Samples per pixel of the camera's passes.
    pub samples: u32,
}

/// Properties that differ between the pipelines.
#[derive(Clone, Debug)]
pub struct Shape<'a> {
    /// Name for debuggers.
    pub label: &'a str,
    /// Bind groups.
    pub layout: &'a wgpu::PipelineLayout,
    /// Module of both stages.
    pub module: &'a wgpu::ShaderModule,
    /// Entry points of the vertex and the fragment stage. Without a fragment stage only depth is written.
    pub entries: (&'a str, Option<&'a str>),
    /// Names and values of the module's `override` constants that differ from their defaults; 1 is true.
    pub constants: &'a [(&'a str, f64)],
    /// Vertex streams.
    pub buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    /// Colour targets.
    pub targets: &'a [Option<wgpu::ColorTargetState>],
    /// Kind of primitives, and the culled faces.
    pub primitive: wgpu::PrimitiveState,
    /// Whether depth is written, and how it is compared.
    pub depth: Option<wgpu::DepthStencilState>,
    /// Samples per pixel.
    pub samples: u32,
}

/// Target of passes that draw opaque colours.
pub(crate) const COLOR: [Option<wgpu::ColorTargetState>; 1] =
    [Some(wgpu::ColorTargetState { format: COLOR_FORMAT, blend: None, write_mask: wgpu::ColorWrites::ALL })];

/// Target of passes that blend colours by their alpha.
pub(crate) const BLENDED_COLOR: [Option<wgpu::ColorTargetState>; 1] = [Some(wgpu::ColorTargetState {
    format: COLOR_FORMAT,
    blend: Some(wgpu::BlendState::ALPHA_BLENDING),
    write_mask: wgpu::ColorWrites::ALL,
})];

/// Returns the state for triangle strips.
pub(crate) fn strips() -> wgpu::PrimitiveState {
    wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() }
}

/// Returns the state for triangles with these faces culled.
pub fn culled(cull_mode: Option<wgpu::Face>) -> wgpu::PrimitiveState {
    wgpu::PrimitiveState { cull_mode, ..Default::default() }
}

/// Returns the state of the camera's depth, written or not, with its comparison.
pub fn depth(write: bool, compare: wgpu::CompareFunction) -> Option<wgpu::DepthStencilState> {
    Some(wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(write),
        depth_compare: Some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    })
}

impl<'a> Shape<'a> {
    /// Returns a shape for passes that fill the picture: triangles of one sample without vertices, depth or
    /// blending.
    pub fn new(
        label: &'a str,
        layout: &'a wgpu::PipelineLayout,
        module: &'a wgpu::ShaderModule,
        entries: [&'a str; 2],
    ) -> Self {
        Self {
            label,
            layout,
            module,
            entries: (entries[0], Some(entries[1])),
            constants: &[],
            buffers: &[],
            targets: &COLOR,
            primitive: wgpu::PrimitiveState::default(),
            depth: None,
            samples: 1,
        }
    }
}

impl Maker<'_> {
    /// Creates a module from WGSL.
    pub fn module(&self, label: &str, source: String) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(source.into());
        making(|| self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source }))
    }

    /// Creates the layout of bind groups in this order.
    pub fn layout(&self, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
        let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        })
    }

    /// Creates a pipeline.
    pub fn pipeline(&self, shape: &Shape<'_>) -> wgpu::RenderPipeline {
        let compilation_options = wgpu::PipelineCompilationOptions { constants: shape.constants, ..Default::default() };
        let descriptor = wgpu::RenderPipelineDescriptor {
            label: Some(shape.label),
            layout: Some(shape.layout),
            vertex: wgpu::VertexState {
                module: shape.module,
                entry_point: Some(shape.entries.0),
                compilation_options: compilation_options.clone(),
                buffers: shape.buffers,
            },
            primitive: shape.primitive,
            depth_stencil: shape.depth.clone(),
            multisample: wgpu::MultisampleState { count: shape.samples, ..Default::default() },
            fragment: shape.entries.1.map(|entry| wgpu::FragmentState {
                module: shape.module,
                entry_point: Some(entry),
                compilation_options,
                targets: shape.targets,
            }),
            multiview_mask: None,
            cache: None,
        };
        making(|| self.device.create_render_pipeline(&descriptor))
    }
}

/// Meaning of an instance's number in shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstanceNumber {
    /// Number of its first triangle.
    FirstTriangle,
    /// The map that holds the instance.
    Holder,
}

/// Optional vertex streams of a part that have an element for each vertex. The others have a single element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Streams {
    /// Tangents; zero if missing.
    pub tangents: bool,
    /// Texture coordinates and colours; the origin and white if missing.
    pub surface: bool,
}

/// Slot of the instance stream, after the vertex streams.
pub(crate) const INSTANCES: u32 = 4;

/// Returns the vertex streams of a part: positions, normals, tangents, texture coordinates with colours, and
/// the instances.
pub fn part_buffers(number: InstanceNumber, streams: Streams) -> [Option<wgpu::VertexBufferLayout<'static>>; 5] {
    const POSITIONS: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
    const NORMALS: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![1 => Float32x3];
    const TANGENTS: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Float32x4];
    const SURFACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![3 => Float32x2, 4 => Float32x4];
    const FIRST_TRIANGLE: [wgpu::VertexAttribute; 4] = instance(offset_of!(InstanceData, first_triangle));
    const FIRST_MAP: [wgpu::VertexAttribute; 4] = instance(offset_of!(InstanceData, first_map));
    let stream = |array_stride: usize, step_mode, attributes| {
        Some(wgpu::VertexBufferLayout { array_stride: array_stride as u64, step_mode, attributes })
    };
    let [positions, normals, tangents, surface] = STRIDES;
    let instance = match number {
        InstanceNumber::FirstTriangle => &FIRST_TRIANGLE,
        InstanceNumber::Holder => &FIRST_MAP,
    };
    let each = wgpu::VertexStepMode::Vertex;
    [
        stream(positions, each, &POSITIONS),
        stream(normals, each, &NORMALS),
        stream(if streams.tangents { tangents } else { 0 }, each, &TANGENTS),
        stream(if streams.surface { surface } else { 0 }, each, &SURFACE),
        stream(size_of::<InstanceData>(), wgpu::VertexStepMode::Instance, instance),
    ]
}

/// Returns the streams of the shadow pass: positions, texture coordinates with colours, and the instances.
pub(crate) fn caster_buffers(surface: bool) -> [Option<wgpu::VertexBufferLayout<'static>>; 3] {
    let [positions, _, _, surface, instances] =
        part_buffers(InstanceNumber::FirstTriangle, Streams { tangents: false, surface });
    [positions, surface, instances]
}

/// Returns the rows of the transform, and the number at an offset.
const fn instance(number: usize) -> [wgpu::VertexAttribute; 4] {
    const ROW: usize = size_of::<[f32; 4]>();
    const ROWS: usize = offset_of!(InstanceData, rows);
    const fn attribute(location: u32, format: wgpu::VertexFormat, offset: usize) -> wgpu::VertexAttribute {
        wgpu::VertexAttribute { format, offset: offset as u64, shader_location: location }
    }
    [
        attribute(5, wgpu::VertexFormat::Float32x4, ROWS),
        attribute(6, wgpu::VertexFormat::Float32x4, ROWS + ROW),
        attribute(7, wgpu::VertexFormat::Float32x4, ROWS + 2 * ROW),
        attribute(8, wgpu::VertexFormat::Uint32, number),
    ]
}

/// Returns a stream of packed instances.
pub(crate) fn instances<T>(attributes: &[wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<T>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes,
    }
}
