//! The texture of a sample's map, and its bind group.

use shadowfit_render::attachment::cleared;
use shadowfit_render::passes::DEPTH_FORMAT;
use shadowfit_render::{Gpu, bindings};

use super::{LightImage, SampleFormat, SampleMapSettings};

/// A map and its bind group.
#[derive(Debug)]
pub(super) struct SampleMap {
    pub(super) settings: SampleMapSettings,
    image: LightImage,
    pub(super) texture: wgpu::Texture,
    color: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    pub(super) group: wgpu::BindGroup,
}

/// Creates the layout of the map's bind group. `is_depth` tells whether it is a depth texture.
pub(super) fn layout(device: &wgpu::Device, is_depth: bool) -> wgpu::BindGroupLayout {
    let sample_type =
        if is_depth { wgpu::TextureSampleType::Depth } else { wgpu::TextureSampleType::Float { filterable: false } };
    let types = [
        bindings::texture(sample_type, false),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
        bindings::texture(wgpu::TextureSampleType::Float { filterable: true }, false),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
    ];
    bindings::layout(device, "sample map", wgpu::ShaderStages::FRAGMENT, &types)
}

impl SampleMap {
    pub(super) fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        settings: SampleMapSettings,
        image: LightImage,
    ) -> Self {
        let device = &gpu.device;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let texture = |format| bindings::plain_texture(device, "sample map", settings.size, format, usage);
        let map = texture(settings.format.texture());
        let view = map.create_view(&Default::default());
        let (color, depth) = if settings.format.is_depth() {
            (None, view.clone())
        } else {
            (Some(view.clone()), texture(DEPTH_FORMAT).create_view(&Default::default()))
        };
        let image_view = image.upload(gpu).create_view(&Default::default());
        let compare = sampler(device, settings.compares_linearly, Some(wgpu::CompareFunction::LessEqual));
        let filter = sampler(device, true, None);
        let resources = [
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&compare),
            wgpu::BindingResource::TextureView(&image_view),
            wgpu::BindingResource::Sampler(&filter),
        ];
        let group = bindings::group(device, "sample map", layout, &resources);
        Self { settings, image, texture: map, color, depth, group }
    }

    /// Returns whether the map has these settings.
    pub(super) fn is_of(&self, settings: &SampleMapSettings, image: LightImage) -> bool {
        (&self.settings, self.image) == (settings, image)
    }

    /// Begins the pass that draws the casters.
    pub(super) fn begin<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        let clear = f64::from(self.settings.clear);
        let color_attachments = [self.color.as_ref().map(|view| cleared(view, None, self.cleared(clear)))];
        // The depth buffer that sorts casters is cleared to the farthest depth. Only a depth map may use
        // another value.
        let far = if self.settings.format.is_depth() { clear as f32 } else { 1.0 };
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(far), store: wgpu::StoreOp::Store };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sample map"),
            color_attachments: if self.color.is_some() { &color_attachments } else { &[] },
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(ops),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// Returns the colour that encodes a stored depth of 0 or 1.
    fn cleared(&self, depth: f64) -> wgpu::Color {
        match self.settings.format {
            SampleFormat::Rgba8Packed => {
                let [r, g, b, a] = (depth as f32).to_le_bytes().map(|byte| f64::from(byte) / 255.0);
                wgpu::Color { r, g, b, a }
            }
            _ => wgpu::Color { r: depth, g: depth, b: depth, a: depth },
        }
    }
}

fn sampler(device: &wgpu::Device, linear: bool, compare: Option<wgpu::CompareFunction>) -> wgpu::Sampler {
    let filter = if linear { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest };
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("sample map"),
        mag_filter: filter,
        min_filter: filter,
        compare,
        ..Default::default()
    })
}
