//! The passes that draw the scene through the camera: shaded, and as a probe.

use wgpu_profiler::GpuProfilerQuery;

use super::{Plan, Renderer};
use crate::attachment::{cleared, depth, drawn_over, kept_depth};
use crate::formats::COLOR_FORMAT;
use crate::pipelines::Drawn;
use crate::probe::ProbeTargets;
use crate::scene::{Draw, GpuScene};
use crate::target::RenderTarget;
use crate::timer::Pass;
use crate::{Gpu, bindings};

/// Bind groups of the material and of a judged picture.
const MATERIAL_GROUP: u32 = 2;
const JUDGED_GROUP: u32 = 3;

impl Renderer {
    /// Creates missing objects for drawing the scene's parts.
    pub(super) fn prepare_parts(&mut self, gpu: &Gpu, scene: &GpuScene, drawn: Drawn) {
        let Self { layouts, judged, sun, .. } = self;
        self.pipelines.of_map.add(&gpu.device, layouts, &judged.layout, sun.map(), drawn, &scene.parts);
    }

    pub(super) fn scene_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        plan: &Plan,
        target: &RenderTarget,
    ) {
        // Resolving writes whole pictures. A part is therefore resolved into another texture and copied.
        let resolved = plan.part.filter(|_| target.multisampled.is_some()).map(|part| {
            let texture = self.part_texture(gpu, target.size);
            (part, texture.create_view(&Default::default()), texture)
        });
        let resolve_target = resolved.as_ref().map_or(&target.color_view, |(_, view, _)| view);
        let color = match &target.multisampled {
            Some(view) => cleared(view, Some(resolve_target), wgpu::Color::BLACK),
            None if plan.part.is_some() => drawn_over(&target.color_view),
            None => cleared(&target.color_view, None, wgpu::Color::BLACK),
        };
        let query = self.timer.begin(plan.timed, encoder);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(match plan.part {
                Some(_) => kept_depth(&target.depth_view),
                None => depth(&target.depth_view),
            }),
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        self.draw_picture(&mut pass, scene, plan);
        drop(pass);
        self.timer.end(query, encoder);
        if let Some((part, _, texture)) = &resolved {
            copy_part(encoder, texture, &target.color, *part);
        }
    }

    fn draw_picture(&self, pass: &mut wgpu::RenderPass<'_>, scene: &GpuScene, plan: &Plan) {
        let drawn = Drawn::Shaded(plan.overlay);
        set_part(pass, plan);
        if plan.part.is_some() {
            pass.set_pipeline(&self.pipelines.clear);
            pass.draw(0..3, 0..1);
        }
        if let Some(judged) = plan.judged.as_ref().filter(|_| plan.overlay.is_judged()) {
            pass.set_bind_group(JUDGED_GROUP, judged, &[]);
        }
        self.draw_scene(pass, scene, &plan.opaque, drawn);
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_pipeline(self.pipelines.sky(plan.overlay));
        pass.draw(0..3, 0..1);
        self.draw_scene(pass, scene, &plan.blended, drawn);
        pass.set_bind_group(0, &self.frame_group, &[]);
        self.lines.draw(pass, &self.pipelines.lines, 6);
    }

    /// Draws the visible triangle and the shadow factor of each pixel, timed or not.
    pub(super) fn probe_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &GpuScene,
        plan: &Plan,
        targets: &ProbeTargets,
        is_timed: bool,
    ) {
        let query = if is_timed { self.timer.begin(Pass::Probe, encoder) } else { None };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("probe"),
            color_attachments: &[Some(cleared(&targets.view, None, wgpu::Color::TRANSPARENT))],
            depth_stencil_attachment: Some(depth(&targets.depth)),
            timestamp_writes: query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes),
            ..Default::default()
        });
        set_part(&mut pass, plan);
        self.draw_scene(&mut pass, scene, &plan.opaque, Drawn::Probe);
        drop(pass);
        self.timer.end(query, encoder);
    }

    pub(super) fn draw_scene(&self, pass: &mut wgpu::RenderPass<'_>, scene: &GpuScene, draws: &[Draw], drawn: Drawn) {
        pass.set_bind_group(0, &self.lit_group, &[]);
        pass.set_bind_group(1, self.shadow_map().receiver_group(), &[]);
        for draw in draws {
            pass.set_pipeline(self.pipelines.of_map.part(&scene.parts[draw.part], drawn));
            match drawn {
                Drawn::Probe => scene.draw_probed(pass, draw, MATERIAL_GROUP),
                _ => scene.draw(pass, draw, Some(MATERIAL_GROUP)),
            }
        }
    }

    /// Returns the texture into which a part of a picture of the given size is resolved.
    fn part_texture(&mut self, gpu: &Gpu, [width, height]: [u32; 2]) -> wgpu::Texture {
        let kept = self.part.take().filter(|texture| (texture.width(), texture.height()) == (width, height));
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let make = || bindings::plain_texture(&gpu.device, "part of a picture", [width, height], COLOR_FORMAT, usage);
        self.part.insert(kept.unwrap_or_else(make)).clone()
    }
}

/// Limits a pass to the part of the picture that is drawn.
pub(super) fn set_part(pass: &mut wgpu::RenderPass<'_>, plan: &Plan) {
    if let Some([x, y, width, height]) = plan.part {
        pass.set_scissor_rect(x, y, width, height);
    }
}

fn copy_part(
    encoder: &mut wgpu::CommandEncoder,
    from: &wgpu::Texture,
    to: &wgpu::Texture,
    [x, y, width, height]: [u32; 4],
) {
    let at = |texture| wgpu::TexelCopyTextureInfo {
        texture,
        mip_level: 0,
        origin: wgpu::Origin3d { x, y, z: 0 },
        aspect: wgpu::TextureAspect::All,
    };
    encoder.copy_texture_to_texture(at(from), at(to), wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
}
