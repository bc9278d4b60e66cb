//! Pipelines of mapped frames, created on first use.

use std::collections::HashMap;

use shadowfit_render::passes::{
    ENCODED_FORMAT, InstanceNumber, Maker, Numbering, PROBE_FORMAT, Shape, Streams, culled, depth, material_layout,
    part_buffers,
};
use shadowfit_render::{Gpu, bindings};

use super::{SampleFormat, SampleFrame, StoredDepth, map, shaders};

/// Purpose of a pipeline, with the values that its states depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Use {
    Caster(Option<wgpu::Face>, Streams),
    Shaded(Option<wgpu::Face>, Streams),
    Probe(Option<wgpu::Face>, Streams),
    Inset,
}

/// Key of a pipeline: its use, the map's format, and the names of the test and the shading.
type Key = (Use, SampleFormat, StoredDepth, [&'static str; 2]);

/// Layouts and pipelines.
#[derive(Debug)]
pub(super) struct SamplePipelines {
    pub(super) uniform: wgpu::BindGroupLayout,
    material: wgpu::BindGroupLayout,
    maps: [wgpu::BindGroupLayout; 2],
    made: HashMap<Key, wgpu::RenderPipeline>,
    samples: u32,
}

fn key(purpose: Use, frame: &SampleFrame) -> Key {
    (purpose, frame.map.format, frame.map.depth, [frame.test.name, frame.shading.name])
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

    /// Returns the layout of the bind group of a map.
    pub(super) fn map(&self, format: SampleFormat) -> &wgpu::BindGroupLayout {
        &self.maps[usize::from(format.is_depth())]
    }

    /// Creates a frame's pipeline unless it exists.
    pub(super) fn add(&mut self, gpu: &Gpu, purpose: Use, frame: &SampleFrame) {
        if !self.made.contains_key(&key(purpose, frame)) {
            let pipeline = self.make(gpu, purpose, frame);
            self.made.insert(key(purpose, frame), pipeline);
        }
    }

    /// Returns a frame's pipeline, which [`Self::add`] has created.
    pub(super) fn get(&self, purpose: Use, frame: &SampleFrame) -> &wgpu::RenderPipeline {
        &self.made[&key(purpose, frame)]
    }

    fn make(&self, gpu: &Gpu, purpose: Use, frame: &SampleFrame) -> wgpu::RenderPipeline {
        let maker = Maker { device: &gpu.device, samples: self.samples };
        let numbering = Numbering::of(&gpu.device);
        let seen = |target: wgpu::TextureFormat, (cull_mode, streams), samples, (label, source, entries)| {
            let module = maker.module(label, source);
            let layout = maker.layout(&[&self.uniform, self.map(frame.map.format), &self.material]);
            maker.pipeline(&Shape {
                buffers: &part_buffers(InstanceNumber::FirstTriangle, streams),
                targets: &[Some(target.into())],
                primitive: culled(cull_mode),
                depth: depth(true, wgpu::CompareFunction::GreaterEqual),
                samples,
                ..Shape::new(label, &layout, &module, entries)
            })
        };
        match purpose {
            Use::Caster(cull_mode, streams) => self.caster(&maker, frame, cull_mode, streams),
            Use::Shaded(faces, streams) => {
                let shader = ("sample", shaders::shaded(frame), ["vs_sample", "fs_shaded"]);
                seen(ENCODED_FORMAT, (faces, streams), self.samples, shader)
            }
            Use::Probe(faces, streams) => {
                let entries = [numbering.vertex_entry("vs_sample"), "fs_probe"];
                let shader = ("sample's probe", shaders::probe(frame, numbering), entries);
                seen(PROBE_FORMAT, (faces, streams), 1, shader)
            }
            Use::Inset => {
                let format = frame.map.format;
                let module = maker.module("sample's inset", shaders::inset(format));
                let layout = maker.layout(&[&self.uniform, self.map(format)]);
                maker.pipeline(&Shape {
                    targets: &[Some(ENCODED_FORMAT.into())],
                    ..Shape::new("sample's inset", &layout, &module, ["vs_inset", "fs_inset"])
                })
            }
        }
    }

    fn caster(
        &self,
        maker: &Maker<'_>,
        frame: &SampleFrame,
        cull_mode: Option<wgpu::Face>,
        streams: Streams,
    ) -> wgpu::RenderPipeline {
        let format = frame.map.format;
        let module = maker.module("sample's casters", shaders::caster());
        let layout = maker.layout(&[&self.uniform]);
        maker.pipeline(&Shape {
            entries: ("vs_caster", (!format.is_depth()).then_some("fs_caster")),
            constants: &[
                ("REVERSED", f64::from(frame.map.depth == StoredDepth::ReversedAtVertices)),
                ("PACKED", f64::from(format == SampleFormat::Rgba8Packed)),
            ],
            buffers: &part_buffers(InstanceNumber::FirstTriangle, streams),
            targets: &[Some(format.texture().into())],
            primitive: culled(cull_mode),
            depth: depth(true, wgpu::CompareFunction::LessEqual),
            ..Shape::new("sample's casters", &layout, &module, ["vs_caster", ""])
        })
    }
}
