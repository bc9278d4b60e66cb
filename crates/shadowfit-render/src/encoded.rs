//! Display values of pictures on OpenGL, where a texture cannot have a view of another format. Linear colours
//! are encoded into a separate texture once they are drawn.

use crate::bindings;
use crate::formats::ENCODED_FORMAT;
use crate::maker::{Maker, Shape};
use crate::shaders;

/// Display values of a picture.
#[derive(Debug)]
pub(crate) struct Encoded {
    pub(crate) texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
    pub(crate) multisampled: Option<wgpu::TextureView>,
}

/// Encodes pictures.
#[derive(Debug)]
pub(crate) struct Encoding {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl Encoding {
    pub(crate) fn new(maker: &Maker<'_>) -> Self {
        let colors = bindings::texture(wgpu::TextureSampleType::Float { filterable: false }, false);
        let layout = bindings::layout(maker.device, LABEL, wgpu::ShaderStages::FRAGMENT, &[colors]);
        let (groups, module) = (maker.layout(&[&layout]), maker.module(LABEL, shaders::encode()));
        let pipeline = maker.pipeline(&Shape {
            targets: &[Some(ENCODED_FORMAT.into())],
            ..Shape::new(LABEL, &groups, &module, ["vs_screen", "fs_encode"])
        });
        Self { layout, pipeline }
    }

    /// Encodes linear colours.
    pub(crate) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        colors: &wgpu::TextureView,
        encoded: &Encoded,
    ) {
        let group = bindings::group(device, LABEL, &self.layout, &[wgpu::BindingResource::TextureView(colors)]);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(LABEL),
            color_attachments: &[Some(crate::attachment::cleared(&encoded.view, None, wgpu::Color::BLACK))],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

const LABEL: &str = "encoded picture";
