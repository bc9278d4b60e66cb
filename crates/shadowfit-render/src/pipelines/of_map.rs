//! Pipelines that read or draw the shadow map.

use std::collections::HashMap;

use shadowfit_gpu::make_at_once;
use shadowfit_scene::Casting;
use shadowfit_wgpu::ShadowMap;

use super::Layouts;
use crate::formats::NORMAL_FORMAT;
use crate::maker::{
    BLENDED_COLOR, COLOR, InstanceNumber, Maker, Shape, caster_buffers, culled, depth, instances, part_buffers, strips,
};
use crate::part::{Part, PartKey};
use crate::pixel::BLOCK_FORMAT;
use crate::probe::PROBE_FORMAT;
use crate::uniform::InsetVertex;
use crate::unrolled::Numbering;
use crate::wait::making;
use crate::{Overlay, shaders};

/// Kind of drawing of a scene's parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Drawn {
    /// A picture with an overlay.
    Shaded(Overlay),
    /// A probe.
    Probe,
    /// The depths and normals for tracing edges, with this number of samples per pixel.
    Surfaces(u32),
}

/// Pipelines that read or draw the shadow map.
#[derive(Debug)]
pub(crate) struct MapPipelines {
    pub(crate) inset: wgpu::RenderPipeline,
    caster: wgpu::RenderPipeline,
    /// For parts with one surface element in all, and with one for each vertex.
    caster_masked: [wgpu::RenderPipeline; 2],
    /// Created when a part first needs it.
    parts: HashMap<(Drawn, PartKey), wgpu::RenderPipeline>,
    modules: HashMap<Drawn, wgpu::ShaderModule>,
    /// Created for the first block of texels that is read.
    block: Option<wgpu::RenderPipeline>,
    samples: u32,
}

impl MapPipelines {
    pub(crate) fn new(maker: &Maker<'_>, layouts: &Layouts, map: &ShadowMap) -> Self {
        let caster = maker.module("caster", shaders::caster(map.descriptor()));
        let caster_layout = maker.layout(&[map.caster_layout(), &layouts.material]);
        let entry = match (map.color_target().is_some(), map.clamps_in_fragment()) {
            (false, false) => "fs_caster",
            (false, true) => "fs_caster_clamped",
            (true, false) => "fs_caster_color",
            (true, true) => "fs_caster_clamped_color",
        };
        // Casters without cut-outs, computed depth or colour need no fragment stage.
        let plain_entry = Some(entry).filter(|entry| *entry != "fs_caster");
        let caster_pipeline =
            |entry, masked, surface| maker.caster(&caster_layout, &caster, entry, masked, surface, map);
        Self {
            inset: maker.inset(layouts, map),
            caster: caster_pipeline(plain_entry, false, false),
            caster_masked: [false, true].map(|surface| caster_pipeline(Some(entry), true, surface)),
            parts: HashMap::new(),
            modules: HashMap::new(),
            block: None,
            samples: maker.samples,
        }
    }

    /// Creates the missing pipelines for drawing parts.
    pub(crate) fn add(
        &mut self,
        device: &wgpu::Device,
        layouts: &Layouts,
        judged: &wgpu::BindGroupLayout,
        map: &ShadowMap,
        drawn: Drawn,
        parts: &[Part],
    ) {
        let maker = Maker { device, samples: self.samples };
        let is_judged = matches!(drawn, Drawn::Shaded(overlay) if overlay.is_judged());
        let groups = [&layouts.frame, map.receiver_layout(), &layouts.material, judged];
        let groups = &groups[..if is_judged { 4 } else { 3 }];
        let mut keys: Vec<PartKey> = Vec::new();
        for key in parts.iter().map(PartKey::of) {
            if !self.parts.contains_key(&(drawn, key)) && !keys.contains(&key) {
                keys.push(key);
            }
        }
        if keys.is_empty() {
            return;
        }
        let module = &*self.modules.entry(drawn).or_insert_with(|| maker.drawn(drawn, map));
        let layout = maker.layout(groups);
        let make = |key: &PartKey| maker.part(&layout, module, drawn, *key);
        let made = making(|| make_at_once(device, &keys, make));
        self.parts.extend(keys.into_iter().map(|key| (drawn, key)).zip(made));
    }

    /// Returns the pipeline of a part, created by [`Self::add`].
    pub(crate) fn part(&self, part: &Part, drawn: Drawn) -> &wgpu::RenderPipeline {
        &self.parts[&(drawn, PartKey::of(part))]
    }

