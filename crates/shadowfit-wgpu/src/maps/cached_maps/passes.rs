//! The passes of a frame, for the engine to draw.

use shadowfit::cache::{FramePlan, PassKind, PassPlan, RegionVolumes};

use super::CachedMaps;
use crate::CullingRegion;
use crate::maps::static_layers::Opening;

/// A pass into a map. A map that is kept unchanged has none.
#[derive(Clone, Copy, Debug)]
pub struct ShadowPass<'a> {
    pub(super) maps: &'a CachedMaps,
    pub(super) pass: &'a PassPlan,
    /// Number of its plan's first region, among those of all sets of maps.
    first_region: usize,
}

/// A part of a pass: the casters that are drawn with one viewport and within one scissor rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawRegion<'a> {
    /// Number of the region among those of all passes of the frame.
    pub number: usize,
    /// Number of the map.
    pub map: usize,
    /// Left, top, width and height of the viewport, in texels. It may begin outside the texture: maps wrap around in
    /// their layers.
    pub viewport: [f32; 4],
    /// Left, top, width and height of the scissor rectangle, in texels.
    pub scissor: [u32; 4],
    /// The casters of the list to draw, by number, nearest to the light first, so that those behind others cost least.
    pub casters: &'a [u32],
    /// The static casters to draw ([`SunFrame::static_boxes`](crate::SunFrame::static_boxes)), by their numbers in the
    /// tree, likewise.
    pub static_boxes: &'a [u32],
}

impl<'a> ShadowPass<'a> {
    /// Number of the map. While the sun [steps](crate::SunShadows::set_light_steps) two maps have the same number.
    pub fn map(&self) -> usize {
        self.pass.map
    }

    /// What it draws.
    pub fn content(&self) -> PassKind {
        self.pass.content
    }

    /// Whether the whole layer is cleared, because no part of it can be kept.
    pub fn is_cleared(&self) -> bool {
        self.pass.clears
    }

    /// Its parts.
    pub fn regions(&self) -> impl ExactSizeIterator<Item = DrawRegion<'a>> + use<'a> {
        let (plan, pass) = (self.maps.cache.plan(), self.pass);
        let first = self.first_region;
        pass.regions.clone().map(move |region| DrawRegion { number: first + region, ..draw_region(plan, pass, region) })
    }
}

impl<'a> ShadowPass<'a> {
    /// The pass's regions for shaders that find their casters.
    pub(crate) fn culling_regions(&self) -> impl Iterator<Item = CullingRegion> + use<'a> {
        let (cache, pass) = (&self.maps.cache, self.pass);
        let parts = cache.plan().regions_of(pass).iter().map(|region| region.part.window);
        self.regions().zip(parts).map(move |(region, part)| {
            let RegionVolumes { casters, moving } = cache.region_volumes(pass.map, pass.content, part);
            let all = CullingRegion::new([casters].into_iter().chain(moving), cache.plan().origin);
            CullingRegion {
                viewport: region.viewport,
                scissor: region.scissor,
                map: region.map as u32,
                fixed: (pass.content != PassKind::Moving).into(),
                moving: (pass.content != PassKind::Static).into(),
                fixed_planes: casters.count,
                ..all
            }
        })
    }
}

impl ShadowPass<'_> {
    /// Records the pass. `draw` is called for each part that has casters.
    pub(crate) fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        draw: &mut impl FnMut(&mut wgpu::RenderPass<'_>, &DrawRegion<'_>),
    ) {
        let mut opened = self.begin(encoder, group, None);
        for region in self.regions().filter(|region| !region.casters.is_empty() || !region.static_boxes.is_empty()) {
            region.set(&mut opened);
            draw(&mut opened, &region);
        }
    }

    /// Opens the pass: cleared or mended, with the map's matrix bound at `group`.
    pub(crate) fn begin<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let CachedMaps { map, cache, layers, .. } = self.maps;
        layers.begin(encoder, Opening { map, plan: cache.plan(), group }, self.pass, timestamps)
    }
}

fn draw_region<'a>(plan: &'a FramePlan, pass: &PassPlan, number: usize) -> DrawRegion<'a> {
    let region = &plan.regions[number];
    let (first, stored) = (region.part.viewport(), region.part.stored);
    DrawRegion {
        number,
        map: pass.map,
        viewport: [first.x as f32, first.y as f32, pass.size.x as f32, pass.size.y as f32],
        scissor: [stored.min.x, stored.min.y, stored.size.x, stored.size.y],
        casters: plan.casters_of(region),
        static_boxes: plan.static_boxes_of(region),
    }
}

impl DrawRegion<'_> {
    /// Sets viewport and scissor rectangle.
    pub fn set(&self, pass: &mut wgpu::RenderPass<'_>) {
        let [x, y, width, height] = self.viewport;
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        let [x, y, width, height] = self.scissor;
        pass.set_scissor_rect(x, y, width, height);
    }
}

impl CachedMaps {
    /// Leaves the frame without passes.
    pub(crate) fn skip(&mut self) {
        self.cache.skip();
    }

    /// Number of passes of this frame.
    pub(crate) fn pass_count(&self) -> usize {
        self.cache.plan().passes.len()
    }

    /// Number of the passes' regions.
    pub(crate) fn piece_count(&self) -> usize {
        self.cache.plan().regions.len()
    }

    /// One of the passes, in the order in which they must be drawn. `first_region`: number of the first region of all.
    pub(crate) fn pass(&self, index: usize, first_region: usize) -> ShadowPass<'_> {
        ShadowPass { maps: self, pass: &self.cache.plan().passes[index], first_region }
    }
}
