//! The data of one pixel.

use super::Renderer;
use super::edges::Extent;
use crate::attachment::cleared;
use crate::frame::Frame;
use crate::pipelines::Drawn;
use crate::pixel::{BLOCK_FORMAT, PixelQuery, PixelRead, ROW, TexelBlock};
use crate::probe::{ProbeError, ProbeTargets};
use crate::scene::GpuScene;
use crate::uniform::BlockUniform;
use crate::{Gpu, bindings};

impl Renderer {
    /// Starts to read the visible triangle and factor of one pixel of a frame, and the depths of a map around
    /// a texel. The maps [stay](Frame::maps_stay) as they were drawn last, regardless of the frame's setting.
    ///
    /// # Errors
    ///
    /// [`ProbeError`] if the camera has no direction.
    pub fn probe_pixel(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        query: &PixelQuery,
    ) -> Result<PixelRead, ProbeError> {
        let kept = self.pixel_targets.take().filter(|targets| targets.size == query.size);
        let targets = kept.unwrap_or_else(|| ProbeTargets::new(&gpu.device, query.size));
        let [x, y] = [0, 1].map(|i| query.pixel[i].min(targets.size[i] - 1));
        let frame = Frame {
            reader: frame.reader,
            shadows: frame.shadows,
            maps_stay: true,
            scissor: Some([x, y, 1, 1]),
            ..Frame::new(frame.camera, frame.direction, &[], frame.atmosphere)
        };
        let plan = self.prepare(gpu, scene, &frame, Drawn::Probe, targets.size)?;
        let block = query.texels.filter(|block| block.map < self.sun.maps().len());
        let read = PixelRead::new(&gpu.device, *query, block.is_some());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.trace_edges(gpu, &mut encoder, scene, &frame, &plan, Extent { size: targets.size, samples: 1 });
        self.probe_pass(&mut encoder, scene, &plan, &targets, false);
        let pixel = Texels { texture: &targets.texture, corner: [x, y], size: [1, 1] };
        pixel.copy(&mut encoder, read.buffer(), 0);
        if let Some(block) = block {
            self.block_pass(gpu, &mut encoder, &block, read.buffer());
        }
        gpu.submit([encoder.finish()]);
        read.map();
        self.pixel_targets = Some(targets);
        Ok(read)
    }

    /// Draws the depths of a block of texels of an existing map, and copies them.
    fn block_pass(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, block: &TexelBlock, buffer: &wgpu::Buffer) {
        let side = block.side();
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let texture = bindings::plain_texture(&gpu.device, "texels", [side; 2], BLOCK_FORMAT, usage);
        let view = texture.create_view(&Default::default());
        let uniform = bindings::uniform_buffer::<BlockUniform>(&gpu.device, "texels");
        let last = self.sun.maps()[block.map].projection.resolution.as_ivec2() - 1;
        let reach = (side / 2).cast_signed();
        let first = block.texel.map(|texel| texel.saturating_sub(reach));
        let data = BlockUniform { first, last: last.to_array(), map: block.map as u32, ..BlockUniform::default() };
        gpu.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&data));
        let resources = [uniform.as_entire_binding()];
        let group = bindings::group(&gpu.device, "texels", &self.layouts.uniform, &resources);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("texels"),
            color_attachments: &[Some(cleared(&view, None, wgpu::Color::TRANSPARENT))],
            ..Default::default()
        });
        pass.set_pipeline(self.pipelines.of_map.block(&gpu.device, &self.layouts, self.sun.map()));
        pass.set_bind_group(0, &group, &[]);
        pass.set_bind_group(1, self.sun.map().receiver_group(), &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        Texels { texture: &texture, corner: [0, 0], size: [side; 2] }.copy(encoder, buffer, u64::from(ROW));
    }
}

/// A part of a texture, from its left top pixel on.
struct Texels<'a> {
    texture: &'a wgpu::Texture,
    corner: [u32; 2],
    size: [u32; 2],
}

impl Texels<'_> {
    /// Copies the texels to a buffer, in rows of [`ROW`] bytes from an offset on.
    fn copy(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer, offset: u64) {
        let Self { texture, corner: [x, y], size: [width, height] } = *self;
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x, y, z: 0 },
                aspect: wgpu::TextureAspect::All,
            },
            wgpu::TexelCopyBufferInfo {
                buffer,
                layout: wgpu::TexelCopyBufferLayout { offset, bytes_per_row: Some(ROW), rows_per_image: None },
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    }
}
