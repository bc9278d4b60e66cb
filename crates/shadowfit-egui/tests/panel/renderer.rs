//! Draws a harness with the software adapter, on any machine.
//!
//! The renderer of `egui_kittest` would add OpenGL to the whole workspace.

use egui::{Context, FullOutput, TexturesDelta};
use egui_kittest::TestRenderer;
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use image::RgbaImage;

/// Format of the pictures. egui blends encoded colours.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Bytes of a pixel.
const PIXEL: u32 = 4;

/// egui on the software adapter.
pub(crate) struct SoftwareRenderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
}

impl SoftwareRenderer {
    /// Makes the renderer. Tests that the machine cannot run are skipped by name before they start, so a
    /// missing adapter is a failure here.
    pub(crate) fn new() -> Self {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
        let software = adapters.into_iter().find(|adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu);
        let adapter = software.expect("this test draws, and there is no software graphics adapter, such as lavapipe");
        let device = adapter.request_device(&wgpu::DeviceDescriptor::default());
        let (device, queue) = pollster::block_on(device).expect("the software adapter works");
        let renderer = Renderer::new(&device, FORMAT, RendererOptions::PREDICTABLE);
        Self { device, queue, renderer }
    }

    fn draw(&mut self, ctx: &Context, output: &FullOutput, target: &wgpu::Texture) {
        let (width, height) = (target.width(), target.height());
        let screen = ScreenDescriptor { size_in_pixels: [width, height], pixels_per_point: ctx.pixels_per_point() };
        let jobs = ctx.tessellate(output.shapes.clone(), ctx.pixels_per_point());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let commands = self.renderer.update_buffers(&self.device, &self.queue, &mut encoder, &jobs, &screen);
        let view = target.create_view(&Default::default());
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        self.renderer.render(&mut pass.forget_lifetime(), &jobs, &screen);
        self.queue.submit(commands.into_iter().chain([encoder.finish()]));
    }

    fn read(&self, texture: &wgpu::Texture) -> RgbaImage {
        let (width, height) = (texture.width(), texture.height());
        let row = (width * PIXEL).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let copy = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), copy, texture.size());
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.expect("the picture can be read"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the software adapter draws");
        let bytes = buffer.slice(..).get_mapped_range().expect("it was mapped");
        let pixels = bytes.chunks_exact(row as usize).flat_map(|row| &row[..(width * PIXEL) as usize]).copied();
        RgbaImage::from_raw(width, height, pixels.collect()).expect("as many bytes as pixels")
    }
}

impl TestRenderer for SoftwareRenderer {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        for (id, images) in delta.set.drain() {
            for image in images {
                self.renderer.update_texture(&self.device, &self.queue, id, &image);
            }
        }
        for id in delta.free.drain() {
            self.renderer.free_texture(&id);
        }
    }

    fn render(&mut self, ctx: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let size = ctx.content_rect().size() * ctx.pixels_per_point();
        let target = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: size.x.round() as u32,
                height: size.y.round() as u32,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        self.draw(ctx, output, &target);
        Ok(self.read(&target))
    }
}
