//! The render pipelines, and the layouts that they share. Pipelines that read the shadow map are rebuilt when
//! its shaders change. Pipelines of parts are built when the first part needs them.

mod of_map;

use shadowfit_wgpu::ShadowMap;

use crate::encoded::Encoding;
use crate::gpu::is_opengl;
use crate::maker::{BLENDED_COLOR, Maker, Shape, depth, instances, strips};
use crate::material::material_layout;
use crate::uniform::{LineVertex, QuadVertex};
use crate::{Overlay, bindings, shaders};

pub(crate) use of_map::{Drawn, MapPipelines};

/// Bind group layouts of this crate.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// The uniform of a frame and the factors of its picture, for shaded passes.
    pub(crate) frame: wgpu::BindGroupLayout,
    /// A uniform: of a frame, or of a pass that needs no frame.
    pub(crate) uniform: wgpu::BindGroupLayout,
    pub(crate) material: wgpu::BindGroupLayout,
}

/// Pipelines of every pass.
#[derive(Debug)]
pub(crate) struct Pipelines {
    /// Clears colour and depth of a part of a picture.
    pub(crate) clear: wgpu::RenderPipeline,
    sky: wgpu::RenderPipeline,
    sky_gray: wgpu::RenderPipeline,
    pub(crate) lines: wgpu::RenderPipeline,
    pub(crate) quads: wgpu::RenderPipeline,
    /// Used if display values are not a view of the picture.
    pub(crate) encoding: Option<Encoding>,
    /// Pipelines that read or draw the shadow map.
    pub(crate) of_map: MapPipelines,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let floats = wgpu::TextureSampleType::Float { filterable: false };
        Self {
            frame: frame_layout(device, [bindings::UNIFORM, bindings::texture(floats, false)]),
            uniform: bindings::layout(device, "uniform", visibility, &[bindings::UNIFORM]),
            material: material_layout(device),
        }
    }
}

/// Creates the layout of a frame's uniform and of the factors that fragments read.
fn frame_layout(device: &wgpu::Device, [uniform, factors]: [wgpu::BindingType; 2]) -> wgpu::BindGroupLayout {
    let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let entries =
        [entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT, uniform), entry(1, wgpu::ShaderStages::FRAGMENT, factors)];
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("frame"), entries: &entries })
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts, map: &ShadowMap, samples: u32) -> Self {
        let maker = Maker { device, samples };
        Self {
            clear: maker.clear(),
            sky: maker.sky(layouts, &[]),
            sky_gray: maker.sky(layouts, &[("GRAY", 1.0)]),
            lines: maker.lines(layouts),
            quads: maker.quads(layouts),
            encoding: is_opengl(device).then(|| Encoding::new(&maker)),
            of_map: MapPipelines::new(&maker, layouts, map),
        }
    }

    /// Returns the pipeline of the sky behind an overlay.
    pub(crate) fn sky(&self, overlay: Overlay) -> &wgpu::RenderPipeline {
        if overlay.has_gray_sky() { &self.sky_gray } else { &self.sky }
    }
}

impl Maker<'_> {
    fn clear(&self) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[]), self.module("clear", shaders::clear()));
        self.pipeline(&Shape {
            depth: depth(true, wgpu::CompareFunction::Always),
            samples: self.samples,
            ..Shape::new("clear", &layout, &module, ["vs_screen", "fs_clear"])
        })
    }

    fn sky(&self, layouts: &Layouts, constants: &[(&str, f64)]) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[&layouts.uniform]), self.module("sky", shaders::sky()));
        self.pipeline(&Shape {
            depth: depth(false, wgpu::CompareFunction::GreaterEqual),
            samples: self.samples,
            constants,
            ..Shape::new("sky", &layout, &module, ["vs_sky", "fs_sky"])
        })
    }

    fn lines(&self, layouts: &Layouts) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[&layouts.uniform]), self.module("lines", shaders::lines()));
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x4, 2 => Float32x3, 3 => Float32x4];
        self.pipeline(&Shape {
            buffers: &[Some(instances::<[LineVertex; 2]>(&attributes))],
            targets: &BLENDED_COLOR,
            depth: depth(false, wgpu::CompareFunction::Always),
            samples: self.samples,
            ..Shape::new("lines", &layout, &module, ["vs_line", "fs_line"])
        })
    }

    fn quads(&self, layouts: &Layouts) -> wgpu::RenderPipeline {
        let (layout, module) = (self.layout(&[&layouts.uniform]), self.module("quads", shaders::quads()));
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
        self.pipeline(&Shape {
            buffers: &[Some(instances::<QuadVertex>(&attributes))],
            targets: &BLENDED_COLOR,
            primitive: strips(),
            ..Shape::new("quads", &layout, &module, ["vs_quad", "fs_quad"])
        })
    }
}
