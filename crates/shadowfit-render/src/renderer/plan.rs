//! Draws of each pass of a frame.

use glam::Mat4;

use super::Renderer;
use crate::attachment::{part, part_from_whole};
use crate::casters::CasterDraw;
use crate::frame::Frame;
use crate::scene::{Draw, GpuScene};
use crate::statistics::{MapStatistics, Statistics};
use crate::timer::Pass;
use crate::uniform::FrameUniform;
use crate::{Gpu, Overlay};
use shadowfit_wgpu::MAX_MAPS;

/// The draws of a frame's passes.
pub(super) struct Plan {
    /// Draws of each region of each shadow pass, in their order; `None` if the maps stay.
    pub(super) shadow: Option<Vec<Vec<CasterDraw>>>,
    pub(super) opaque: Vec<Draw>,
    pub(super) blended: Vec<Draw>,
    pub(super) overlay: Overlay,
    /// The judged picture's bind group, if it is shown.
    pub(super) judged: Option<wgpu::BindGroup>,
    /// Left, top, width and height of the part that is drawn, in pixels, unless the whole picture is drawn.
    pub(super) part: Option<[u32; 4]>,
    /// Timer label of the shaded pass.
    pub(super) timed: Pass,
}

impl Renderer {
    /// Decides what each pass draws and uploads the instances. `uniform` is the uniform of a picture of
    /// `size` pixels.
    pub(super) fn plan(
        &mut self,
        gpu: &Gpu,
        scene: &mut GpuScene,
        frame: &Frame<'_>,
        uniform: &FrameUniform,
        size: [u32; 2],
    ) -> Plan {
        scene.begin_frame(frame.camera.eye);
        let shadow = (!frame.maps_stay).then(|| self.plan_maps(scene));
        if shadow.is_some() {
            self.note_maps(scene, frame);
        }
        if frame.overlay == Overlay::Casters {
            let masks = self.sun.maps_by_caster(&scene.casters());
            scene.set_maps_by_caster(&masks);
        }
        let part = frame.scissor.map(|scissor| part(scissor, size));
        let clip_from_world = Mat4::from_cols_array_2d(&uniform.clip_from_world);
        let shown_from_whole = part.map_or(Mat4::IDENTITY, |part| part_from_whole(part, size));
        let [opaque, blended] = scene.seen(shown_from_whole * clip_from_world);
        scene.end_frame(gpu);
        let shows_judged = frame.overlay.is_judged() || (frame.marks.is_some() && frame.judged.is_some());
        Plan {
            shadow,
            opaque,
            blended,
            overlay: frame.overlay,
            judged: shows_judged.then(|| self.judged.bind(gpu, frame.judged, &frame.camera, size)),
            part,
            timed: self.timer.scene(frame.maps_stay),
        }
    }

    /// Returns the draws of the shadow passes' regions, and counts them.
    fn plan_maps(&mut self, scene: &mut GpuScene) -> Vec<Vec<CasterDraw>> {
        let mut shadow = Vec::new();
        let mut drawn = [MapStatistics::default(); MAX_MAPS];
        for region in self.sun.passes().flat_map(|pass| pass.regions()) {
            let mut draws: Vec<CasterDraw> = Vec::new();
            scene.caster_draws(region.casters, &mut draws);
            let map = &mut drawn[region.map];
            map.casters += region.casters.len() as u32;
            map.draws += draws.len() as u32;
            map.triangles +=
                draws.iter().map(|draw| (draw.indices.len() / 3 * draw.instances.len()) as u64).sum::<u64>();
            shadow.push(draws);
        }
        for update in self.sun.updates() {
            drawn[update.map].texels += update.rect.area();
        }
        self.drawn = drawn;
        shadow
    }
}

impl Plan {
    /// Returns the statistics of the frame. `maps` are the statistics of the shadow passes.
    pub(super) fn statistics(&self, maps: [MapStatistics; MAX_MAPS]) -> Statistics {
        Statistics {
            shadow_draws: maps.iter().map(|map| map.draws).sum(),
            shadow_triangles: maps.iter().map(|map| map.triangles).sum(),
            shadow_texels: maps.iter().map(|map| map.texels).sum(),
            scene_draws: (self.opaque.len() + self.blended.len()) as u32,
            maps,
        }
    }
}
