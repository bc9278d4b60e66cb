//! Elements drawn over the picture: marks, insets, quadrilaterals.

use super::picture::set_part;
use super::{Plan, Renderer};
use crate::Gpu;
use crate::attachment::drawn_over;
use crate::frame::Frame;
use crate::marks::{MarkPasses, PreparedMarks};
use crate::target::RenderTarget;

impl Renderer {
    /// Draws over the resolved picture, if the frame has such elements.
    pub(super) fn over_pass(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
        plan: &Plan,
        target: &RenderTarget,
    ) {
        let marks = self.prepare_marks(gpu, encoder, frame, plan, target);
        if marks.is_none() && frame.insets.is_empty() && frame.quads.is_empty() {
            return;
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("over the picture"),
            color_attachments: &[Some(drawn_over(&target.color_view))],
            ..Default::default()
        });
        set_part(&mut pass, plan);
        if let Some(marks) = marks {
            marks.draw(&mut pass);
        }
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, self.shadow_map().receiver_group(), &[]);
        self.insets.draw(&mut pass, &self.pipelines.of_map.inset, 4);
        self.quads.draw(&mut pass, &self.pipelines.quads, 4);
    }

    fn prepare_marks(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
        plan: &Plan,
        target: &RenderTarget,
    ) -> Option<PreparedMarks> {
        let marks = frame.marks.filter(|marks| marks.strength > 0.0 && frame.judged.is_some())?;
        let judged = plan.judged.as_ref()?;
        let passes = self.marks.get_or_insert_with(|| MarkPasses::new(&gpu.device, &self.judged, self.samples));
        Some(passes.prepare(gpu, encoder, &marks, judged, self.judged.no_depth(), target))
    }
}
