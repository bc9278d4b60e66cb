//! Layouts and pipelines of ambient occlusion.

use std::collections::HashMap;

use shadowfit_render::bindings;
use shadowfit_render::passes::{
    Draw, ENCODED_FORMAT, InstanceNumber, Maker, PartKey, Shape, culled, depth, material_layout, part_buffers,
};

use super::formats::{NORMAL_FORMAT, OCCLUSION_FORMAT, POSITION_FORMAT};
use super::frame::{OcclusionMethod, OcclusionSettings, OcclusionView};
use super::shaders;

/// Kinds of passes over the scene's parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Drawn {
    /// Positions and normals.
    Surface,
    /// Positions of back faces.
    Back,
    /// A picture in display values.
    Classic,
    /// A picture in linear light.
    Modern,
}

impl Drawn {
    /// Returns the kind of pass of a view, or `None` if the view does not draw parts.
    pub(super) fn of_view(view: OcclusionView) -> Option<Self> {
        match view {
            OcclusionView::Classic => Some(Self::Classic),
            OcclusionView::Modern => Some(Self::Modern),
            OcclusionView::Occlusion => None,
        }
    }

    fn is_picture(self) -> bool {
        matches!(self, Self::Classic | Self::Modern)
    }
}

/// Bind group layouts of the passes.
#[derive(Debug)]
pub(super) struct Layouts {
    pub(super) uniform: wgpu::BindGroupLayout,
    /// Three textures read with `textureLoad`.
    pub(super) buffers: wgpu::BindGroupLayout,
    /// Occlusion.
    pub(super) shown: wgpu::BindGroupLayout,
    material: wgpu::BindGroupLayout,
}

/// Pipelines of the passes.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub(super) layouts: Layouts,
    samples: u32,
    normals: wgpu::RenderPipeline,
    normals_and_backs: wgpu::RenderPipeline,
    depth_only: wgpu::RenderPipeline,
    pub(super) blur: wgpu::RenderPipeline,
    pub(super) view: wgpu::RenderPipeline,
    surface_module: wgpu::ShaderModule,
    picture_module: wgpu::ShaderModule,
    /// Created when the first part that needs it is drawn.
    parts: HashMap<(Drawn, PartKey), wgpu::RenderPipeline>,
}

impl Layouts {
    fn new(device: &wgpu::Device) -> Self {
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let texture = bindings::texture(wgpu::TextureSampleType::Float { filterable: false }, false);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        Self {
            uniform: bindings::layout(device, "uniform", stages, &[bindings::UNIFORM]),
            buffers: bindings::layout(device, "view-space surfaces", fragment, &[texture; 3]),
            shown: bindings::layout(device, "occlusion", fragment, &[texture]),
            material: material_layout(device),
        }
    }
}

/// Keeps the greater of the occlusion of two radii.
const GREATER: wgpu::BlendComponent = wgpu::BlendComponent {
    src_factor: wgpu::BlendFactor::One,
    dst_factor: wgpu::BlendFactor::One,
    operation: wgpu::BlendOperation::Max,
};

const fn target(format: wgpu::TextureFormat, blend: Option<wgpu::BlendState>) -> wgpu::ColorTargetState {
    wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL }
}