    /// Returns the pipeline of the pass that reads a block of texels.
    pub(crate) fn block(&mut self, device: &wgpu::Device, layouts: &Layouts, map: &ShadowMap) -> &wgpu::RenderPipeline {
        let maker = Maker { device, samples: self.samples };
        self.block.get_or_insert_with(|| maker.block(layouts, map))
    }

    /// Returns the pipeline of the shadow pass. Casters are double-sided.
    pub(crate) fn caster(&self, part: &Part) -> &wgpu::RenderPipeline {
        match part.casting {
            Casting::CutOut(_) => &self.caster_masked[usize::from(part.has.surface)],
            Casting::Whole | Casting::Nothing => &self.caster,
        }
    }
}

impl Maker<'_> {
    fn drawn(&self, drawn: Drawn, map: &ShadowMap) -> wgpu::ShaderModule {
        let source = match drawn {
            Drawn::Shaded(Overlay::None) => shaders::scene(map.descriptor()),
            Drawn::Shaded(overlay) => shaders::overlay(map.descriptor(), overlay),
            Drawn::Probe => shaders::probe(map.descriptor(), Numbering::of(self.device)),
            Drawn::Surfaces(_) => shaders::surfaces(map.descriptor()),
        };
        self.module("parts", source)
    }

    /// Creates the pipeline of parts with a key.
    fn part(
        &self,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        drawn: Drawn,
        key: PartKey,
    ) -> wgpu::RenderPipeline {
        let entry = match drawn {
            Drawn::Shaded(Overlay::None) => "fs_scene",
            Drawn::Shaded(_) => "fs_overlay",
            Drawn::Probe => "fs_probe",
            Drawn::Surfaces(_) => "fs_surfaces",
        };
        let number = match drawn {
            Drawn::Shaded(Overlay::Casters) => InstanceNumber::Holder,
            _ => InstanceNumber::FirstTriangle,
        };
        let [probe, normals] = [PROBE_FORMAT, NORMAL_FORMAT].map(|format| [Some(format.into())]);
        let (targets, samples) = match drawn {
            Drawn::Probe => (&probe, 1),
            Drawn::Surfaces(samples) => (&normals, samples),
            Drawn::Shaded(_) => (if key.blended { &BLENDED_COLOR } else { &COLOR }, self.samples),
        };
        let vertex_entry = match drawn {
            Drawn::Probe => Numbering::of(self.device).vertex_entry("vs_scene"),
            _ => "vs_scene",
        };
        self.pipeline(&Shape {
            buffers: &part_buffers(number, key.streams),
            targets,
            primitive: culled(key.cull_mode()),
            depth: depth(!key.blended, wgpu::CompareFunction::GreaterEqual),
            samples,
            constants: &key.constants(),
            ..Shape::new("parts", layout, module, [vertex_entry, entry])
        })
    }

    fn caster(
        &self,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        entry: Option<&str>,
        masked: bool,
        surface: bool,
        map: &ShadowMap,
    ) -> wgpu::RenderPipeline {
        let color = [map.color_target()];
        self.pipeline(&Shape {
            entries: ("vs_caster", entry),
            constants: &[("MASKED", f64::from(masked))],
            buffers: &caster_buffers(surface),
            targets: if color[0].is_some() { &color } else { &[] },
            primitive: map.primitive_state(),
            depth: Some(map.depth_stencil_state()),
            ..Shape::new("caster", layout, module, ["vs_caster", ""])
        })
    }

    fn inset(&self, layouts: &Layouts, map: &ShadowMap) -> wgpu::RenderPipeline {
        let layout = self.layout(&[&layouts.uniform, map.receiver_layout()]);
        let module = self.module("inset", shaders::inset(map.descriptor(), self.device.adapter_info().backend));
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x2, 2 => Uint32, 3 => Float32x3];
        self.pipeline(&Shape {
            buffers: &[Some(instances::<InsetVertex>(&attributes))],
            primitive: strips(),
            ..Shape::new("inset", &layout, &module, ["vs_inset", "fs_inset"])
        })
    }

    fn block(&self, layouts: &Layouts, map: &ShadowMap) -> wgpu::RenderPipeline {
        let layout = self.layout(&[&layouts.uniform, map.receiver_layout()]);
        let module = self.module("texels", shaders::block(map.descriptor(), self.device.adapter_info().backend));
        self.pipeline(&Shape {
            targets: &[Some(BLOCK_FORMAT.into())],
            ..Shape::new("texels", &layout, &module, ["vs_screen", "fs_block"])
        })
    }
}
