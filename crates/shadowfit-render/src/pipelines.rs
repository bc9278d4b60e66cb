//! The render pipelines, and the layouts that they share. Those that read the shadow map are made
//! anew when its descriptor changes.

use std::collections::HashMap;

use shadowfit_scene::AlphaMode;
use shadowfit_wgpu::ShadowMap;

use crate::material::material_layout;
use crate::probe::PROBE_FORMAT;
use crate::scene::Part;
use crate::shaders;
use crate::target::{COLOR_FORMAT, DEPTH_FORMAT};
use crate::uniform::{InstanceData, LineVertex};

/// Bind group layouts of this crate.
#[derive(Debug)]
pub(crate) struct Layouts {
    pub(crate) frame: wgpu::BindGroupLayout,
    pub(crate) material: wgpu::BindGroupLayout,
    pub(crate) inset: wgpu::BindGroupLayout,
}

/// What selects a part's pipeline, in every pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent property of the part")]
pub(crate) struct PartKey {
    masked: bool,
    blended: bool,
    double_sided: bool,
    mirrored: bool,
}

/// Pipelines of every pass.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) sky: wgpu::RenderPipeline,
    pub(crate) lines: wgpu::RenderPipeline,
    pub(crate) inset: wgpu::RenderPipeline,
    caster: wgpu::RenderPipeline,
    caster_masked: wgpu::RenderPipeline,
    scene: HashMap<PartKey, wgpu::RenderPipeline>,
    probe: HashMap<PartKey, wgpu::RenderPipeline>,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let uniform = |label, visibility| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: None,
                    },
                    count: None,
                }],
            })
        };
        Self {
            frame: uniform("frame", wgpu::ShaderStages::VERTEX_FRAGMENT),
            material: material_layout(device),
            inset: uniform("inset", wgpu::ShaderStages::VERTEX_FRAGMENT),
        }
    }
}

impl PartKey {
    pub(crate) fn of(part: &Part) -> Self {
        Self {
            masked: matches!(part.alpha, AlphaMode::Mask { .. }),
            blended: part.alpha == AlphaMode::Blend,
            double_sided: part.double_sided,
            mirrored: part.mirrored,
        }
    }

    fn all() -> impl Iterator<Item = Self> {
        (0..12).map(|bits| Self {
            masked: bits % 3 == 1,
            blended: bits % 3 == 2,
            double_sided: bits / 3 % 2 == 1,
            mirrored: bits / 6 == 1,
        })
    }

    /// Back faces of single-sided parts are left out; a mirrored part's back is its front.
    fn cull_mode(self) -> Option<wgpu::Face> {
        match (self.double_sided, self.mirrored) {
            (true, _) => None,
            (false, false) => Some(wgpu::Face::Back),
            (false, true) => Some(wgpu::Face::Front),
        }
    }
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts, map: &ShadowMap, samples: u32) -> Self {
        let maker = Maker { device, samples };
        let caster = maker.module("caster", shaders::caster(map.descriptor()));
        let scene = maker.module("scene", shaders::scene(map.descriptor()));
        let caster_layout = maker.layout(&[map.caster_layout(), &layouts.material]);
        let scene_layout = maker.layout(&[&layouts.frame, map.receiver_layout(), &layouts.material]);
        let [plain_entry, masked_entry] = match (map.color_target().is_some(), map.clamps_in_fragment()) {
            (false, false) => [None, Some("fs_caster_masked")],
            (false, true) => [Some("fs_caster_clamped"), Some("fs_caster_masked_clamped")],
            (true, false) => [Some("fs_caster_color"), Some("fs_caster_masked_color")],
            (true, true) => [Some("fs_caster_clamped_color"), Some("fs_caster_masked_clamped_color")],
        };
        let caster_pipeline = |entry| maker.caster(&caster_layout, &caster, entry, map);
        Self {
            sky: maker.sky(layouts),
            lines: maker.lines(layouts),
            inset: maker.inset(layouts, map),
            caster: caster_pipeline(plain_entry),
            caster_masked: caster_pipeline(masked_entry),
            scene: PartKey::all().map(|key| (key, maker.scene(&scene_layout, &scene, key))).collect(),
            probe: maker.probes(&scene_layout, map),
        }
    }

    /// Pipeline of the shadow pass. Casters are double-sided.
    pub(crate) fn caster(&self, part: &Part) -> &wgpu::RenderPipeline {
        if PartKey::of(part).masked { &self.caster_masked } else { &self.caster }
    }

    /// Pipeline of the shaded pass.
    pub(crate) fn scene(&self, part: &Part) -> &wgpu::RenderPipeline {
        &self.scene[&PartKey::of(part)]
    }

    /// Whether the device can draw the probe pass.
    pub(crate) fn can_probe(&self) -> bool {
        !self.probe.is_empty()
    }

    /// Pipeline of the probe pass, where there is one.
    pub(crate) fn probe(&self, part: &Part) -> &wgpu::RenderPipeline {
        &self.probe[&PartKey::of(part)]
    }
}

struct Maker<'a> {
    device: &'a wgpu::Device,
    samples: u32,
}

/// What differs between the pipelines of the camera's passes.
struct Shape<'a> {
    label: &'a str,
    layout: &'a wgpu::PipelineLayout,
    module: &'a wgpu::ShaderModule,
    entries: [&'a str; 2],
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    targets: &'a [Option<wgpu::ColorTargetState>],
    topology: wgpu::PrimitiveTopology,
    cull_mode: Option<wgpu::Face>,
    depth: Option<(bool, wgpu::CompareFunction)>,
    samples: u32,
}

