//! egui's shapes painted by wgpu.

use egui::{ClippedPrimitive, TextureId, TexturesDelta};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use shadowfit_render::{Gpu, ReadBack, ReadError, RenderTarget};

/// Paints egui's shapes, with the pictures of the stage as textures.
pub(crate) struct Painter {
    renderer: Renderer,
    /// Textures that are no longer used after the last layout.
    unused: Vec<TextureId>,
}

/// A laid out frame, ready to be painted.
pub(crate) struct Layout {
    pub(crate) jobs: Vec<ClippedPrimitive>,
    pub(crate) pixels_per_point: f32,
}

impl Painter {
    pub(crate) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        Self { renderer: Renderer::new(device, format, RendererOptions::default()), unused: Vec::new() }
    }

    /// Registers a picture as a texture of egui.
    pub(crate) fn register(&mut self, gpu: &Gpu, picture: &RenderTarget) -> TextureId {
        self.renderer.register_native_texture(&gpu.device, &picture.encoded_view(), wgpu::FilterMode::Nearest)
    }

    /// Replaces a picture.
    pub(crate) fn replace(&mut self, gpu: &Gpu, texture: TextureId, picture: &RenderTarget) {
        let (view, filter) = (picture.encoded_view(), wgpu::FilterMode::Nearest);
        self.renderer.update_egui_texture_from_wgpu_texture(&gpu.device, &view, filter, texture);
    }

    /// Uploads the textures of a layout, which is to be painted next.
    pub(crate) fn take(&mut self, gpu: &Gpu, textures: &mut TexturesDelta) {
        for id in self.unused.drain(..) {
            self.renderer.free_texture(&id);
        }
        for (id, deltas) in &textures.set {
            for delta in deltas {
                self.renderer.update_texture(&gpu.device, &gpu.queue, *id, delta);
            }
        }
        self.unused.extend(&textures.free);
        // All deltas are applied. egui requires clearing the list.
        textures.clear();
    }

    /// Paints to `target` of `size` pixels.
    pub(crate) fn paint(&mut self, gpu: &Gpu, layout: &Layout, target: &wgpu::TextureView, size: [u32; 2]) {
        // egui's renderer assumes that creating buffers succeeds.
        if gpu.lost().is_some() {
            return;
        }
        let Layout { jobs, pixels_per_point } = layout;
        let screen = ScreenDescriptor { size_in_pixels: size, pixels_per_point: *pixels_per_point };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let commands = self.renderer.update_buffers(&gpu.device, &gpu.queue, &mut encoder, jobs, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("interface"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        self.renderer.render(&mut pass.forget_lifetime(), jobs, &screen);
        gpu.submit(commands.into_iter().chain([encoder.finish()]));
    }
}

/// A texture that a frame is painted to, for reading.
pub(crate) struct Canvas {
    texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
    size: [u32; 2],
}

impl Canvas {
    /// Makes a canvas of a format of four bytes, red or blue first.
    pub(crate) fn new(device: &wgpu::Device, size: [u32; 2], format: wgpu::TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("canvas"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        Self { texture, view, size }
    }

    /// Returns the pixels, red first, four bytes each, rows from the top.
    ///
    /// # Errors
    ///
    /// If the device was lost.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadError> {
        let mut pixels = self.read_back(gpu).wait(gpu)?;
        if self.is_blue_first() {
            red_first(&mut pixels);
        }
        Ok(pixels)
    }

    /// Starts to read the pixels, in the order of the texture.
    pub(crate) fn read_back(&self, gpu: &Gpu) -> ReadBack {
        ReadBack::new(gpu, &self.texture, self.size, 4)
    }

    /// Returns whether the texture has blue first.
    pub(crate) fn is_blue_first(&self) -> bool {
        self.texture.format().remove_srgb_suffix() == wgpu::TextureFormat::Bgra8Unorm
    }
}

/// Swaps blue and red of pixels of four bytes.
pub(crate) fn red_first(pixels: &mut [u8]) {
    pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
}