impl Pipelines {
    pub(super) fn new(device: &wgpu::Device, samples: u32) -> Self {
        let layouts = Layouts::new(device);
        let maker = Maker { device, samples };
        let gather = maker.module("occlusion", shaders::gather());
        let layout = maker.layout(&[&layouts.uniform, &layouts.buffers]);
        let greater = wgpu::BlendState { color: GREATER, alpha: GREATER };
        let greater = [Some(target(OCCLUSION_FORMAT, Some(greater)))];
        let gathered = |entry, constants| {
            let shape = Shape::new("occlusion", &layout, &gather, ["vs_screen", entry]);
            maker.pipeline(&Shape { targets: &greater, constants, ..shape })
        };
        let blur = maker.module("occlusion blur", shaders::blur());
        let view = maker.module("occlusion view", shaders::view());
        Self {
            samples,
            normals: gathered("fs_normals", &[]),
            normals_and_backs: gathered("fs_normals", &[("BACK_FACES", 1.0)]),
            depth_only: gathered("fs_depth_only", &[]),
            blur: maker.pipeline(&Shape {
                targets: &[Some(OCCLUSION_FORMAT.into())],
                ..Shape::new("occlusion blur", &layout, &blur, ["vs_screen", "fs_blur"])
            }),
            view: maker.pipeline(&Shape {
                targets: &[Some(ENCODED_FORMAT.into())],
                depth: depth(false, wgpu::CompareFunction::Always),
                samples,
                ..Shape::new("occlusion view", &maker.layout(&[&layouts.shown]), &view, ["vs_screen", "fs_occlusion"])
            }),
            surface_module: maker.module("view-space surfaces", shaders::surface()),
            picture_module: maker.module("ambient occlusion", shaders::shade()),
            layouts,
            parts: HashMap::new(),
        }
    }

    /// Returns the pipeline of the pass that computes occlusion.
    pub(super) fn gather(&self, settings: &OcclusionSettings) -> &wgpu::RenderPipeline {
        match settings.method {
            OcclusionMethod::DepthOnly => &self.depth_only,
            OcclusionMethod::Normals if settings.back_faces => &self.normals_and_backs,
            OcclusionMethod::Normals => &self.normals,
        }
    }

    /// Creates the missing pipelines of draws.
    pub(super) fn add(&mut self, device: &wgpu::Device, drawn: Drawn, draws: &[Draw]) {
        for key in draws.iter().map(|draw| draw.key) {
            if !self.parts.contains_key(&(drawn, key)) {
                let pipeline = self.make(device, drawn, key);
                self.parts.insert((drawn, key), pipeline);
            }
        }
    }

    /// Returns the pipeline of a part, which [`Self::add`] has created.
    pub(super) fn part(&self, drawn: Drawn, key: PartKey) -> &wgpu::RenderPipeline {
        &self.parts[&(drawn, key)]
    }

    fn make(&self, device: &wgpu::Device, drawn: Drawn, key: PartKey) -> wgpu::RenderPipeline {
        let maker = Maker { device, samples: self.samples };
        let Layouts { uniform, material, shown, .. } = &self.layouts;
        let groups = [uniform, uniform, material, shown];
        let layout = maker.layout(if drawn.is_picture() { &groups } else { &groups[..3] });
        let module = if drawn.is_picture() { &self.picture_module } else { &self.surface_module };
        let entry = match drawn {
            Drawn::Surface => "fs_surface",
            Drawn::Back => "fs_back",
            Drawn::Classic | Drawn::Modern => "fs_picture",
        };
        let constants = [key.constants()[0], ("MODERN", f64::from(drawn == Drawn::Modern))];
        let blend = key.blended.then_some(wgpu::BlendState::ALPHA_BLENDING);
        let targets = match drawn {
            Drawn::Surface => [Some(POSITION_FORMAT.into()), Some(NORMAL_FORMAT.into())],
            Drawn::Back => [Some(POSITION_FORMAT.into()), None],
            Drawn::Classic | Drawn::Modern => [Some(target(ENCODED_FORMAT, blend)), None],
        };
        maker.pipeline(&Shape {
            buffers: &part_buffers(InstanceNumber::FirstTriangle, key.streams),
            targets: &targets[..if drawn == Drawn::Surface { 2 } else { 1 }],
            primitive: culled(if drawn == Drawn::Back { Some(key.front()) } else { key.cull_mode() }),
            depth: depth(!key.blended, wgpu::CompareFunction::GreaterEqual),
            samples: if drawn.is_picture() { self.samples } else { 1 },
            constants: &constants[..if drawn.is_picture() { 2 } else { 1 }],
            ..Shape::new("ambient occlusion", &layout, module, ["vs_part", entry])
        })
    }
}
