//! Pipelines of the samples' passes, made when a frame first needs them.

use std::collections::HashMap;

use super::map::{self, MAP_DEPTH, cull_mode};
use super::{CasterFaces, SampleFormat, SampleFrame, ShadingKind, StoredDepth, TestKind};
use crate::material::material_layout;
use crate::pipelines::{InstanceNumber, Maker, Shape, part_buffers};
use crate::probe::PROBE_FORMAT;
use crate::shaders::samples as shaders;
use crate::target::ENCODED_FORMAT;
use crate::{Gpu, bindings};

/// A kind of pass, by all that its shaders and states depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    Caster { format: SampleFormat, depth: StoredDepth, faces: CasterFaces, mirrored: bool },
    Shaded { read: Read, shading: ShadingKind, faces: CasterFaces, mirrored: bool },
    Probe { read: Read, faces: CasterFaces, mirrored: bool },
    Inset { format: SampleFormat },
}

/// How a map is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Read {
    format: SampleFormat,
    test: TestKind,
}

impl Read {
    pub(super) fn of(frame: &SampleFrame<'_>) -> Self {
        Self { format: frame.map.format, test: frame.test.into() }
    }
}

/// Layouts and pipelines.
#[derive(Debug)]
pub(super) struct SamplePipelines {
    pub(super) uniform: wgpu::BindGroupLayout,
    material: wgpu::BindGroupLayout,
    maps: [wgpu::BindGroupLayout; 2],
    made: HashMap<Kind, wgpu::RenderPipeline>,
    samples: u32,
}

impl SamplePipelines {
    pub(super) fn new(gpu: &Gpu, samples: u32) -> Self {
        let device = &gpu.device;
        let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
        Self {
            uniform: bindings::layout(device, "sample", visibility, &[bindings::UNIFORM]),
            material: material_layout(device),
            maps: [false, true].map(|is_depth| map::layout(device, is_depth)),
            made: HashMap::new(),
            samples,
        }
    }

    /// Layout of the bind group of a map.
    pub(super) fn map(&self, format: SampleFormat) -> &wgpu::BindGroupLayout {
        &self.maps[usize::from(format.is_depth())]
    }

    /// Makes a pipeline that is not there yet.
    pub(super) fn add(&mut self, gpu: &Gpu, kind: Kind) {
        if !self.made.contains_key(&kind) {
            let pipeline = self.make(gpu, kind);
            self.made.insert(kind, pipeline);
        }
    }

    /// A pipeline that [`Self::add`] has made.
    pub(super) fn get(&self, kind: Kind) -> &wgpu::RenderPipeline {
        &self.made[&kind]
    }

    fn make(&self, gpu: &Gpu, kind: Kind) -> wgpu::RenderPipeline {
        let maker = Maker { device: &gpu.device, samples: self.samples };
        match kind {
            Kind::Caster { format, depth, faces, mirrored } => {
                caster(&maker, &maker.layout(&[&self.uniform]), (format, depth), cull_mode(faces, mirrored))
            }
            Kind::Shaded { read, shading, faces, mirrored } => {
                let module = maker.module("sample", shaders::shaded(read.format, read.test, shading));
                maker.pipeline(&Shape {
                    buffers: &part_buffers(InstanceNumber::FirstTriangle),
                    targets: &[Some(ENCODED_FORMAT.into())],
                    cull_mode: cull_mode(faces, mirrored),
                    depth: Some((true, wgpu::CompareFunction::GreaterEqual)),
                    samples: self.samples,
                    ..Shape::new("sample", &self.picture(&maker, read.format), &module, ["vs_sample", "fs_shaded"])
                })
            }
            Kind::Probe { read, faces, mirrored } => {
                let module = maker.module("sample's probe", shaders::probe(read.format, read.test));
                maker.pipeline(&Shape {
                    buffers: &part_buffers(InstanceNumber::FirstTriangle),
                    targets: &[Some(PROBE_FORMAT.into())],
                    cull_mode: cull_mode(faces, mirrored),
                    depth: Some((true, wgpu::CompareFunction::GreaterEqual)),
                    ..Shape::new("probe", &self.picture(&maker, read.format), &module, ["vs_sample", "fs_probe"])
                })
            }
            Kind::Inset { format } => {
                let module = maker.module("sample's inset", shaders::inset(format));
                let layout = maker.layout(&[&self.uniform, self.map(format)]);
                maker.pipeline(&Shape {
                    targets: &[Some(ENCODED_FORMAT.into())],
                    ..Shape::new("sample's inset", &layout, &module, ["vs_inset", "fs_inset"])
                })
            }
        }
    }

    /// Layout of what draws the scene as the camera sees it.
    fn picture(&self, maker: &Maker<'_>, format: SampleFormat) -> wgpu::PipelineLayout {
        maker.layout(&[&self.uniform, self.map(format), &self.material])
    }
}

fn caster(
    maker: &Maker<'_>,
    layout: &wgpu::PipelineLayout,
    (format, depth): (SampleFormat, StoredDepth),
    cull_mode: Option<wgpu::Face>,
) -> wgpu::RenderPipeline {
    let module = maker.module("sample's casters", shaders::caster());
    let entry = match (format, depth) {
        (SampleFormat::Depth32, _) => None,
        (SampleFormat::Rgba8Packed, StoredDepth::Plain) => Some("fs_packed"),
        (SampleFormat::Rgba8Packed, StoredDepth::ReversedAtVertices) => Some("fs_packed_reversed"),
        (_, StoredDepth::Plain) => Some("fs_depth"),
        (_, StoredDepth::ReversedAtVertices) => Some("fs_reversed"),
    };
    let targets = [(!format.is_depth()).then(|| format.texture().into())];
    maker.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("sample's casters"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_caster"),
            compilation_options: Default::default(),
            buffers: &part_buffers(InstanceNumber::FirstTriangle),
        },
        primitive: wgpu::PrimitiveState { cull_mode, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: MAP_DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: entry.map(|entry| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
