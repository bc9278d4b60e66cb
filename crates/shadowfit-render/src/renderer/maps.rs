//! The shadow passes.

use shadowfit::ViewFrustum;
use shadowfit_wgpu::{Casters, Culling, DrawRegion, MapView, ShadowMapError, SunFrame};
use wgpu_profiler::GpuProfilerQuery;

use super::{Plan, Renderer};
use crate::Gpu;
use crate::casters::CasterDraw;
use crate::frame::Frame;
use crate::scene::GpuScene;
use crate::shaders::CASTER_GROUP;
use crate::timer::Pass;

impl Renderer {
    /// Decides what to draw into the maps, and writes the uniforms of the look-up.
    pub(super) fn prepare_maps(
        &mut self,
        gpu: &Gpu,
        scene: &GpuScene,
        frame: &Frame<'_>,
    ) -> Result<(), ShadowMapError> {
        let (eye, forward) = frame.reader();
        let origin = frame.camera.eye;
        if frame.maps_stay {
            return self.sun.set_view(&gpu.queue, &MapView { origin, ..MapView::from_eye(eye, forward) });
        }
        // The view of an invalid camera is unknown, so maps get all casters that they can store.
        let seen: Option<ViewFrustum> = frame.camera.frustum().ok();
        self.sun.set_culling(if seen.is_some() { frame.culling } else { Culling::WholeMap });
        let casters: Casters<'_> = scene.casters();
        let sun = SunFrame {
            eye,
            forward,
            receivers: None,
            ..SunFrame::new(seen.as_slice(), frame.direction, casters.boxes, casters)
        };
        self.sun.prepare(&gpu.queue, &sun.with_origin(origin), frame.maps)
    }

    pub(super) fn shadow_passes(&self, encoder: &mut wgpu::CommandEncoder, scene: &GpuScene, plan: &Plan) {
        let Some(shadow) = &plan.shadow else { return };
        let mut regions = shadow.iter();
        for pass in self.sun.passes() {
            let query = self.timer.begin(Pass::Shadow(pass.map()), encoder);
            let timestamps = query.as_ref().and_then(GpuProfilerQuery::render_pass_timestamp_writes);
            let mut opened = self.sun.begin_pass(encoder, &pass, CASTER_GROUP, timestamps);
            for (region, draws) in pass.regions().zip(&mut regions) {
                self.draw_piece(&mut opened, scene, &region, draws);
            }
            drop(opened);
            self.timer.end(query, encoder);
        }
    }

    fn draw_piece(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &GpuScene,
        region: &DrawRegion<'_>,
        draws: &[CasterDraw],
    ) {
        region.set(pass);
        for draw in draws {
            let part = &scene.parts[draw.part];
            pass.set_pipeline(self.pipelines.of_map.caster(part));
            pass.set_bind_group(1, &scene.materials[part.material], &[]);
            pass.set_vertex_buffer(0, part.streams[0].slice(..));
            pass.set_vertex_buffer(1, part.streams[3].slice(..));
            pass.set_vertex_buffer(2, scene.instance_buffer.slice(..));
            pass.set_index_buffer(part.caster_indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(draw.indices.clone(), 0, draw.instances.start as u32..draw.instances.end as u32);
        }
    }
}
