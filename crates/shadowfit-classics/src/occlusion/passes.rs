//! The passes that compute ambient occlusion and draw pictures with it.

use shadowfit::PerspectiveCamera;
use shadowfit_render::attachment::{cleared, depth};
use shadowfit_render::passes::Draw;
use shadowfit_render::{Atmosphere, FrameUniform, Gpu, GpuScene, ReadBack, ReadError, RenderTarget, bindings};

use super::pipelines::{Drawn, Pipelines};
use super::targets::Targets;
use super::{OcclusionFrame, OcclusionSettings, OcclusionUniform};

const MATERIAL_GROUP: u32 = 2;
const OCCLUSION_GROUP: u32 = 3;

/// Greatest number of radii of a frame.
const RADII: usize = 2;

/// Draws scenes with screen-space ambient occlusion.
#[derive(Debug)]
pub struct OcclusionPasses {
    pipelines: Pipelines,
    frame_uniform: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    /// One for each radius.
    uniforms: [(wgpu::Buffer, wgpu::BindGroup); RADII],
    targets: Option<Targets>,
    /// Whether the last frame was blurred.
    is_blurred: bool,
}

impl OcclusionPasses {
    /// Creates passes for targets with `samples` samples per pixel (1 or 4).
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let device = &gpu.device;
        let pipelines = Pipelines::new(device, samples);
        let layout = &pipelines.layouts.uniform;
        let bound =
            |label, buffer: &wgpu::Buffer| bindings::group(device, label, layout, &[buffer.as_entire_binding()]);
        let frame_uniform = bindings::uniform_buffer::<FrameUniform>(device, "frame");
        let frame_group = bound("frame", &frame_uniform);
        let uniforms = [(); RADII].map(|()| {
            let buffer = bindings::uniform_buffer::<OcclusionUniform>(device, "occlusion");
            let group = bound("occlusion", &buffer);
            (buffer, group)
        });
        Self { pipelines, frame_uniform, frame_group, uniforms, targets: None, is_blurred: false }
    }

    /// Draws a frame into a target with these passes' number of samples per pixel, and submits it. Afterwards
    /// the target's depth buffer holds the frame's depth, or is cleared for
    /// [`OcclusionView::Occlusion`](super::OcclusionView::Occlusion).
    ///
    /// `given` is occlusion from another source, such as rays: 0..=1 for each of the target's pixels, rows
    /// from the top. It replaces the occlusion of the frame's settings.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &OcclusionFrame,
        camera: &PerspectiveCamera,
        given: Option<&[f32]>,
        target: &RenderTarget,
    ) {
        self.is_blurred = given.is_none() && frame.settings.is_some_and(|settings| settings.blur);
        scene.begin_frame(camera.eye);
        let [opaque, blended] = scene.seen(camera.clip_from_world(shadowfit::DepthConvention::Reversed));
        scene.end_frame(gpu);
        self.prepare(gpu, frame, camera, &opaque, &blended, target.size);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        match given {
            Some(given) => self.take(gpu, given),
            None => self.occlusion_passes(&mut encoder, scene, frame, &opaque),
        }
        self.picture_pass(&mut encoder, scene, frame, &opaque, &blended, target);
        gpu.submit([encoder.finish()]);
    }

    /// Reads back the occlusion of the frame that was drawn last: 0 (open) to 1 (closed), rows from the top,
    /// 0 in the sky. Pixel centres match [`Renderer::probe`](shadowfit_render::Renderer::probe) for the same
    /// camera and size. Empty before the first frame.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    pub async fn read_occlusion(&self, gpu: &Gpu) -> Result<Vec<f32>, ReadError> {
        let Some(targets) = &self.targets else { return Ok(Vec::new()) };
        let bytes = ReadBack::new(gpu, targets.occlusion(self.is_blurred), targets.size, 2).arrive(gpu).await?;
        Ok(bytes.as_chunks().0.iter().map(|half| from_half(u16::from_le_bytes(*half))).collect())
    }

    /// Writes uniforms, and creates the targets and pipelines that the frame needs.
    fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &OcclusionFrame,
        camera: &PerspectiveCamera,
        opaque: &[Draw],
        blended: &[Draw],
        size: [u32; 2],
    ) {
        let settings = frame.settings.unwrap_or_default();
        let has_backs = frame.settings.is_some_and(|settings| settings.reads_backs());
        let uniform = FrameUniform::new(camera, frame.light.to_light, false, &Atmosphere::default(), size);
        gpu.queue.write_buffer(&self.frame_uniform, 0, bytemuck::bytes_of(&uniform));
        let radii = [settings.radius, settings.second_radius.unwrap_or(0.0)];
        for ((buffer, _), radius) in self.uniforms.iter().zip(radii) {
            let uniform = OcclusionUniform::new(camera, &frame.light, &OcclusionSettings { radius, ..settings });
            gpu.queue.write_buffer(buffer, 0, bytemuck::bytes_of(&uniform));
        }
        let kept = self.targets.take().filter(|targets| targets.serves(size, has_backs));
        let layouts = &self.pipelines.layouts;
        self.targets = Some(kept.unwrap_or_else(|| Targets::new(&gpu.device, layouts, size, has_backs)));
        let picture = Drawn::of_view(frame.view);
        for drawn in [Some(Drawn::Surface), has_backs.then_some(Drawn::Back), picture].into_iter().flatten() {
            self.pipelines.add(&gpu.device, drawn, opaque);
        }
        if let Some(picture) = picture {
            self.pipelines.add(&gpu.device, picture, blended);
        }
    }

    /// Uploads given occlusion. Ignores occlusion of another size.
    fn take(&self, gpu: &Gpu, given: &[f32]) {
        let Some(targets) = &self.targets else { return };
        let texture = targets.occlusion(false);
        let halves: Vec<u16> = given.iter().map(|value| to_half(*value)).collect();
        if halves.len() == targets.size[0] as usize * targets.size[1] as usize {
            gpu.queue.write_texture(
                texture.as_image_copy(),
                bytemuck::cast_slice(&halves),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(targets.size[0] * 2),
                    rows_per_image: None,
                },
                texture.size(),
            );
        }
    }

    /// Records the passes of positions, normals, occlusion and blur.
    fn occlusion_passes(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &OcclusionFrame,
        opaque: &[Draw],
    ) {
        let Some(targets) = &self.targets else { return };
        if let Some(settings) = &frame.settings {
            self.part_pass(encoder, scene, opaque, Drawn::Surface, targets);
            if settings.reads_backs() {
                self.part_pass(encoder, scene, opaque, Drawn::Back, targets);
            }
        }
        let mut pass = screen_pass(encoder, &targets.raw_view);
        if let Some(settings) = &frame.settings {
            pass.set_pipeline(self.pipelines.gather(settings));
            pass.set_bind_group(1, &targets.surfaces, &[]);
            let radii = 1 + usize::from(settings.second_radius.is_some());
            for (_, group) in &self.uniforms[..radii] {
                pass.set_bind_group(0, group, &[]);
                pass.draw(0..3, 0..1);
            }
        }
        drop(pass);
        if self.is_blurred {
            let mut pass = screen_pass(encoder, &targets.blurred_view);
            pass.set_pipeline(&self.pipelines.blur);
            pass.set_bind_group(0, &self.uniforms[0].1, &[]);
            pass.set_bind_group(1, &targets.blurring, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    /// Records the pass of positions and normals, or of the positions of back faces.
    fn part_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        draws: &[Draw],
        drawn: Drawn,
        targets: &Targets,
    ) {
        let none = wgpu::Color::TRANSPARENT;
        let position = if drawn == Drawn::Back { &targets.backs } else { &targets.positions };
        let normals = (drawn == Drawn::Surface).then(|| cleared(&targets.normals, None, none));
        let colors = [Some(cleared(position, None, none)), normals];
        let count = if drawn == Drawn::Back { 1 } else { 2 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("view-space surfaces"),
            color_attachments: &colors[..count],
            depth_stencil_attachment: Some(depth(&targets.depth)),
            ..Default::default()
        });
        self.draw_parts(&mut pass, scene, draws, drawn);
    }

    /// Records the picture's pass, which reads the occlusion.
    fn picture_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        frame: &OcclusionFrame,
        opaque: &[Draw],
        blended: &[Draw],
        target: &RenderTarget,
    ) {
        let Some(targets) = &self.targets else { return };
        let background = frame.background.as_dvec3().to_array();
        let mut pass = target.begin_encoded(encoder, "ambient occlusion", background);
        let Some(drawn) = Drawn::of_view(frame.view) else {
            pass.set_pipeline(&self.pipelines.view);
            pass.set_bind_group(0, targets.shown(self.is_blurred), &[]);
            pass.draw(0..3, 0..1);
            return;
        };
        pass.set_bind_group(OCCLUSION_GROUP, targets.shown(self.is_blurred), &[]);
        self.draw_parts(&mut pass, scene, opaque, drawn);
        self.draw_parts(&mut pass, scene, blended, drawn);
    }

    fn draw_parts(&self, pass: &mut wgpu::RenderPass<'_>, scene: &GpuScene, draws: &[Draw], drawn: Drawn) {
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, &self.uniforms[0].1, &[]);
        for draw in draws {
            pass.set_pipeline(self.pipelines.part(drawn, draw.key));
            scene.draw(pass, draw, Some(MATERIAL_GROUP));
        }
    }
}

