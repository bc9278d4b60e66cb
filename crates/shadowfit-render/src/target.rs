//! A render target: colour (resolved to one sample), depth, and the read-back to the CPU.

use crate::Gpu;
use crate::attachment::{cleared, depth};
use crate::encoded::Encoded;
use crate::formats::{COLOR_FORMAT, DEPTH_FORMAT, ENCODED_FORMAT};
use crate::gpu::is_opengl;
use crate::read_back::{ReadBack, ReadError};

/// Textures that a picture is drawn into.
#[derive(Debug)]
pub struct RenderTarget {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    pub(crate) color: wgpu::Texture,
    pub(crate) color_view: wgpu::TextureView,
    pub(crate) multisampled: Option<wgpu::TextureView>,
    pub(crate) depth_view: wgpu::TextureView,
    /// The display values, if they are not a view of the colours.
    pub(crate) encoded: Option<Encoded>,
}

impl RenderTarget {
    /// Creates a target with `samples` per pixel (1 or 4). Its size is at least 1×1 pixels and at most the
    /// device's limit.
    pub fn new(device: &wgpu::Device, size: [u32; 2], samples: u32) -> Self {
        let limit = device.limits().max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, limit));
        let color = attachment(device, size, COLOR_FORMAT, 1);
        let multisampled =
            (samples > 1).then(|| attachment(device, size, COLOR_FORMAT, samples).create_view(&Default::default()));
        let depth_view = attachment(device, size, DEPTH_FORMAT, samples).create_view(&Default::default());
        let color_view = color.create_view(&Default::default());
        let encoded = is_opengl(device).then(|| {
            let texture = attachment(device, size, ENCODED_FORMAT, 1);
            let several = (samples > 1).then(|| attachment(device, size, ENCODED_FORMAT, samples));
            let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
            Encoded { view: view(&texture), multisampled: several.as_ref().map(view), texture }
        });
        Self { size, color, color_view, multisampled, depth_view, encoded }
    }

    /// Returns the depth buffer of the last picture, with the target's number of samples: reversed, 0 for the
    /// sky. Shaders can load it, except on OpenGL.
    pub fn depth_view(&self) -> &wgpu::TextureView {
        &self.depth_view
    }

    /// Returns the depth buffer, if shaders can read it.
    pub(crate) fn readable_depth(&self) -> Option<&wgpu::TextureView> {
        let is_readable = self.depth_view.texture().usage().contains(wgpu::TextureUsages::TEXTURE_BINDING);
        is_readable.then_some(&self.depth_view)
    }

    /// Returns the texture of the colours, which identifies this target.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.color
    }

    /// Returns a view of the encoded bytes, for user interfaces.
    pub fn encoded_view(&self) -> wgpu::TextureView {
        let view = wgpu::TextureViewDescriptor { format: Some(ENCODED_FORMAT), ..Default::default() };
        self.encoded.as_ref().map_or_else(|| self.color.create_view(&view), |encoded| encoded.view.clone())
    }

    /// Begins a pass that writes display values unchanged, over a `background` of display values, with the
    /// camera's depth. Its pipelines must have [`ENCODED_FORMAT`], [`DEPTH_FORMAT`] and the target's number
    /// of samples.
    pub fn begin_encoded<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        label: &str,
        [r, g, b]: [f64; 3],
    ) -> wgpu::RenderPass<'a> {
        let resolved = self.encoded_view();
        let encoded = wgpu::TextureViewDescriptor { format: Some(ENCODED_FORMAT), ..Default::default() };
        let multisampled = match &self.encoded {
            Some(encoded) => encoded.multisampled.clone(),
            None => self.multisampled.as_ref().map(|view| view.texture().create_view(&encoded)),
        };
        let background = wgpu::Color { r, g, b, a: 1.0 };
        let color = match &multisampled {
            Some(view) => cleared(view, Some(&resolved), background),
            None => cleared(&resolved, None, background),
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(depth(&self.depth_view)),
            ..Default::default()
        })
    }

    /// Copies a part (left, top, width and height, in pixels) of the colours of a target of the same size.
    pub fn copy_part(&self, gpu: &Gpu, from: &Self, part: [u32; 4]) {
        let [x, y, width, height] = crate::attachment::part(crate::attachment::part(part, from.size), self.size);
        let at = |texture| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x, y, z: 0 },
            aspect: wgpu::TextureAspect::All,
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        encoder.copy_texture_to_texture(at(&from.color), at(&self.color), extent);
        if let (Some(from), Some(to)) = (&from.encoded, &self.encoded) {
            encoder.copy_texture_to_texture(at(&from.texture), at(&to.texture), extent);
        }
        gpu.submit([encoder.finish()]);
    }

    /// Starts to read the picture: sRGB pixels, four bytes each, rows from the top.
    pub fn read_back(&self, gpu: &Gpu) -> ReadBack {
        let texture = self.encoded.as_ref().map_or(&self.color, |encoded| &encoded.texture);
        ReadBack::new(gpu, texture, self.size, 4)
    }

    /// Waits for the picture and returns its sRGB pixels, four bytes each, rows from the top.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadError> {
        self.read_back(gpu).wait(gpu)
    }
}

fn attachment(device: &wgpu::Device, size: [u32; 2], format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    // Multisampled colours are not read before they are resolved.
    let readable = match (samples, format) {
        // Parts of pictures are copied into these.
        (1, COLOR_FORMAT | ENCODED_FORMAT) => {
            wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST
        }
        (1, _) => wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC,
        (_, DEPTH_FORMAT) if !is_opengl(device) => wgpu::TextureUsages::TEXTURE_BINDING,
        _ => wgpu::TextureUsages::empty(),
    };
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("render target"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | readable,
        view_formats: if format == COLOR_FORMAT && !is_opengl(device) { &[ENCODED_FORMAT] } else { &[] },
    })
}
