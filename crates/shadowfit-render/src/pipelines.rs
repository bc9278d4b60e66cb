//! The render pipelines, and the layouts that they share. Those that read the shadow map are made
//! anew when its descriptor changes, and those of overlays when they are first shown.

mod maker;

use std::collections::HashMap;

use shadowfit_scene::AlphaMode;
use shadowfit_wgpu::ShadowMap;

use crate::material::material_layout;
use crate::pixel::BLOCK_FORMAT;
use crate::probe::PROBE_FORMAT;
use crate::scene::Part;
use crate::uniform::{InsetVertex, LineVertex, QuadVertex};
use crate::{Overlay, bindings, shaders};

pub(crate) use maker::{BLENDED_COLOR, COLOR, InstanceNumber, Maker, Shape, part_buffers};

/// Bind group layouts of this crate.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// A uniform: of a frame, or of a pass that needs no frame.
    pub(crate) uniform: wgpu::BindGroupLayout,
    pub(crate) material: wgpu::BindGroupLayout,
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
    /// Clears colour and depth of a part of a picture.
    pub(crate) clear: wgpu::RenderPipeline,
    sky: wgpu::RenderPipeline,
    sky_gray: Option<wgpu::RenderPipeline>,
    pub(crate) lines: wgpu::RenderPipeline,
    pub(crate) inset: wgpu::RenderPipeline,
    pub(crate) quads: wgpu::RenderPipeline,
    caster: wgpu::RenderPipeline,
    caster_masked: wgpu::RenderPipeline,
    scene: HashMap<PartKey, wgpu::RenderPipeline>,
    probe: HashMap<PartKey, wgpu::RenderPipeline>,
    overlays: HashMap<(Overlay, PartKey), wgpu::RenderPipeline>,
    modules: HashMap<Overlay, wgpu::ShaderModule>,
    /// Made for the first block of texels that is read.
    block: Option<wgpu::RenderPipeline>,
    samples: u32,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
        Self {
            uniform: bindings::layout(device, "uniform", visibility, &[bindings::UNIFORM]),
            material: material_layout(device),
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
        let scene_layout = maker.layout(&[&layouts.uniform, map.receiver_layout(), &layouts.material]);
        let [plain_entry, masked_entry] = match (map.color_target().is_some(), map.clamps_in_fragment()) {
            (false, false) => [None, Some("fs_caster_masked")],
            (false, true) => [Some("fs_caster_clamped"), Some("fs_caster_masked_clamped")],
            (true, false) => [Some("fs_caster_color"), Some("fs_caster_masked_color")],
            (true, true) => [Some("fs_caster_clamped_color"), Some("fs_caster_masked_clamped_color")],
        };
        let caster_pipeline = |entry| maker.caster(&caster_layout, &caster, entry, map);
        let entries = ["fs_scene", "fs_scene_masked"];
        Self {
            clear: maker.clear(),
            sky: maker.sky(layouts, "fs_sky"),
            sky_gray: None,
            lines: maker.lines(layouts),
            inset: maker.inset(layouts, map),
            quads: maker.quads(layouts),
            caster: caster_pipeline(plain_entry),
            caster_masked: caster_pipeline(masked_entry),
            scene: PartKey::all().map(|key| (key, maker.scene(&scene_layout, &scene, entries, key))).collect(),
            probe: maker.probes(&scene_layout, map),
            overlays: HashMap::new(),
            modules: HashMap::new(),
            block: None,
            samples,
        }
    }

    /// Makes those pipelines of an overlay that parts need and that are not there yet.
    pub(crate) fn add_overlay(
        &mut self,
        device: &wgpu::Device,
        (layouts, judged): (&Layouts, &wgpu::BindGroupLayout),
        map: &ShadowMap,
        (overlay, parts): (Overlay, &[Part]),
    ) {
        if overlay == Overlay::None {
            return;
        }
        let maker = Maker { device, samples: self.samples };
        if overlay.has_gray_sky() {
            self.sky_gray.get_or_insert_with(|| maker.sky(layouts, "fs_sky_gray"));
        }
        let groups = [&layouts.uniform, map.receiver_layout(), &layouts.material, judged];
        let groups = &groups[..if overlay.is_judged() { 4 } else { 3 }];
        let mut layout = None;
        for key in parts.iter().map(PartKey::of) {
            if self.overlays.contains_key(&(overlay, key)) {
                continue;
            }
            let make = || maker.module("overlay", shaders::overlay(map.descriptor(), overlay));
            let module = self.modules.entry(overlay).or_insert_with(make);
            let layout = layout.get_or_insert_with(|| maker.layout(groups));
            let pipeline = maker.overlay(layout, module, overlay, key);
            self.overlays.insert((overlay, key), pipeline);
        }
    }

    /// Pipeline of the sky behind an overlay.
    pub(crate) fn sky(&self, overlay: Overlay) -> &wgpu::RenderPipeline {
        self.sky_gray.as_ref().filter(|_| overlay.has_gray_sky()).unwrap_or(&self.sky)
    }

    /// Pipeline of the pass that reads a block of texels.
    pub(crate) fn block(&mut self, device: &wgpu::Device, layouts: &Layouts, map: &ShadowMap) -> &wgpu::RenderPipeline {
        let maker = Maker { device, samples: self.samples };
        self.block.get_or_insert_with(|| maker.block(layouts, map))
    }

    /// Pipeline of the shadow pass. Casters are double-sided.
    pub(crate) fn caster(&self, part: &Part) -> &wgpu::RenderPipeline {
        if PartKey::of(part).masked { &self.caster_masked } else { &self.caster }
    }

    /// Pipeline of the shaded pass.
    pub(crate) fn scene(&self, part: &Part, overlay: Overlay) -> &wgpu::RenderPipeline {
        let key = PartKey::of(part);
        self.overlays.get(&(overlay, key)).unwrap_or_else(|| &self.scene[&key])
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

impl Maker<'_> {
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
                buffers: &part_buffers(InstanceNumber::FirstTriangle),
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

    /// `entries` are those of the fragment shader, the second for cut-outs.
    fn scene(
        &self,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        entries: [&str; 2],
        key: PartKey,
    ) -> wgpu::RenderPipeline {
        self.part(layout, module, entries, (key, InstanceNumber::FirstTriangle))
    }

    fn overlay(
        &self,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        overlay: Overlay,
        key: PartKey,
    ) -> wgpu::RenderPipeline {
        let number = if overlay == Overlay::Casters { InstanceNumber::Holder } else { InstanceNumber::FirstTriangle };
        self.part(layout, module, ["fs_overlay", "fs_overlay_masked"], (key, number))
    }

    fn part(
        &self,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        [plain, masked]: [&str; 2],
        (key, number): (PartKey, InstanceNumber),
    ) -> wgpu::RenderPipeline {
        self.pipeline(&Shape {
            buffers: &part_buffers(number),
            targets: if key.blended { &BLENDED_COLOR } else { &COLOR },
            cull_mode: key.cull_mode(),
            depth: Some((!key.blended, wgpu::CompareFunction::GreaterEqual)),
            samples: self.samples,
            ..Shape::new("scene", layout, module, ["vs_scene", if key.masked { masked } else { plain }])
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
        let entry = if key.masked { "fs_probe_masked" } else { "fs_probe" };
        self.pipeline(&Shape {
            buffers: &part_buffers(InstanceNumber::FirstTriangle),
            targets: &[Some(PROBE_FORMAT.into())],
            cull_mode: key.cull_mode(),
            depth: Some((true, wgpu::CompareFunction::GreaterEqual)),
            ..Shape::new("probe", layout, module, ["vs_scene", entry])
        })
    }

    fn clear(&self) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[]), self.module("clear", shaders::clear()));
        self.pipeline(&Shape {
            depth: Some((true, wgpu::CompareFunction::Always)),
            samples: self.samples,
            ..Shape::new("clear", &layout, &module, ["vs_screen", "fs_clear"])
        })
    }

    fn sky(&self, layouts: &Layouts, entry: &str) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[&layouts.uniform]), self.module("sky", shaders::sky()));
        self.pipeline(&Shape {
            depth: Some((false, wgpu::CompareFunction::GreaterEqual)),
            samples: self.samples,
            ..Shape::new("sky", &layout, &module, ["vs_sky", entry])
        })
    }

    fn lines(&self, layouts: &Layouts) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[&layouts.uniform]), self.module("lines", shaders::lines()));
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x4, 2 => Float32x3, 3 => Float32x4];
        self.pipeline(&Shape {
            buffers: &[Some(instances::<[LineVertex; 2]>(&attributes))],
            targets: &BLENDED_COLOR,
            depth: Some((false, wgpu::CompareFunction::Always)),
            samples: self.samples,
            ..Shape::new("lines", &layout, &module, ["vs_line", "fs_line"])
        })
    }

    fn inset(&self, layouts: &Layouts, map: &ShadowMap) -> wgpu::RenderPipeline {
        let layout = self.layout(&[&layouts.uniform, map.receiver_layout()]);
        let module = self.module("inset", shaders::inset(map.descriptor()));
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x2, 2 => Uint32, 3 => Float32x3];
        self.pipeline(&Shape {
            buffers: &[Some(instances::<InsetVertex>(&attributes))],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Shape::new("inset", &layout, &module, ["vs_inset", "fs_inset"])
        })
    }

    fn block(&self, layouts: &Layouts, map: &ShadowMap) -> wgpu::RenderPipeline {
        let layout = self.layout(&[&layouts.uniform, map.receiver_layout()]);
        let module = self.module("texels", shaders::block(map.descriptor()));
        self.pipeline(&Shape {
            targets: &[Some(BLOCK_FORMAT.into())],
            ..Shape::new("texels", &layout, &module, ["vs_screen", "fs_block"])
        })
    }

    fn quads(&self, layouts: &Layouts) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[&layouts.uniform]), self.module("quads", shaders::quads()));
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
        self.pipeline(&Shape {
            buffers: &[Some(instances::<QuadVertex>(&attributes))],
            targets: &BLENDED_COLOR,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Shape::new("quads", &layout, &module, ["vs_quad", "fs_quad"])
        })
    }
}

/// A stream of packed instances.
fn instances<T>(attributes: &[wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'_> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<T>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes,
    }
}