/// Begins a pass over an occlusion texture, which is cleared to 0 (open).
fn screen_pass<'a>(encoder: &'a mut wgpu::CommandEncoder, view: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("occlusion"),
        color_attachments: &[Some(cleared(view, None, wgpu::Color::TRANSPARENT))],
        ..Default::default()
    })
}

/// Converts a half float that is finite and not negative.
fn from_half(bits: u16) -> f32 {
    // The exponent biases differ by 127 - 15 = 112. A product adds the difference without a special case for
    // subnormals.
    f32::from_bits(u32::from(bits) << 13) * 2.0_f32.powi(112)
}

/// Converts a number to a half float, clamped to 0..=1 and rounded to the nearest.
fn to_half(value: f32) -> u16 {
    let value = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
    // The product subtracts the difference of the exponent biases, also for subnormals. Adding half of the
    // last place rounds.
    let bits = (value * 2.0_f32.powi(-112)).to_bits();
    ((bits + 0x0fff + (bits >> 13 & 1)) >> 13) as u16
}

#[cfg(test)]
mod tests {
    use super::{from_half, to_half};

    #[test]
    fn half_floats_are_read_as_they_are() {
        // 1 is 0x3c00 (exponent 15), 0.5 is 0x3800, 0.1 is rounded to 0x2e66, the least one is 2⁻²⁴.
        for (bits, value) in [(0, 0.0), (0x3c00, 1.0), (0x3800, 0.5), (0x2e66, 0.099_975_586), (1, 2.0_f32.powi(-24))] {
            assert_eq!(from_half(bits), value);
            assert_eq!(to_half(value), bits);
        }
        assert_eq!(to_half(0.1), 0x2e66, "rounded");
        assert_eq!([f32::NAN, -1.0, 7.0].map(to_half), [0, 0, 0x3c00]);
    }
}