impl Maker<'_> {
    fn module(&self, label: &str, source: String) -> wgpu::ShaderModule {
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        })
    }

    fn layout(&self, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
        let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        })
    }

    fn pipeline(&self, shape: &Shape<'_>) -> wgpu::RenderPipeline {
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(shape.label),
            layout: Some(shape.layout),
            vertex: wgpu::VertexState {
                module: shape.module,
                entry_point: Some(shape.entries[0]),
                compilation_options: Default::default(),
                buffers: shape.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: shape.topology,
                cull_mode: shape.cull_mode,
                ..Default::default()
            },
            depth_stencil: shape.depth.map(|(write, compare)| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(write),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: shape.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: shape.module,
                entry_point: Some(shape.entries[1]),
                compilation_options: Default::default(),
                targets: shape.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn caster(
        &self,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        entry: Option<&str>,
        map: &ShadowMap,
    ) -> wgpu::RenderPipeline {
        let color = [map.color_target()];
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("caster"),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some("vs_caster"),
                compilation_options: Default::default(),
                buffers: &part_buffers(),
            },
            primitive: map.primitive_state(),
            depth_stencil: Some(map.depth_stencil_state()),
            multisample: wgpu::MultisampleState::default(),
            fragment: entry.map(|entry| wgpu::FragmentState {
                module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: if color[0].is_some() { &color } else { &[] },
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn scene(&self, layout: &wgpu::PipelineLayout, module: &wgpu::ShaderModule, key: PartKey) -> wgpu::RenderPipeline {
        self.pipeline(&Shape {
            label: "scene",
            layout,
            module,
            entries: ["vs_scene", if key.masked { "fs_scene_masked" } else { "fs_scene" }],
            buffers: &part_buffers(),
            targets: &[Some(wgpu::ColorTargetState {
                format: COLOR_FORMAT,
                blend: key.blended.then_some(wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull_mode: key.cull_mode(),
            depth: Some((!key.blended, wgpu::CompareFunction::GreaterEqual)),
            samples: self.samples,
        })
    }

    /// Pipelines of the probe pass; none where the device does not support the primitive index.
    fn probes(&self, layout: &wgpu::PipelineLayout, map: &ShadowMap) -> HashMap<PartKey, wgpu::RenderPipeline> {
        if !self.device.features().contains(wgpu::Features::PRIMITIVE_INDEX) {
            return HashMap::new();
        }
        let module = self.module("probe", shaders::probe(map.descriptor()));
        PartKey::all().map(|key| (key, self.probe(layout, &module, key))).collect()
    }

    fn probe(&self, layout: &wgpu::PipelineLayout, module: &wgpu::ShaderModule, key: PartKey) -> wgpu::RenderPipeline {
        self.pipeline(&Shape {
            label: "probe",
            layout,
            module,
            entries: ["vs_scene", if key.masked { "fs_probe_masked" } else { "fs_probe" }],
            buffers: &part_buffers(),
            targets: &[Some(PROBE_FORMAT.into())],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull_mode: key.cull_mode(),
            depth: Some((true, wgpu::CompareFunction::GreaterEqual)),
            samples: 1,
        })
    }

    fn sky(&self, layouts: &Layouts) -> wgpu::RenderPipeline {
        self.pipeline(&Shape {
            label: "sky",
            layout: &self.layout(&[&layouts.frame]),
            module: &self.module("sky", shaders::sky()),
            entries: ["vs_sky", "fs_sky"],
            buffers: &[],
            targets: &[Some(COLOR_FORMAT.into())],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull_mode: None,
            depth: Some((false, wgpu::CompareFunction::GreaterEqual)),
            samples: self.samples,
        })
    }

    fn lines(&self, layouts: &Layouts) -> wgpu::RenderPipeline {
        self.pipeline(&Shape {
            label: "lines",
            layout: &self.layout(&[&layouts.frame]),
            module: &self.module("lines", shaders::lines()),
            entries: ["vs_line", "fs_line"],
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 2 * size_of::<LineVertex>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x4, 2 => Float32x3, 3 => Float32x4],
            })],
            targets: &[Some(wgpu::ColorTargetState {
                format: COLOR_FORMAT,
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull_mode: None,
            depth: Some((false, wgpu::CompareFunction::Always)),
            samples: self.samples,
        })
    }

    fn inset(&self, layouts: &Layouts, map: &ShadowMap) -> wgpu::RenderPipeline {
        self.pipeline(&Shape {
            label: "inset",
            layout: &self.layout(&[&layouts.frame, map.receiver_layout(), &layouts.inset]),
            module: &self.module("inset", shaders::inset(map.descriptor())),
            entries: ["vs_inset", "fs_inset"],
            buffers: &[],
            targets: &[Some(COLOR_FORMAT.into())],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            cull_mode: None,
            depth: None,
            samples: 1,
        })
    }
}

/// The three vertex streams of a part: what deforms, what does not, and the instances.
fn part_buffers() -> [Option<wgpu::VertexBufferLayout<'static>>; 3] {
    const MOTION: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];
    const SURFACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![3 => Float32x2, 4 => Float32x4];
    const INSTANCE: [wgpu::VertexAttribute; 4] =
        wgpu::vertex_attr_array![5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Uint32];
    let stream =
        |array_stride, step_mode, attributes| Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes });
    [
        stream(40, wgpu::VertexStepMode::Vertex, &MOTION),
        stream(24, wgpu::VertexStepMode::Vertex, &SURFACE),
        stream(size_of::<InstanceData>() as u64, wgpu::VertexStepMode::Instance, &INSTANCE),
    ]
}
